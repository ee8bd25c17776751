//! Stresses from the coefficients of strains are those from their means.

use crate::support::{plate, root};
use fem::core::element::{Cell, Element, ElementError, ElementInfo, Part, Point, Scratch, form};
use fem::core::recovery::{PlyHeights, Recovery};
use fem::core::window::{Windows, own};
use fem::io::scene;
use fem::{Model, Registry};
use std::fs;

/// An element that keeps its coefficients to itself.
#[derive(Debug, Clone)]
struct Reserved<'a> {
    own: &'a dyn Element,
    triangular: Option<Box<Self>>,
}

impl<'a> Reserved<'a> {
    fn new(own: &'a dyn Element) -> Self {
        Self { own, triangular: own.triangular().map(|form| Box::new(Self::new(form))) }
    }
}

impl Element for Reserved<'_> {
    fn info(&self) -> &ElementInfo {
        self.own.info()
    }

    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.own.strain_operator(cell, slice, xi, b)
    }

    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.own.shape(cell, xi, n)
    }

    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        self.own.mean_strains(cell, parts, plane, scratch, b)
    }

    fn triangular(&self) -> Option<&dyn Element> {
        self.triangular.as_deref().map(|form| form as &dyn Element)
    }
}

#[test]
fn coefficients_and_means_of_strains_have_one_stress() {
    const FIELDS: usize = 3;
    let case = plate()
        .text(
            "title = \"mixed\"\nmesh = { file = \"plate.msh\", unit = \"mm\" }\nmaterials.tape = { library = \"AS4/3502\" }\n\
             materials.resin = { library = \"3502 resin\" }\n\
             laminate = { plies = \"[0/45/-45/90]s\", material = \"tape\", ply_thickness = \"0.13208 mm\", layers = [3, 5], \
             interface = \"resin\" }\n\
             impactor = { mass = \"100 g\", velocity = \"2 m/s\", at = { x = \"30 mm\", y = \"20 mm\" } }\n\
             contact = { law = \"hertz\", k = \"1.07e5 N/mm^1.5\" }\nmarch = { step = \"1 us\", end = \"100 us\" }\n\
             support = [{ group = \"rim\", at = \"all\", fix = [\"U10\", \"U20\", \"U30\"] }]\n\
             failure = { criteria = [\"puck\"] }\n",
        )
        .mesh_bytes(fs::read(root().join("tests/data/meshes/mixed.msh")).unwrap());
    let written = scene::read(&case.folder().join(case.write())).unwrap();
    let model = Model::new(&written, &Registry::standard()).unwrap();
    let Model { plate, element, .. } = &model;
    let quads = 0..plate.plane.quads.len();
    let shapes: Vec<bool> = quads
        .clone()
        .map(|quad| form(&**element, plate.plane.quads[quad].domain()).cubic_strains().is_some())
        .collect();
    assert!(shapes.iter().all(|cubic| *cubic) && quads.len() > 20);
    let reserved = Reserved::new(&**element);
    assert!(reserved.cubic_strains().is_none());
    let windows = Windows::new(&plate.plane, (2.54e-3, 0.3), |quad| plate.region(quad));
    let squares = quads.clone().map(|quad| windows.of_cell(quad));
    let means: Vec<_> = squares.chain(quads.map(|quad| own(&plate.plane, quad))).collect();
    for heights in [PlyHeights::Mean, PlyHeights::Faces] {
        let recovery = Recovery::new(plate, (&model.laminates, heights), &model.materials, model.interface, &means);
        let u: Vec<f64> = (0..FIELDS * plate.ndof()).map(|i| 1e-6 * (i as f64 * 0.7).sin()).collect();
        let stresses = |element: &dyn Element| {
            let mut out = vec![f64::NAN; 6 * recovery.sites() * FIELDS];
            recovery.stresses(plate, element, &u, FIELDS, &mut out).unwrap();
            out
        };
        let (by_coefficients, by_means) = (stresses(&**element), stresses(&reserved));
        let largest = by_means.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
        let apart = by_means.iter().zip(&by_coefficients).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(largest > 1e3 && apart < 1e-12 * largest, "{apart:e} of {largest:e}");
    }
}
