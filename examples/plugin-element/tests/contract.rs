//! The element fulfils the contract of all elements.

use fem_core::testkit::check_element;
use plugin_element::Hex8;

#[test]
fn it_fulfils_the_contract() {
    for assumed_shear in [true, false] {
        assert_eq!(check_element(&Hex8 { assumed_shear }), Ok(()), "{assumed_shear}");
    }
}
