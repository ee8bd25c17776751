//! Where work has gone.

/// The two parts of the work done on something: J on a contact or a plate, J/m³ on a ply, J/m² on an interface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energy {
    /// Recoverable part.
    pub stored: f64,
    /// Lost part.
    pub dissipated: f64,
}

impl Energy {
    /// All the work.
    pub fn total(&self) -> f64 {
        self.stored + self.dissipated
    }
}
