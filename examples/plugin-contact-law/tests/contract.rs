//! The law fulfils the contract of all contact laws.

use fem_core::testkit::check_contact_law;
use plugin_contact_law::ElasticPlastic;

#[test]
fn it_fulfils_the_contract() {
    for yields in [1e-6, 20e-6, 1.0] {
        assert_eq!(check_contact_law(&ElasticPlastic { k: 3.4e9, yields }, 100e-6), Ok(()), "{yields}");
    }
}
