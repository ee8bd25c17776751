//! Every criterion of the registry where stresses are not ordinary ones, and strengths none at all.

use crate::case::{Case, Room};
use crate::registry::{criteria, tapes};
use fem::core::failure::{AssessError, FailureCriterion, assess, check_material};
use fem::core::material::{Material, Strength};
use fem::core::tensor::{Ply, Stress6};
use fem::failure::scan::{PlyOrInterface, Scan, ScanSite};
use fem::io::scene::{self, SceneError};
use std::path::Path;

pub(crate) fn cases() -> Vec<Case> {
    vec![
        Room::Failure.case(
            "no stress",
            "every criterion and tape of the library; components 0 and -0 in all combinations",
            "largest index, infinite where the reserve is not",
            0.0,
            no_stress,
        ),
        Room::Failure.case(
            "signs of zero and ties",
            "every criterion; components 0, a and -a in all combinations, 0 against -0",
            "difference of the exposures (1 / reserve), relative",
            1e-12,
            signs_of_zero,
        ),
        Room::Failure.case(
            "stresses of any size",
            "every criterion; 12 stresses scaled by 1e-300 to 1e280",
            "reserve times scale against the reserve unscaled, relative",
            1e-9,
            any_size,
        ),
        Room::Failure.case(
            "index at the reserve",
            "every criterion but the LaRC, whose indices jump; the same stresses",
            "difference of the largest index from 1",
            1e-9,
            at_the_reserve,
        ),
        Room::Failure.case(
            "ends of the numbers",
            "every criterion; components 0, 5e-324, 1e-310, 1e-300, 1e300 and the largest number, of either sign",
            "stresses without a reserve, or with one that their indices contradict",
            0.0,
            ends_of_the_numbers,
        ),
        Room::Failure.case(
            "stresses that are not numbers",
            "every criterion; NaN and infinity in each component, beside zeros and beside stresses",
            "stresses that are judged or scanned, or whose NaN leaves all indices below 1",
            0.0,
            no_numbers,
        ),
        Room::Failure.case(
            "strengths that are none, of a library",
            "every criterion; each strength that it needs 0, negative, NaN, infinite",
            "materials that are not refused by the name of the strength",
            0.0,
            strengths_of_a_library,
        ),
        Room::Failure.case(
            "strengths that are none, of a scene",
            "each strength 0, negative, NaN, infinite, too large for a number",
            "scenes that are not refused by the name of the strength and its line",
            0.0,
            strengths_of_a_scene,
        ),
    ]
}

struct Judge {
    name: &'static str,
    criterion: Box<dyn FailureCriterion>,
    /// Tapes that suit it, at least one.
    tapes: Vec<Material>,
}

impl Judge {
    fn indices(&self, s: &Stress6<Ply>) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.criterion.info().modes.len()];
        self.criterion.indices(s, &self.tapes[0], &mut out);
        out
    }

    /// Its reserve for a stress in its scope, as seen by [`assess`].
    fn reserve(&self, s: &Stress6<Ply>) -> Option<f64> {
        match assess(&*self.criterion, self.name, s, &self.tapes[0]) {
            Ok(assessment) => Some(assessment.reserve.factor),
            Err(AssessError::Scope(..)) => None,
            Err(other) => panic!("{}: {other}", self.name),
        }
    }
}

fn judges() -> Vec<Judge> {
    let judge = |(info, criterion): (_, Box<dyn FailureCriterion>)| {
        let fem::core::plugin::PluginInfo { name, .. } = info;
        let tapes: Vec<_> = tapes().into_iter().filter(|m| check_material(&*criterion, name, m).is_ok()).collect();
        assert!(!tapes.is_empty(), "{name}");
        Judge { name, criterion, tapes }
    };
    criteria().into_iter().map(judge).collect()
}

/// Largest of numbers of which none may be NaN.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |worst, value| if value > worst || value.is_nan() { value } else { worst })
}

/// All stresses with components out of `n`.
fn combinations<const N: usize>(n: [f64; N]) -> impl Iterator<Item = Stress6<Ply>> {
    (0..N.pow(6)).map(move |k| Stress6::new([0, 1, 2, 3, 4, 5].map(|i| n[k / N.pow(i) % N])))
}

/// Stresses of some hundred MPa along the fibres and some ten across, plane and spatial in turn.
fn ordinary() -> Vec<Stress6<Ply>> {
    let irrationals = [2_f64, 3.0, 5.0, 7.0, 11.0, 13.0].map(f64::sqrt);
    let stress = |k: u32| {
        let component = |i: usize| {
            let scale = if i == 0 { 2e9 } else { 1.5e8 };
            scale * ((f64::from(k) * irrationals[i]).fract() - 0.5)
        };
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(component);
        Stress6::new(if k.is_multiple_of(2) { [a, b, 0.0, d, 0.0, 0.0] } else { [a, b, c, d, e, f] })
    };
    (1..=12).map(stress).collect()
}

fn no_stress() -> f64 {
    largest(judges().iter().flat_map(|judge| {
        combinations([0.0, -0.0]).flat_map(move |s| {
            let reserves = judge.tapes.iter().map(move |m| judge.criterion.reserve_factor(&s, m));
            let unbounded = reserves.map(|r| if r.factor == f64::INFINITY { 0.0 } else { f64::INFINITY });
            judge.indices(&s).into_iter().chain(unbounded).collect::<Vec<_>>()
        })
    }))
}

fn signs_of_zero() -> f64 {
    largest(judges().iter().flat_map(|judge| {
        combinations([0.0, 2e7, -2e7]).filter_map(|s| {
            let exposure = |s: &Stress6<Ply>| judge.reserve(s).map(|reserve| 1.0 / reserve);
            let minus = Stress6::new(s.0.map(|c| if c == 0.0 { -0.0 } else { c }));
            match (exposure(&s), exposure(&minus)) {
                (None, None) => None,
                (Some(a), Some(b)) => Some(if a == b { 0.0 } else { (a - b).abs() / a.max(b) }),
                one => panic!("{} judges one of two equal stresses: {one:?} for {s:?}", judge.name),
            }
        })
    }))
}

fn any_size() -> f64 {
    largest(judges().iter().flat_map(|judge| {
        let judged = ordinary().into_iter().filter_map(|s| Some((s, judge.reserve(&s)?)));
        judged.flat_map(move |(s, reserve)| {
            // 1 Pa is 1e-7 to 1e-9 of these stresses.
            (-30..=28).map(move |decades| {
                let scale = 10_f64.powi(10 * decades);
                let scaled = judge.reserve(&s.scaled(scale)).unwrap_or(f64::NAN) * scale;
                if scaled == reserve { 0.0 } else { (scaled / reserve - 1.0).abs() }
            })
        })
    }))
}

fn at_the_reserve() -> f64 {
    largest(judges().iter().filter(|judge| !judge.name.starts_with("larc")).flat_map(|judge| {
        let judged = ordinary().into_iter().filter_map(|s| Some((s, judge.reserve(&s)?)));
        let bounded = judged.filter(|(_, reserve)| reserve.is_finite());
        bounded.map(|(s, reserve)| (largest(judge.indices(&s.scaled(reserve)).into_iter()) - 1.0).abs())
    }))
}

fn ends_of_the_numbers() -> f64 {
    const ENDS: [f64; 6] = [0.0, 5e-324, 1e-310, 1e-300, 1e300, f64::MAX];
    let stresses = || {
        (0..300_u32).map(|k| {
            Stress6::new([0, 1, 2, 3, 4, 5].map(|i| {
                let choice = (f64::from(k + 1) * f64::from([2, 3, 5, 7, 11, 13][i]).sqrt()).fract() * 12.0;
                let end = ENDS[choice as usize / 2];
                if (choice as usize).is_multiple_of(2) { end } else { -end }
            }))
        })
    };
    let contradictions = judges().into_iter().map(|judge| {
        let wrong = stresses().filter(|s| {
            let Some(reserve) = judge.reserve(s) else { return false };
            // An index that is not a number, from a sum out of the range of numbers, stops a run.
            let indices = judge.indices(s);
            let (fails, safe) = (indices.iter().any(|v| *v >= 1.0), indices.iter().all(|v| *v < 1.0));
            let contradicts = reserve.is_nan() || (fails && reserve > 1.0) || (safe && reserve < 1.0);
            if contradicts {
                eprintln!("{}: {s:?} has the reserve {reserve} and the indices {:?}", judge.name, judge.indices(s));
            }
            contradicts
        });
        wrong.count()
    });
    contradictions.sum::<usize>() as f64
}

fn no_numbers() -> f64 {
    let site =
        ScanSite { cell: 0, region: 0, place: PlyOrInterface::Ply(0), position: [0.0; 3], angle: 0.0, material: 0 };
    let mut judged = 0;
    for judge in judges() {
        let assessed = |s: &Stress6<Ply>| {
            !matches!(assess(&*judge.criterion, judge.name, s, &judge.tapes[0]), Err(AssessError::NotFinite(_)))
        };
        let place = match judge.criterion.info().site {
            fem::core::failure::Site::Ply => site.place,
            fem::core::failure::Site::Interface => PlyOrInterface::Interface(0),
        };
        let scanned = |s: &Stress6<Ply>| {
            let criteria = vec![(judge.name.to_owned(), judge.criterion.clone())];
            let mut scan = Scan::new(criteria, vec![ScanSite { place, ..site }], vec![judge.tapes[0].clone()]).unwrap();
            scan.sample(0.0, &[*s]).is_ok()
        };
        for bad in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for beside in [0.0, 1e6] {
                for i in 0..6 {
                    let with = |c: f64| {
                        let mut s = [beside; 6];
                        s[i] = c;
                        Stress6::new(s)
                    };
                    judged += usize::from(assessed(&with(bad)) || scanned(&with(bad)));
                    // Not all criteria look at all components.
                    let matters = judge.indices(&with(1e9)) != judge.indices(&with(-1e9))
                        || judge.indices(&with(1e9)) != judge.indices(&with(beside));
                    let passes = judge.indices(&with(bad)).iter().all(|v| *v < 1.0);
                    judged += usize::from(bad.is_nan() && matters && passes);
                }
            }
        }
    }
    judged as f64
}

fn strengths_of_a_library() -> f64 {
    let mut taken = 0;
    for judge in judges() {
        for which in judge.criterion.info().strengths {
            for bad in [0.0, -0.0, -1e6, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let tape = judge.tapes[0].clone();
                let tape = Material { strengths: tape.strengths.with(*which, bad), ..tape };
                let refused = assess(&*judge.criterion, judge.name, &Stress6::new([1e6; 6]), &tape);
                let by_name = matches!(&refused, Err(AssessError::Material(e)) if e.to_string().contains(which.name()));
                taken += usize::from(!by_name);
            }
        }
    }
    taken as f64
}

fn strengths_of_a_scene() -> f64 {
    let mut taken = 0;
    for which in Strength::ALL {
        for bad in
            ["\"0 MPa\"", "\"-0 MPa\"", "\"-1 MPa\"", "\"nan MPa\"", "\"inf MPa\"", "\"1e303 MPa\"", "nan", "inf"]
        {
            let name = which.name();
            let text = format!(
                "title = \"t\"\nmesh = {{ file = \"plate.msh\", unit = \"mm\" }}\n[materials.tape]\n\
                 library = \"AS4/3502\"\n{name} = {bad}\n"
            );
            let error = scene::parse(&text, Path::new("scene.toml")).unwrap_err();
            // What else this scene lacks is said beside it.
            let by_name =
                |error: &SceneError| error.to_string().contains(name) && error.location() == Some(("scene.toml", 5));
            taken += usize::from(!error.mistakes().any(by_name));
        }
    }
    taken as f64
}
