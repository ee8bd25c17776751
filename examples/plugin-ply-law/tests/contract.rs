//! The law fulfils the contract of all ply laws.

use fem_core::material::{Elastic, Material, Strengths, Toughnesses};
use fem_core::testkit::check_ply_law;
use plugin_ply_law::ShearCracks;

#[test]
fn it_fulfils_the_contract() {
    let tape = Material {
        name: "tape".into(),
        elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9),
        density: None,
        strengths: Strengths::default(),
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    };
    for most in [0.0, 0.4, 0.9] {
        // Its parameters are pure numbers: they are the same in all units.
        let law = ShearCracks { onset: 0.008, spread: 0.02, most };
        let largest = [0.01, 0.01, 0.01, 0.05, 0.03, 0.03];
        assert_eq!(check_ply_law(|_| Box::new(law), &tape, 1e-3, &largest), Ok(()), "{most}");
    }
}
