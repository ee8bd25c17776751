//! Rows of parameters: what they print is what a scene may say.

use fem::Registry;
use fem::core::plugin::{Kind, ParamForm, Params, Value};
use std::collections::BTreeSet;

#[test]
fn rows_of_parameters_are_sound() {
    let registry = Registry::standard();
    for info in Kind::ALL.iter().flat_map(|kind| registry.list(*kind)) {
        let names: BTreeSet<_> = info.params.iter().map(|row| row.name).collect();
        assert_eq!(names.len(), info.params.len(), "{}: two parameters of one name", info.name);
        for row in info.params {
            let Some(default) = row.default_value() else { continue };
            let printed = default.in_scene();
            let given = match row.form {
                ParamForm::Quantity(_) => {
                    let (value, dimension) = fem::io::units::parse_quantity(printed.trim_matches('"')).unwrap();
                    Value::Quantity(value, dimension)
                }
                _ => default.clone(),
            };
            assert_eq!(given, default, "{} {}: {printed}", info.name, row.name);
            assert_eq!(Params::default().with(row.name, given).value(row), Ok(Some(default)));
        }
    }
}
