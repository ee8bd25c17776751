//! Contact laws.
//!
//! | name | loading | below the largest indentation |
//! | --- | --- | --- |
//! | `linear` | k α | the same |
//! | `hertz` | k αⁿ | the same |
//! | `elastic-plastic` | k α^1.5, a straight line once the plate yields | as stiff as k α^1.5 is there, which leaves a dent and dissipates |
//! | `sun-yang` | k αⁿ | a steeper curve, which leaves a dent and dissipates |

mod elastic_plastic;
mod hertz;
mod linear;
mod sun_yang;
mod without_squeeze;

pub use elastic_plastic::ElasticPlastic;
pub use hertz::Hertz;
pub use linear::Linear;
pub use sun_yang::SunYang;
pub use without_squeeze::WithoutSqueeze;
