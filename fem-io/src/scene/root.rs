//! The outermost table of a scene.

use super::mesh::MESHES;
use super::{BUCKLING, Fidelity, MODES, delamination, laminate, load, path, run, study, substructures, support, sweep};
use crate::document::keys::{Form, Keys, key, words};
use crate::materials::constants;
use fem_core::plate::ZDerivatives;
use fem_core::plugin::Kind;
use fem_core::symmetry::SymmetryGroup;

/// Which analysis a scene asks for.
#[derive(Clone, Copy)]
pub(super) enum Which {
    Impact,
    Static,
    Modes,
    Buckling,
}

pub(super) const ANALYSES: [(&str, Which); 4] =
    [("impact", Which::Impact), ("static", Which::Static), ("modes", Which::Modes), ("buckling", Which::Buckling)];
pub(super) const Z_DERIVATIVES: [(&str, ZDerivatives); 2] =
    [("shared", ZDerivatives::Shared), ("layer-wise", ZDerivatives::LayerWise)];

/// Its keys, in the order in which a new scene has them.
pub(super) const KEYS: Keys = &[
    key("title", Form::Text, r#""16 plies, 2.49 kg at 1.56 m/s""#, "what it is about; heads results and pictures")
        .required(),
    key("fidelity", Form::Words(&words(&Fidelity::ALL)), r#""engineering""#, "preset beneath the keys of the scene")
        .default(r#""engineering""#),
    key(
        "accuracy",
        Form::OneOf(&[Form::Number, Form::Text]),
        r#""1 %""#,
        "largest error of the results: `fem run` raises mesh, layers, reduction and step until it is kept",
    ),
    key("analysis", Form::Words(&words(&ANALYSES)), r#""static""#, "what is computed").default(r#""impact""#),
    key(
        "symmetry",
        Form::Words(&words(&SymmetryGroup::ALL)),
        r#""half-turn""#,
        "by what plate, supports and loads are symmetric: a part of the plate is computed",
    ),
    key("mesh", Form::OneOf(MESHES), r#"{ file = "plate.msh", unit = "mm" }"#, "cells of the plate in its plane")
        .required(),
    key(
        "materials",
        Form::Named(&Form::Table(constants::KEYS)),
        r#"{ as4-3502 = { library = "AS4/3502" } }"#,
        "materials by names of your own",
    )
    .required(),
    key(
        "laminate",
        Form::OneOf(&[Form::Table(laminate::KEYS), Form::List(&Form::Table(laminate::KEYS))]),
        r#"{ plies = "[0/45/-45/90]2s", material = "as4-3502", ply_thickness = "0.13208 mm" }"#,
        "plies, and the layers of cells that hold them; a list for several parts of the plate",
    )
    .required(),
    key(
        "element",
        Form::Plugin(
            Kind::Element,
            "kind",
            &[key(
                "z_derivatives",
                Form::Words(&words(&Z_DERIVATIVES)),
                r#""layer-wise""#,
                "whether layers of cells share their derivatives along z",
            )
            .default(r#""layer-wise""#)],
        ),
        r#"{ kind = "hermite-prism" }"#,
        "element of the cells: `fem list elements`",
    )
    .required(),
    key(
        "support",
        Form::List(&Form::OneOf(support::SUPPORTS)),
        r#"[{ group = "edge", kind = "clamped" }]"#,
        "what holds the plate",
    ),
    key(
        "equation",
        Form::List(&Form::Table(support::EQUATION)),
        r#"[{ terms = [{ group = "a", at = "top", dof = "U10", factor = 1.0 }] }]"#,
        "linear equations between unknowns",
    ),
    key(
        "couple",
        Form::List(&Form::Table(support::COUPLE)),
        r#"[{ group = "edge", at = "all", dofs = ["U30"] }]"#,
        "sets of nodes that move together",
    ),
    key(
        "substructures",
        Form::Table(substructures::KEYS),
        "{ cells = [5, 5] }",
        "parts of the plate that are condensed on their outlines",
    ),
    key(
        "impactor",
        Form::OneOf(&[Form::Table(run::IMPACTOR), Form::List(&Form::Table(run::IMPACTOR))]),
        r#"{ mass = "2.49 kg", velocity = "1.56 m/s", at = { group = "impact" } }"#,
        "what strikes the plate from above; a list for several",
    ),
    key(
        "contact",
        Form::Plugin(Kind::Contact, "law", &[]),
        r#"{ law = "sun-yang", k = "1.07e5 N/mm^1.5", n = 1.5, m = 2.5, critical = "0.08 mm", beta = 0.4 }"#,
        "contact law: `fem list contact-laws`",
    ),
    key("effects", Form::Effects, r#"{ damage = "onset" }"#, "what is simulated beyond the linear plate").default("{}"),
    key(
        "delamination",
        delamination::FORM,
        r#"{ law = "bilinear", friction = 0.3 }"#,
        "interfaces that open, where `effects.delamination` is \"growth\": `fem list interface-laws`",
    ),
    key("load", Form::List(&Form::OneOf(load::LOADS)), r#"[{ pressure = "1 MPa", face = "top" }]"#, "loads at rest"),
    key(
        "path",
        Form::Table(path::KEYS),
        r#"{ until = "4 mm" }"#,
        "how loads at rest are followed, where `effects.delamination` is \"growth\"",
    ),
    key("modes", Form::Table(MODES), "{ count = 10 }", "natural modes that are found").default("{}"),
    key("buckling", Form::Table(BUCKLING), "{ count = 4 }", "load factors of the preload that are found").default("{}"),
    key(
        "profile",
        Form::List(&Form::Table(load::PROFILE)),
        r#"[{ name = "centre", at = { x = "50 mm", y = "50 mm" }, points = 5 }]"#,
        "lines through the thickness along which stresses are written",
    ),
    key(
        "reduction",
        Form::Plugin(Kind::Reduction, "method", run::REDUCTION),
        r#"{ method = "craig-bampton", modes = 40 }"#,
        "reduction of the plate to few unknowns: `fem list reductions`",
    ),
    key(
        "march",
        Form::Table(run::MARCH),
        r#"{ integrator = "newmark", step = "0.5 us", end = "1 ms" }"#,
        "the march in time",
    ),
    key(
        "failure",
        Form::Table(run::FAILURE),
        r#"{ criteria = ["hashin-report"], every = "5 us", window = "2.54 mm" }"#,
        "where and when failure is looked for",
    ),
    key("output", Form::Table(run::OUTPUT), "{ plots = true }", "what is written").default("{}"),
    key(
        "study",
        Form::Table(study::KEYS),
        r#"{ quantities = ["peak-force"] }"#,
        "what `fem study` varies and looks at",
    )
    .default("{}"),
    key("sweep", Form::Table(sweep::KEYS), r#"{ set = { impactor.velocity = "1..5:9" } }"#, "what `fem sweep` varies")
        .default("{}"),
];
