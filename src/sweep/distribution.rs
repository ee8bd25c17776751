//! What a number scatters by.

use statrs::distribution::{ContinuousCDF, Normal};
use std::fmt;

/// A distribution, in the unit in which it is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Gauss's, by mean and standard deviation.
    Normal {
        /// μ.
        mean: f64,
        /// σ.
        deviation: f64,
    },
    /// That of a number whose logarithm is normal, by mean and standard deviation of the number itself.
    LogNormal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
    },
    /// F(x) = 1 − exp(−(x/scale)^shape).
    Weibull {
        /// Below it are 63.2 %.
        scale: f64,
        /// The larger, the less scatter: the coefficient of variation is about 1.2/shape.
        shape: f64,
    },
    /// The same density everywhere between two numbers.
    Uniform {
        /// The least.
        from: f64,
        /// The largest.
        to: f64,
    },
}

/// Names by which sweeps call them, with what they take.
pub(super) const NAMES: [(&str, &str); 4] = [
    ("normal", "mean, deviation"),
    ("lognormal", "mean, deviation"),
    ("weibull", "scale, shape"),
    ("uniform", "least, largest"),
];

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, a, b) = match *self {
            Self::Normal { mean, deviation } => (0, mean, deviation),
            Self::LogNormal { mean, deviation } => (1, mean, deviation),
            Self::Weibull { scale, shape } => (2, scale, shape),
            Self::Uniform { from, to } => (3, from, to),
        };
        write!(f, "{}({a}, {b})", NAMES[kind].0)
    }
}

impl Distribution {
    /// That called `name`, of its two numbers.
    ///
    /// # Errors
    /// Why there is none.
    pub(super) fn new(name: &str, [a, b]: [f64; 2]) -> Result<Self, String> {
        let above = |what: &str, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(format!("its {what} is {value} and must be above 0")),
        };
        match name {
            "normal" => above("deviation", b).map(|()| Self::Normal { mean: a, deviation: b }),
            "lognormal" => {
                above("mean", a)?;
                above("deviation", b).map(|()| Self::LogNormal { mean: a, deviation: b })
            }
            "weibull" => {
                above("scale", a)?;
                above("shape", b).map(|()| Self::Weibull { scale: a, shape: b })
            }
            _ if a < b => Ok(Self::Uniform { from: a, to: b }),
            _ => Err(format!("its least number is {a} and its largest {b}")),
        }
    }

    /// The number below which the share `p` of all lies, 0 < p < 1.
    pub fn quantile(&self, p: f64) -> f64 {
        let normal = |mean: f64, deviation: f64| mean + deviation * standard_quantile(p);
        match *self {
            Self::Normal { mean, deviation } => normal(mean, deviation),
            Self::LogNormal { mean, deviation } => {
                let [mu, sigma] = logarithmic(mean, deviation);
                normal(mu, sigma).exp()
            }
            Self::Weibull { scale, shape } => scale * (-(-p).ln_1p()).powf(1.0 / shape),
            Self::Uniform { from, to } => from + p * (to - from),
        }
    }

    /// The share of all that lies below `x`.
    pub fn share_below(&self, x: f64) -> f64 {
        let normal = |x: f64, mean: f64, deviation: f64| standard_share((x - mean) / deviation);
        match *self {
            Self::Normal { mean, deviation } => normal(x, mean, deviation),
            Self::LogNormal { .. } | Self::Weibull { .. } if x <= 0.0 => 0.0,
            Self::LogNormal { mean, deviation } => {
                let [mu, sigma] = logarithmic(mean, deviation);
                normal(x.ln(), mu, sigma)
            }
            Self::Weibull { scale, shape } => -(-(x / scale).powf(shape)).exp_m1(),
            Self::Uniform { from, to } => ((x - from) / (to - from)).clamp(0.0, 1.0),
        }
    }
}

/// Mean and deviation of the logarithm of a number with these of its own.
fn logarithmic(mean: f64, deviation: f64) -> [f64; 2] {
    let square = (deviation / mean).powi(2).ln_1p();
    [mean.ln() - 0.5 * square, square.sqrt()]
}

/// Φ⁻¹.
pub(super) fn standard_quantile(p: f64) -> f64 {
    Normal::standard().inverse_cdf(p)
}

/// Φ.
pub(super) fn standard_share(z: f64) -> f64 {
    Normal::standard().cdf(z)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Mean and deviation from 10⁵ quantiles in the middle of parts of equal probability.
    fn moments(of: Distribution) -> [f64; 2] {
        let n = 100_000;
        let values = (0..n).map(|k| of.quantile((f64::from(k) + 0.5) / f64::from(n)));
        let mean = values.clone().sum::<f64>() / f64::from(n);
        [mean, (values.map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n)).sqrt()]
    }

    #[test]
    fn moments_are_those_of_theory() {
        let weibull = |scale: f64, shape: f64| {
            let gamma = |x: f64| statrs::function::gamma::gamma(x);
            let mean = scale * gamma(1.0 + 1.0 / shape);
            [mean, (scale * scale * gamma(1.0 + 2.0 / shape) - mean * mean).sqrt()]
        };
        for (name, numbers, want) in [
            ("normal", [50.0, 5.0], [50.0, 5.0]),
            ("lognormal", [50.0, 20.0], [50.0, 20.0]),
            ("weibull", [50.0, 12.0], weibull(50.0, 12.0)),
            ("uniform", [2.0, 8.0], [5.0, 3.0_f64.sqrt()]),
        ] {
            let of = Distribution::new(name, numbers).unwrap();
            for (got, want) in moments(of).into_iter().zip(want) {
                assert!((got / want - 1.0).abs() < 2e-3, "{name}: {got}, {want}");
            }
            for p in [1e-4, 0.1, 0.5, 0.9, 0.9999] {
                assert!((of.share_below(of.quantile(p)) - p).abs() < 1e-9, "{name} {p}");
            }
        }
        assert!(Distribution::new("normal", [50.0, -5.0]).unwrap_err().contains("above 0"));
    }
}
