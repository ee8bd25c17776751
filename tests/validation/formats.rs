//! One plate from files of every format: the same answer to the bit.

use super::scene::isotropic;
use fem::analyses::statics;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

/// Displacements of a plate that is clamped on one side, under a pressure.
fn displacements(file: &str, clamped: &str) -> Vec<f64> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/other-meshes");
    let text = format!(
        "title = 'plate'\nanalysis = 'static'\nmesh = {{ file = '{folder}/{file}', unit = 'mm' }}\n\
         support = [{{ group = '{clamped}', kind = 'clamped' }}]\n[materials.m]\n{}[laminate]\nplies = '[0/0]'\n\
         material = 'm'\nply_thickness = '1 mm'\n[[load]]\npressure = '0.1 MPa'\nface = 'top'\n",
        isotropic(70.0, 0.3, 2.7)
    );
    let model = Model::new(scene::parse(&text, "scene.toml".as_ref()).unwrap(), &Registry::standard()).unwrap();
    statics::solve(&model, NonZeroUsize::MIN).unwrap().u
}

#[test]
fn the_answer_does_not_depend_on_the_format() {
    for shape in ["quads", "triangles"] {
        let of = |end: &str, clamped: &str| displacements(&format!("gmsh-{shape}{end}"), clamped);
        let expected = of("-41.msh", "clamped");
        assert!(expected.iter().any(|u| u.abs() > 1e-6));
        for end in ["-41-binary.msh", "-40.msh", "-22.msh", "-22-binary.msh", ".inp"] {
            assert_eq!(of(end, "clamped"), expected, "{end}");
        }
        for end in ["-free.bdf", "-small.bdf", "-large.bdf"] {
            assert_eq!(of(end, "pid-2"), expected, "{end}");
        }
        assert_eq!(displacements(&format!("meshio-{shape}.inp"), "clamped"), expected);
    }
    for (file, clamped) in [("hand-cae.inp", "clamped/edges"), ("hand-nastran.bdf", "clamped")] {
        assert_eq!(displacements(file, clamped), displacements("gmsh-quads-41.msh", "clamped"), "{file}");
    }
}
