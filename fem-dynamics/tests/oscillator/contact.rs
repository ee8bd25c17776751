//! Contact laws.

use crate::{hertz, law, length, stiffness, sun_yang, table};
use fem_core::contact::{ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::{Dimension, Params, Value};
use fem_core::testkit::check_contact_law;
use fem_dynamics::contact::{Hertz, Linear, SunYang, WithoutSqueeze, YigitChristoforou};
use std::f64::consts::PI;

const RULES: [&str; 2] = ["unloading-curve", "loading-exponent"];

#[test]
fn contracts_hold() {
    check_contact_law(&*law::<Linear>(&stiffness(3e7, 1.0).with("n", Value::Number(1.0))), 1e-4).unwrap();
    check_contact_law(&*hertz(3.38e9, 1.5), 1e-4).unwrap();
    check_contact_law(&*hertz(2.0, 1.0), 3.0).unwrap();
    for rule in RULES {
        // Without a dent, with one from the middle on, with one from the beginning.
        for critical in [2e-4, 8e-5, 1e-7] {
            check_contact_law(&*sun_yang(3.38e9, critical, rule), 1.6e-4)
                .unwrap_or_else(|why| panic!("{rule} {critical}: {why}"));
        }
        let other = stiffness(5.0, 1.2).with("m", Value::Number(1.2)).with("beta", Value::Number(1.0));
        check_contact_law(
            &*law::<SunYang>(&other.with("critical", length(0.1)).with("reloading", Value::Text(rule.into()))),
            1.0,
        )
        .unwrap();
    }
}

#[test]
fn a_plate_that_yields_keeps_the_contract() {
    // Not at all, from the middle on, from the beginning.
    for critical in [2e-4, 8e-5, 1e-7] {
        check_contact_law(&YigitChristoforou::new(3.38e9, critical), 1.6e-4)
            .unwrap_or_else(|why| panic!("{critical}: {why}"));
    }
}

/// Below a sphere the largest shear stress is 0.303 of the largest pressure.
#[test]
fn a_plate_yields_where_its_shear_stress_is_its_strength() {
    let (radius, modulus, strength) = (8e-3, 8e9, 110e6);
    let k = 4.0 / 3.0 * modulus * f64::sqrt(radius);
    let pressure: f64 = strength / 0.303;
    let yields = radius * (PI * pressure / (2.0 * modulus)).powi(2);
    let params = stiffness(k, 1.5)
        .with("radius", length(radius))
        .with("strength", Value::Quantity(strength, Dimension::PRESSURE));
    let law = law::<YigitChristoforou>(&params);
    let dent = |alpha: f64| law.branches(&committed(&*law, &[alpha])).touch;
    assert!(dent(0.99 * yields) == 0.0 && dent(1.01 * yields) > 0.0, "{}", dent(1.01 * yields));
}

/// Three times as deep as it yields, with F in units of k yields^1.5 and lengths in those of the yielding.
#[test]
fn a_plate_that_yields_loses_what_the_formulas_say() {
    let (k, yields) = (2.0_f64, 0.25_f64);
    let unit = k * yields.powf(1.5);
    let law = YigitChristoforou::new(k, yields);
    let h = committed(&law, &[3.0 * yields]);
    assert!((law.force(&h, 3.0 * yields).force / unit - 4.0).abs() < 1e-14);
    let dent = (3.0_f64.powf(1.5) - 4.0).powf(2.0 / 3.0);
    assert!((law.branches(&h).touch / yields - dent).abs() < 1e-14);
    let given_back = 0.4 * (3.0_f64.powf(2.5) - dent.powf(2.5)) - dent.powf(1.5) * (3.0 - dent);
    let lost = (0.4 + 2.0 * (1.0 + 4.0) / 2.0 - given_back) * unit * yields;
    let Energy { stored, dissipated } = law.energy(&h, -1.0);
    assert!(stored == 0.0 && (dissipated / lost - 1.0).abs() < 1e-13, "{dissipated} {lost}");
    assert!((law.energy(&h, 3.0 * yields).stored / (given_back * unit * yields) - 1.0).abs() < 1e-13);
}

#[test]
fn hertz_stiffness_of_a_steel_ball_on_a_laminate() {
    let params = Params::default()
        .with("radius", length(6.35e-3))
        .with("e_tip", Value::Quantity(210e9, Dimension::PRESSURE))
        .with("nu_tip", Value::Number(0.3))
        .with("e_plate", Value::Quantity(7.9e9, Dimension::PRESSURE));
    let k = law::<Hertz>(&params).force(&ContactHistory::default(), 1.0).force;
    assert!((k / 811585276.4303534 - 1.0).abs() < 1e-14, "{k}");
}

/// Takes `path` into a fresh history.
fn committed(law: &dyn ContactLaw, path: &[f64]) -> ContactHistory {
    let mut h = ContactHistory::default();
    path.iter().for_each(|&alpha| law.commit(&mut h, alpha));
    h
}

#[test]
fn second_contacts_agree_with_the_reference() {
    for rule in RULES {
        let law = sun_yang(811585276.4303534, 8.03e-5, rule);
        let mut h = ContactHistory::default();
        let rows: Vec<_> =
            table("sun_yang_reloading").into_iter().filter(|row| row.text("reloading") == rule).collect();
        assert!(rows.len() > 100);
        for row in rows {
            let alpha = 1e-3 * row.number("d");
            let (force, expected) = (law.force(&h, alpha).force, row.number("F"));
            // Highest force and indentation of the reference agree to 1.6e-6.
            assert!((force - expected).abs() < 2e-6 * 289.0, "{rule} {}: {force}, {expected}", row.text("t"));
            law.commit(&mut h, alpha);
        }
    }
}

#[test]
fn a_cycle_dissipates_what_the_formulas_say() {
    let (k, critical, beta, alpha) = (2.0, 0.5_f64, 0.4, 0.8_f64);
    let force = k * alpha.powf(1.5);
    let depth = alpha * (critical / alpha).powf(beta);
    let first = force * alpha / 2.5 - force * depth / 3.5;
    let again = force * depth / 2.5 - force * depth / 3.5;
    for (rule, second) in RULES.into_iter().zip([first, first + again]) {
        let law = sun_yang(k, critical, rule);
        let apart = |path: &[f64]| law.energy(&committed(&*law, path), -1.0);
        let close = |energy: Energy, dissipated: f64| {
            assert_eq!(energy.stored, 0.0, "{rule}");
            assert!((energy.dissipated - dissipated).abs() < 1e-14, "{rule}: {energy:?} {dissipated}");
        };
        close(apart(&[0.3, 0.5, alpha, 0.0]), first);
        // Below the largest indentation a second contact is elastic; exceeding it takes the unloading curve again.
        close(apart(&[alpha, 0.0, 0.7, 0.0]), first);
        close(apart(&[alpha, 0.0, alpha * (1.0 + 1e-15), 0.0]), second);
    }
}

#[test]
fn no_force_within_the_dent() {
    for rule in RULES {
        let law = sun_yang(2.0, 0.1, rule);
        let dent = 1.0 - 0.1_f64.powf(0.4);
        let h = committed(&*law, &[1.0]);
        assert_eq!(law.force(&h, dent - 1e-12).force, 0.0);
        assert!(law.force(&h, dent + 1e-6).force > 0.0);
        assert_eq!(law.force(&h, 1.0).force, 2.0);
    }
}

#[test]
fn without_the_squeeze_of_the_plate_contracts_hold() {
    // The squeeze is 0.4, 4 and 26 % of what the law gives at the deepest, and beyond a limit in the middle.
    for compliance in [1e-10, 1e-9, 5e-9, 2e-8] {
        let law = WithoutSqueeze::new(hertz(3.38e9, 1.5), compliance).unwrap();
        check_contact_law(&law, 1e-4).unwrap_or_else(|why| panic!("{compliance}: {why}"));
    }
    for rule in RULES {
        for critical in [2e-4, 8e-5, 1e-7] {
            for compliance in [1e-10, 2e-9] {
                let law = WithoutSqueeze::new(sun_yang(3.38e9, critical, rule), compliance).unwrap();
                check_contact_law(&law, 1.6e-4).unwrap_or_else(|why| panic!("{rule} {critical} {compliance}: {why}"));
            }
        }
    }
}

#[test]
fn two_springs_in_series_are_one_that_was_measured() {
    // What is left of a linear law and the squeeze are in series the law itself.
    let (k, c) = (2e7, 1e-8);
    let law = WithoutSqueeze::new(hertz(k, 1.0), c).unwrap();
    let h = ContactHistory::default();
    for face in [1e-6, 3e-5, 4e-4, 0.4] {
        let at = law.force(&h, face);
        assert!((at.force * (1.0 / k - c) / face - 1.0).abs() < 1e-14);
        assert!((at.tangent * (1.0 / k - c) - 1.0).abs() < 1e-14);
        assert!((law.energy(&h, face).stored - 0.5 * at.force * face).abs() < 1e-14 * at.force * face);
    }
    // Of Hertz's law and of an unloading branch by the forces: the face lies c F above the surface that the law counts from.
    let (whole, left) =
        (sun_yang(3.38e9, 8e-5, RULES[0]), WithoutSqueeze::new(sun_yang(3.38e9, 8e-5, RULES[0]), 1e-9).unwrap());
    let (mut of_law, mut of_face) = (h, h);
    for alpha in [1e-5, 8e-5, 1.5e-4, 1.3e-4, 7e-5, 1e-5, 9e-5, 1.7e-4] {
        let force = whole.force(&of_law, alpha).force;
        let face = alpha - 1e-9 * force;
        assert!((left.force(&of_face, face).force - force).abs() < 1e-9 * (1.0 + force), "{alpha}");
        whole.commit(&mut of_law, alpha);
        left.commit(&mut of_face, face);
    }
}

#[test]
fn a_law_as_stiff_as_the_plate_holds_no_squeeze() {
    assert!(WithoutSqueeze::new(hertz(2e7, 1.0), 3e-8).is_none());
    // One that is ever stiffer on the way back.
    assert!(WithoutSqueeze::new(Box::new(YigitChristoforou::new(9.7e8, 4e-5)), 2e-8).is_none());
    // Hertz's law gives more than any squeeze at first, and half of it at the limit: F' = 1.5 k^(2/3) F^(1/3) = 1/(2 c).
    let (k, c) = (3.38e9_f64, 2e-8_f64);
    let law = WithoutSqueeze::new(hertz(k, 1.5), c).unwrap();
    let limit = (1.0 / (3.0 * c)).powi(3) / (k * k);
    assert!((law.force_limit() / limit - 1.0).abs() < 1e-9, "{} {limit}", law.force_limit());
    // It does not pull, and beyond the limit it is the law once more, deeper by what was taken away.
    let h = ContactHistory::default();
    assert_eq!(law.force(&h, -1e-6).force, 0.0);
    let deep = 1e-2;
    let expected = hertz(k, 1.5).force(&h, deep + c * limit).force;
    assert!((law.force(&h, deep).force / expected - 1.0).abs() < 1e-12);
}
