//! Contact laws.
//!
//! | name | loading | below the largest indentation |
//! | --- | --- | --- |
//! | `linear` | k α | the same |
//! | `hertz` | k αⁿ | the same |
//! | `sun-yang` | k αⁿ | a steeper curve, which leaves a dent and dissipates |

mod hertz;
mod linear;
mod sun_yang;
mod without_squeeze;

pub use hertz::Hertz;
pub use linear::Linear;
pub use sun_yang::SunYang;
pub use without_squeeze::WithoutSqueeze;
