//! A hard case and what was measured of it.

use std::time::Instant;

/// Rooms of the catalogue, in the order of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Room {
    Time,
    Guards,
    Space,
    Algebra,
    Failure,
    Growth,
    Resources,
    Input,
}

impl Room {
    pub(crate) const ALL: [Self; 8] = [
        Self::Time,
        Self::Guards,
        Self::Space,
        Self::Algebra,
        Self::Failure,
        Self::Growth,
        Self::Resources,
        Self::Input,
    ];

    /// A case that does not wait for `--ignored`; see [`Case`].
    pub(crate) fn case(
        self,
        name: &'static str,
        varied: &'static str,
        measure: &'static str,
        bound: f64,
        worst: fn() -> f64,
    ) -> Case {
        Case { room: self, name, varied, measure, bound, long: false, worst }
    }

    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Time => "Time integration and contact",
            Self::Guards => "Guards of a march",
            Self::Space => "Space",
            Self::Algebra => "Algebra",
            Self::Failure => "Failure criteria",
            Self::Growth => "Delaminations that grow",
            Self::Resources => "Resources",
            Self::Input => "Malformed input",
        }
    }
}

/// A hard case: one number, the worst of all that is varied, must not exceed a bound.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    pub(crate) room: Room,
    pub(crate) name: &'static str,
    /// What is varied, over which range.
    pub(crate) varied: &'static str,
    /// What the number is. Where it counts ("inputs that are not refused by name"), the bound is 0.
    pub(crate) measure: &'static str,
    pub(crate) bound: f64,
    /// Takes more than some seconds: runs with `--ignored` only.
    pub(crate) long: bool,
    /// The worst value met. It panics where something other than the number is wrong.
    pub(crate) worst: fn() -> f64,
}

/// What was measured of the case of a name.
#[derive(Debug, Clone)]
pub(crate) struct Measured {
    pub(crate) name: &'static str,
    pub(crate) worst: f64,
    pub(crate) seconds: f64,
}

impl Case {
    /// The same, run with `--ignored` only.
    pub(crate) fn long(self) -> Self {
        Self { long: true, ..self }
    }

    /// Name as a test: `time::a_name_of_words`.
    pub(crate) fn title(&self) -> String {
        format!("{:?}::{}", self.room, self.name.replace(|c: char| !c.is_alphanumeric(), "_")).to_lowercase()
    }

    pub(crate) fn measure(&self) -> Measured {
        let start = Instant::now();
        let worst = (self.worst)();
        Measured { name: self.name, worst, seconds: start.elapsed().as_secs_f64() }
    }

    /// Whether the bound holds; a NaN does not.
    pub(crate) fn verdict(&self, measured: &Measured) -> Result<(), String> {
        let (worst, bound) = (measured.worst, self.bound);
        if worst <= bound {
            return Ok(());
        }
        Err(format!("{}: {} is {worst:e}, more than {bound:e}", self.name, self.measure))
    }
}
