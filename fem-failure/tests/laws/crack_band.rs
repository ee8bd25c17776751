//! Crack-band damage of a ply.

use super::tables::{columns, paths};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
use fem_core::ply_law::{LawPoint, PlyLaw, PlyResponse, check_law};
use fem_core::tensor::{Matrix6, Strain6, apply};
use fem_core::testkit::{Units, check_ply_law};
use fem_failure::laws::{Breaks, CrackBand, HahnTsai, Unloading};

/// IM7/8552 (Camanho et al. 2007; nu23 and S23 assumed).
fn tape() -> Material {
    let strengths = [
        (Strength::Xt, 2326e6),
        (Strength::Xc, 1200e6),
        (Strength::Yt, 62.3e6),
        (Strength::Yc, 199.8e6),
        (Strength::S12, 92.3e6),
        (Strength::S23, 75.3e6),
    ];
    let toughness =
        [(Toughness::Gft, 81.5e3), (Toughness::Gfc, 106.3e3), (Toughness::Gmt, 277.4), (Toughness::Gmc, 1310.0)];
    Material {
        name: "IM7/8552".into(),
        elastic: Elastic::transversely_isotropic(171.4e9, 9.08e9, 0.32, 0.45, 5.29e9),
        density: None,
        strengths: strengths.into_iter().fold(Strengths::default(), |all, (which, v)| all.with(which, v)),
        toughness: toughness.into_iter().fold(Toughnesses::default(), |all, (which, v)| all.with(which, v)),
        eta: None,
        expansion: None,
    }
}

fn sheared(gms: f64) -> Material {
    Material { toughness: tape().toughness.with(Toughness::Gms, gms), ..tape() }
}

const PLAIN: CrackBand = CrackBand { alpha: None, breaks: Breaks::All, faces: false, lower_strengths: false };
const FIBRES: CrackBand = CrackBand { breaks: Breaks::Fibres, ..PLAIN };
const SPLITS: CrackBand = CrackBand { breaks: Breaks::Splits, ..PLAIN };
const ALPHA: f64 = 2.44e-26;

/// The tape without what its matrix bears.
fn fibres() -> Material {
    let (x, toughness) = (tape().strengths, tape().toughness);
    Material {
        strengths: Strengths::default().with(Strength::Xt, x.xt()).with(Strength::Xc, x.xc()),
        toughness: Toughnesses::default().with(Toughness::Gft, toughness.gft()).with(Toughness::Gfc, toughness.gfc()),
        ..tape()
    }
}

/// A law at a point and what it remembers.
struct Point {
    law: CrackBand,
    material: Material,
    length: f64,
    thickness: f64,
    state: Vec<f64>,
    strain: [f64; 6],
}

impl Point {
    fn new(law: CrackBand, material: Material, length: f64) -> Self {
        let state = vec![0.0; law.info().state.len()];
        Self { law, material, length, thickness: length, state, strain: [0.0; 6] }
    }

    fn ask(&self, strain: &[f64; 6]) -> (PlyResponse, Matrix6, Vec<f64>) {
        let stiffness = self.material.elastic.stiffness();
        let point = LawPoint {
            material: &self.material,
            stiffness: &stiffness,
            length: self.length,
            thickness: self.thickness,
            means: &[],
        };
        let (mut new, mut tangent) = (vec![f64::NAN; self.state.len()], [[f64::NAN; 6]; 6]);
        let strain = Strain6::new(*strain);
        let answer = self.law.respond(&point, &strain, &self.state, &mut new, Some(&mut tangent)).unwrap();
        (answer, tangent, new)
    }

    /// The answer at the end of a straight way.
    fn walk(&mut self, to: &[f64; 6], parts: u32) -> PlyResponse {
        let from = self.strain;
        let mut last = None;
        for part in 1..=parts {
            let share = f64::from(part) / f64::from(parts);
            self.strain = std::array::from_fn(|k| from[k] + share * (to[k] - from[k]));
            let (answer, _, new) = self.ask(&self.strain);
            self.state = new;
            last = Some(answer);
        }
        last.unwrap()
    }

    /// The answer where one component of strain is given and all other stresses are zero, by Newton's method.
    fn uniaxial(&mut self, component: usize, strain: f64) -> PlyResponse {
        let mut trial = self.strain;
        trial[component] = strain;
        for _ in 0..50 {
            let (answer, tangent, new) = self.ask(&trial);
            let free: Vec<usize> = (0..3).filter(|k| *k != component).collect();
            let [a, b] = [free[0], free[1]];
            let [f, g] = [answer.stress.0[a], answer.stress.0[b]];
            if f.hypot(g) < 1e-4 {
                (self.strain, self.state) = (trial, new);
                return answer;
            }
            let [p, q, r, s] = [tangent[a][a], tangent[a][b], tangent[b][a], tangent[b][b]];
            let over = 1.0 / (p * s - q * r);
            trial[a] -= over * (s * f - q * g);
            trial[b] -= over * (p * g - r * f);
        }
        panic!("no uniaxial stress at {strain} of {component}");
    }
}

#[test]
fn it_keeps_the_contract() {
    for (law, material, length, largest) in [
        (PLAIN, tape(), 1e-4, [0.02, 0.012, 0.012, 0.03, 0.03, 0.03]),
        (PLAIN, sheared(788.0), 2e-4, [0.03, 0.02, 0.02, 0.03, 0.04, 0.04]),
        (CrackBand { alpha: Some(ALPHA), ..PLAIN }, sheared(788.0), 2e-4, [0.01, 0.012, 0.012, 0.04, 0.03, 0.05]),
        (CrackBand { lower_strengths: true, ..PLAIN }, tape(), 4e-3, [0.02, 0.01, 0.01, 0.01, 0.01, 0.01]),
        (FIBRES, fibres(), 4e-3, [0.02, 0.01, 0.01, 0.01, 0.01, 0.01]),
        (CrackBand { faces: true, ..FIBRES }, fibres(), 4e-3, [0.02, 0.01, 0.01, 0.01, 0.01, 0.01]),
        (CrackBand { alpha: Some(ALPHA), ..FIBRES }, tape(), 1e-3, [0.01, 0.01, 0.01, 0.06, 0.03, 0.06]),
        (SPLITS, sheared(788.0), 2e-4, [0.02, 0.012, 0.012, 0.04, 0.04, 0.04]),
        (CrackBand { alpha: Some(ALPHA), ..SPLITS }, sheared(788.0), 2e-4, [0.01, 0.012, 0.012, 0.06, 0.04, 0.06]),
    ] {
        let make = |units: &Units| -> Box<dyn PlyLaw> {
            Box::new(CrackBand { alpha: law.alpha.map(|a| units.number(a, HahnTsai::ALPHA)), ..law })
        };
        assert_eq!(check_ply_law(make, &material, length, &largest), Ok(()), "{law:?}");
    }
}

/// Fibres break as they do where the matrix may break as well, and nothing else does.
#[test]
fn fibres_break_alone() {
    for way in [1.0, -1.0] {
        let mut both = [(PLAIN, tape()), (FIBRES, fibres())].map(|(law, material)| Point::new(law, material, 1e-3));
        // There, halfway back, and on until they are through.
        let there = (1..=7).chain((2..=6).rev()).chain(3..=40).map(|part| 0.002 * f64::from(part));
        let lost: Vec<f64> = there
            .map(|strain| {
                let [all, fibres] = both.each_mut().map(|point| point.uniaxial(0, way * strain));
                assert!((all.stress.0[0] - fibres.stress.0[0]).abs() < 1.0, "{all:?} {fibres:?}");
                let [all, fibres] = [all, fibres].map(|answer| answer.energy.dissipated);
                assert!((all - fibres).abs() <= 1e-9 * all, "{all} {fibres}");
                fibres
            })
            .collect();
        assert!(lost[0] == 0.0 && lost[7] > 0.0 && lost[lost.len() - 1] > lost[7], "{lost:?}");
    }
    // A matrix at rest bears all shears, through broken fibres too.
    let mut point = Point::new(FIBRES, fibres(), 1e-3);
    let broken = point.walk(&[0.2, 0.0, 0.0, 0.01, 0.01, 0.01], 400);
    let stiffness = point.material.elastic.stiffness();
    let elastic = |k: usize| (broken.stress.0[k] / (0.01 * stiffness[k][k]) - 1.0).abs() < 1e-12;
    assert!(broken.stress.0[0].abs() < 1.0 && (3..6).all(elastic), "{broken:?}");
    let taken = broken.energy.dissipated * 1e-3 / point.material.toughness.gft();
    assert!((taken - 1.0).abs() < 0.05, "{taken}");
    let mut point = Point::new(FIBRES, fibres(), 4e-3);
    let answer = point.walk(&[0.0, 0.05, -0.05, 0.1, 0.1, 0.1], 10);
    let linear = apply(&point.material.elastic.stiffness(), &point.strain);
    assert!(answer.stress.0.iter().zip(linear).all(|(s, l)| (s - l).abs() < 1e-9 * 1e9), "{answer:?}");
    assert_eq!(answer.energy.dissipated, 0.0);
}

/// Pure modes to rounding in one step from row to row. On other paths the state is that of small steps: to rounding where the
/// matrix does not turn from tension to compression, to the first order of a step where it does.
#[test]
fn the_tables_are_met() {
    const STRAIN: [&str; 6] = ["e11", "e22", "e33", "g12", "g23", "g13"];
    const STRESS: [&str; 6] = ["s11", "s22", "s33", "s12", "s23", "s13"];
    const TURNS: [&str; 4] =
        ["compression2_with_shear", "constrained_tension_1", "fibre_crack_then_compression", "random"];
    let material = tape();
    let x = &material.strengths;
    let strength = [x.xt(), x.yt(), x.yt(), x.s12(), x.s23(), x.s12()];
    for (name, rows) in paths("ply_damage.csv.gz") {
        let (parts, exact, lost) = match (name.starts_with("pure"), TURNS.iter().any(|turns| name.starts_with(turns))) {
            (true, _) => (1, 1e-10, 1e-10),
            (false, false) => (100, 1e-10, 1e-6),
            (false, true) => (4000, 1e-4, 1e-5),
        };
        let mut point = Point::new(PLAIN, tape(), 2e-4);
        for row in &rows {
            let answer = point.walk(&columns(row, STRAIN), parts);
            let near = |got: f64, want: f64, within: f64, what: &str| {
                assert!((got - want).abs() <= within, "{name} {}: {what} {got} {want}", row["step"]);
            };
            for ((got, want), x) in answer.stress.0.into_iter().zip(columns(row, STRESS)).zip(strength) {
                near(got, want, exact * x, "stress");
            }
            for (got, want) in point.state.iter().zip(columns(row, ["d_ft", "d_fc", "d_mt", "d_mc"])) {
                near(*got, want, exact, "damage");
            }
            near(answer.energy.stored, row["stored_J_m3"], exact * 1e7, "stored");
            near(
                answer.energy.dissipated * 2e-4,
                row["dissipated_J_m2"],
                lost * row["dissipated_J_m2"].max(277.4),
                "lost",
            );
        }
    }
}

/// A bar of cells of which the middle one breaks: with the crack band its curve u(F) = 2 G/X + F/(E A) (L − 2 E G/X²) and its energy
/// G A do not know the number of cells; through the snap-back, by the strain of the weak cell.
#[test]
fn bars_of_any_number_of_cells_break_alike() {
    let material = tape();
    let (e, x, g) = (9.08e9, 62.3e6, 277.4);
    for (bar, cells) in [(0.9e-3, [1.0, 3.0, 9.0, 27.0]), (5.4e-3, [9.0, 27.0, 81.0, 243.0])] {
        for cells in cells {
            let length = bar / cells;
            let mut weak = Point::new(PLAIN, material.clone(), length);
            let (broken, mut work, mut last) = (2.0 * g / (x * length), 0.0, (0.0, 0.0));
            let mut answer = None;
            for k in 1..=400 {
                let strain = 1.001 * broken * f64::from(k) / 400.0;
                let found = weak.uniaxial(1, strain);
                let force = found.stress.s22();
                let u = strain * length + force / e * (bar - length);
                if found.energy.dissipated > 0.0 {
                    let want = 2.0 * g / x + force / e * (bar - 2.0 * e * g / (x * x));
                    assert!(strain > broken || (u / want - 1.0).abs() < 1e-9, "{cells} {u} {want}");
                }
                work += 0.5 * (force + last.0) * (u - last.1);
                last = (force, u);
                answer = Some(found);
            }
            let lost = answer.unwrap().energy.dissipated * length;
            // The work by the trapezoidal rule, which cuts off the corner of the curve.
            assert!((lost / g - 1.0).abs() < 1e-9 && (work / g - 1.0).abs() < 5e-3, "{cells}: {lost} {work}");
        }
    }
}

/// Shear that breaks the matrix takes Gms, tension Gmt, and a mix what the linear law says.
#[test]
fn shear_has_a_toughness_of_its_own() {
    let (gmt, gms) = (277.4, 788.0);
    let lost = |strain: [f64; 6], parts| {
        let mut point = Point::new(PLAIN, sheared(gms), 2e-4);
        point.walk(&strain, parts).energy.dissipated * 2e-4
    };
    for parts in [1, 50] {
        for component in 3..6 {
            let strain = std::array::from_fn(|k| if k == component { 0.3 } else { 0.0 });
            assert!((lost(strain, parts) / gms - 1.0).abs() < 1e-9);
        }
    }
    // Effective stresses in a fixed mix: shear beside uniaxial tension.
    let (s2, t) = (1e9, 1.5e9);
    let [normal, shear] = [s2 * s2 / (2.0 * 9.08e9), t * t / (2.0 * 5.29e9)];
    let want = (normal + shear) / (normal / gmt + shear / gms);
    let mut point = Point::new(PLAIN, sheared(gms), 2e-4);
    let found = (1..=2000).map(|k| {
        let share = f64::from(k) / 2000.0;
        point.strain[3] = share * t / 5.29e9;
        point.uniaxial(1, share * s2 / 9.08e9).energy.dissipated * 2e-4
    });
    let found = found.last().unwrap();
    assert!((found / want - 1.0).abs() < 1e-9, "{found} {want}");
}

/// Below the strength the law is Hahn and Tsai's; softening begins at S12 and takes the toughness beside what yielding took.
#[test]
fn a_permanent_shear_strain_is_hahn_and_tsais() {
    let law = CrackBand { alpha: Some(ALPHA), ..PLAIN };
    let mut point = Point::new(law, sheared(788.0), 2e-4);
    let curve = HahnTsai::new(ALPHA, Unloading::Permanent);
    let (material, mut state) = (tape(), [0.0; 2]);
    let stiffness = material.elastic.stiffness();
    let place = LawPoint { material: &material, stiffness: &stiffness, length: 2e-4, thickness: 2e-4, means: &[] };
    let s12 = 92.3e6_f64;
    let strength = s12 / 5.29e9 + ALPHA * s12.powi(3);
    for gamma in [0.3 * strength, 0.6 * strength, 0.2 * strength, -0.2 * strength, 0.1 * strength] {
        let mut new = [0.0; 2];
        let strain = Strain6::new([1e-4, 0.0, 0.0, gamma, 0.0, 0.0]);
        let want = curve.respond(&place, &strain, &state, &mut new, None).unwrap();
        state = new;
        let found = point.walk(&strain.0, 1);
        assert!((found.stress.s12() - want.stress.s12()).abs() < 1e-6 * s12, "{found:?} {want:?}");
        assert!((found.energy.total() / want.energy.total() - 1.0).abs() < 1e-9);
    }
    let mut fresh = Point::new(law, sheared(788.0), 2e-4);
    let along = |gamma: f64| [0.0, 0.0, 0.0, 0.6 * gamma, 0.0, 0.8 * gamma];
    let peak = fresh.walk(&along(strength), 1).stress;
    assert!((peak.0[3].hypot(peak.0[5]) / s12 - 1.0).abs() < 1e-9 && fresh.state[2] < 1e-9);
    let broken = fresh.walk(&along(0.2), 1000);
    let yielded = 0.75 * ALPHA * s12.powi(4);
    assert_eq!(broken.stress.0[3], 0.0);
    assert!(((broken.energy.dissipated - yielded) * 2e-4 / 788.0 - 1.0).abs() < 1e-9, "{broken:?}");
    assert!((fresh.state[17] / (ALPHA * s12.powi(3)) - 1.0).abs() < 1e-12);
    // It ends there in a single step too.
    let mut sudden = Point::new(law, sheared(788.0), 2e-4);
    sudden.walk(&along(0.2), 1);
    assert!((sudden.state[17] / (ALPHA * s12.powi(3)) - 1.0).abs() < 1e-12);
}

/// Where the matrix bears it, shear yields on at S12: closed forms of the curve, of the energy and of the way back.
#[test]
fn shear_yields_on_where_no_crack_takes_over() {
    let (g, s12) = (5.29e9, 92.3e6_f64);
    let curve = ALPHA * s12.powi(3);
    for parts in [1, 7, 100] {
        let mut point = Point::new(CrackBand { alpha: Some(ALPHA), ..FIBRES }, tape(), 1e-3);
        let along = |gamma: f64| [0.0, 0.0, 0.0, 0.6 * gamma, 0.0, 0.8 * gamma];
        let there = point.walk(&along(0.1), parts);
        assert!((there.stress.0[3].hypot(there.stress.0[5]) / s12 - 1.0).abs() < 1e-12, "{there:?}");
        let way = 0.1 - s12 / g;
        let lost = 0.75 * ALPHA * s12.powi(4) + s12 * (way - curve);
        assert!((there.energy.dissipated / lost - 1.0).abs() < 1e-12 && (point.state[17] / way - 1.0).abs() < 1e-12);
        // Back by twice the elastic strain, and on: elastic first, then at −S12.
        let back = point.walk(&along(0.1 - 2.0 * s12 / g), parts);
        assert!((back.energy.dissipated / lost - 1.0).abs() < 1e-9, "{back:?}");
        let on = point.walk(&along(0.1 - 2.0 * s12 / g - 0.01), parts);
        assert!((on.stress.0[3] / (-0.6 * s12) - 1.0).abs() < 1e-9, "{on:?}");
        assert!((on.energy.dissipated / (lost + 0.01 * s12) - 1.0).abs() < 1e-9);
    }
}

/// Splits take their toughness over the thickness of the ply, however wide the cell, and leave what is between them: of σ22 and τ12 what
/// shear lag says, of τ23 what a short column bears. 33, 13 and a pressure stay as these were.
#[test]
fn splits_run_through_their_ply() {
    let (gmt, gms, thickness) = (277.4, 788.0, 2.5e-4);
    let (e2, g12) = (9.08e9, 5.29e9_f64);
    let g23 = e2 / 2.9;
    let lag = |square: f64| 1.0 - square.sqrt().tanh() / square.sqrt();
    let (open, slid, sheared_across) = (lag(3.0 * g23 / e2), lag(3.0), 1.0 / (1.2 + g23 / e2));
    let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-9, "{got} {want}");
    let fresh = |length: f64| Point { thickness, ..Point::new(SPLITS, sheared(gms), length) };
    let alone = |component: usize, strain: f64| std::array::from_fn(|k| if k == component { strain } else { 0.0 });
    for length in [5e-4, 4e-3] {
        let mut point = fresh(length);
        let broken = (1..=1000).map(|k| point.uniaxial(1, 1e-4 * f64::from(k))).last().unwrap();
        near(broken.stress.s22(), open * 0.1 * e2);
        near(broken.energy.dissipated * thickness, gmt);
        assert_eq!(point.state[..4], [0.0, 0.0, 1.0, 0.0]);
        for (component, left) in [(3, slid * g12), (4, sheared_across * g23)] {
            let found = fresh(length).walk(&alone(component, 0.5), 50);
            near(found.stress.0[component], 0.5 * left);
            near(found.energy.dissipated * thickness, gms);
        }
        // Closed, the ply is that of before under pressure, and slides.
        near(point.uniaxial(1, -0.005).stress.s22(), -0.005 * e2);
        let closed = point.walk(&[0.0, -0.005, 0.0, 0.01, 0.01, 0.01], 5);
        near(closed.stress.0[3], 0.01 * slid * g12);
        near(closed.stress.0[4], 0.01 * sheared_across * g23);
        near(closed.stress.0[5], 0.01 * g12);
        let across = fresh(length).walk(&[0.0, -0.05, 0.05, 0.0, 0.0, 0.1], 10);
        let linear = apply(&sheared(gms).elastic.stiffness(), &[0.0, -0.05, 0.05, 0.0, 0.0, 0.1]);
        assert!(across.stress.0.iter().zip(linear).all(|(s, l)| (s - l).abs() < 1.0), "{across:?}");
    }
    // Plies too thick for the toughness are refused by name, whatever the cell.
    let stiffness = tape().elastic.stiffness();
    let material = sheared(gms);
    let point = LawPoint { material: &material, stiffness: &stiffness, length: 8e-3, thickness: 5e-3, means: &[] };
    let refused = check_law(SPLITS.info(), "crack-band", &point, SPLITS.check(&point)).unwrap_err().to_string();
    assert!(refused.contains("Yt^2") && refused.contains("plies = 5.000000e-3 m"), "{refused}");
}

#[test]
fn cells_too_wide_for_their_toughness_are_refused_or_lower_their_strengths() {
    let stiffness = tape().elastic.stiffness();
    let said = |law: &CrackBand, material: &Material, length: f64| {
        let point = LawPoint { material, stiffness: &stiffness, length, thickness: length, means: &[] };
        let checked = check_law(law.info(), "crack-band", &point, law.check(&point));
        (checked.map_err(|e| e.to_string()), law.warning(&point))
    };
    // 0.9 times 2 G23 Gmt/S23²; with a toughness of shear 0.9 times 2 E2 Gmc/Yc².
    let (refused, _) = said(&PLAIN, &tape(), 5e-4);
    assert!(refused.clone().unwrap_err().contains("S23^2") && refused.unwrap_err().contains("widest = 2.757255e-4 m"));
    let (refused, _) = said(&PLAIN, &sheared(788.0), 2e-3);
    assert!(refused.unwrap_err().contains("1.8 E2 Gmc/Yc^2"));
    assert_eq!(said(&PLAIN, &sheared(788.0), 2e-4), (Ok(()), None));
    let (taken, warned) = said(&PLAIN, &sheared(788.0), 3e-4);
    assert!(taken.is_ok() && warned.unwrap().contains("cells of 0.220 mm or a larger Gmc"));

    let lowering = CrackBand { lower_strengths: true, ..PLAIN };
    let (taken, warned) = said(&lowering, &sheared(788.0), 2e-3);
    let warned = warned.unwrap();
    assert!(taken.is_ok() && warned.contains("Yt from 62.3 to 47.6 MPa") && !warned.contains("Xt"), "{warned}");
    // The energy is kept.
    let mut point = Point::new(lowering, sheared(788.0), 2e-3);
    let shear = |k: u32| [0.0, 0.0, 0.0, 0.02 * f64::from(k) / 2000.0, 0.0, 0.0];
    let answers: Vec<_> = (1..=2000).map(|k| point.walk(&shear(k), 1)).collect();
    let peak = answers.iter().map(|answer| answer.stress.s12()).fold(0.0, f64::max);
    assert!((answers[1999].energy.dissipated * 2e-3 / 788.0 - 1.0).abs() < 1e-9);
    assert!((peak / 61.2509e6 - 1.0).abs() < 1e-2 && warned.contains("S12 from 92.3 to 61.3 MPa"), "{peak} {warned}");

    let missing = Material { toughness: Toughnesses::default().with(Toughness::Gft, 1.0), ..tape() };
    assert!(said(&PLAIN, &missing, 1e-4).0.unwrap_err().contains("needs the toughness Gfc, Gmt, Gmc"));
}

#[test]
fn it_is_built_from_a_scene() {
    let alpha = Value::Quantity(ALPHA, HahnTsai::ALPHA);
    let Built::PlyLaw(law) = CrackBand::build(&Params::default().with("alpha", alpha)).unwrap() else { unreachable!() };
    assert_eq!(law.info().state.len(), 18);
    let Built::PlyLaw(law) = CrackBand::build(&Params::default()).unwrap() else { unreachable!() };
    assert_eq!(law.info().state.len(), 15);
    let wrong = Params::default().with("alpha", Value::Quantity(1.0, Dimension::PRESSURE));
    assert_eq!(CrackBand::build(&wrong).unwrap_err().key, "alpha");
}
