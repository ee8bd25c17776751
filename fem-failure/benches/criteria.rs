//! Cost of one stress state per criterion, through `indices_many` behind `dyn`, one thread.
//!
//! `cargo bench -p fem-failure`; the counter is the number of states, so that divan shows states per second.

#![allow(clippy::unwrap_used, missing_docs)]

use divan::Bencher;
use divan::counter::ItemsCount;
use fem_core::failure::{FailureCriterion, Site};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughnesses};
use fem_core::tensor::{Ply, Stress6};
use fem_failure::*;

const STATES: usize = 4096;

fn main() {
    divan::main();
}

fn as4_3502() -> Material {
    use Strength::*;
    let strengths = [
        (Xt, 1793e6),
        (Xc, 1724e6),
        (Yt, 64e6),
        (Yc, 138e6),
        (S12, 109e6),
        (S23, 69e6),
        (Zt, 60e6),
        (Zc, 150e6),
        (S13, 90e6),
    ];
    Material {
        name: "AS4/3502".into(),
        elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9),
        density: None,
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
        strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
    }
}

/// Stresses of all signs, by Weyl sequences.
fn states() -> Vec<Stress6<Ply>> {
    let component = |k: usize, i: usize, scale: f64| {
        let irrational = [0.414_213_562, 0.732_050_808, 0.236_067_977, 0.645_751_311, 0.316_624_790, 0.605_551_275][i];
        scale * (2.0 * (k as f64 * irrational).fract() - 1.0)
    };
    let scales = [1500e6, 80e6, 40e6, 80e6, 50e6, 50e6];
    (1..=STATES).map(|k| Stress6::new(std::array::from_fn(|i| component(k, i, scales[i])))).collect()
}

/// [`HashinReport`] as a scene would write it.
fn hashin_report_in_words() -> Expression {
    let modes = [
        ("fibre tension", "(s1 >= 0)*((s1/Xt)^2 + (s12^2 + s13^2)/S12^2)"),
        ("fibre compression", "(s1 < 0)*(s1/Xc)^2"),
        ("matrix tension", "(s2 + s3 >= 0)*(((s2 + s3)/Yt)^2 + (s23^2 - s2*s3)/S23^2 + (s12^2 + s13^2)/S12^2)"),
        ("matrix compression", "(s2 + s3 < 0)*((((s2 - s3)/2)^2 + s23^2)/S23^2 + (s12^2 + s13^2)/S12^2)"),
    ];
    Expression::new(Site::Ply, &modes).unwrap()
}

fn criteria() -> Vec<(&'static str, Box<dyn FailureCriterion>)> {
    let ignore = OutOfPlane::Ignore;
    vec![
        ("hashin-report", Box::new(HashinReport::default())),
        ("hashin-1980", Box::new(Hashin1980)),
        ("hashin-rotem", Box::new(HashinRotem)),
        ("max-stress", Box::new(MaxStress)),
        ("max-strain", Box::new(MaxStrain { e1t: 0.014, e1c: 0.013, e2t: 0.007, e2c: 0.014, g12: 0.018, g23: 0.02 })),
        ("tsai-hill", Box::new(TsaiHill { out_of_plane: ignore, ..TsaiHill::default() })),
        ("tsai-wu", Box::new(TsaiWu::default())),
        ("hoffman", Box::new(Hoffman)),
        ("christensen", Box::new(Christensen)),
        ("chang-chang", Box::new(ChangChang { out_of_plane: ignore, ..ChangChang::default() })),
        ("chang-lessard", Box::new(ChangLessard)),
        ("choi-chang", Box::new(ChoiChang)),
        ("puck-2d", Box::new(Puck2d { out_of_plane: ignore, ..Puck2d::default() })),
        ("puck", Box::new(Puck::default())),
        ("larc03", Box::new(Larc03 { out_of_plane: ignore, ..Larc03::default() })),
        ("larc05", Box::new(Larc05::default())),
        ("cuntze", Box::new(Cuntze::default())),
        ("cuntze-2d", Box::new(Cuntze2d { out_of_plane: ignore, ..Cuntze2d::default() })),
        ("expression", Box::new(hashin_report_in_words())),
        ("octahedral", Box::new(Octahedral)),
        ("quadratic-stress", Box::new(QuadraticStress)),
        ("max-stress-interface", Box::new(MaxStressInterface)),
        ("brewer-lagace", Box::new(BrewerLagace)),
    ]
}

fn names() -> impl Iterator<Item = &'static str> {
    criteria().into_iter().map(|(name, _)| name)
}

fn criterion(name: &str) -> Box<dyn FailureCriterion> {
    criteria().into_iter().find(|(n, _)| *n == name).map(|(_, c)| c).unwrap()
}

#[divan::bench(args = names())]
fn indices_many(bencher: Bencher<'_, '_>, name: &str) {
    let (criterion, material, states) = (criterion(name), as4_3502(), states());
    let mut out = vec![0.0; STATES * criterion.info().modes.len()];
    bencher.counter(ItemsCount::new(STATES)).bench_local(|| {
        criterion.indices_many(divan::black_box(&states), &material, divan::black_box(&mut out));
    });
}

#[divan::bench(args = names())]
fn reserve_factor(bencher: Bencher<'_, '_>, name: &str) {
    let (criterion, material) = (criterion(name), as4_3502());
    let states = &states()[..16];
    bencher.counter(ItemsCount::new(states.len())).bench_local(|| {
        states.iter().map(|s| criterion.reserve_factor(divan::black_box(s), &material).factor).fold(0.0, f64::max)
    });
}

/// A sample of the first-damage scan: gathering, Hashin's indices, maxima and crossings.
#[divan::bench]
fn scan_sample(bencher: Bencher<'_, '_>) {
    let site = |cell| scan::ScanSite {
        cell,
        region: 0,
        place: scan::PlyOrInterface::Ply((cell % 16) as u16),
        position: [0.0; 3],
        angle: 0.0,
        material: 0,
    };
    let states = states();
    let sites = (0..STATES as u32).map(site).collect();
    let mut scan = scan::Scan::new(vec![("h".into(), criterion("hashin-report"))], sites, vec![as4_3502()]).unwrap();
    let mut time = 0.0;
    bencher.counter(ItemsCount::new(STATES)).bench_local(|| {
        time += 1.0;
        scan.sample(time, divan::black_box(&states)).unwrap();
    });
}
