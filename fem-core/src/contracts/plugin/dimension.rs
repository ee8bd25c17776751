//! Dimensions of quantities.

use std::fmt;

/// Exponents of length, mass, time and temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimension(pub [f64; 4]);

#[allow(missing_docs)]
impl Dimension {
    pub const NONE: Self = Self([0.0; 4]);
    pub const LENGTH: Self = Self([1.0, 0.0, 0.0, 0.0]);
    pub const AREA: Self = Self([2.0, 0.0, 0.0, 0.0]);
    pub const MASS: Self = Self([0.0, 1.0, 0.0, 0.0]);
    pub const TIME: Self = Self([0.0, 0.0, 1.0, 0.0]);
    pub const TEMPERATURE: Self = Self([0.0, 0.0, 0.0, 1.0]);
    pub const EXPANSION: Self = Self([0.0, 0.0, 0.0, -1.0]);
    pub const VELOCITY: Self = Self([1.0, 0.0, -1.0, 0.0]);
    pub const ACCELERATION: Self = Self([1.0, 0.0, -2.0, 0.0]);
    pub const FREQUENCY: Self = Self([0.0, 0.0, -1.0, 0.0]);
    pub const FORCE: Self = Self([1.0, 1.0, -2.0, 0.0]);
    pub const ENERGY: Self = Self([2.0, 1.0, -2.0, 0.0]);
    pub const PRESSURE: Self = Self([-1.0, 1.0, -2.0, 0.0]);
    pub const DENSITY: Self = Self([-3.0, 1.0, 0.0, 0.0]);
    /// Energy per area, as of a fracture toughness.
    pub const TOUGHNESS: Self = Self([0.0, 1.0, -2.0, 0.0]);

    /// Force per length to the power `n`: the stiffness of a contact law F = k αⁿ.
    pub const fn contact_stiffness(n: f64) -> Self {
        Self([1.0 - n, 1.0, -2.0, 0.0])
    }

    /// Equal to rounding (exponents may be fractions).
    pub fn matches(&self, other: &Self) -> bool {
        self.0.iter().zip(other.0).all(|(a, b)| (a - b).abs() < 1e-9)
    }
}

/// As a unit that readers of scenes take: N, Pa, J, m/s, kg/m^3, N/m^1.5.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [m, kg, s, kelvin] = self.0;
        let factors = match (m, kg, s) {
            (2.0, 1.0, -2.0) => vec![("J", 1.0), ("K", kelvin)],
            (m, kg, s) if kg != 0.0 && m == -kg && s == -2.0 * kg => vec![("Pa", kg), ("K", kelvin)],
            (_, 1.0, -2.0) => vec![("N", 1.0), ("m", m - 1.0), ("K", kelvin)],
            _ => vec![("kg", kg), ("m", m), ("s", s), ("K", kelvin)],
        };
        let power = |(unit, exponent): &(&str, f64)| match exponent.abs() {
            1.0 => (*unit).to_owned(),
            exponent => format!("{unit}^{exponent}"),
        };
        let of_sign = |sign: f64| -> Vec<String> { factors.iter().filter(|f| f.1 * sign > 0.0).map(power).collect() };
        let (above, below) = (of_sign(1.0), of_sign(-1.0));
        match (above.join(" "), &below[..]) {
            (above, []) if above.is_empty() => write!(f, "a pure number"),
            (above, []) => write!(f, "{above}"),
            (above, below) => {
                let above = if above.is_empty() { "1" } else { &above };
                let below = if let [one] = below { one.clone() } else { format!("({})", below.join(" ")) };
                write!(f, "{above}/{below}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dimensions_are_written_as_units() {
        let expected = [
            (Dimension::LENGTH, "m"),
            (Dimension::EXPANSION, "1/K"),
            (Dimension::VELOCITY, "m/s"),
            (Dimension::FORCE, "N"),
            (Dimension::ENERGY, "J"),
            (Dimension::PRESSURE, "Pa"),
            (Dimension::TOUGHNESS, "N/m"),
            (Dimension::DENSITY, "kg/m^3"),
            (Dimension::contact_stiffness(1.5), "N/m^1.5"),
            (Dimension([3.0, -3.0, 6.0, 0.0]), "1/Pa^3"),
            (Dimension([-1.0, 0.0, -2.0, 0.0]), "1/(m s^2)"),
            (Dimension::NONE, "a pure number"),
        ];
        for (dimension, unit) in expected {
            assert_eq!(dimension.to_string(), unit);
        }
    }
}
