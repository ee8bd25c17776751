//! Failure indices as tables and a picture: over time at the gauges, their largest over the plate.

use crate::analyses::impact::Outcome;
use crate::analyses::stress::IndexHistory;
use crate::error::Error;
use crate::model::Model;
use crate::words::{name_ply, name_ply_of};
use fem_failure::scan::ScanSite;
use fem_io::files::OutputDir;
use fem_io::plot;
use fem_io::tables::{self, IndexHistoryRow, IndexRow};

fn row(model: &Model, criterion: usize, mode: Option<usize>, site: &ScanSite, index: f64) -> IndexRow {
    let (name, criterion) = &model.criteria[criterion];
    IndexRow {
        criterion: name.clone(),
        mode: mode.map_or("none", |mode| criterion.info().modes[mode]).to_owned(),
        region: model.region_of(site.cell as usize).map(str::to_owned),
        cell: model.plate.plane.quad_tags[site.cell as usize],
        ply: name_ply(site.place),
        position_m: site.position,
        index,
    }
}

/// Writes `index_history.csv` where the scene watches places, `index_maxima.csv` where it asks for maps.
///
/// # Errors
/// As [`OutputDir::write`].
pub(crate) fn write_tables(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    if !model.gauges.is_empty() {
        let rows: Vec<_> = outcome.histories.iter().flat_map(|history| history_rows(model, history)).collect();
        tables::write_index_history(dir, &rows)?;
    }
    if model.output.maps {
        let (mesh, symmetry) = (&model.plate.plane, model.plate.symmetry());
        let mut represented = vec![Vec::new(); mesh.quads.len()];
        (0..mesh.quads.len()).for_each(|quad| represented[symmetry.quad(quad)].push(quad));
        let rows = outcome.maxima.iter().flat_map(|m| {
            let [x, y, z] = m.site.position;
            let row = |site: &ScanSite| row(model, m.criterion, m.mode, site, m.index);
            if model.centres.iter().any(|centre| centre.at == [x, y]) {
                return vec![row(&m.site)];
            }
            let of_cell = |quad: &usize| {
                let [x, y] = mesh.corners(*quad).centroid();
                row(&ScanSite { cell: *quad as u32, position: [x, y, z], ..m.site })
            };
            represented[m.site.cell as usize].iter().map(of_cell).collect()
        });
        tables::write_index_maxima(dir, &rows.collect::<Vec<_>>())?;
    }
    Ok(())
}

fn history_rows(model: &Model, history: &IndexHistory) -> Vec<IndexHistoryRow> {
    let modes = model.criteria[history.criterion].1.info().modes.len();
    let mut rows = Vec::new();
    for (&time_s, indices) in history.times.iter().zip(history.indices.chunks_exact(modes)) {
        for (mode, &index) in indices.iter().enumerate() {
            let index = row(model, history.criterion, Some(mode), &history.site, index);
            rows.push(IndexHistoryRow { time_s, index });
        }
    }
    rows
}

/// Draws the largest index over the modes of every criterion at every gauge, over time.
///
/// # Errors
/// As [`OutputDir::write`], and numbers that no plot can show.
pub(crate) fn write_plots(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    if model.gauges.is_empty() {
        return Ok(());
    }
    let curves: Vec<_> = outcome.histories.iter().map(|history| curve(model, history)).collect();
    let picture = plot::line_plot(&plot::index_history(&model.origin.title, &curves))?;
    Ok(picture.write(dir, "index_history")?)
}

fn curve(model: &Model, history: &IndexHistory) -> (String, Vec<(f64, f64)>) {
    let (name, criterion) = &model.criteria[history.criterion];
    let [x, y] = [0, 1].map(|d| history.site.position[d] * 1e3);
    let ply = name_ply_of(history.site.place, model.region_of(history.site.cell as usize));
    let label = format!("{name}, ply {ply} at ({x:.2}, {y:.2}) mm");
    let largest = history.indices.chunks_exact(criterion.info().modes.len());
    let largest = largest.map(|indices| indices.iter().fold(f64::NEG_INFINITY, |m, v| m.max(*v)));
    (label, history.times.iter().copied().zip(largest).collect())
}
