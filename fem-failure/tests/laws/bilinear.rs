//! The bilinear law of an interface.

use super::tables::{columns, paths};
use fem_core::interface_law::{InterfaceLaw, InterfaceResponse, Jump};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::plugin::{Built, Params, Plugin, Value};
use fem_core::ply_law::{LawPoint, check_law};
use fem_core::testkit::{Units, check_interface_law};
use fem_failure::laws::{Bilinear, MixedMode};

/// Strengths in MPa, toughnesses in J/m².
fn resin([zt, s13]: [f64; 2], [gic, giic]: [f64; 2], eta: f64) -> Material {
    Material {
        name: "resin".into(),
        elastic: Elastic::isotropic(3.8e9, 0.36),
        density: None,
        strengths: Strengths::default().with(Strength::Zt, 1e6 * zt).with(Strength::S13, 1e6 * s13),
        toughness: Toughnesses::default().with(Toughness::GIc, gic).with(Toughness::GIIc, giic),
        eta: Some(eta),
        expansion: None,
    }
}

fn im7() -> Material {
    resin([60.0, 90.0], [277.4, 787.9], 1.634)
}

fn law(penalty: f64) -> Bilinear {
    Bilinear { penalty, shear_penalty: None, criterion: MixedMode::BenzeggaghKenane, strengthening: 0.0, friction: 0.0 }
}

/// A law and what it remembers.
struct Point {
    law: Bilinear,
    material: Material,
    state: [f64; 9],
}

impl Point {
    fn new(law: Bilinear, material: Material) -> Self {
        Self { law, material, state: [0.0; 9] }
    }

    fn step(&mut self, jump: &Jump) -> InterfaceResponse {
        let stiffness = self.material.elastic.stiffness();
        let point =
            LawPoint { material: &self.material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
        let mut new = [f64::NAN; 9];
        let answer = self.law.respond(&point, jump, &self.state, &mut new, None).unwrap();
        self.state = new;
        answer
    }

    /// The answers at the ends of straight ways in `parts` steps each.
    fn walk(&mut self, turns: &[Jump], parts: u32) -> Vec<InterfaceResponse> {
        let ends = turns.iter().map(|turn| {
            let from: Jump = [self.state[1], self.state[2], self.state[3]];
            let mut last = None;
            for part in 1..=parts {
                let share = f64::from(part) / f64::from(parts);
                last = Some(self.step(&std::array::from_fn(|k| from[k] + share * (turn[k] - from[k]))));
            }
            last.unwrap()
        });
        ends.collect()
    }
}

#[test]
fn it_keeps_the_contract() {
    // So soft that steps of the kit resolve the onset.
    let soft = Bilinear { penalty: 2e13, ..law(0.0) };
    for law in [
        soft.clone(),
        Bilinear { shear_penalty: Some(4e13), ..soft.clone() },
        Bilinear { criterion: MixedMode::Power(1.0), ..soft.clone() },
        Bilinear { criterion: MixedMode::Power(1.6), ..soft.clone() },
        Bilinear { strengthening: 0.3, ..soft.clone() },
        Bilinear { friction: 0.4, ..soft.clone() },
        Bilinear { friction: 0.2, strengthening: 0.2, shear_penalty: Some(3e13), ..soft },
    ] {
        let make = |units: &Units| -> Box<dyn InterfaceLaw> {
            let number = |v| units.number(v, Bilinear::STIFFNESS);
            Box::new(Bilinear {
                penalty: number(law.penalty),
                shear_penalty: law.shear_penalty.map(number),
                ..law.clone()
            })
        };
        for largest in [[1.2e-5, 2.5e-5, 2.5e-5], [4e-6, 9e-6, 7e-6]] {
            assert_eq!(check_interface_law(make, &im7(), 1e-3, &largest), Ok(()), "{law:?}");
        }
    }
}

#[test]
fn the_tables_are_met() {
    let peek = resin([80.0, 100.0], [969.0, 1719.0], 2.284);
    for (table, material, penalties) in [
        ("cohesive_equal_penalty.csv.gz", im7(), [1e15, 1e15]),
        ("cohesive_mode_penalty.csv.gz", im7(), [1e15, f64::NAN]),
        ("cohesive_mode_penalty_soft.csv.gz", peek, [1e14, f64::NAN]),
    ] {
        let law = Bilinear { shear_penalty: Some(penalties[1]).filter(|k| !k.is_nan()), ..law(penalties[0]) };
        let [strength, toughness] = [material.strengths.s13(), material.toughness.giic()];
        for (name, rows) in paths(table) {
            // Rows of the random paths lie on all sides of the origin: a step from one to the next takes what a straight line
            // between them does, but for the places where it turns from growing to healing.
            let energy = if name.starts_with("random") { [0.25, 1e-5, 1e-8] } else { [1e-3, 1e-10, 1e-10] };
            for (parts, exact) in [1, 20, 400].into_iter().zip(energy) {
                let mut point = Point::new(law.clone(), material.clone());
                for row in &rows {
                    let answer = point.walk(&[columns(row, ["dn", "ds", "dt"])], parts)[0];
                    let want = columns(row, ["tn", "ts", "tt"]);
                    let near = |got: f64, want: f64, size: f64, what: &str| {
                        assert!((got - want).abs() <= size, "{table} {name} {}: {what} {got} {want}", row["step"]);
                    };
                    near(point.state[0], row["damage"], 1e-11, "damage");
                    for (got, want) in answer.traction.into_iter().zip(want) {
                        near(got, want, 1e-11 * strength.max(want.abs()), "traction");
                    }
                    near(answer.stored, row["stored_J_m2"], 1e-11 * toughness.max(row["stored_J_m2"]), "stored");
                    near(answer.dissipated.total(), row["dissipated_J_m2"], exact * toughness, "dissipated");
                }
            }
        }
    }
}

/// From no jump to complete failure at B, straight, and with unloading and closure on the way: G to rounding in any number of
/// steps, in parts 1 − B and B.
#[test]
fn what_is_dissipated_is_the_toughness_of_the_mix() {
    let tough = |criterion, b: f64, [i, ii]: [f64; 2]| match criterion {
        MixedMode::BenzeggaghKenane => i + (ii - i) * b.powf(1.634),
        MixedMode::Power(a) => (((1.0 - b) / i).powf(a) + (b / ii).powf(a)).powf(-1.0 / a),
    };
    for criterion in [MixedMode::BenzeggaghKenane, MixedMode::Power(1.0), MixedMode::Power(1.7)] {
        for shear_penalty in [None, Some(3e14)] {
            let (law, material) = (Bilinear { shear_penalty, criterion, ..law(1e14) }, im7());
            let consistent = 1e14 * 277.4 / 787.9 * 2.25;
            for b in [0.0_f64, 1e-9, 0.1, 0.5, 0.9, 1.0] {
                let sheared = (b / shear_penalty.unwrap_or(consistent)).sqrt();
                let ray = [((1.0 - b) / 1e14).sqrt(), 0.6 * sheared, -0.8 * sheared];
                let at = |size: f64| ray.map(|v| size * v * 1e7 * 80.0);
                for parts in [1, 7, 300] {
                    for turns in
                        [vec![at(1.0)], vec![at(0.05), at(0.0), [-1e-6, 0.0, 0.0], at(0.2), at(-0.01), at(1.0)]]
                    {
                        let answer = *Point::new(law.clone(), material.clone()).walk(&turns, parts).last().unwrap();
                        let want = tough(criterion, b, [277.4, 787.9]);
                        let found = answer.dissipated;
                        assert_eq!(answer.traction, [0.0; 3]);
                        assert!(
                            (found.total() / want - 1.0).abs() < 1e-9,
                            "{criterion:?} {b} {parts}: {found:?} {want}"
                        );
                        assert!((found.shear - b * want).abs() < 1e-9 * want && found.friction == 0.0);
                    }
                }
            }
        }
    }
}

/// Published single-point values of an independent implementation (NASA CompDam, IM7/8552).
#[test]
fn published_points_are_met() {
    let material = resin([62.3, 92.3], [277.0, 788.0], 1.634);
    let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-3, "{got} {want}");
    // Largest traction, and the first jump at which it is `residual`.
    let pull = |law: &Bilinear, direction: usize, pressed: f64, residual: f64| {
        let mut point = Point::new(law.clone(), material.clone());
        let (mut peak, mut broken, mut lost) = (0.0_f64, 0.0, 0.0);
        for k in 1..=40_000 {
            let mut jump = [-pressed / law.penalty, 0.0, 0.0];
            jump[direction] += 5e-10 * f64::from(k);
            let answer = point.step(&jump);
            peak = peak.max(answer.traction[direction]);
            if answer.traction[direction] > residual + 1.0 {
                (broken, lost) = (jump[direction], answer.dissipated.total());
            }
        }
        let last = point.step(&[-pressed / law.penalty, 2e-5, 0.0]).traction[1];
        (peak, broken, lost, last)
    };
    let stiff = law(1e15);
    let (peak, broken, lost, _) = pull(&stiff, 0, 0.0, 0.0);
    near(peak, 62.3e6);
    near(broken, 8.8925e-6);
    near(lost, 277.0);
    let (peak, broken, ..) = pull(&stiff, 1, 0.0, 0.0);
    near(peak, 92.3e6);
    near(broken, 17.0748e-6);
    // The strengthening follows from the angle of fracture under compression: 92.3 cos 106° / (199.8 cos² 53°).
    let strengthening = 92.3 * -(106.0_f64.to_radians().cos()) / (199.8 * 53.0_f64.to_radians().cos().powi(2));
    let (peak, _, lost, last) = pull(&Bilinear { strengthening, ..stiff.clone() }, 1, 10e6, 0.0);
    near(peak, 95.815e6);
    near(lost, 788.0);
    assert_eq!(last, 0.0);
    let (_, _, _, last) = pull(&Bilinear { friction: 0.3, ..stiff }, 1, 10e6, 3e6);
    near(last, 3.0e6);
}

/// A broken interface that is pressed and rubbed to and fro: Coulomb's loop, whatever the steps.
#[test]
fn friction_takes_force_times_way() {
    let rubbing = Bilinear { friction: 0.25, ..law(1e14) };
    let ks = 1e14 * 277.4 / 787.9 * 2.25;
    for parts in [3, 50] {
        let mut point = Point::new(rubbing.clone(), im7());
        let pressed = -4e-7;
        let turns = [[0.0, 3e-5, 0.0], [pressed, 3e-5, 0.0], [pressed, 4e-5, 0.0], [pressed, 2e-5, 0.0]];
        let found = point.walk(&turns, parts);
        let slides = 0.25 * 40e6;
        for (answer, want) in found.iter().zip([0.0, 0.0, slides, -slides]) {
            assert!((answer.traction[1] - want).abs() < 1.0, "{answer:?}");
        }
        // Less what is stored where the faces stick: once on the way out, twice on the way back.
        let (out, back) = (slides * (1e-5 - slides / ks), slides * (2e-5 - 2.0 * slides / ks));
        let lost = [2, 3].map(|k| found[k].dissipated.friction);
        assert!(
            (lost[0] / out - 1.0).abs() < 1e-9 && (lost[1] / (out + back) - 1.0).abs() < 1e-9,
            "{lost:?} {out} {back}"
        );
        assert!((found[3].stored - 0.5 * 1e14 * pressed * pressed - 0.5 * slides * slides / ks).abs() < 1e-9);
    }
}

/// A face that is just touched carries nothing, neither does a jump of nothing damage or press.
#[test]
fn a_jump_of_zero_is_open() {
    let mut point = Point::new(law(1e14), im7());
    point.step(&[1e-3, 0.0, 0.0]);
    let stiffness = point.material.elastic.stiffness();
    let place =
        LawPoint { material: &point.material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
    let mut tangent = [[f64::NAN; 3]; 3];
    for (n, normal) in [(0.0, 0.0), (-1e-12, 1e14)] {
        point.law.respond(&place, &[n, 0.0, 0.0], &point.state, &mut [0.0; 9], Some(&mut tangent)).unwrap();
        assert_eq!(tangent, [[normal, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
    }
}

#[test]
fn constants_that_do_not_fit_are_refused() {
    let stiffness = im7().elastic.stiffness();
    let refused = |law: &Bilinear, material: &Material| {
        let point = LawPoint { material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
        check_law(law.info(), "bilinear", &point, law.check(&point)).unwrap_err().to_string()
    };
    let without = Material { toughness: Toughnesses::default().with(Toughness::GIIc, 788.0), ..im7() };
    assert!(refused(&law(1e14), &without).contains("needs the toughness GIc"));
    assert!(refused(&law(1e14), &Material { eta: None, ..im7() }).contains("Benzeggagh and Kenane's exponent"));
    let soft = refused(&law(5e12), &im7());
    assert!(soft.contains("Kn = 5.000000e12") && soft.contains("the least = 7.209805e12"), "{soft}");
    let power = Bilinear { criterion: MixedMode::Power(1.0), ..law(1e14) };
    let material = Material { eta: None, ..im7() };
    let point = LawPoint { material: &material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
    assert_eq!(power.check(&point), Ok(()));
}

#[test]
fn it_is_built_from_parameters() {
    let built = |params: Params| Bilinear::build(&params);
    let Ok(Built::InterfaceLaw(law)) = built(Params::default()) else { unreachable!() };
    assert!(format!("{law:?}").contains("penalty: 100000000000000.0"), "{law:?}");
    let power = Params::default().with("criterion", Value::Text("power".into()));
    assert!(built(power.with("exponent", Value::Number(1.5))).is_ok());
    let lost = built(Params::default().with("exponent", Value::Number(1.5))).unwrap_err();
    assert!(lost.to_string().contains("`eta` of the material"), "{lost}");
}
