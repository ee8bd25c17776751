//! Impacts against modal series of plate and beam theory.
//!
//! The series know no squeeze of the laminate under the contact: it is part of the contact stiffness. Solid elements add it,
//! and then differ by it, which [`Strike::stiff_across`] shows: plies that do not yield across the laminate leave of a solid
//! what first-order theory has, and its histories meet the series.

use super::scene::{AS4, Cells, MeshFile, Plate, Side, gmsh_cells, isotropic, order, reference};
use crate::support::draw;
use fem::analyses::impact;
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

/// Largest force of the first contact, relative.
const PEAK: f64 = 1e-2;
/// Impulse, up to the end of the first contact and in all, relative; so is the velocity at the end.
const IMPULSE: f64 = 5e-3;
/// The first contact, as L2 difference of the force.
const CURVE: f64 = 2e-2;
/// Deflection under the impactor, as L2 difference over the whole history.
const DEFLECTION: f64 = 1e-2;

/// Series that the book shows: table, picture, heading.
const DRAWN: [(&str, &str, &str); 4] = [
    (KARAS, "karas", "Karas: a steel ball on a steel plate"),
    (SUN_AND_CHEN, "sun-and-chen", "Sun and Chen: a steel ball on ten plies"),
    (LARGE_MASS, "large-mass", "2.49 kg on sixteen plies, law of Sun and Yang"),
    (SMALL_MASS, "small-mass", "16 g on sixteen plies, law of Sun and Yang"),
];

/// Separations up to this, us, count as one contact. Two of the series of repeated contacts, of eight contacts each, graze so at
/// 3.01 ms: force is zero for one or two rows of their tables, and below 6 % of its largest around them. Such separations
/// come and go with the highest mode.
const GRAZING: f64 = 15.5;

/// An impact in the middle of a simply supported square plate, or of a strip, of which symmetry leaves a quarter or half.
#[derive(Debug, Clone)]
pub(super) struct Strike {
    pub(super) element: String,
    pub(super) material: String,
    pub(super) plies: &'static str,
    pub(super) ply_mm: f64,
    /// Plies per layer of cells.
    pub(super) layers: &'static [usize],
    /// Half the side or length, mm.
    pub(super) half: f64,
    /// Width of a strip, mm.
    pub(super) width: Option<f64>,
    /// Side of the square over which the contact acts, mm.
    pub(super) patch: f64,
    /// Cells are half a patch long under the impactor, longer by `growth` from one to the next, at most `longest`, mm.
    pub(super) growth: f64,
    pub(super) longest: f64,
    pub(super) cells: Cells,
    /// kg and m/s.
    pub(super) mass: f64,
    pub(super) velocity: f64,
    /// N/m^1.5.
    pub(super) k: f64,
    /// Name and other keys of the law.
    pub(super) law: &'static str,
    /// Surface that its indentation counts from.
    pub(super) from: &'static str,
    pub(super) vectors: usize,
    /// How they are found.
    pub(super) space: &'static str,
    /// us.
    pub(super) step: f64,
    pub(super) end: f64,
    /// Keys of its effects.
    pub(super) effects: String,
}

const HERTZ: &str = "law = 'hertz'";
const SUN_YANG: &str = "law = 'sun-yang'\ncritical = '0.08 mm'\nm = 2.5\nbeta = 0.4";
const RELOADING_BY_N: &str =
    "law = 'sun-yang'\ncritical = '0.08 mm'\nm = 2.5\nbeta = 0.4\nreloading = 'loading-exponent'";

impl Strike {
    /// The plies with a modulus of 100 TPa across the laminate, which then keeps its thickness and plane stress.
    fn stiff_across(mut self) -> Self {
        for (from, to) in
            [("e3 = '9.65 GPa'", "e3 = '1e5 GPa'"), ("nu13 = 0.35", "nu13 = 0"), ("nu23 = 0.4", "nu23 = 0")]
        {
            assert_eq!(self.material.matches(from).count(), 1, "{from}");
            self.material = self.material.replace(from, to);
        }
        self
    }

    fn law(self, law: &'static str) -> Self {
        Self { law, ..self }
    }

    /// Lines from the support to the middle, mm.
    fn lines(&self) -> Vec<f64> {
        let first = 0.5 * self.patch;
        let (mut from_middle, mut cell) = (vec![0.0, first], first);
        loop {
            cell = (cell * self.growth).min(self.longest);
            let next = from_middle[from_middle.len() - 1] + cell;
            if next > self.half * (1.0 + 1e-9) {
                break;
            }
            from_middle.push(next);
        }
        let stretch = (self.half - first) / (from_middle[from_middle.len() - 1] - first);
        let line = |(i, x): (usize, &f64)| self.half - if i < 2 { *x } else { first + (x - first) * stretch };
        from_middle.iter().enumerate().rev().map(line).collect()
    }

    /// Of the quarter or half that symmetry leaves.
    pub(super) fn mesh(&self) -> MeshFile {
        let x = self.lines();
        let y = self.width.map_or_else(|| x.clone(), |width| vec![0.0, width]);
        gmsh_cells(&x, &y, 0.0, self.cells)
    }

    /// Of the whole plate to that which is computed.
    pub(super) fn parts(&self) -> f64 {
        if self.width.is_some() { 2.0 } else { 4.0 }
    }

    /// The scene on its mesh.
    pub(super) fn text(&self, mesh: &MeshFile) -> String {
        let parts = self.parts();
        let across = match self.width {
            Some(_) => [Side::Free; 2],
            None => [Side::Supported, Side::Symmetric],
        };
        // The part of the patch that lies on the part of the plate bears its part of the force.
        let side = 0.5 * self.patch;
        let at = [self.half - 0.5 * side, self.width.map_or(self.half - 0.5 * side, |width| 0.5 * width)];
        let mut plate = Plate::new(&self.material, self.plies, self.ply_mm, self.layers.to_vec())
            .on(mesh)
            .element(&self.element)
            .sides([Side::Supported, Side::Symmetric, across[0], across[1]]);
        plate.more = format!(
            "[impactor]\nmass = '{} kg'\nvelocity = '{} m/s'\nat = {{ x = '{} mm', y = '{} mm' }}\npatch_side = '{side} mm'\n\
             indentation_from = '{}'\n[contact]\n{}\nk = '{} N/m^1.5'\n[effects]\ndamage = 'off'\n{}\n[reduction]\nmethod = 'ritz'\nvectors = {}\nspace = '{}'\n\
             [march]\nintegrator = 'newmark'\nstep = '{} us'\nend = '{} us'\n[output]\nhistory_every = '1 us'\n",
            self.mass / parts,
            self.velocity,
            at[0],
            at[1],
            self.from,
            self.law,
            self.k / parts,
            self.effects,
            self.vectors,
            self.space,
            self.step,
            self.end,
        );
        plate.text("impact")
    }

    fn run(&self) -> History {
        let mesh = self.mesh();
        let scene = scene::parse(&self.text(&mesh), "scene.toml".as_ref()).unwrap();
        let model = Model::new(scene, &Registry::standard()).unwrap();
        let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
        assert_eq!(outcome.stopped, None);
        assert!(outcome.energy_error < 1e-4, "{}", outcome.energy_error);
        History { rows: outcome.history, parts: self.parts() }
    }

    /// Largest force, N.
    pub(super) fn peak(&self) -> f64 {
        let History { rows, parts } = self.run();
        rows.iter().fold(0.0, |m, row| m.max(parts * row.contact_force_n()))
    }

    /// What sets its history apart from that of `table`.
    fn against(&self, table: &str) -> Difference {
        let (history, rows) = (self.run(), reference(table));
        let force = |row: &HistoryRow| history.parts * row.contact_force_n();
        let all = rows.iter().position(|r| r["t_us"] > self.end).unwrap_or(rows.len());
        let first = rows.iter().skip(2).position(|r| r["F_N"] == 0.0).map_or(all, |i| i + 2);
        let sampled = |upto: usize, value: &dyn Fn(&HistoryRow) -> f64| -> Vec<f64> {
            rows[..upto].iter().map(|r| history.at(r["t_us"] * 1e-6, value)).collect()
        };
        let column = |upto: usize, name: &str| -> Vec<f64> { rows[..upto].iter().map(|r| r[name]).collect() };
        let (forces, deflections) =
            (sampled(first, &force), sampled(all, &|r| 1e3 * r.impactors[0].plate_displacement_m));
        if let Some((_, name, title)) = DRAWN.iter().find(|drawn| drawn.0 == table) {
            let curve = |forces: Vec<f64>| -> Vec<_> { rows.iter().map(|r| r["t_us"] * 1e-6).zip(forces).collect() };
            draw(name, title, &curve(sampled(all, &force)), ("series", &curve(column(all, "F_N"))));
        }
        let velocities = sampled(all, &|r| r.impactors[0].impactor_velocity_m_s);
        let impulse =
            |row: usize| (self.velocity - velocities[row]) / (self.velocity - rows[row]["v_impactor_m_s"]) - 1.0;
        Difference {
            peak: largest(&forces) / largest(&column(first, "F_N")) - 1.0,
            curve: l2(&forces, &column(first, "F_N")),
            first_impulse: impulse(first - 1),
            impulse: impulse(all - 1),
            velocity: velocities[all - 1] / rows[all - 1]["v_impactor_m_s"] - 1.0,
            deflection: l2(&deflections, &column(all, "w_contact_mm")),
            contacts: [
                contacts(rows[..all].iter().map(|r| (r["t_us"], r["F_N"]))),
                contacts(history.rows.iter().map(|r| (1e6 * r.time_s, r.contact_force_n()))),
            ],
        }
    }
}

struct History {
    rows: Vec<HistoryRow>,
    /// Of the whole plate to that which is computed.
    parts: f64,
}

impl History {
    /// Between the rows.
    fn at(&self, t: f64, value: &dyn Fn(&HistoryRow) -> f64) -> f64 {
        let after = self.rows.partition_point(|r| r.time_s < t).clamp(1, self.rows.len() - 1);
        let (a, b) = (&self.rows[after - 1], &self.rows[after]);
        value(a) + (t - a.time_s) / (b.time_s - a.time_s) * (value(b) - value(a))
    }
}

/// Relative differences from a series.
#[derive(Debug, Clone, Copy)]
struct Difference {
    /// Largest force of the first contact.
    peak: f64,
    /// First contact.
    curve: f64,
    /// Impulse up to its end, and in all.
    first_impulse: f64,
    impulse: f64,
    /// Velocity of the impactor at the end.
    velocity: f64,
    deflection: f64,
    /// Their number, in the series and here.
    contacts: [usize; 2],
}

impl Difference {
    /// Force and impulse.
    #[track_caller]
    fn small_in_force(self) {
        assert!(self.peak.abs() < PEAK && self.curve < CURVE, "{self:?}");
        assert!(self.first_impulse.abs() < IMPULSE, "{self:?}");
        self.small_in_motion();
    }

    /// Impulse, velocity and deflection.
    #[track_caller]
    fn small_in_motion(self) {
        assert!(self.impulse.abs() < IMPULSE && self.velocity.abs() < IMPULSE, "{self:?}");
        assert!(self.deflection < DEFLECTION, "{self:?}");
    }
}

/// How often force acts anew, of rows of time (us) and force.
fn contacts(rows: impl Iterator<Item = (f64, f64)>) -> usize {
    let touching: Vec<f64> = rows.filter(|(_, force)| *force > 0.0).map(|(t, _)| t).collect();
    1 + touching.windows(2).filter(|t| t[1] - t[0] > GRAZING).count()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(*x))
}

fn l2(values: &[f64], exact: &[f64]) -> f64 {
    let off: f64 = values.iter().zip(exact).map(|(a, b)| (a - b).powi(2)).sum();
    (off / exact.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// Plates of `mitc4`, with its shear stiffness from equilibrium, which for layers differs from 5/6 G h.
pub(super) fn shell(material: String, plies: &'static str, ply_mm: f64, layers: &'static [usize]) -> Strike {
    Strike {
        element: "kind = 'mitc4'".into(),
        material,
        plies,
        ply_mm,
        layers,
        half: 100.0,
        width: None,
        patch: 2.0,
        growth: 1.12,
        longest: 100.0,
        cells: Cells::Quads,
        mass: 0.0328107936740918,
        velocity: 1.0,
        k: 14901620370.37037,
        law: HERTZ,
        from: "face",
        vectors: 150,
        space: "two-level",
        step: 0.1,
        end: 90.0,
        effects: String::new(),
    }
}

/// Holds `strike` to every tolerance.
#[track_caller]
fn agrees(strike: &Strike, table: &str, contacts: usize) {
    let difference = strike.against(table);
    difference.small_in_force();
    assert_eq!(difference.contacts, [contacts; 2], "{difference:?}");
}

pub(super) const KARAS: &str = "impact_karas_fsdtri_patch2.csv";
pub(super) const SUN_AND_CHEN: &str = "impact_sunchenA_fsdtri_patch2_hertz.csv";
const LARGE_MASS: &str = "impact_as4x16_largemass_fsdtri_patch2_sunyang.csv";
const SMALL_MASS: &str = "impact_as4x16_smallmass_fsdtri_patch2_sunyang.csv";

/// A steel ball on a steel plate.
pub(super) fn on_steel() -> Strike {
    shell(isotropic(206.0, 0.28, 7.833), "[0]", 8.0, &[1])
}

#[test]
fn karas() {
    agrees(&on_steel(), KARAS, 1);
}

/// A steel ball on ten plies.
pub(super) fn on_ten_plies() -> Strike {
    let material = "e1 = '120 GPa'\ne2 = '7.9 GPa'\ne3 = '7.9 GPa'\nnu12 = 0.3\nnu13 = 0.3\nnu23 = 0.3\n\
                    g12 = '5.5 GPa'\ng13 = '5.5 GPa'\ng23 = '5.5 GPa'\ndensity = '1.58 g/cm^3'\n";
    Strike {
        mass: 0.008537345412820706,
        velocity: 3.0,
        k: 811585276.4303534,
        step: 0.2,
        end: 250.0,
        ..shell(material.into(), "[0/90/0/90/0]s", 0.269, &[10])
    }
}

/// The first of two contacts. The other shear stiffness shows in the slow rebound: 3 % of its velocity.
#[test]
fn sun_and_chen() {
    let difference = on_ten_plies().against(SUN_AND_CHEN);
    assert!(difference.peak.abs() < PEAK && difference.curve < CURVE, "{difference:?}");
    assert!(difference.first_impulse.abs() < IMPULSE, "{difference:?}");
}

/// 2.49 kg and 16 plies, 75 x 75 mm, one layer of solids.
fn as4x16() -> Strike {
    Strike {
        // The series' shear stiffness is a mean of the plies' moduli times 5/6, as that of strains which share none of their stresses.
        element: "kind = 'hermite-prism', transverse_stresses = 'of-strains'".into(),
        material: AS4.into(),
        plies: "[0/90/0/90/0/90/0/90]s",
        ply_mm: 0.13,
        layers: &[16],
        half: 37.5,
        width: None,
        patch: 2.0,
        growth: 1.2,
        longest: 4.0,
        cells: Cells::Quads,
        mass: 2.49,
        velocity: 1.56,
        k: 3383637096.3801656,
        law: HERTZ,
        from: "face",
        vectors: 100,
        space: "two-level",
        step: 0.5,
        end: 8000.0,
        effects: String::new(),
    }
}

fn small_mass() -> Strike {
    Strike { mass: 0.016, velocity: 19.46, step: 0.1, end: 700.0, ..as4x16() }
}

#[test]
fn a_large_mass_on_sixteen_plies() {
    let strike = as4x16().stiff_across();
    agrees(&strike, "impact_as4x16_largemass_fsdtri_patch2_hertz.csv", 3);
    agrees(&strike.law(SUN_YANG), LARGE_MASS, 2);
}

#[test]
fn a_small_mass_on_sixteen_plies() {
    let strike = small_mass().stiff_across();
    agrees(&strike, "impact_as4x16_smallmass_fsdtri_patch2_hertz.csv", 3);
    agrees(&strike.law(SUN_YANG), SMALL_MASS, 3);
}

/// The same series by triangles, and by triangles among quadrilaterals.
#[test]
fn cells_of_both_shapes() {
    for cells in [Cells::Triangles, Cells::Mixed] {
        let strike = Strike { cells, ..as4x16().stiff_across() };
        agrees(&strike.law(SUN_YANG), LARGE_MASS, 2);
    }
}

/// With the modulus that the plies have across the laminate, the squeeze under the patch makes the contact softer than that
/// of the series, which finer cells and a second layer do not change: the first force is lower, by 1.0 % (large mass), 2.0 %
/// and, finer, 1.7 % (small mass), the impulse of the first contact higher, by 0.3 %, 0.6 % and 0.65 %. The peak of the
/// small mass stands on a ripple of the highest modes: by way of the coarse model and from 100 to 500 vectors it lies 1.7 to
/// 2.5 % low, while the impulse moves by 2e-5.
#[test]
#[ignore = "twenty seconds"]
fn solids_squeeze_under_the_contact() {
    let finer = Strike { growth: 1.15, longest: 3.0, layers: &[8, 8], vectors: 150, ..small_mass() };
    let [large, small] = ["large", "small"].map(|mass| format!("impact_as4x16_{mass}mass_fsdtri_patch2_hertz.csv"));
    for (strike, table, peak, impulse) in
        [(as4x16(), &large, -0.0103, 0.0033), (small_mass(), &small, -0.0203, 0.0058), (finer, &small, -0.0173, 0.0065)]
    {
        let difference = Strike { space: "krylov", ..strike }.against(table);
        assert!((difference.peak - peak).abs() < 1e-3, "{difference:?}");
        assert!((difference.first_impulse - impulse).abs() < 3e-4, "{difference:?}");
        assert!(difference.curve < 2.0 * CURVE && difference.impulse.abs() < IMPULSE, "{difference:?}");
    }
}

/// Counted from the mid-plane, as the series does it, the law holds the squeeze, and it counts once: the first forces are 0.15 % and 0.11 %
/// higher instead of 1.0 % and 2.0 % lower, and their impulses within 0.04 %.
#[test]
#[ignore = "fifteen seconds"]
fn a_squeeze_that_counts_once() {
    for (strike, mass) in [(as4x16(), "large"), (small_mass(), "small")] {
        let table = format!("impact_as4x16_{mass}mass_fsdtri_patch2_hertz.csv");
        let difference = Strike { space: "krylov", from: "mid-plane", ..strike }.against(&table);
        assert!(difference.peak.abs() < 3e-3 && difference.curve < 1.5e-2, "{mass}: {difference:?}");
        assert!(difference.first_impulse.abs() < 1e-3, "{mass}: {difference:?}");
        difference.small_in_motion();
    }
}

/// 20 g on 8 plies, 150 x 150 mm: repeated contacts, whose forces follow the highest mode of the series, and whose motion
/// does not.
#[track_caller]
fn repeated(law: &'static str, table: &str, contacts: usize) {
    let strike = Strike {
        plies: "[0/90/0/90]s",
        layers: &[8],
        half: 75.0,
        growth: 1.4,
        longest: 3.0,
        mass: 0.02,
        velocity: 3.0,
        vectors: 300,
        step: 0.2,
        end: 4000.0,
        ..as4x16()
    };
    let difference = strike.stiff_across().law(law).against(table);
    difference.small_in_motion();
    assert!(difference.first_impulse.abs() < IMPULSE, "{difference:?}");
    assert_eq!(difference.contacts, [contacts; 2], "{difference:?}");
}

#[test]
#[ignore = "ten seconds"]
fn repeated_contacts() {
    repeated(HERTZ, "impact_as4x8_multi_fsdtri_patch2_hertz.csv", 7);
}

#[test]
#[ignore = "ten seconds"]
fn repeated_contacts_that_would_leave_a_dent() {
    repeated(SUN_YANG, "impact_as4x8_multi_fsdtri_patch2_sunyang.csv", 7);
}

#[test]
#[ignore = "ten seconds"]
fn repeated_contacts_that_reload_otherwise() {
    repeated(RELOADING_BY_N, "impact_as4x8_multi_fsdtri_patch2_sunyang_reload_n.csv", 7);
}

/// A strip 1 mm wide in plane stress.
#[test]
fn a_laminated_beam() {
    let strike = Strike {
        element: SECTION.into(),
        half: 25.0,
        width: Some(1.0),
        patch: 0.5,
        mass: 0.001,
        velocity: 1.0,
        k: 1e8,
        vectors: 60,
        step: 0.2,
        end: 2000.0,
        ..as4x16()
    };
    agrees(&strike.stiff_across(), "impact_beam_as4x16_L50_timo_patch0p5_hertz.csv", 6);
}

const SECTION: &str = "kind = 'webster-beam', state = 'plane-stress'";

/// Timoshenko's beams of steel, 10 mm wide, as a strip `height` high that has the bending stiffness and the mass of 10 mm.
fn steel(height: f64, half: f64, mass: f64, k: f64) -> Strike {
    let slender = 10.0 / height;
    Strike {
        element: SECTION.into(),
        material: isotropic(215.82 * slender.powi(3), 0.3, 7.96 * slender),
        plies: "[0]",
        ply_mm: height,
        layers: &[1],
        half,
        width: Some(10.0),
        patch: 1.0,
        growth: 1.3,
        longest: half,
        mass,
        velocity: 0.01,
        k,
        vectors: 40,
        end: 3000.0,
        ..as4x16()
    }
}

/// The series are Euler and Bernoulli's: no shear, no rotary inertia, a force at a point. A strip of the same bending
/// stiffness and mass comes to them as the square of its height; at the height of 10 mm, shear makes the first force 0.8 % and
/// 1.3 % lower.
#[test]
fn timoshenkos_beams() {
    let tables = ["impact_timoshenko_R10_L153p5_eb_point.csv", "impact_timoshenko_R20_L307_eb_point.csv"];
    let beam = |height, i| match i {
        0 => steel(height, 76.75, 0.033342770030099673, 15810989010.989012),
        _ => steel(height, 153.5, 0.2667421602407974, 22360115093.872627),
    };
    for (i, (table, contacts)) in tables.into_iter().zip([1, 3]).enumerate() {
        agrees(&beam(1.0, i), table, contacts);
        let [real, half] = [10.0, 5.0].map(|height| beam(height, i).against(table));
        assert!((-0.02..-0.005).contains(&real.peak) && real.contacts == [contacts; 2], "{real:?}");
        let order = order(&[1, 2], &[real.curve, half.curve]);
        assert!((1.7..2.6).contains(&order), "{order}: {real:?} {half:?}");
    }
}
