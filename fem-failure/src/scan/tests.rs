use super::*;
use crate::{HashinReport, Octahedral, TsaiWu};
use fem_core::failure::{CriterionInfo, StressRange};
use fem_core::material::{Elastic, Strength, Strengths, Toughnesses};

fn material(name: &str, strengths: &[(Strength, f64)]) -> Material {
    Material {
        name: name.into(),
        elastic: Elastic::isotropic(1.0, 0.3),
        density: None,
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
        strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
    }
}

fn ply() -> Material {
    use Strength::{S12, S23, Xc, Xt, Yt};
    material("ply", &[(Xt, 100.0), (Xc, 80.0), (Yt, 10.0), (S12, 10.0), (S23, 10.0)])
}

fn resin(shear: f64) -> Material {
    material("resin", &[(Strength::S12, shear)])
}

fn site(cell: u32, place: PlyOrInterface, material: u16) -> ScanSite {
    ScanSite { cell, region: 0, place, position: [f64::from(cell), 0.0, 0.0], angle: 0.1, material }
}

fn octahedral(sites: Vec<ScanSite>, materials: Vec<Material>) -> Scan {
    Scan::new(vec![("octahedral".into(), Box::new(Octahedral))], sites, materials).unwrap()
}

fn shear(s23: f64) -> Stress6<Ply> {
    Stress6::new([0.0, 0.0, 0.0, 0.0, s23, 0.0])
}

/// Index equal to σ11.
#[derive(Debug, Clone)]
struct Plain;
impl FailureCriterion for Plain {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo =
            CriterionInfo { site: Site::Ply, modes: &["m"], strengths: &[], invariant_about_fibre: true };
        &INFO
    }
    fn indices(&self, s: &Stress6<Ply>, _: &Material, out: &mut [f64]) {
        out[0] = s.s11();
    }
}

fn plain(cells: u32) -> Scan {
    let sites = (0..cells).map(|c| site(c, PlyOrInterface::Ply(0), 0)).collect();
    Scan::new(vec![("plain".into(), Box::new(Plain))], sites, vec![ply()]).unwrap()
}

fn along(v: f64) -> Stress6<Ply> {
    Stress6::new([v, 0.0, 0.0, 0.0, 0.0, 0.0])
}

#[test]
fn the_crossing_is_interpolated_at_its_own_site() {
    let mut scan = plain(2);
    scan.sample(0.0, &[along(0.0), along(0.9)]).unwrap();
    // Site 0 crosses at 2 · 1/4 = 0.5, site 1 at 2 · 0.1/1.1 = 0.18.
    scan.sample(2.0, &[along(4.0), along(2.0)]).unwrap();
    scan.sample(3.0, &[along(9.0), along(0.0)]).unwrap();
    let events = scan.events();
    assert_eq!(events.len(), 1);
    assert_eq!((events[0].cell, events[0].index), (1, 2.0));
    assert!((events[0].time - 2.0 * (0.1 / 1.1)).abs() < 1e-15);
    assert_eq!((events[0].position, events[0].angle), ([1.0, 0.0, 0.0], 0.1));
    assert!((events[0].stress.s11() - 1.0).abs() < 1e-15, "the index is the stress: {events:?}");
    let peak = &scan.peaks()[0];
    assert_eq!((peak.index, peak.time, peak.site.cell), (9.0, 3.0, 0));
    assert_eq!(scan.evaluations(), 6);
    assert_eq!(scan.maxima(0).map(|(s, m, _)| (s.cell, m[0])).collect::<Vec<_>>(), [(0, 9.0), (1, 2.0)]);
    // Every site has its own time, and going below 1 and above again does not change it.
    scan.sample(4.0, &[along(0.0), along(8.0)]).unwrap();
    let reached: Vec<f64> = scan.maxima(0).map(|(_, _, reached)| reached[0]).collect();
    assert!((reached[0] - 0.5).abs() < 1e-15 && (reached[1] - 2.0 * (0.1 / 1.1)).abs() < 1e-15, "{reached:?}");
    assert_eq!(plain(1).maxima(0).map(|(_, _, reached)| reached[0]).collect::<Vec<_>>(), [f64::INFINITY]);
}

#[test]
fn a_site_that_starts_broken_fails_at_the_first_sample() {
    let mut scan = plain(1);
    scan.sample(0.25, &[along(1.0)]).unwrap();
    scan.sample(0.5, &[along(1.5)]).unwrap();
    assert_eq!((scan.events()[0].time, scan.events()[0].stress), (0.25, along(1.0)));
    let mut scan = plain(1);
    scan.sample(0.25, &[along(1.0 - f64::EPSILON)]).unwrap();
    assert!(scan.events().is_empty());
    assert!((scan.peaks()[0].index - 1.0).abs() < 1e-15);
}

#[test]
fn ties_go_to_the_larger_index_then_to_the_first_site() {
    let mut scan = plain(4);
    scan.sample(0.0, &[along(0.5), along(0.0), along(0.5), along(0.0)]).unwrap();
    // All cross half way; sites 1 and 3 end higher.
    scan.sample(1.0, &[along(1.5), along(2.0), along(1.5), along(2.0)]).unwrap();
    let events = scan.events();
    assert_eq!((events.len(), events[0].cell, events[0].time), (1, 1, 0.5));
    assert_eq!(scan.peaks()[0].site.cell, 1);
}

#[test]
fn each_place_and_mode_has_its_own_event() {
    let sites = vec![
        site(0, PlyOrInterface::Interface(0), 1),
        site(0, PlyOrInterface::Ply(1), 0),
        site(1, PlyOrInterface::Ply(0), 0),
        site(1, PlyOrInterface::Interface(0), 2),
    ];
    let criteria: Vec<(String, Box<dyn FailureCriterion>)> =
        vec![("h".into(), Box::new(HashinReport::default())), ("o".into(), Box::new(Octahedral))];
    let mut scan = Scan::new(criteria, sites, vec![ply(), resin(20.0), resin(10.0)]).unwrap();
    let zero = Stress6::new([0.0; 6]);
    scan.sample(0.0, &[zero; 4]).unwrap();
    let tension = Stress6::new([0.0, 20.0, 0.0, 0.0, 0.0, 0.0]);
    let compression = Stress6::new([-160.0, -40.0, 0.0, 0.0, 0.0, 0.0]);
    scan.sample(1.0, &[shear(25.0), tension, compression, shear(25.0)]).unwrap();
    let got: Vec<_> = scan.events().into_iter().map(|e| (e.time, e.criterion, e.mode, e.cell, e.place)).collect();
    // Indices 4, 4, 4 and 6.25 (site 3; site 0 has 1.5625) grow from 0 in one second.
    let want = [
        (0.16, "o", "interface shear", 1, PlyOrInterface::Interface(0)),
        (0.25, "h", "fibre compression", 1, PlyOrInterface::Ply(0)),
        (0.25, "h", "matrix tension", 0, PlyOrInterface::Ply(1)),
        (0.25, "h", "matrix compression", 1, PlyOrInterface::Ply(0)),
    ];
    assert_eq!(got, want.map(|(t, c, m, cell, p)| (t, c.to_owned(), m, cell, p)));
    assert_eq!(first_per_mode(&scan.events()).len(), 4);
    // Modes that did not fail have their peak too.
    assert!(scan.peaks().iter().any(|p| p.mode == "fibre tension" && p.index < 1.0));
    assert_eq!(scan.evaluations(), 8);
}

#[test]
fn a_probe_reads_the_indices_of_its_site() {
    let sites = vec![
        site(0, PlyOrInterface::Interface(0), 1),
        site(0, PlyOrInterface::Ply(0), 0),
        site(1, PlyOrInterface::Ply(0), 0),
    ];
    let criteria: Vec<(String, Box<dyn FailureCriterion>)> =
        vec![("p".into(), Box::new(Plain)), ("o".into(), Box::new(Octahedral))];
    let mut scan = Scan::new(criteria, sites, vec![ply(), resin(10.0)]).unwrap();
    assert_eq!((scan.probe(0, 0), scan.probe(1, 1), scan.probe(2, 0), scan.probe(0, 3)), (None, None, None, None));
    let probes = [scan.probe(0, 2).unwrap(), scan.probe(1, 0).unwrap()];
    assert_eq!(probes.map(|p| scan.read(p)[0]), [0.0, 0.0]);
    for (t, s) in [(0.0, 0.5), (1.0, 0.75)] {
        scan.sample(t, &[shear(10.0 * s), along(9.0), along(s)]).unwrap();
        assert_eq!(probes.map(|p| scan.read(p)[0]), [s, s * s]);
    }
    assert!(scan.sample(2.0, &[shear(f64::NAN), along(1.0), along(1.0)]).is_err());
    assert_eq!(probes.map(|p| scan.read(p)[0]), [0.75, 0.5625], "a refused sample leaves no trace");
}

#[test]
fn sites_of_mixed_materials_keep_their_own_strength() {
    let n = 50;
    let sites: Vec<_> = (0..n).map(|c| site(c, PlyOrInterface::Interface(0), (c % 2) as u16)).collect();
    let mut scan = octahedral(sites, vec![resin(1.0), resin(2.0)]);
    let stress: Vec<_> = (0..n).map(|c| shear(f64::from(c))).collect();
    scan.sample(0.0, &stress).unwrap();
    for (site, maxima, _) in scan.maxima(0) {
        let strength = if site.cell % 2 == 0 { 1.0 } else { 2.0 };
        assert_eq!(maxima[0], (f64::from(site.cell) / strength).powi(2));
    }
    assert_eq!(scan.maxima(0).count(), n as usize);
}

#[test]
fn bad_samples_are_refused_and_leave_the_scan_as_it_was() {
    let mut scan = plain(2);
    scan.sample(0.0, &[along(0.0), along(0.5)]).unwrap();
    let before = format!("{:?}", (scan.events(), scan.peaks(), scan.evaluations()));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = scan.sample(1.0, &[along(2.0), Stress6::new([0.0, 0.0, 0.0, 0.0, bad, 0.0])]).unwrap_err();
        let text = error.to_string();
        let there = |site: &ScanSite| (site.cell, site.place) == (1, PlyOrInterface::Ply(0));
        assert!(matches!(&error, ScanError::Stress { time: 1.0, site, .. } if there(site)), "{text}");
        assert!(
            text.contains("in ply 1 from the bottom at (") && text.contains("at 1 s") && text.contains("σ23 "),
            "{text}"
        );
        assert!(scan.sample(bad, &[along(2.0), along(2.0)]).is_err());
    }
    assert!(matches!(scan.sample(0.0, &[along(2.0); 2]), Err(ScanError::Time { .. })));
    assert!(matches!(scan.sample(1.0, &[along(2.0)]), Err(ScanError::Length { got: 1, want: 2 })));
    assert_eq!(format!("{:?}", (scan.events(), scan.peaks(), scan.evaluations())), before);
    scan.sample(1.0, &[along(0.0), along(1.5)]).unwrap();
    assert_eq!(scan.events()[0].time, 0.5);
}

#[test]
fn an_index_that_is_no_number_is_an_error() {
    #[derive(Debug, Clone)]
    struct Forgetful;
    impl FailureCriterion for Forgetful {
        fn info(&self) -> &CriterionInfo {
            const INFO: CriterionInfo =
                CriterionInfo { site: Site::Ply, modes: &["a", "b"], strengths: &[], invariant_about_fibre: true };
            &INFO
        }
        fn indices(&self, s: &Stress6<Ply>, _: &Material, out: &mut [f64]) {
            out[0] = 0.0;
            if s.s11() < 1.0 {
                out[1] = 0.0;
            }
        }
    }
    let sites = vec![site(0, PlyOrInterface::Ply(0), 0), site(7, PlyOrInterface::Ply(3), 0)];
    let mut scan = Scan::new(vec![("f".into(), Box::new(Forgetful))], sites, vec![ply()]).unwrap();
    scan.sample(0.0, &[along(0.0), along(0.5)]).unwrap();
    let error = scan.sample(1.0, &[along(0.0), along(1.5)]).unwrap_err();
    let there = |site: &ScanSite| (site.cell, site.place) == (7, PlyOrInterface::Ply(3));
    assert!(matches!(&error, ScanError::Index { mode: "b", site, .. } if there(site)), "{error}");
    // An overflow of the stress itself is caught as well: ∞ − ∞.
    let mut scan = octahedral(vec![site(0, PlyOrInterface::Interface(2), 0)], vec![resin(1.0)]);
    assert!(scan.sample(0.0, &[Stress6::new([1e308, -1e308, 0.0, 0.0, 0.0, 0.0])]).is_ok());
    assert_eq!(scan.peaks()[0].index, f64::INFINITY);
}

#[test]
fn missing_constants_are_named_before_the_march() {
    let sites = vec![site(3, PlyOrInterface::Ply(0), 0), site(4, PlyOrInterface::Interface(1), 1)];
    let criteria = || -> Vec<(String, Box<dyn FailureCriterion>)> { vec![("oct".into(), Box::new(Octahedral))] };
    // The ply has no business with the interface's criterion.
    assert!(Scan::new(criteria(), sites.clone(), vec![material("bare", &[]), resin(1.0)]).is_ok());
    let error = Scan::new(criteria(), sites.clone(), vec![ply(), material("bare", &[])]).unwrap_err();
    assert!(matches!(error, ScanError::Material { cell: 4, place: PlyOrInterface::Interface(1), .. }));
    let source = std::error::Error::source(&error).unwrap().to_string();
    assert!(source.contains("`bare`") && source.contains("`oct`") && source.contains("S12"), "{source}");
    assert!(matches!(
        Scan::new(criteria(), sites, vec![ply()]),
        Err(ScanError::NoSuchMaterial { material: 1, given: 1, .. })
    ));
}

/// Stresses of sites over a batch of samples, and ranges that hold them closely.
struct Batch<'a>(&'a [Vec<Stress6<Ply>>]);

impl Samples for Batch<'_> {
    fn ranges(&mut self, site: usize, out: &mut [StressRange]) {
        for (window, out) in windows(self.0.len()).zip(out) {
            let states = self.0[window].iter().map(|sample| sample[site].0);
            let [low, high] = [f64::min, f64::max].map(|f: fn(f64, f64) -> f64| {
                let extreme = |a: [f64; 6], b: [f64; 6]| std::array::from_fn(|i| f(a[i], b[i]));
                Stress6::new(states.clone().reduce(extreme).unwrap())
            });
            *out = StressRange { low, high };
        }
    }

    fn stresses(&mut self, site: usize, window: usize, out: &mut [Stress6<Ply>]) {
        let window = windows(self.0.len()).nth(window).unwrap();
        self.0[window].iter().zip(out).for_each(|(sample, out)| *out = sample[site]);
    }
}

#[test]
fn a_survey_finds_what_a_scan_of_all_samples_finds() {
    let places = [PlyOrInterface::Ply(0), PlyOrInterface::Interface(0), PlyOrInterface::Ply(1)];
    let sites: Vec<_> = (0..40).flat_map(|cell| places.map(|p| site(cell, p, u16::from(p == places[1])))).collect();
    let (mut tape, resin) = (ply(), resin(9.0));
    tape.strengths = tape.strengths.with(Strength::Yc, 30.0);
    let mut failed = 0;
    // `Plain` cannot say what it does not exceed.
    for (size, with_plain) in [(0.1, true), (0.4, false), (1.0, false), (3.0, true), (20.0, false)] {
        // Indices of Tsai and Wu's may be below zero.
        let mut criteria: Vec<(String, Box<dyn FailureCriterion>)> = vec![
            ("h".into(), Box::new(HashinReport::default())),
            ("o".into(), Box::new(Octahedral)),
            ("t".into(), Box::new(TsaiWu::default())),
        ];
        if with_plain {
            criteria.push(("p".into(), Box::new(Plain)));
        }
        let stress = |sample: usize, site: usize| {
            let component = |i: usize| {
                let (t, phase) = (sample as f64 / 100.0, (site * 7 + i * 3) as f64);
                let near = 1.0 / (1.0 + (site / 3) as f64);
                size * t * near * 6.0 * ((4.0 + 0.1 * phase) * t + phase).sin()
            };
            Stress6::new(std::array::from_fn(component))
        };
        let samples: Vec<Vec<_>> = (0..100).map(|s| (0..sites.len()).map(|k| stress(s, k)).collect()).collect();
        let times: Vec<f64> = (0..samples.len()).map(|s| s as f64 * 1e-5).collect();
        let scan = Scan::new(criteria, sites.clone(), vec![tape.clone(), resin.clone()]).unwrap();
        let mut all = scan.clone();
        times.iter().zip(&samples).for_each(|(t, s)| all.sample(*t, s).unwrap());
        for (batch, wanted) in
            [100, 37, 2].into_iter().flat_map(|batch| [(batch, Wanted::Extremes), (batch, Wanted::EverySite)])
        {
            let mut some = scan.clone();
            let mut end = 0;
            while end < times.len() {
                let start = end.saturating_sub(1);
                end = (start + batch).min(times.len());
                some.survey(&times[start..end], &mut Batch(&samples[start..end]), wanted).unwrap();
            }
            assert_eq!(some.events(), all.events());
            assert_eq!(some.peaks(), all.peaks());
            if wanted == Wanted::EverySite {
                let maxima = |scan: &Scan| {
                    let of =
                        |k: usize| scan.maxima(k).map(|(s, m, t)| (*s, m.to_vec(), t.to_vec())).collect::<Vec<_>>();
                    (0..3 + usize::from(with_plain)).map(of).collect::<Vec<_>>()
                };
                assert_eq!(maxima(&some), maxima(&all));
            }
            failed += usize::from(!some.events().is_empty());
            if batch == 100 && !with_plain && wanted == Wanted::Extremes {
                assert!(some.evaluations() < all.evaluations() / 2, "{} {size}", some.evaluations());
            }
        }
    }
    assert!((12..=24).contains(&failed), "some sizes fail, some do not: {failed}");
}

/// Under many strengths, one after the other, whatever was likely before.
#[test]
fn hulls_find_what_a_scan_of_all_samples_finds() {
    let places = [PlyOrInterface::Ply(0), PlyOrInterface::Interface(0), PlyOrInterface::Ply(1)];
    let sites: Vec<_> = (0..90).flat_map(|cell| places.map(|p| site(cell, p, u16::from(p == places[1])))).collect();
    let stress = |sample: usize, site: usize| {
        let component = |i: usize| {
            let (t, phase) = (sample as f64 / 100.0, (site * 7 + i * 3) as f64);
            t * 6.0 / (1.0 + (site / 3) as f64) * ((4.0 + 0.1 * phase) * t + phase).sin()
        };
        Stress6::new(std::array::from_fn(component))
    };
    let samples: Vec<Vec<_>> = (0..100).map(|s| (0..sites.len()).map(|k| stress(s, k)).collect()).collect();
    let times: Vec<f64> = (0..samples.len()).map(|s| s as f64 * 1e-5).collect();
    let all: Vec<_> = windows(samples.len()).collect();
    let ranges = |site: usize, out: &mut [StressRange]| Batch(&samples).ranges(site, out);
    let unknown = |m: Material| Material { strengths: Strengths::default(), ..m };
    let known = [vec![ply(), resin(1.0)], vec![unknown(ply()), unknown(resin(1.0))]];
    let hulls = known.each_ref().map(|m| Hulls::new(sites.clone(), times.clone(), all.clone(), m, ranges).unwrap());
    let stresses = |site: usize, window: usize, out: &mut [Stress6<Ply>]| Batch(&samples).stresses(site, window, out);
    let mut failed = [0; 2];
    for round in 0..40 {
        // From what fails at once to what never does, and back.
        let factor = 0.05 * f64::from(1 + (round * 7) % 40).powi(2);
        let mut criteria: Vec<(String, Box<dyn FailureCriterion>)> =
            vec![("h".into(), Box::new(HashinReport::default())), ("o".into(), Box::new(Octahedral))];
        if round % 10 == 9 {
            criteria.push(("p".into(), Box::new(Plain)));
        }
        let mut tape = ply();
        for which in [Strength::Xt, Strength::Xc, Strength::Yt, Strength::S12, Strength::S23] {
            let own = tape.strengths.get(which).unwrap();
            tape.strengths =
                tape.strengths.with(which, own * if which == Strength::S23 { 0.2 + factor } else { factor });
        }
        let materials = vec![tape, resin(9.0 * factor)];
        let found = hulls[round as usize % 2].judge(&criteria, &materials, &stresses).unwrap();
        let mut scan = Scan::new(criteria.clone(), sites.clone(), materials).unwrap();
        times.iter().zip(&samples).for_each(|(t, s)| scan.sample(*t, s).unwrap());
        let firsts: Vec<_> = first_per_mode(&scan.events()).into_iter().cloned().collect();
        assert_eq!(found.firsts, firsts, "{round}");
        let largest: Vec<f64> = scan.peaks().iter().map(|peak| peak.index).collect();
        assert_eq!(found.largest.concat(), largest, "{round}");
        failed[usize::from(firsts.is_empty())] += 1;
    }
    assert!(failed.iter().all(|count| *count > 5), "some fail, some do not: {failed:?}");
    let large = |_: usize, out: &mut [StressRange]| out.iter_mut().for_each(|range| range.high.0[0] = 1e100);
    let nowhere = Hulls::new(sites, times, all, &known[0], large);
    assert!(nowhere.is_none());
}

#[test]
fn a_survey_refuses_what_a_scan_refuses() {
    let mut scan = plain(1);
    let sample = |s: f64| vec![along(s)];
    assert!(matches!(
        scan.survey(&[0.0, 0.0], &mut Batch(&[sample(0.0), sample(1.0)]), Wanted::Extremes),
        Err(ScanError::Time { .. })
    ));
    assert!(scan.survey(&[f64::NAN], &mut Batch(&[sample(0.0)]), Wanted::Extremes).is_err());
    scan.survey(&[0.0, 1.0], &mut Batch(&[sample(0.0), sample(0.5)]), Wanted::Extremes).unwrap();
    assert!(
        scan.survey(&[2.0, 3.0], &mut Batch(&[sample(0.0), sample(1.0)]), Wanted::Extremes).is_err(),
        "a sample is left out"
    );
    let bad = [sample(0.5), sample(f64::INFINITY)];
    assert!(matches!(scan.survey(&[1.0, 2.0], &mut Batch(&bad), Wanted::Extremes), Err(ScanError::Stress { .. })));
}
