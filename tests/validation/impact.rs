//! Impacts against modal series of first-order plate theory with rotary inertia.

use super::scene::{gmsh_grid, reference};
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry, run};
use std::num::NonZeroUsize;

/// Largest force, relative.
const PEAK: f64 = 1e-2;
/// Impulse and velocity after the contact, relative.
const IMPULSE: f64 = 5e-3;
/// The first contact, as L2 difference of the force. The series take the shear stiffness 5/6 G h, `mitc4` that from
/// equilibrium, which differs for layers.
const CURVE: f64 = 2e-2;

/// Lines across 200 mm: 1 mm apart at the middle, wider by `growth` from there.
fn lines(growth: f64) -> Vec<f64> {
    let mut half = vec![0.0, 1.0];
    let mut step = 1.0;
    while half[half.len() - 1] + step * growth < 100.0 {
        step *= growth;
        half.push(half[half.len() - 1] + step);
    }
    let scale = |i: usize, x: f64| if i < 2 { x } else { 1.0 + (x - 1.0) * 99.0 / (half[half.len() - 1] - 1.0) };
    let half: Vec<f64> = half.iter().enumerate().map(|(i, x)| scale(i, *x)).collect();
    half.iter().rev().map(|x| 100.0 - x).chain(half[1..].iter().map(|x| 100.0 + x)).collect()
}

/// A square plate of 200 mm of `mitc4`, simply supported, struck in its middle over a square of 2 mm.
fn history(laminate: &str, impactor: &str, k: &str, step: &str, end: &str) -> Vec<HistoryRow> {
    let line = lines(1.12);
    let mesh = gmsh_grid(&line, &line, 0.0);
    let supports: String = [("x-min", 2), ("x-max", 2), ("y-min", 1), ("y-max", 1)]
        .map(|(group, n)| format!("[[support]]\ngroup = '{group}'\nat = 'all'\nfix = ['U30', 'U{n}0', 'U{n}3']\n"))
        .concat();
    let text = format!(
        "title = 'impact'\nmesh = {{ file = 'plate.msh', unit = 'mm' }}\nelement = {{ kind = 'mitc4' }}\n{laminate}{supports}\
         [impactor]\n{impactor}\nat = {{ x = '100 mm', y = '100 mm' }}\npatch_side = '2 mm'\n\
         [contact]\nlaw = 'hertz'\nk = '{k} N/m^1.5'\n[effects]\ndamage = 'off'\n[reduction]\nmethod = 'none'\n\
         [march]\nintegrator = 'newmark'\nstep = '{step}'\nend = '{end}'\n"
    );
    let scene = scene::parse(&text, &mesh.folder().join("scene.toml")).unwrap();
    let model = Model::new(scene, &Registry::standard()).unwrap();
    let outcome = run::march(run::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
    assert_eq!(outcome.stopped, None);
    assert!(outcome.energy_error < 1e-4, "{}", outcome.energy_error);
    outcome.history
}

/// Compares the first contact, and the impulse and velocity at its end.
fn check(history: &[HistoryRow], table: &str, mass: f64) {
    let rows = reference(table);
    let force = |t: f64| {
        let after = history.partition_point(|r| r.time_s < t).clamp(1, history.len() - 1);
        let (a, b) = (&history[after - 1], &history[after]);
        a.contact_force_n() + (t - a.time_s) / (b.time_s - a.time_s) * (b.contact_force_n() - a.contact_force_n())
    };
    let end = rows.iter().skip(2).position(|r| r["F_N"] == 0.0).map_or(rows.len(), |i| i + 2);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let last = rows[end - 1]["t_us"] * 1e-6;
    let peak = largest(&mut history.iter().filter(|r| r.time_s <= last).map(|r| r.contact_force_n()));
    let want = largest(&mut rows[..end].iter().map(|r| r["F_N"]));
    assert!((peak / want - 1.0).abs() < PEAK, "{table}: peak {peak} N, not {want} N");
    let (mut off, mut all) = (0.0, 0.0);
    for row in &rows[..end] {
        off += (force(row["t_us"] * 1e-6) - row["F_N"]).powi(2);
        all += row["F_N"].powi(2);
    }
    assert!((off / all).sqrt() < CURVE, "{table}: curve {}", (off / all).sqrt());
    let start = rows[0]["v_impactor_m_s"];
    let v =
        history[history.partition_point(|r| r.time_s < last).min(history.len() - 1)].impactors[0].impactor_velocity_m_s;
    let impulse = mass * (start - v);
    let wanted = mass * (start - rows[end - 1]["v_impactor_m_s"]);
    assert!((impulse / wanted - 1.0).abs() < IMPULSE, "{table}: impulse {impulse}, not {wanted}");
}

#[test]
fn karas() {
    let laminate = "[materials.steel]\ne = '206 GPa'\nnu = 0.28\ndensity = '7833 kg/m^3'\n\
                    [laminate]\nplies = '[0]'\nmaterial = 'steel'\nply_thickness = '8 mm'\nlayers = 1\n";
    let history =
        history(laminate, "mass = '0.0328107936740918 kg'\nvelocity = '1 m/s'", "14901620370.37037", "0.1 us", "90 us");
    check(&history, "impact_karas_fsdtri_patch2.csv", 0.0328107936740918);
}

#[test]
#[ignore = "ten seconds"]
fn sun_and_chen() {
    let laminate = "[materials.tape]\ne1 = '120 GPa'\ne2 = '7.9 GPa'\ne3 = '7.9 GPa'\nnu12 = 0.3\nnu13 = 0.3\nnu23 = 0.3\n\
                    g12 = '5.5 GPa'\ng13 = '5.5 GPa'\ng23 = '5.5 GPa'\ndensity = '1580 kg/m^3'\n\
                    [laminate]\nplies = '[0/90/0/90/0]s'\nmaterial = 'tape'\nply_thickness = '0.269 mm'\nlayers = 1\n";
    let mass = 0.008537345412820706;
    let impactor = format!("mass = '{mass} kg'\nvelocity = '3 m/s'");
    let history = history(laminate, &impactor, "811585276.4303534", "0.2 us", "250 us");
    check(&history, "impact_sunchenA_fsdtri_patch2_hertz.csv", mass);
}
