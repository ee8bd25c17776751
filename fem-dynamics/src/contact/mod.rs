//! Contact laws.
//!
//! | name | loading | below the largest indentation |
//! | --- | --- | --- |
//! | `linear` | k α | the same |
//! | `hertz` | k αⁿ | the same |
//! | `yigit-christoforou` | k α^1.5, a straight line once the plate yields | as stiff as k α^1.5 is there, which leaves a dent and dissipates |
//! | `sun-yang` | k αⁿ | a steeper curve, which leaves a dent and dissipates |

mod hertz;
mod linear;
mod sun_yang;
mod without_squeeze;
mod yigit_christoforou;

pub use hertz::Hertz;
pub use linear::Linear;
pub use sun_yang::SunYang;
pub use without_squeeze::WithoutSqueeze;
pub use yigit_christoforou::YigitChristoforou;
