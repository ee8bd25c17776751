//! How near the interfaces of the sound plate come to opening.

use super::sampling::look_often;
use crate::analyses::impact;
use crate::error::Error;
use crate::model::{Model, Separation};

use fem_core::failure::{CriterionInfo, FailureCriterion, Site};
use fem_core::interfaces::Interfaces;
use fem_core::material::Material;
use fem_core::tensor::{Ply, Stress6};
use fem_failure::scan::PlyOrInterface;
use std::collections::BTreeSet;
use std::num::NonZeroUsize;

/// Share of the tractions at which an interface is damaged, from which on delaminations grow where the advisor has the word.
pub(super) const THRESHOLD: f64 = 0.5;

/// Shares below are taken for none, and those above for this.
const LEAST: f64 = 0.02;
const MOST: f64 = 20.0;

/// Bisections of the logarithm: the share to 1 %.
const BISECTIONS: usize = 10;

/// Share of its tractions that an interface would be damaged at, by its law: 1/λ, λ t the tractions on the way of t from nothing at
/// which a virgin point first loses some of its cohesion.
///
/// It judges the stress between plies as any criterion of interfaces does, in the axes of the ply below.
#[derive(Debug, Clone)]
struct Onset(Interfaces);

impl FailureCriterion for Onset {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Interface,
            modes: &["interface"],
            strengths: &[],
            invariant_about_fibre: false,
        };
        &INFO
    }

    fn indices(&self, s: &Stress6<Ply>, _: &Material, out: &mut [f64]) {
        let traction = [s.s33(), s.s31(), s.s23()];
        let damaged_beyond = |share: f64| self.0.begins_to_fail(&traction.map(|t| t / share));
        out[0] = if !damaged_beyond(LEAST) {
            0.0
        } else if damaged_beyond(MOST) {
            MOST
        } else {
            let (mut low, mut high) = (LEAST, MOST);
            for _ in 0..BISECTIONS {
                let middle = (low * high).sqrt();
                *(if damaged_beyond(middle) { &mut low } else { &mut high }) = middle;
            }
            low
        };
    }
}

/// Largest share of the tractions at which its interfaces are damaged that the plate of `model` comes to, which is that of
/// `separation` without growth; at the places and times at which the scene looks for damage.
///
/// # Errors
/// What keeps the impact from being computed.
pub(super) fn strained(model: &Model, separation: &Separation, threads: NonZeroUsize) -> Result<f64, Error> {
    let mut trial = model.clone();
    trial.criteria = vec![("interface".into(), Box::new(Onset(separation.interfaces.clone())))];
    trial.interface = trial.interface.or(Some(trial.laminate.plies[0].material));
    trial.gauges.clear();
    (trial.output.modes, trial.output.fields, trial.output.maps) = (None, None, true);
    let trial = look_often(trial);
    let outcome = impact::march(impact::prepare(&trial, threads)?.without_estimates(), |_| ())?;
    let may_open: BTreeSet<(u32, u16)> = separation
        .interfaces
        .cells()
        .iter()
        .map(|cell| (cell.quad as u32, separation.below(cell.face) as u16 - 1))
        .collect();
    let opens = |place: PlyOrInterface, cell: u32| match place {
        PlyOrInterface::Interface(below) => may_open.contains(&(cell, below)),
        PlyOrInterface::Ply(_) => false,
    };
    let maxima = outcome.maxima.iter().filter(|of| opens(of.site.place, of.site.cell));
    Ok(maxima.map(|of| of.index).fold(0.0, f64::max))
}
