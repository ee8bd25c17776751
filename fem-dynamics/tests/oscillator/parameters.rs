//! Parameters that are refused, with the key they name.

use crate::{length, stiffness};
use fem_core::plugin::{Dimension, Params, Plugin, Value};
use fem_dynamics::contact::{Hertz, Linear, SunYang, YigitChristoforou};
use fem_dynamics::integrate::{DormandPrince, GeneralizedAlpha, HhtAlpha, Newmark};

#[track_caller]
fn refused<P: Plugin>(params: &Params, key: &str) {
    assert!(P::INFO.params.iter().any(|p| p.name == key), "{key} is not listed");
    assert_eq!(P::build(params).unwrap_err().key, key);
}

fn number(key: &str, value: f64) -> Params {
    Params::default().with(key, Value::Number(value))
}

#[test]
fn of_contact_laws() {
    refused::<Linear>(&Params::default(), "k");
    refused::<Linear>(&stiffness(1.0, 1.5), "k");
    refused::<Hertz>(&stiffness(0.0, 1.5), "k");
    refused::<Hertz>(&stiffness(f64::NAN, 1.5), "k");
    refused::<Hertz>(&stiffness(1.0, 0.9), "n");
    refused::<Hertz>(&number("radius", 1.0), "radius");
    let tip = Params::default().with("radius", length(0.01)).with("nu_tip", Value::Number(0.3));
    refused::<Hertz>(&tip, "e_tip");
    refused::<Hertz>(&tip.clone().with("n", Value::Number(1.5)), "n");
    let tip = tip.with("e_tip", Value::Quantity(1e11, Dimension::PRESSURE));
    refused::<Hertz>(&tip, "e_plate");
    let tip = tip.with("e_plate", Value::Quantity(1e10, Dimension::PRESSURE)).with("nu_tip", Value::Number(0.6));
    refused::<Hertz>(&tip, "nu_tip");

    let sound = stiffness(1.0, 1.5).with("critical", length(1e-4));
    assert!(SunYang::build(&sound).is_ok());
    refused::<SunYang>(&stiffness(1.0, 1.5), "critical");
    refused::<SunYang>(&sound.clone().with("m", Value::Number(1.4)), "m");
    refused::<SunYang>(&sound.clone().with("beta", Value::Number(0.0)), "beta");
    refused::<YigitChristoforou>(&stiffness(1.0, 1.5).with("n", Value::Number(1.5)), "critical");
    let sphere = stiffness(1.0, 1.5).with("radius", length(8e-3));
    refused::<YigitChristoforou>(&sphere, "strength");
    refused::<YigitChristoforou>(&sphere.clone().with("critical", length(1e-4)), "critical");
    let sphere = sphere.with("strength", Value::Quantity(0.0, Dimension::PRESSURE));
    refused::<YigitChristoforou>(&sphere, "strength");
    refused::<SunYang>(&sound.with("reloading", Value::Text("elastic".into())), "reloading");
}

#[test]
fn of_integrators() {
    refused::<Newmark>(&number("beta", 0.0), "beta");
    refused::<Newmark>(&number("gamma", 0.49), "gamma");
    refused::<HhtAlpha>(&number("alpha", 0.1), "alpha");
    refused::<HhtAlpha>(&number("alpha", -0.4), "alpha");
    refused::<GeneralizedAlpha>(&number("rho", 1.1), "rho");
    refused::<DormandPrince>(&number("tolerance", 0.0), "tolerance");
}
