//! Plug-ins of Python beside those of the program.

use crate::contact::PyContactLaw;
use crate::criterion::{PyCriterion, Raised};
use crate::ply_law::PyPlyLaw;
use fem::Registry;
use fem::core::plugin::{Built, Kind, PluginInfo};
use pyo3::prelude::*;

/// A plug-in that is an object of Python.
pub(crate) enum Own {
    Criterion(PyCriterion),
    Contact(PyContactLaw),
    Ply(PyPlyLaw),
}

impl FromPyObject<'_, '_> for Own {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        if object.hasattr("indices")? {
            object.extract().map(Self::Criterion)
        } else if object.hasattr("respond")? {
            object.extract().map(Self::Ply)
        } else {
            object.extract().map(Self::Contact)
        }
    }
}

/// What each of them raises first.
pub(crate) fn raised(own: &[Own]) -> Vec<Raised> {
    let raised = |own: &Own| match own {
        Own::Criterion(criterion) => criterion.raised.clone(),
        Own::Contact(law) => law.raised.clone(),
        Own::Ply(law) => law.raised.clone(),
    };
    own.iter().map(raised).collect()
}

/// The plug-ins of the program with `own` besides.
pub(crate) fn registry(own: &[Own]) -> Registry {
    let info = |kind, name, summary| PluginInfo { kind, name, summary, source: "Python", params: &[] };
    own.iter().fold(Registry::standard(), |registry, own| match own {
        Own::Criterion(criterion) => {
            let criterion = criterion.clone();
            let info = info(Kind::Criterion, criterion.name, criterion.summary);
            registry.with_built(info, move |_| Ok(Built::Criterion(Box::new(criterion.clone()))))
        }
        Own::Contact(law) => {
            let law = law.clone();
            let info = info(Kind::Contact, law.name, law.summary);
            registry.with_built(info, move |_| Ok(Built::Contact(Box::new(law.clone()))))
        }
        Own::Ply(law) => {
            let law = law.clone();
            let info = info(Kind::PlyLaw, law.name, law.summary);
            registry.with_built(info, move |_| Ok(Built::PlyLaw(Box::new(law.built()))))
        }
    })
}
