//! Quantities as people read them.

use super::Dimension;

/// A unit to show values in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayUnit {
    /// As it is written behind a number; empty for a pure number.
    pub symbol: &'static str,
    /// How many of it are one in SI units.
    pub per: f64,
    /// The smallest value in SI units that it is used for.
    from: f64,
}

const fn unit(symbol: &'static str, per: f64, from: f64) -> DisplayUnit {
    DisplayUnit { symbol, per, from }
}

/// Dimensions and their units, the largest first.
const UNITS: [(Dimension, &[DisplayUnit]); 10] = [
    (Dimension::NONE, &[unit("", 1.0, 0.0)]),
    (Dimension::LENGTH, &[unit("m", 1.0, 1.0), unit("mm", 1e3, 1e-4), unit("um", 1e6, 1e-7), unit("nm", 1e9, 0.0)]),
    (Dimension::MASS, &[unit("kg", 1.0, 1.0), unit("g", 1e3, 1e-4), unit("mg", 1e6, 0.0)]),
    (Dimension::TIME, &[unit("s", 1.0, 0.1), unit("ms", 1e3, 1e-4), unit("us", 1e6, 1e-7), unit("ns", 1e9, 0.0)]),
    (Dimension::VELOCITY, &[unit("km/s", 1e-3, 1e4), unit("m/s", 1.0, 0.1), unit("mm/s", 1e3, 0.0)]),
    (Dimension::FREQUENCY, &[unit("MHz", 1e-6, 1e6), unit("kHz", 1e-3, 1e4), unit("Hz", 1.0, 0.0)]),
    (Dimension::FORCE, &[unit("MN", 1e-6, 1e7), unit("kN", 1e-3, 1e4), unit("N", 1.0, 0.1), unit("mN", 1e3, 0.0)]),
    (Dimension::ENERGY, &[unit("kJ", 1e-3, 1e4), unit("J", 1.0, 0.1), unit("mJ", 1e3, 1e-4), unit("uJ", 1e6, 0.0)]),
    (
        Dimension::PRESSURE,
        &[unit("GPa", 1e-9, 1e10), unit("MPa", 1e-6, 1e5), unit("kPa", 1e-3, 100.0), unit("Pa", 1.0, 0.0)],
    ),
    (Dimension::AREA, &[unit("m^2", 1.0, 0.1), unit("mm^2", 1e6, 0.0)]),
];

impl Dimension {
    /// The unit that fits values up to `largest` in SI units, for columns, axes and lists; `None` where none is known here.
    pub fn unit_for(self, largest: f64) -> Option<DisplayUnit> {
        let (_, units) = UNITS.iter().find(|(dimension, _)| dimension.matches(&self))?;
        // Compared as it is shown: 0.99999 kg is 1 kg, not 1000 g. Zero is shown in the usual unit, which has no prefix or
        // that of millimetres and milliseconds.
        let shown = rounded(largest.abs());
        let usual = || {
            units
                .iter()
                .find(|u| matches!(u.symbol, "mm" | "ms" | "m/s" | "Hz" | "N" | "J" | "MPa" | "mm^2"))
                .or(units.first())
        };
        if shown == 0.0 { usual().copied() } else { units.iter().find(|u| shown >= u.from).copied() }
    }

    /// Values in SI units with one unit behind them, "0, 1.5 mm".
    pub fn list(self, values: &[f64]) -> String {
        let unit = self.unit_for(values.iter().fold(0.0, |most, value| value.abs().max(most)));
        let number = |value: &f64| unit.map_or_else(|| digits(*value), |unit| unit.number(*value));
        let numbers = values.iter().map(number).collect::<Vec<_>>().join(", ");
        match unit {
            Some(DisplayUnit { symbol: "", .. }) => numbers,
            Some(unit) => format!("{numbers} {}", unit.symbol),
            None => format!("{numbers} {self}"),
        }
    }

    /// `value`, in SI units, with its unit and the prefix that fits.
    ///
    /// ```
    /// use fem_core::plugin::Dimension;
    /// assert_eq!(Dimension::MASS.of(1.05e-3), "1.05 g");
    /// assert_eq!(Dimension::TIME.of(3.5e-7), "0.35 us");
    /// assert_eq!(Dimension::FORCE.of(1911.23), "1911 N");
    /// ```
    pub fn of(self, value: f64) -> String {
        self.list(&[value])
    }
}

impl DisplayUnit {
    /// `value`, in SI units, as a number in this unit.
    pub fn number(self, value: f64) -> String {
        digits(value * self.per)
    }
}

/// A number to four significant digits, without zeros behind them; powers of ten below a thousandth and from ten million on.
pub fn digits(value: f64) -> String {
    let value = match rounded(value) {
        // Whole digits are not made up.
        large if large.abs() >= 1e4 && large.abs() < 1e7 => value.round(),
        rounded => rounded,
    };
    if value != 0.0 && !(1e-3..1e7).contains(&value.abs()) { format!("{value:e}") } else { (value + 0.0).to_string() }
}

/// `value` with four significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_and_the_prefix_that_fits() {
        let cases = [
            (Dimension::MASS, 2.49, "2.49 kg"),
            (Dimension::MASS, 0.999_99, "1 kg"),
            (Dimension::MASS, 6.5167e-3, "6.517 g"),
            (Dimension::TIME, 0.0, "0 ms"),
            (Dimension::FREQUENCY, 0.0, "0 Hz"),
            (Dimension::VELOCITY, 0.0, "0 m/s"),
            (Dimension::TIME, 3.922e-4, "0.3922 ms"),
            (Dimension::TIME, 1e-7, "0.1 us"),
            (Dimension::TIME, 4e-8, "40 ns"),
            (Dimension::TIME, 0.5638, "0.5638 s"),
            (Dimension::LENGTH, 1.3208e-4, "0.1321 mm"),
            (Dimension::LENGTH, -1.36e-6, "-1.36 um"),
            (Dimension::FORCE, 12_345.0, "12.35 kN"),
            (Dimension::PRESSURE, 130.3e9, "130.3 GPa"),
            (Dimension::PRESSURE, 535.6e6, "535.6 MPa"),
            (Dimension::ENERGY, 3.0298, "3.03 J"),
            (Dimension::NONE, 0.25, "0.25"),
            (Dimension::contact_stiffness(1.5), 3.3836e9, "3.384e9 N/m^1.5"),
        ];
        for (dimension, value, text) in cases {
            assert_eq!(dimension.of(value), text);
        }
    }

    #[test]
    fn numbers_have_four_digits_at_most_and_whole_ones_all() {
        let cases = [
            (0.1 + 0.2, "0.3"),
            (1_913.209_752, "1913"),
            (12_345.6, "12346"),
            (7.633_260_46e-9, "7.633e-9"),
            (-0.0, "0"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ];
        for (value, text) in cases {
            assert_eq!(digits(value), text);
        }
    }

    #[test]
    fn a_column_has_one_unit() {
        let unit = Dimension::TIME.unit_for(2e-3);
        assert_eq!(unit.map(|u| (u.symbol, u.number(5e-5))), Some(("ms", "0.05".to_owned())));
        assert_eq!(Dimension::DENSITY.unit_for(1.0), None);
        assert_eq!(Dimension::LENGTH.list(&[0.0, -1.5e-3]), "0, -1.5 mm");
        assert_eq!(Dimension::DENSITY.list(&[1575.0]), "1575 kg/m^3");
    }
}
