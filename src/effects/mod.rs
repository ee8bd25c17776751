//! The effects of the framework, one file each.

mod cure;
mod damping;
mod gravity;
mod growth;
mod inertia;
mod membrane;
mod plies;
mod preload;

pub use cure::Cure;
pub use damping::ViscousDamping;
pub use gravity::Gravity;
pub use growth::GrowingDelaminations;
pub use inertia::NoInertia;
pub use membrane::Membrane;
pub use plies::NonlinearPlies;
pub use preload::Preload;

use crate::effect::{Effect, Wish};
use fem_io::scene::{Form, SceneError, SceneValue};

/// The word of what does not act.
const OFF: Form = Form::Words(&["off"]);

/// Whether an effect acts, as a scene says it.
#[derive(Clone, Copy, PartialEq)]
enum Switch {
    Off,
    On,
    Auto,
}

const SWITCHES: [(&str, Switch); 3] = [("off", Switch::Off), ("on", Switch::On), ("auto", Switch::Auto)];

/// What a switch wishes of an effect that acts when it is `acts`.
fn read_switch(value: &SceneValue<'_>, acts: Switch, effect: impl Effect + 'static) -> Result<Wish, SceneError> {
    Ok(match value.choice(&SWITCHES)? {
        Switch::Auto => Wish::Auto(Box::new(effect)),
        switch if switch == acts => Wish::On(Box::new(effect)),
        _ => Wish::Off,
    })
}
