//! Damage of plies that follow laws, and of interfaces that open, as fields.

use crate::model::{FieldPlan, Model};
use fem_core::interfaces::Interfaces;
use fem_core::laws::PlyLaws;
use fem_io::vtu::Array;

/// Fields of an interface that may open.
const OF_INTERFACES: [&str; 3] = ["damage", "opening", "sliding"];

/// From the cells that a symmetry leaves to the sheets of a series.
#[derive(Debug)]
pub(super) struct Damaged<'a> {
    model: &'a Model,
    /// The quad that each of those shown is computed as.
    kept: Vec<usize>,
}

impl<'a> Damaged<'a> {
    pub(super) fn new(model: &'a Model, plan: &FieldPlan) -> Self {
        let symmetry = model.plate.symmetry();
        Self { model, kept: plan.quads.iter().map(|quad| symmetry.quad(*quad)).collect() }
    }

    /// Mean damages of the plies over each quad, which begin at `starts`, at the states `points` of their laws; not a number where no law
    /// has them.
    pub(super) fn of_plies(&self, points: &[f64], starts: &[usize]) -> Vec<Array> {
        let Some(laws) = self.model.laws.as_ref().filter(|laws| laws.states() == points.len()) else {
            return Vec::new();
        };
        let count = starts[starts.len() - 1];
        let mut arrays: Vec<(&str, Vec<Option<f64>>)> =
            self.names(laws).into_iter().map(|name| (name, vec![None; count])).collect();
        for (kept, start) in self.kept.iter().zip(starts) {
            let mut below = 0;
            for (layer, stack) in self.model.plate.stacks(self.model.plate.region(*kept)).iter().enumerate() {
                let cell = self.model.plate.cell_over(*kept, layer);
                let states = &points[laws.states_of(cell)];
                for (ply, name, mean) in laws.damages(&self.model.plate, &*self.model.element, cell, states) {
                    for (_, values) in arrays.iter_mut().filter(|(own, _)| *own == name) {
                        values[start + below + ply] = Some(mean);
                    }
                }
                below += stack.slices.len();
            }
        }
        arrays.into_iter().map(|(name, values)| Array::where_known(format!("{name} damage"), &values)).collect()
    }

    /// What of plies is damaged, each once.
    fn names(&self, laws: &PlyLaws) -> Vec<&'static str> {
        let mut names = Vec::new();
        for law in laws.laws() {
            for k in law.damages() {
                let name = law.info().state[k];
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        names
    }

    /// Numbers for each ply, and for each interface.
    pub(super) fn changing(&self) -> [usize; 2] {
        let of_plies = self.model.laws.as_ref().map_or(0, |laws| self.names(laws).len());
        [of_plies, if self.model.separation.is_some() { OF_INTERFACES.len() } else { 0 }]
    }

    /// Mean damage and jump of each interface, at the states `interfaces` of those that may open and displacements `u`; not a number
    /// of others.
    pub(super) fn of_interfaces(&self, interfaces: &[f64], u: &[f64], starts: &[usize]) -> Vec<Array> {
        let Some(separation) = self.model.separation.as_ref().filter(|of| of.states.len() == interfaces.len()) else {
            return Vec::new();
        };
        let mut arrays = OF_INTERFACES.map(|name| (name, vec![None; starts[starts.len() - 1]]));
        let first = separation.first();
        for (number, cell) in separation.interfaces.cells().iter().enumerate() {
            let states = &interfaces[first[number]..first[number + 1]];
            let [normal, x, y] = separation.interfaces.mean_jump(number, u);
            let (mut lost, mut area) = (0.0, 0.0);
            for (own, damage) in separation.interfaces.damage(number, states) {
                area += own;
                lost += own * damage;
            }
            let damage = if Interfaces::is_open(states) { lost / area } else { 0.0 };
            let sheet = separation.below(cell.face) - 1;
            for (_, start) in self.kept.iter().zip(starts).filter(|(kept, _)| **kept == cell.quad) {
                for ((_, values), value) in arrays.iter_mut().zip([damage, normal, x.hypot(y)]) {
                    values[start + sheet] = Some(value);
                }
            }
        }
        arrays.into_iter().map(|(name, values)| Array::where_known(name, &values)).collect()
    }
}
