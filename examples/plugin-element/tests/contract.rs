//! The element fulfils the contract of all elements.

use fem_core::testkit::check_element;
use plugin_element::{Hex8, Shear};

#[test]
fn it_fulfils_the_contract() {
    for shear in [Shear::Assumed, Shear::Full] {
        assert_eq!(check_element(&Hex8 { shear }), Ok(()), "{shear:?}");
    }
}
