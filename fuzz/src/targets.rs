//! What holds of every reader, whatever it is given: an error with words and a place in the text, or a value that is
//! sound. A target panics where it does not.

use fem_core::failure::{FailureCriterion as _, Site};
use fem_core::layup::{self, LayupPly};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughnesses};
use fem_core::mesh::{Curves, PlaneMesh};
use fem_core::tensor::Stress6;
use fem_failure::Expression;
use fem_io::deck::{self, Deck, DeckSource, Freedom, NoResults, Program, Relation};
use fem_io::scene::{self, ContactLoad, MeshSource};
use fem_io::{meshes, units};
use miette::Diagnostic as _;
use std::path::Path;

fn text(data: &[u8]) -> &str {
    std::str::from_utf8(data).unwrap_or_default()
}

/// A mesh of gmsh that is read has finite corners and cells of positive area.
pub fn mesh(data: &[u8]) {
    plate(data, "plate.msh");
}

/// The same of meshes of Abaqus and Nastran.
pub fn lines(data: &[u8]) {
    plate(data, "plate.inp");
    plate(data, "plate.bdf");
}

fn plate(data: &[u8], name: &str) {
    match meshes::parse(data, name, 1e-3) {
        Ok(plate) => {
            let mesh = plate.mesh;
            sound(&mesh);
            sound(&mesh.refined(Curves::Kept));
        }
        Err(error) => {
            assert!(!error.fault.to_string().is_empty());
            match error.place {
                meshes::FilePlace::File => {}
                meshes::FilePlace::Line(line) => assert!((1..=1 + newlines(data)).contains(&line), "{error}"),
                meshes::FilePlace::Byte(byte) => assert!(byte <= data.len(), "{error}"),
            }
        }
    }
}

fn sound(mesh: &PlaneMesh) {
    assert!(mesh.points.iter().flatten().all(|x| x.is_finite()));
    assert!(!mesh.quads.is_empty() && mesh.quads.len() == mesh.quad_tags.len());
    assert!((0..mesh.quads.len()).all(|q| mesh.quality(q).area > 0.0), "a cell without area");
    assert!(mesh.area().is_finite() && mesh.curved_turn().is_finite());
    let (nodes, cells) = (mesh.points.len() as u32, mesh.quads.len() as u32);
    for group in mesh.groups.values() {
        assert!(group.nodes.is_sorted_by(|a, b| a < b) && group.nodes.last().is_none_or(|n| *n < nodes));
        assert!(group.quads.iter().all(|q| *q < cells));
    }
}

fn newlines(data: &[u8]) -> usize {
    data.iter().filter(|b| **b == b'\n').count()
}

/// A scene that is read has quantities that a computation can begin with. Its folder is none, so that it names no files.
pub fn scene(data: &[u8]) {
    match scene::parse(text(data), Path::new("no-such-folder/scene.toml")) {
        Ok(scene) => {
            let positive = |x: f64| assert!(x > 0.0 && x.is_finite(), "{x}");
            let plies = &scene.laminates[0].laminate.value.plies;
            assert_eq!(plies.len(), scene.laminates[0].laminate.value.layers.iter().sum::<usize>());
            plies.iter().for_each(|ply| positive(ply.thickness));
            positive(scene.laminates[0].laminate.value.thickness());
            assert!(plies.iter().all(|ply| ply.angle.is_finite() && ply.material < scene.materials.len()));
            for material in &scene.materials {
                assert_eq!(material.value.check(), Ok(()));
            }
            match scene.mesh {
                MeshSource::Rectangle { size, cells, .. } => {
                    size.into_iter().for_each(positive);
                    assert!(cells.iter().all(|n| *n > 0));
                }
                MeshSource::File { metres_per_unit, .. } => positive(metres_per_unit),
                MeshSource::Graded { ref plate, .. } => assert!(plate.value.cells().is_ok_and(|n| n > 0)),
            }
            if let Some(impact) = scene.impact() {
                for impactor in &impact.impactors {
                    [impactor.mass, impactor.velocity].into_iter().for_each(positive);
                    assert!(impactor.start >= 0.0 && impactor.start.is_finite());
                    match impactor.load.value {
                        ContactLoad::Node => {}
                        ContactLoad::Patch { radius: length }
                        | ContactLoad::Tip { radius: length }
                        | ContactLoad::Square { side: length } => positive(length),
                    }
                }
                [impact.march.step.value, impact.march.end.value, scene.failure.every].into_iter().for_each(positive);
            }
            scene.output.history_every.into_iter().for_each(positive);
            assert!(scene.output.checkpoint_every >= 0.0);
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            let source = error.source_code();
            for label in error.labels().into_iter().flatten() {
                assert!(source.is_some_and(|text| text.read_span(label.inner(), 0, 0).is_ok()), "no place for {error}");
            }
        }
    }
}

/// A deck that is read as one of any program has masters or governors that are free, print steps and plies; an error has a place
/// and a remedy.
pub fn deck(data: &[u8]) {
    let source = DeckSource::new("deck.dat", String::from_utf8_lossy(data).into_owned());
    for program in [Program::Lamcel, Program::Lamsub, Program::Tradyr] {
        match deck::parse(&source, program, &NoResults).map(|parsed| parsed.deck) {
            Ok(Deck::Generation(deck)) => {
                free(&deck.freedom);
                assert!(deck.laminate.plies.iter().all(|ply| ply.thickness > 0.0 && ply.angle.is_finite()));
                assert!(deck.laminate.materials.iter().all(|material| material.check().is_ok()));
                let nodes = deck.piece.nodes.len();
                assert!(deck.piece.elements.iter().all(|card| card.nodes.iter().all(|node| *node < nodes)));
            }
            Ok(Deck::Impact(deck)) => {
                free(&deck.freedom);
                assert!(deck.freedom.kept.contains(&deck.struck) && deck.impactor.velocity != 0.0);
                assert!(deck.march.steps > 0 && deck.march.every > 0 && deck.march.step.value > 0.0);
            }
            Ok(Deck::Restart(march)) => assert!(march.steps > 0 && march.every > 0 && march.step.value > 0.0),
            Ok(Deck::BackSubstitution(back)) => assert!(back.sets.iter().all(|set| set.step > 0)),
            Err(error) => {
                assert!(!error.to_string().is_empty() && !error.remedy().is_empty(), "{error}");
                let text = error.source_code();
                for label in error.labels().into_iter().flatten() {
                    assert!(
                        text.is_none_or(|text| text.read_span(label.inner(), 0, 0).is_ok()),
                        "no place for {error}"
                    );
                }
            }
        }
    }
}

/// What is kept is there, once, and follows nothing.
fn free(freedom: &Freedom) {
    let mut kept = freedom.kept.clone();
    kept.sort_unstable();
    assert!(!kept.is_empty() && kept.windows(2).all(|pair| pair[0] < pair[1]) && kept[kept.len() - 1] < freedom.ndof());
    let bound = |relation: &Relation| kept.binary_search(&relation.dof).is_ok();
    assert!(!freedom.relations.iter().any(bound) && freedom.nodes.is_sorted_by(|a, b| a < b));
}

/// A layup that is read and written ply by ply is the same layup.
pub fn layup(data: &[u8]) {
    let text = text(data);
    match layup::parse(text) {
        Ok(plies) => {
            assert!(!plies.is_empty() && plies.len() <= layup::MAX_PLIES);
            assert!(plies.iter().all(|ply| ply.angle_deg.abs() <= 180.0 && ply.angle_deg.to_bits() != MINUS_ZERO));
            if plies.len() <= 100 {
                let written = format!("[{}]", plies.iter().map(written).collect::<Vec<_>>().join("/"));
                assert_eq!(layup::parse(&written).as_ref(), Ok(&plies), "{written}");
            }
        }
        Err(error) => {
            assert!(!error.why.is_empty() && text.is_char_boundary(error.at), "{error}");
            assert!(error.to_string().ends_with('^'));
        }
    }
}

const MINUS_ZERO: u64 = 1 << 63;

fn written(ply: &LayupPly) -> String {
    let label = ply.label.as_ref().map_or(String::new(), |label| format!("{{{label}}}"));
    format!("{}{label}", ply.angle_deg)
}

/// A formula that is read has a value, and none for a stress that is not a number.
pub fn expression(data: &[u8]) {
    let text = text(data);
    match Expression::new(Site::Ply, &[("failure", text)]) {
        Ok(criterion) => {
            let index = |component| {
                let mut index = [0.0];
                criterion.indices(&Stress6::new([component; 6]), &material(), &mut index);
                index[0]
            };
            for component in [0.0, 1e6, -1e300] {
                index(component);
            }
            let names_a_stress = text.as_bytes().windows(2).any(|pair| pair[0] == b's' && pair[1].is_ascii_digit());
            assert!(index(f64::NAN).is_nan() || !names_a_stress, "{text} is {} without a stress", index(f64::NAN));
        }
        Err(error) => {
            let why = error.to_string();
            assert!(why.starts_with("mode `failure`, `") && !why.ends_with(": "), "{why}");
        }
    }
}

fn material() -> Material {
    let strengths = Strength::ALL.iter().fold(Strengths::default(), |all, which| all.with(*which, 1e7));
    let elastic = Elastic::transversely_isotropic(1.3e11, 1e10, 0.3, 0.4, 5e9);
    Material {
        name: "tape".into(),
        elastic,
        density: None,
        strengths,
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    }
}

/// A quantity that is read is finite, and 0 only where it is written so.
pub fn units(data: &[u8]) {
    let text = text(data);
    match units::parse_quantity(text) {
        Ok((value, dimension)) => {
            assert!(
                value.is_finite() && dimension.0.iter().all(|exponent| exponent.is_finite()),
                "{text}: {dimension}"
            );
            assert_eq!(units::parse_as(text, dimension), Ok(value));
        }
        Err(error) => assert!(!error.to_string().is_empty() && !error.remedy(None).is_empty()),
    }
}
