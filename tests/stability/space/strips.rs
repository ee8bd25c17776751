//! Cylindrical bending against exact elasticity: slender and thick, stiff and soft, thin beside thick.

use super::exact::{Layer, bending};
use crate::case::{Case, Room};
use crate::plates::{HEX, SECTION, SHELL, SOLIDS, probe, solve, worst};
use crate::scene::{Plate, Side, reference};
use fem::core::material::Elastic;
use fem::{Error, output};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// A strip of plies, each a layer of cells.
#[derive(Debug, Clone)]
struct Strip {
    /// Thickness, mm, material, MPa, and whether its fibres run across.
    plies: Vec<(f64, Elastic, bool)>,
    /// Span over thickness.
    slenderness: f64,
    /// Cells of half the span.
    cells: usize,
}

impl Strip {
    fn height(&self) -> f64 {
        self.plies.iter().map(|p| p.0).sum()
    }

    fn span(&self) -> f64 {
        self.slenderness * self.height()
    }

    /// Half of it, as cells as wide as long.
    fn text(&self, element: &str) -> String {
        let (half, wave) = (0.5 * self.span(), PI / self.span());
        let names: Vec<String> =
            self.plies.iter().enumerate().map(|(i, p)| format!("{}{{p{i}}}", if p.2 { 90 } else { 0 })).collect();
        let first = constants(&self.plies[0].1);
        let others: String =
            self.plies.iter().enumerate().map(|(i, p)| format!("[materials.m{i}]\n{}", constants(&p.1))).collect();
        let across = if element == SECTION { Side::Free } else { Side::Symmetric };
        let mut plate = Plate::new(
            &format!("{first}{others}"),
            &format!("[{}]", names.join("/")),
            1.0,
            if element == SHELL { vec![self.plies.len()] } else { vec![1; self.plies.len()] },
        )
        .element(element)
        .rectangle([half, half / self.cells as f64], [self.cells, 1])
        .sides([Side::Supported, Side::Symmetric, across, across])
        .pressure(&format!("-sin({wave}*x)"));
        for (i, p) in self.plies.iter().enumerate() {
            let _ = writeln!(plate.more, "[laminate.ply.p{i}]\nmaterial = 'm{i}'\nthickness = '{} mm'", p.0);
        }
        probe(plate, [half, 0.0]).text("static")
    }

    fn errors(&self, element: &str) -> [f64; 2] {
        self.errors_and_warnings(element).unwrap().0
    }

    /// Largest error of w and of σx at the faces of plies, each relative to the largest; of a shell, of w in the middle.
    fn errors_and_warnings(&self, element: &str) -> Result<([f64; 2], String), Error> {
        let (model, solution) = solve(&self.text(element))?;
        let warnings = output::statics::StaticSummary::new(&model, &solution).warnings.join("; ");
        let points = &solution.profiles[0];
        let layers: Vec<Layer> = self.plies.iter().map(|(t, e, turned)| Layer::new(*t, e, *turned)).collect();
        let exact = bending(&layers, self.span());
        let found = |k: usize, i: usize| {
            let p = &points[i];
            if k == 0 { p.displacement[2] * 1e3 } else { p.global.0[0] * 1e-6 }
        };
        let at = |k: usize| -> f64 {
            let exact: Vec<f64> = exact.iter().flatten().map(|s| s[k]).collect();
            let most = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if element == SHELL && k == 0 {
                let middle = exact[exact.len() / 2];
                return (found(0, 0) / middle - 1.0).abs();
            }
            let off = exact.iter().enumerate().map(|(i, x)| (found(k, i) - x).abs());
            worst(off) / most
        };
        Ok(([at(0), at(1)], warnings))
    }
}

fn constants(e: &Elastic) -> String {
    let Elastic { e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 } = e;
    format!(
        "e1 = '{e1} MPa'\ne2 = '{e2} MPa'\ne3 = '{e3} MPa'\nnu12 = {nu12}\nnu13 = {nu13}\nnu23 = {nu23}\n\
         g12 = '{g12} MPa'\ng13 = '{g13} MPa'\ng23 = '{g23} MPa'\ndensity = '1 g/cm^3'\n"
    )
}

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Space.case(
            "slender and stout strips of solids",
            "span over height from 2 to 1000; every solid and the section, 12 cells",
            "error of the deflection, against exact elasticity",
            1e-2,
            slender_solids,
        ),
        Room::Space.case(
            "slender strips of shells",
            "span over height from 10 to 1e5; 12 cells",
            "error of the deflection, against exact elasticity",
            1e-2,
            slender_shells,
        ),
        Room::Space.case(
            "strips too slender for solids",
            "span over height from 1e3 to 1e5, 4 to 24 cells; every solid and the section",
            "deflections more than 1 % off without a refusal or a warning",
            0.0,
            too_slender,
        ),
        Room::Space.case(
            "thin plies beside thick ones, stiff beside soft",
            "thickness 1 to 1:1000, modulus 1 to 1:1e4 of faces and core, span over height 4 to 100; every solid and the section",
            "error of the deflection and of the stress along the strip, against exact elasticity",
            2e-2,
            sandwich,
        ),
        Room::Space.case(
            "anisotropic plies",
            "E1/E3 from 1 to 200, cross-ply of three, span over height 4 to 100; every solid and the section, 2 layers a ply",
            "error of the deflection, against exact elasticity",
            2e-2,
            anisotropic,
        ),
        Room::Space.case(
            "nearly incompressible: deflection",
            "Poisson's ratio from 0 to 0.4999, span over height 4 to 100; every element",
            "error of the deflection, against exact elasticity",
            2e-2,
            incompressible_deflection,
        ),
        Room::Space.case(
            "nearly incompressible: stress",
            "the same, solids and the section; a ratio above 0.45 is warned of and not judged: its stresses are far off",
            "error of the stress along the strip at the faces where no warning is given, against exact elasticity",
            5e-2,
            incompressible_stress,
        ),
    ]
}

const SOLID: [&str; 5] = [SOLIDS[0], SOLIDS[1], SOLIDS[2], HEX, SECTION];

fn halves(material: Elastic) -> Vec<(f64, Elastic, bool)> {
    vec![(0.5, material, false); 2]
}

fn steel() -> Elastic {
    Elastic::isotropic(2e5, 0.3)
}

fn slender_solids() -> f64 {
    let strips =
        [2.0, 4.0, 10.0, 100.0, 1e3].map(|slenderness| Strip { plies: halves(steel()), slenderness, cells: 12 });
    worst(strips.iter().flat_map(|strip| SOLID.map(|element| strip.errors(element)[0])))
}

fn slender_shells() -> f64 {
    let strips =
        [10.0, 100.0, 1e3, 1e4, 1e5].map(|slenderness| Strip { plies: halves(steel()), slenderness, cells: 12 });
    worst(strips.iter().map(|strip| strip.errors(SHELL)[0]))
}

fn too_slender() -> f64 {
    let mut silent = 0;
    for slenderness in [1e3, 3e3, 1e4, 3e4, 1e5] {
        for cells in [4, 8, 16, 24] {
            let strip = Strip { plies: halves(steel()), slenderness, cells };
            silent += SOLID
                .iter()
                .filter(|element| match strip.errors_and_warnings(element) {
                    Ok((errors, warnings)) => {
                        !(errors[0] <= 1e-2 || warnings.contains("bend too stiffly") || warnings.contains("condition"))
                    }
                    Err(Error::IllConditioned { .. } | Error::Solve(_)) => false,
                    Err(other) => panic!("{other}"),
                })
                .count();
        }
    }
    silent as f64
}

fn sandwich() -> f64 {
    let table = &reference("pagano_cyl_0_90_0_pag25.csv")[0];
    let ply = Elastic { e1: 25.0, e2: 1.0, e3: 1.0, nu12: 0.25, nu13: 0.25, nu23: 0.25, g12: 0.5, g13: 0.5, g23: 0.2 };
    let three = [false, true, false].map(|turned| Layer::new(1.0 / 3.0, &ply, turned));
    let [w, stress] = bending(&three, 4.0)[0][0];
    assert!((w / table["W"] - 1.0).abs() < 1e-9 && (stress / table["sx"] - 1.0).abs() < 1e-9, "{w} {stress}");

    let mut all = Vec::new();
    for softer in [1.0, 1e-2, 1e-4] {
        for thinner in [1.0, 1e-2, 1e-3] {
            for slenderness in [4.0, 10.0, 100.0] {
                let core = Elastic::isotropic(2e5 * softer, 0.3);
                let plies = vec![(thinner, steel(), false), (1.0, core, false), (thinner, steel(), false)];
                let strip = Strip { plies, slenderness, cells: 12 };
                all.extend(SOLID.iter().flat_map(|element| strip.errors(element)));
            }
        }
    }
    worst(all)
}

fn anisotropic() -> f64 {
    let mut all = Vec::new();
    for e1 in [1.0, 25.0, 200.0] {
        let ply = Elastic { e1, e2: 1.0, e3: 1.0, nu12: 0.25, nu13: 0.25, nu23: 0.25, g12: 0.5, g13: 0.5, g23: 0.2 };
        let plies: Vec<_> = [false, false, true, true, false, false].map(|turned| (0.5, ply, turned)).to_vec();
        for slenderness in [4.0, 10.0, 100.0] {
            let strip = Strip { plies: plies.clone(), slenderness, cells: 12 };
            all.extend(SOLID.iter().map(|element| strip.errors(element)[0]));
        }
    }
    worst(all)
}

fn nearly_incompressible() -> impl Iterator<Item = Strip> {
    let each = |nu| [4.0, 10.0, 100.0].map(|slenderness| (nu, slenderness));
    let all = [0.0, 0.3, 0.4, 0.44, 0.49, 0.499, 0.4999].into_iter().flat_map(each);
    all.map(|(nu, slenderness)| Strip { plies: halves(Elastic::isotropic(2e5, nu)), slenderness, cells: 12 })
}

fn incompressible_deflection() -> f64 {
    worst(nearly_incompressible().flat_map(|strip| {
        // A shell has no stretch of its thickness, which counts in stout strips.
        let shell = (strip.slenderness >= 10.0).then(|| strip.errors(SHELL)[0]);
        SOLID.map(|element| strip.errors(element)[0]).into_iter().chain(shell)
    }))
}

fn incompressible_stress() -> f64 {
    let unwarned = |strip: &Strip, element: &&str| {
        let (errors, warnings) = strip.errors_and_warnings(element).unwrap();
        (!warnings.contains("incompressible")).then_some(errors[1])
    };
    worst(nearly_incompressible().flat_map(|strip| SOLID.into_iter().filter_map(move |e| unwarned(&strip, &e))))
}
