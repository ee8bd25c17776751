//! Numbers, units and names as several results print them.

use fem_core::assembly::NOTABLE_CONDITION;
use fem_failure::scan::PlyOrInterface;
use std::fmt::Display;

/// "3" for a ply, "3|4" for an interface, counted from 1 at the bottom.
pub(crate) fn name_ply(place: PlyOrInterface) -> String {
    match place {
        PlyOrInterface::Ply(k) => format!("{}", k + 1),
        PlyOrInterface::Interface(k) => format!("{}|{}", k + 1, k + 2),
    }
}

/// The same with the region from whose bottom plies are counted, where that is said: "3 doubler".
pub(crate) fn name_ply_of(place: PlyOrInterface, region: Option<&str>) -> String {
    region.map_or_else(|| name_ply(place), |region| format!("{} {region}", name_ply(place)))
}

/// ", symmetry quarter", or nothing.
pub(crate) fn append_symmetry(symmetry: Option<&str>) -> String {
    append(symmetry.map(|name| format!("symmetry {name}")))
}

/// ", 12 masters of 4 substructures", or nothing.
pub(crate) fn append(what: Option<impl Display>) -> String {
    what.map_or_else(String::new, |what| format!(", {what}"))
}

/// What the condition of the stiffness costs, in words.
pub(crate) fn describe_condition(condition: f64) -> String {
    let lost = condition.log10().clamp(0.0, 16.0);
    format!("condition {condition:.1e}: rounding costs up to {lost:.0} of 16 digits")
}

/// What to say of supports and couples that fix values at nodes and leave the plate free between them.
pub(crate) fn warn_of_softness(share: f64) -> String {
    format!(
        "supports or couples fix displacements at nodes, between which the plate moves: it is {:.0} % softer for that; fix their derivatives along \
         the held side as well (with U30 along x also U31), and those along z (U33) where all levels are held",
        100.0 * share / (1.0 - share)
    )
}

/// A warning of a condition that leaves few digits.
pub(crate) fn warn_of_condition(condition: f64) -> Option<String> {
    let enough = condition <= NOTABLE_CONDITION;
    (!enough).then(|| {
        format!(
            "the stiffness has the {}: supports that all but leave a motion free, cells much wider than thick and moduli far \
             apart do that",
            describe_condition(condition)
        )
    })
}

/// `bytes` for people.
pub(crate) fn describe_bytes(bytes: f64) -> String {
    if bytes < 1e9 { format!("{:.0} MB", bytes * 1e-6) } else { format!("{:.1} GB", bytes * 1e-9) }
}
