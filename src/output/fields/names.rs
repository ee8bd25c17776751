//! What numbers in the files count, and what the files are drawn with.

use crate::model::Model;
use fem_core::failure::Site;
use fem_io::results::FORMAT;
use fem_io::scene::FieldSeries;
use serde::Serialize;

/// What numbers in the files count; the content of `names.json`.
#[derive(Serialize)]
pub(super) struct Names<'a> {
    /// [`fem_io::results::FORMAT`].
    format: u32,
    title: &'a str,
    /// By `material`, from 0.
    materials: Vec<&'a str>,
    criteria: Vec<CriterionNames<'a>>,
}

#[derive(Serialize)]
struct CriterionNames<'a> {
    name: &'a str,
    series: &'static str,
    /// By `NAME mode`, from 1.
    modes: &'static [&'static str],
}

impl<'a> Names<'a> {
    pub(super) fn of(model: &'a Model) -> Self {
        let criteria = model.criteria.iter().map(|(name, criterion)| {
            let info = criterion.info();
            let series = if info.site == Site::Ply { FieldSeries::Plies } else { FieldSeries::Interfaces };
            CriterionNames { name, series: series.name(), modes: info.modes }
        });
        let materials = model.materials.iter().map(|material| material.name.as_str());
        Self {
            format: FORMAT,
            title: &model.origin.title,
            materials: materials.collect(),
            criteria: criteria.collect(),
        }
    }
}
