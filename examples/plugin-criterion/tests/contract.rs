//! The criterion fulfils the contract of all criteria.

use fem_core::testkit::check_criterion;
use plugin_criterion::YamadaSun;

#[test]
fn it_fulfils_the_contract() {
    let as4 = &fem::io::materials::library("AS4/3502").expect("a material of the library").material;
    assert_eq!(check_criterion(&YamadaSun { shear: 160e6 }, as4), Ok(()));
}
