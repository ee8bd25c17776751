//! The effects of the framework, one file each.

mod cure;
mod damping;
mod gravity;
mod inertia;
mod membrane;
mod plies;

pub use cure::Cure;
pub use damping::ViscousDamping;
pub use gravity::Gravity;
pub use inertia::NoInertia;
pub use membrane::Membrane;
pub use plies::NonlinearPlies;

use fem_io::scene::Form;

/// The word of what does not act.
const OFF: Form = Form::Words(&["off"]);

/// Whether an effect acts, as a scene says it.
#[derive(Clone, Copy)]
enum Switch {
    Off,
    On,
    Auto,
}

const SWITCHES: [(&str, Switch); 3] = [("off", Switch::Off), ("on", Switch::On), ("auto", Switch::Auto)];
