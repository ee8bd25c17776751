//! Contact laws and integrators on one oscillator and on one sphere, against closed forms and reference tables.
#![allow(clippy::unwrap_used, clippy::panic)]

mod contact;
mod divided;
mod impact;
mod kit;
mod located;
mod order;
mod parameters;
mod spectrum;
mod spring;
mod stiffening;
mod tip;

use fem_core::contact::ContactLaw;
use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
use fem_core::testkit::Oscillators;
use fem_core::time::{Integrator, State};
use fem_dynamics::contact::{Hertz, SunYang};
use fem_dynamics::integrate::{
    CentralDifference, DormandPrince, EnergyConserving, GeneralizedAlpha, HhtAlpha, Newmark, Rk1, Rk2, Rk3, Rk4,
};
use std::collections::BTreeMap;

/// Name in the reference tables and order of every scheme.
const SCHEMES: [(&str, i32); 15] = [
    ("rk1", 1),
    ("rk2", 2),
    ("rk3", 3),
    ("rk4", 4),
    ("dormand-prince", 5),
    ("central-difference", 2),
    ("newmark-average", 2),
    ("newmark-linear", 2),
    ("hht-0.05", 2),
    ("hht-0.1", 2),
    ("hht-0.3", 2),
    ("generalized-0.9", 2),
    ("generalized-0.5", 2),
    ("generalized-0", 2),
    ("energy-conserving", 2),
];

fn scheme(name: &str) -> Box<dyn Integrator> {
    let with = |key: &str, value: f64| Params::default().with(key, Value::Number(value));
    let built = match name.split_once('-') {
        None if name == "rk1" => Rk1::build(&Params::default()),
        None if name == "rk2" => Rk2::build(&Params::default()),
        None if name == "rk3" => Rk3::build(&Params::default()),
        None if name == "rk4" => Rk4::build(&Params::default()),
        Some(("central", _)) => CentralDifference::build(&Params::default()),
        Some(("dormand", _)) => DormandPrince::build(&Params::default()),
        Some(("energy", _)) => EnergyConserving::build(&Params::default()),
        Some(("newmark", "average")) => Newmark::build(&Params::default()),
        Some(("newmark", "linear")) => Newmark::build(&with("beta", 1.0 / 6.0)),
        Some(("hht", alpha)) => HhtAlpha::build(&with("alpha", -alpha.parse::<f64>().unwrap())),
        Some(("generalized", rho)) => GeneralizedAlpha::build(&with("rho", rho.parse().unwrap())),
        _ => panic!("{name}"),
    };
    match built {
        Ok(Built::Integrator(scheme)) => scheme,
        other => panic!("{other:?}"),
    }
}

fn dormand_prince(tolerance: f64) -> Box<dyn Integrator> {
    match DormandPrince::build(&Params::default().with("tolerance", Value::Number(tolerance))) {
        Ok(Built::Integrator(scheme)) => scheme,
        other => panic!("{other:?}"),
    }
}

fn length(value: f64) -> Value {
    Value::Quantity(value, Dimension::LENGTH)
}

fn stiffness(k: f64, n: f64) -> Params {
    Params::default().with("k", Value::Quantity(k, Dimension::contact_stiffness(n))).with("n", Value::Number(n))
}

fn law<P: Plugin>(params: &Params) -> Box<dyn ContactLaw> {
    match P::build(params) {
        Ok(Built::Contact(law)) => law,
        other => panic!("{other:?}"),
    }
}

fn hertz(k: f64, n: f64) -> Box<dyn ContactLaw> {
    law::<Hertz>(&stiffness(k, n))
}

fn sun_yang(k: f64, critical: f64, reloading: &str) -> Box<dyn ContactLaw> {
    law::<SunYang>(
        &stiffness(k, 1.5).with("critical", length(critical)).with("reloading", Value::Text(reloading.into())),
    )
}

/// Starts `s` and makes `steps` steps, handing each state to `see`.
fn march(
    mut scheme: Box<dyn Integrator>,
    sys: &mut Oscillators,
    mut s: State,
    dt: f64,
    steps: usize,
    mut see: impl FnMut(&State),
) {
    scheme.start(sys, &mut s).unwrap();
    see(&s);
    for _ in 0..steps {
        scheme.step(sys, &mut s, dt).unwrap();
        see(&s);
    }
}

/// Row of a reference table: text by column.
struct Row(BTreeMap<String, String>);

impl Row {
    fn text(&self, column: &str) -> &str {
        &self.0[column]
    }

    /// The number, if the cell holds one.
    fn get(&self, column: &str) -> Option<f64> {
        self.text(column).parse().ok()
    }

    fn number(&self, column: &str) -> f64 {
        self.get(column).unwrap()
    }
}

/// A table of `tests/data/integrators`: a comment, the columns, the rows.
fn table(name: &str) -> Vec<Row> {
    let path = format!("{}/../tests/data/integrators/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().skip(1).map(|line| line.split(',').map(str::to_owned));
    let columns: Vec<_> = lines.next().unwrap().collect();
    lines.map(|cells| Row(columns.iter().cloned().zip(cells).collect())).collect()
}
