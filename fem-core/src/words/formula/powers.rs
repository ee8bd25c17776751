//! The unit of a formula's value.

use super::{Formula, Step};

/// Powers nearer to each other than this are one.
const SAME: f64 = 1e-9;

/// Where a formula combines what has not the units for it.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerError {
    /// The operator or function.
    pub symbol: &'static str,
    /// The character at which it stands, counted from 1.
    pub place: usize,
    /// Powers of the unit of what it combines, or of its argument.
    pub powers: (f64, Option<f64>),
}

/// What a value on the stack is.
#[derive(Debug, Clone, Copy)]
struct Kind {
    /// Power of the unit; none for a zero, which has any.
    power: Option<f64>,
    /// Its value where it is a number.
    number: Option<f64>,
}

impl Formula {
    /// The power of a unit that the value of the formula has, where the names in it (in the order of [`Formula::names`]) have
    /// these powers; 0 for a pure number.
    ///
    /// Numbers are pure but for 0, which has any unit. Sums, differences and comparisons want one unit on both sides, powers a pure
    /// number above, and one that is written as such where their base is not pure; `exp ln sin cos tan` want a pure number.
    ///
    /// # Errors
    /// The first operator or function, as they are carried out, for which that does not hold.
    pub fn power(&self, of_names: &[f64]) -> Result<f64, PowerError> {
        let mut stack: Vec<Kind> = Vec::new();
        for (step, &(symbol, place)) in self.steps.iter().zip(&self.sources) {
            let next = match *step {
                Step::Number(number) => Kind { power: (number != 0.0).then_some(0.0), number: Some(number) },
                Step::Value(k) => Kind { power: of_names.get(k).copied(), number: None },
                Step::Apply(function) => {
                    let Some(of) = stack.pop() else { continue };
                    let power = match symbol {
                        "abs" | "pos" => of.power,
                        "sqrt" => of.power.map(|power| 0.5 * power),
                        _ => match of.power {
                            Some(power) if power.abs() > SAME => {
                                return Err(PowerError { symbol, place, powers: (power, None) });
                            }
                            _ => Some(0.0),
                        },
                    };
                    Kind { power, number: of.number.map(function) }
                }
                Step::Combine(operator) => {
                    let (Some(b), Some(a)) = (stack.pop(), stack.pop()) else { continue };
                    let powers = (a.power.unwrap_or(0.0), b.power.unwrap_or(0.0));
                    let refused = Err(PowerError { symbol, place, powers: (powers.0, Some(powers.1)) });
                    let number = a.number.zip(b.number).map(|(a, b)| operator(a, b));
                    let power = match symbol {
                        "*" => a.power.zip(b.power).map(|(a, b)| a + b),
                        "/" => a.power.map(|a| a - powers.1),
                        "^" => match (a.power, b.number) {
                            _ if powers.1.abs() > SAME => return refused,
                            (Some(power), _) if power.abs() <= SAME => Some(0.0),
                            (Some(power), Some(exponent)) => Some(power * exponent),
                            (Some(_), None) => return refused,
                            (None, _) => Some(0.0),
                        },
                        _ => {
                            if let (Some(a), Some(b)) = (a.power, b.power)
                                && (a - b).abs() > SAME
                            {
                                return refused;
                            }
                            let truth = !matches!(symbol, "+" | "-");
                            if truth { Some(0.0) } else { a.power.or(b.power) }
                        }
                    };
                    Kind { power, number }
                }
            };
            stack.push(next);
        }
        Ok(stack.pop().and_then(|kind| kind.power).unwrap_or(0.0))
    }
}
