//! Quantities as people write them: a number and a unit, `"1.07e5 N/mm^1.5"`, into SI.
//!
//! ```text
//! quantity = number unit
//! unit     = factor { ("*" | "·" | blank) factor | "/" factor }
//! factor   = (symbol | "1" | "(" unit ")") ["^" exponent | "²" | "³"]
//! exponent = number | "(" number ["/" number] ")"
//! ```
//!
//! Scale factors of symbols are those of the crate `uom` (its pound and psi are rounded to seven digits); the powers and
//! products are ours, because a contact stiffness has fractional exponents. `u` stands for `µ`. Angles are pure numbers,
//! in radians. A product after a `/` needs parentheses: `J/kg K` is refused, `J/(kg K)` is not.

use fem_core::plugin::{Dimension, unknown_key};
use thiserror::Error;
use uom::si::f64 as si;

/// A text that is not a quantity.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum UnitError {
    /// The text does not begin with a number.
    #[error("`{0}` does not begin with a number")]
    NoNumber(String),
    /// A number alone.
    #[error("`{0}` is a bare number")]
    BareNumber(String),
    /// A symbol that no table knows.
    #[error("unknown unit `{symbol}`")]
    Unknown {
        /// The symbol.
        symbol: String,
    },
    /// A unit that does not follow the grammar.
    #[error("unit `{unit}`: {why}")]
    Syntax {
        /// The whole unit.
        unit: String,
        /// What is wrong.
        why: String,
    },
    /// Too large or too small for a number of 64 bits.
    #[error("`{0}` is out of the range of numbers")]
    OutOfRange(String),
    /// A unit of the wrong dimension.
    #[error("`{text}` is {found}, not {wanted}")]
    WrongDimension {
        /// The quantity.
        text: String,
        /// What it is, in words.
        found: String,
        /// What it should be, in words.
        wanted: String,
    },
}

impl UnitError {
    /// What to write instead, where a quantity of dimension `wanted` belongs (any, if `None`).
    pub fn remedy(&self, wanted: Option<Dimension>) -> String {
        let units = wanted.map_or_else(symbols, accepted);
        match self {
            Self::Unknown { symbol } => format!("`{symbol}` {}", unknown_key(symbol, units.iter().copied())),
            Self::Syntax { unit, .. } if unit.starts_with(',') => "write 2.49, not 2,49".to_owned(),
            Self::Syntax { .. } => "write units such as N/mm^1.5, kg/m^3, J/(kg K), m^(3/2)".to_owned(),
            Self::BareNumber(number) if !units.is_empty() => {
                format!("write its unit, for example \"{number} {}\"; accepted: {}", units[0], units.join(", "))
            }
            _ if !units.is_empty() => format!("write a number and a unit; accepted: {}", units.join(", ")),
            _ => "write a number and a unit, for example \"1.07e5 N/mm^1.5\"".to_owned(),
        }
    }
}

/// A dimension in words with the units to propose for it. Any other unit of the dimension is accepted as well.
struct Named {
    dimension: Dimension,
    name: &'static str,
    units: &'static [&'static str],
}

/// Of the α in Hahn and Tsai's shear, γ = τ/G12 + α τ³.
pub(crate) const SHEAR_ALPHA: Dimension = Dimension([3.0, -3.0, 6.0, 0.0]);

const NAMED: &[Named] = &[
    Named { dimension: Dimension::LENGTH, name: "a length", units: &["mm", "m", "cm", "um", "nm", "in", "mil", "ft"] },
    Named { dimension: Dimension::MASS, name: "a mass", units: &["kg", "g", "mg", "t", "lb", "oz", "slug"] },
    Named { dimension: Dimension::TIME, name: "a time", units: &["us", "s", "ms", "ns", "min"] },
    Named {
        dimension: Dimension::VELOCITY,
        name: "a velocity",
        units: &["m/s", "mm/s", "mm/us", "km/h", "ft/s", "in/s"],
    },
    Named { dimension: Dimension::ACCELERATION, name: "an acceleration", units: &["m/s^2", "mm/s^2"] },
    Named { dimension: Dimension::FREQUENCY, name: "a frequency", units: &["1/s", "Hz", "kHz", "MHz"] },
    Named { dimension: Dimension::FORCE, name: "a force", units: &["N", "kN", "MN", "mN", "lbf", "kip"] },
    Named { dimension: Dimension::ENERGY, name: "an energy", units: &["J", "mJ", "kJ", "N m", "N mm"] },
    Named {
        dimension: Dimension::PRESSURE,
        name: "a stress",
        units: &["MPa", "GPa", "kPa", "Pa", "N/mm^2", "bar", "psi", "ksi", "Msi"],
    },
    Named {
        dimension: Dimension::DENSITY,
        name: "a density",
        units: &["g/cm^3", "kg/m^3", "g/cc", "t/mm^3", "lb/in^3"],
    },
    Named { dimension: Dimension::TOUGHNESS, name: "an energy per area", units: &["kJ/m^2", "J/m^2", "N/mm", "N/m"] },
    Named { dimension: Dimension::TEMPERATURE, name: "a temperature", units: &["K"] },
    Named { dimension: Dimension::EXPANSION, name: "a thermal expansion", units: &["1/K"] },
    Named { dimension: SHEAR_ALPHA, name: "a bend of a shear curve", units: &["1/MPa^3", "1/GPa^3", "1/Pa^3"] },
    Named { dimension: Dimension::NONE, name: "an angle", units: &["deg", "rad"] },
];

/// Units proposed for a dimension; empty for one without a name.
pub(crate) fn accepted(dimension: Dimension) -> Vec<&'static str> {
    NAMED.iter().filter(|n| n.dimension.matches(&dimension)).flat_map(|n| n.units).copied().collect()
}

/// The simple symbols of all tables.
fn symbols() -> Vec<&'static str> {
    NAMED.iter().flat_map(|n| n.units).copied().filter(|u| u.chars().all(char::is_alphabetic)).collect()
}

/// A dimension in words: "a length", or its SI units where it has no name.
fn describe(dimension: Dimension) -> String {
    NAMED
        .iter()
        .find(|n| n.dimension.matches(&dimension))
        .map_or_else(|| format!("a quantity in {dimension}"), |n| n.name.to_owned())
}

/// Reads a quantity: its value in SI and its dimension.
///
/// # Errors
/// [`UnitError`] for anything but a finite number with a known unit.
///
/// ```
/// use fem_core::plugin::Dimension;
/// let (thickness, dimension) = fem_io::units::parse_quantity("5.2 mil")?;
/// assert!((thickness - 1.3208e-4).abs() < 1e-18 && dimension == Dimension::LENGTH);
/// # Ok::<(), fem_io::units::UnitError>(())
/// ```
pub fn parse_quantity(text: &str) -> Result<(f64, Dimension), UnitError> {
    let text = text.trim();
    let (number, unit) = split_number(text);
    let Ok(number) = number.parse::<f64>() else { return Err(UnitError::NoNumber(text.to_owned())) };
    if unit.is_empty() {
        return Err(UnitError::BareNumber(text.to_owned()));
    }
    let mut parser = Parser { unit, at: 0 };
    let scale = parser.product(0)?;
    if parser.peek().is_some() {
        return Err(parser.syntax("`)` without `(`"));
    }
    let value = scaled(number, scale.factor);
    // An underflow is as wrong as an overflow: it would turn a small number into none.
    if !value.is_finite() || !scale.factor.is_normal() || (value == 0.0) != (number == 0.0) {
        return Err(UnitError::OutOfRange(text.to_owned()));
    }
    Ok((value, Dimension(scale.exponents)))
}

/// `number · factor`; rounded once where the factor is a power of ten, so that 5 us is 5e-6 s to the last bit.
fn scaled(number: f64, factor: f64) -> f64 {
    let power = factor.log10().round();
    if (factor / 10_f64.powf(power) - 1.0).abs() < 1e-14
        && let Some((mantissa, exponent)) = format!("{number:e}").split_once('e')
        && let Ok(exponent) = exponent.parse::<i32>()
    {
        return format!("{mantissa}e{}", exponent + power as i32).parse().unwrap_or(f64::NAN);
    }
    number * factor
}

/// Reads a quantity of dimension `wanted`: its value in SI.
///
/// # Errors
/// As [`parse_quantity`], and a quantity of another dimension.
pub fn parse_as(text: &str, wanted: Dimension) -> Result<f64, UnitError> {
    let (value, found) = parse_quantity(text)?;
    if found.matches(&wanted) {
        return Ok(value);
    }
    Err(UnitError::WrongDimension { text: text.to_owned(), found: describe(found), wanted: describe(wanted) })
}

/// True for a text that begins as a number: it must then be a quantity, and is not a word.
pub(crate) fn begins_with_number(text: &str) -> bool {
    !split_number(text.trim()).0.is_empty()
}

/// The decimal number at the beginning of `text` (empty if there is none) and the rest without blanks.
fn split_number(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let sign = |at: usize| usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let digits = |at: usize| bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
    let whole = sign(0);
    let mut end = whole + digits(whole);
    let mut any = end > whole;
    if bytes.get(end) == Some(&b'.') {
        let decimals = digits(end + 1);
        any |= decimals > 0;
        end += 1 + decimals;
    }
    if !any {
        return ("", text);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = end + 1 + sign(end + 1);
        // Without digits the letter begins a unit, as in "5 eV" without its blank.
        if exponent <= bytes.len() && digits(exponent) > 0 {
            end = exponent + digits(exponent);
        }
    }
    (&text[..end], text[end..].trim_start())
}

/// A unit: its size in SI and its exponents of length, mass, time and temperature.
#[derive(Clone, Copy)]
struct Scale {
    factor: f64,
    exponents: [f64; 4],
}

impl Scale {
    const ONE: Self = Self { factor: 1.0, exponents: [0.0; 4] };

    fn power(self, p: f64) -> Self {
        let factor = if p == p.trunc() { self.factor.powi(p as i32) } else { self.factor.powf(p) };
        Self { factor, exponents: self.exponents.map(|e| e * p) }
    }

    fn times(self, other: Self) -> Self {
        let exponents = std::array::from_fn(|i| self.exponents[i] + other.exponents[i]);
        Self { factor: self.factor * other.factor, exponents }
    }
}

/// Largest exponent of a unit: a larger one is a typing error, and would only overflow.
const MAX_EXPONENT: f64 = 12.0;
const MAX_DEPTH: usize = 8;

struct Parser<'a> {
    unit: &'a str,
    at: usize,
}

impl Parser<'_> {
    fn syntax(&self, why: impl Into<String>) -> UnitError {
        UnitError::Syntax { unit: self.unit.to_owned(), why: why.into() }
    }

    fn peek(&mut self) -> Option<char> {
        let rest = self.unit[self.at..].trim_start();
        self.at = self.unit.len() - rest.len();
        rest.chars().next()
    }

    fn accept(&mut self, tokens: &[char]) -> bool {
        match self.peek().filter(|c| tokens.contains(c)) {
            Some(c) => {
                self.at += c.len_utf8();
                true
            }
            None => false,
        }
    }

    fn product(&mut self, depth: usize) -> Result<Scale, UnitError> {
        let mut scale = self.factor(depth)?;
        let mut divided = false;
        while self.peek().is_some_and(|c| c != ')') {
            if self.accept(&['/']) {
                divided = true;
                scale = scale.times(self.factor(depth)?.power(-1.0));
            } else if divided {
                return Err(self.syntax("a product after `/` needs parentheses"));
            } else {
                self.accept(&['*', '·', '⋅']);
                scale = scale.times(self.factor(depth)?);
            }
        }
        Ok(scale)
    }

    fn factor(&mut self, depth: usize) -> Result<Scale, UnitError> {
        let base = if self.accept(&['(']) {
            if depth == MAX_DEPTH {
                return Err(self.syntax(format!("parentheses nest at most {MAX_DEPTH} deep")));
            }
            let inner = self.product(depth + 1)?;
            self.close()?;
            inner
        } else if self.accept(&['1']) {
            Scale::ONE
        } else {
            self.symbol()?
        };
        if self.accept(&['^']) {
            let p = self.exponent()?;
            Ok(base.power(p))
        } else if self.accept(&['²']) {
            Ok(base.power(2.0))
        } else if self.accept(&['³']) {
            Ok(base.power(3.0))
        } else {
            Ok(base)
        }
    }

    fn close(&mut self) -> Result<(), UnitError> {
        if self.accept(&[')']) { Ok(()) } else { Err(self.syntax("`)` is missing")) }
    }

    fn exponent(&mut self) -> Result<f64, UnitError> {
        let p = if self.accept(&['(']) {
            let numerator = self.number()?;
            let p = if self.accept(&['/']) { numerator / self.number()? } else { numerator };
            self.close()?;
            p
        } else {
            self.number()?
        };
        if p.abs() <= MAX_EXPONENT { Ok(p) } else { Err(self.syntax(format!("exponents lie within ±{MAX_EXPONENT}"))) }
    }

    fn number(&mut self) -> Result<f64, UnitError> {
        self.peek();
        let (number, rest) = split_number(&self.unit[self.at..]);
        let value = number.parse().map_err(|_| self.syntax("expected an exponent, as in m^2 or mm^1.5"))?;
        self.at = self.unit.len() - rest.len();
        Ok(value)
    }

    fn symbol(&mut self) -> Result<Scale, UnitError> {
        let Some(first) = self.peek() else { return Err(self.syntax("a unit is missing at the end")) };
        let rest = &self.unit[self.at..];
        let after = match first {
            '°' => &rest[first.len_utf8()..],
            _ => rest.trim_start_matches(char::is_alphabetic),
        };
        let symbol = &rest[..rest.len() - after.len()];
        match first {
            _ if !symbol.is_empty() => {
                self.at += symbol.len();
                simple(symbol).ok_or_else(|| UnitError::Unknown { symbol: symbol.to_owned() })
            }
            ',' => Err(self.syntax("decimals take a point, not a comma")),
            other => Err(self.syntax(format!("`{other}` is not part of a unit"))),
        }
    }
}

/// Size and dimension of a simple symbol.
fn simple(symbol: &str) -> Option<Scale> {
    const OURS: [(&str, f64, &str, f64); 4] =
        [("cc", 1.0, "cm", 3.0), ("ksi", 1e3, "psi", 1.0), ("Msi", 1e6, "psi", 1.0), ("deg", 1.0, "°", 1.0)];
    if let Some((_, count, of, power)) = OURS.iter().find(|(name, ..)| *name == symbol) {
        let scale = from_uom(of)?.power(*power);
        return Some(Scale { factor: count * scale.factor, ..scale });
    }
    from_uom(symbol).or_else(|| from_uom(&format!("µ{}", symbol.strip_prefix(['u', 'μ'])?)))
}

fn from_uom(symbol: &str) -> Option<Scale> {
    let one = format!("1 {symbol}");
    // The order decides between namesakes: `mil` is a length before it is an angle.
    macro_rules! first_of {
        ($($quantity:ident $dimension:expr),+ $(,)?) => {
            $(if let Ok(q) = one.parse::<si::$quantity>() {
                return Some(Scale { factor: q.value, exponents: $dimension.0 });
            })+
        };
    }
    first_of!(
        Length Dimension::LENGTH,
        Mass Dimension::MASS,
        Time Dimension::TIME,
        Frequency Dimension::FREQUENCY,
        Force Dimension::FORCE,
        Pressure Dimension::PRESSURE,
        Energy Dimension::ENERGY,
        Power Dimension([2.0, 1.0, -3.0, 0.0]),
        TemperatureInterval Dimension::TEMPERATURE,
        Angle Dimension::NONE,
    );
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_reads(text: &str, value: f64, dimension: Dimension) {
        let (v, d) = parse_quantity(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!((v - value).abs() <= 1e-13 * value.abs(), "{text}: {v} instead of {value}");
        assert!(d.matches(&dimension), "{text}: {d}");
    }

    #[test]
    fn what_the_report_and_its_readers_write() {
        assert_reads("130.3 GPa", 130.3e9, Dimension::PRESSURE);
        assert_reads("1.07e5 N/mm^1.5", 1.07e5 * 1e-3_f64.powf(-1.5), Dimension::contact_stiffness(1.5));
        assert_reads("1.07e5 N/mm^(3/2)", 1.07e5 * 1e-3_f64.powf(-1.5), Dimension::contact_stiffness(1.5));
        assert_reads("1.575 g/cm^3", 1575.0, Dimension::DENSITY);
        assert_reads("1.575 g/cc", 1575.0, Dimension::DENSITY);
        assert_reads("1.575e-9 t/mm³", 1575.0, Dimension::DENSITY);
        assert_reads("5.2 mil", 1.3208e-4, Dimension::LENGTH);
        assert_reads("0.052 in", 1.3208e-3, Dimension::LENGTH);
        for micro in ["0.5 us", "0.5 µs", "0.5 μs", "0.5us", "+.5 us", "500 ns", "5e-4 ms"] {
            assert_reads(micro, 5e-7, Dimension::TIME);
        }
        assert_reads("-10 kHz", -1e4, Dimension::FREQUENCY);
        assert_reads("3.84 J", 3.84, Dimension::ENERGY);
        assert_reads("0.5 kJ/m^2", 500.0, Dimension::TOUGHNESS);
        assert_reads("0.5 N/mm", 500.0, Dimension::TOUGHNESS);
        assert_reads("1 kg*m/s^2", 1.0, Dimension::FORCE);
        assert_reads("1 kg·m s^-2", 1.0, Dimension::FORCE);
        assert_reads("2 J/(kg K)", 2.0, Dimension([2.0, 0.0, -2.0, -1.0]));
        assert_reads("2 m/s/s", 2.0, Dimension::ACCELERATION);
        assert_reads("3 1/s", 3.0, Dimension::FREQUENCY);
        assert_reads("180 deg", std::f64::consts::PI, Dimension::NONE);
        assert_reads("90 °", std::f64::consts::FRAC_PI_2, Dimension::NONE);
        assert_reads("1 Msi", 6894.757e6, Dimension::PRESSURE);
        assert_reads("1 slug", 14.593_90, Dimension::MASS);
        assert_reads("2 millimeters", 2e-3, Dimension::LENGTH);
    }

    #[test]
    fn decimal_units_are_exact() {
        for (text, value) in [
            ("130.3 GPa", 130.3e9),
            ("5 us", 5e-6),
            ("0.13208 mm", 0.13208e-3),
            ("1.575 g/cm^3", 1575.0),
            ("-1.2e-3 N/mm^2", -1200.0),
            ("0 mm", 0.0),
        ] {
            assert_eq!(parse_quantity(text).map(|q| q.0), Ok(value), "{text}");
        }
    }

    #[test]
    fn every_proposed_unit_is_accepted() {
        for named in NAMED {
            for unit in named.units {
                assert_eq!(parse_as(&format!("0 {unit}"), named.dimension), Ok(0.0), "{unit} as {}", named.name);
            }
        }
    }

    #[test]
    fn imperial_units_are_right_to_the_digits_of_their_table() {
        for (text, exact) in [("1 lb", 0.453_592_37), ("1 psi", 6_894.757_293_168), ("1 lbf", 4.448_221_615_260_5)] {
            let (value, _) = parse_quantity(text).unwrap();
            assert!((value / exact - 1.0).abs() < 1e-7, "{text}: {value}");
        }
    }

    #[test]
    fn refusals_name_the_trouble_and_the_remedy() {
        let refusal = |text: &str, wanted: Dimension| {
            let error = parse_as(text, wanted).unwrap_err();
            format!("{error}; {}", error.remedy(Some(wanted)))
        };
        for (text, wanted, parts) in [
            ("2.49", Dimension::MASS, ["bare number", "\"2.49 kg\""]),
            ("9.65 GPA", Dimension::PRESSURE, ["unknown unit `GPA`", "did you mean `GPa`"]),
            ("9.65 mm", Dimension::PRESSURE, ["is a length, not a stress", "accepted: MPa, GPa"]),
            ("kg", Dimension::MASS, ["does not begin with a number", "accepted: kg"]),
            ("nan kg", Dimension::MASS, ["does not begin with a number", "accepted: kg"]),
            ("1e999 kg", Dimension::MASS, ["out of the range", "accepted: kg"]),
            ("1e-320 mg", Dimension::MASS, ["out of the range", "accepted: kg"]),
            ("2,49 kg", Dimension::MASS, ["a point, not a comma", "write 2.49, not 2,49"]),
            ("2 kg/", Dimension::MASS, ["missing at the end", "N/mm^1.5"]),
            ("2 kg^", Dimension::MASS, ["expected an exponent", "N/mm^1.5"]),
            ("2 kg^1e9", Dimension::MASS, ["within ±12", "N/mm^1.5"]),
            ("2 kg^(1/0)", Dimension::MASS, ["within ±12", "N/mm^1.5"]),
            ("2 (kg", Dimension::MASS, ["`)` is missing", "N/mm^1.5"]),
            ("2 kg)", Dimension::MASS, ["`)` without `(`", "N/mm^1.5"]),
            ("2 J/kg K", Dimension::MASS, ["needs parentheses", "J/(kg K)"]),
            ("2 %", Dimension::MASS, ["`%` is not part of a unit", "N/mm^1.5"]),
            ("20 °C", Dimension::TEMPERATURE, ["unknown unit `C`", "known: K"]),
            ("3", Dimension::contact_stiffness(1.5), ["bare number", "N/mm^1.5"]),
            ("3 N", Dimension::contact_stiffness(1.5), ["is a force, not a quantity in N/m^1.5", "N/mm^1.5"]),
        ] {
            let refusal = refusal(text, wanted);
            assert!(parts.iter().all(|part| refusal.contains(part)), "{text}: {refusal}");
        }
        let nested = format!("1 {}", "(".repeat(100_000));
        assert!(parse_quantity(&nested).unwrap_err().to_string().contains("8 deep"));
        assert!(parse_quantity("1 mn").unwrap_err().remedy(None).contains("did you mean"));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*") {
            if let Ok((value, _)) = parse_quantity(&text) { prop_assert!(value.is_finite()); }
        }

        #[test]
        fn no_text_of_the_alphabet_panics(text in "[-+]?[0-9.e]{1,4} ?[a-zµ°0-9()*/^ .²-]{0,12}") {
            if let Ok((value, _)) = parse_quantity(&text) { prop_assert!(value.is_finite()); }
        }

        #[test]
        fn a_number_keeps_its_value(value in proptest::num::f64::NORMAL) {
            prop_assume!(value.abs() < 1e300);
            prop_assert_eq!(parse_quantity(&format!("{value:e} m")), Ok((value, Dimension::LENGTH)));
        }
    }
}
