//! Times apart that a scene asks for, those that steps allow, and what is kept at them.

use super::{Impact, Model};
use fem_core::plugin::Dimension;
use fem_core::time::StepLimit;
use fem_io::scene::MarchSpec;
use fem_io::tables::{HistoryRow, ImpactorRow};

/// Share by which times may differ from what is asked without a word: a step is shortened a little where the end does not fit it.
const APART: f64 = 0.01;

/// A warning of every interval, s, by its key, that is no whole number of steps of `march` and does not go beyond its end.
pub(super) fn check(march: &MarchSpec, intervals: &[(&str, Option<f64>)]) -> Vec<String> {
    let (steps, dt) = march.steps();
    let apart = |(key, asked): &(&str, Option<f64>)| {
        let asked = asked.filter(|asked| *asked < steps as f64 * dt)?;
        let count = asked / dt;
        let nearest = count.round().max(1.0);
        let times = |count: f64| Dimension::TIME.of(count * dt);
        let others =
            if count < 1.0 { times(1.0) } else { format!("{} or {}", times(count.floor()), times(count.ceil())) };
        ((nearest - count).abs() > APART * count).then(|| {
            format!(
                "`{key}` is {}, no whole number of steps of {}: it is done every {}; write {others}, or another \
                 `march.step`",
                Dimension::TIME.of(asked),
                times(1.0),
                times(nearest)
            )
        })
    };
    intervals.iter().filter_map(apart).collect()
}

/// A warning where every length of a divided step factorises the full plate.
pub(super) fn check_parts(impact: &Impact) -> Option<String> {
    let implicit = impact.integrator.limit() == StepLimit::None && impact.integrator.order() <= 2;
    (impact.spec.march.tolerance.is_some() && impact.reduction.is_none() && implicit).then(|| {
        let (steps, _) = impact.spec.march.steps();
        format!(
            "with `march.tolerance` an implicit step is tried whole and in halves, and each length factorises the full plate: at \
             least {} times in {steps} steps; name a reduction, for example {{ method = \"ritz\", vectors = 60 }}, or leave \
             the tolerance out",
            2 * steps
        )
    })
}

/// Rows of the history unless the scene says otherwise.
const HISTORY_ROWS: u64 = 2000;

/// Copies of what a march keeps, at its peak: a list that grows has room for twice of what it holds, and a checkpoint holds it once
/// more.
const COPIES: f64 = 3.0;

/// What a row and a sample take beside their numbers, bytes: where two lists of them lie.
const LISTS: usize = 32;

/// Numbers of a step: the force, and of each contact up to two deflections with their times.
const PER_STEP: [usize; 2] = [1, 4];

/// Steps of `dt` in an interval, at least one.
pub(crate) fn count_steps(interval: f64, dt: f64) -> u64 {
    ((interval / dt).round() as u64).max(1)
}

impl Model {
    /// Steps between two rows of the history of a march of so many `steps` of `dt`.
    pub(crate) fn row_every(&self, steps: u64, dt: f64) -> u64 {
        self.output.history_every.map_or(steps.div_ceil(HISTORY_ROWS), |every| count_steps(every, dt))
    }

    /// What a march keeps of its steps, its rows and its samples at the watched places, bytes.
    pub(super) fn kept(&self, impact: &Impact) -> f64 {
        let (steps, dt) = impact.spec.march.steps();
        let contacts = impact.strikes.len();
        let row = size_of::<HistoryRow>() + contacts * size_of::<ImpactorRow>() + LISTS;
        let numbers = self.effects.columns().count() + self.output.modes.as_ref().map_or(0, |modes| modes.value);
        let gauges = self.gauges.iter().flat_map(|gauge| &gauge.criteria);
        let indices: usize = gauges.map(|criterion| 1 + self.criteria[*criterion].1.info().modes.len()).sum();
        let of_steps = 8 * (PER_STEP[0] + PER_STEP[1] * contacts);
        let each = |count: u64, bytes: usize| count as f64 * bytes as f64;
        COPIES
            * (each(steps, of_steps)
                + each(steps / self.row_every(steps, dt), row + 8 * numbers)
                + each(steps / count_steps(self.sample_every, dt), 8 * indices))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]

    use super::*;
    use fem_io::scene;

    /// Warnings about an interval of so many microseconds in a march of 50 steps of 0.2 us.
    fn said(us: f64) -> Vec<String> {
        let text = "title = 't'\nmesh = { rectangle = ['10 mm', '10 mm'], cells = [2, 2] }\nmaterials.m = { library = 'AS4/3502' }\n\
                    laminate = { plies = '[0]', material = 'm', ply_thickness = '1 mm', layers = [1] }\n\
                    support = [{ group = 'x-min', at = 'all', fix = ['U10', 'U20', 'U30'] }]\n\
                    impactor = { mass = '1 g', velocity = '1 m/s', at = { x = '5 mm', y = '5 mm' } }\n\
                    contact = { law = 'hertz', k = '1e9 N/m^1.5' }\n\
                    march = { step = '0.2 us', end = '10 us' }\neffects = { damage = 'off' }\n";
        let scene = scene::parse(text, "scene.toml".as_ref()).unwrap();
        check(&scene.impact().unwrap().march, &[("key", Some(us * 1e-6)), ("other", None)])
    }

    #[test]
    fn an_interval_is_a_whole_number_of_steps_or_said_not_to_be() {
        for good in [0.2, 0.4, 1.0, 5.0, 10.0, 11.1, 1e6] {
            assert_eq!(said(good), [""; 0], "{good}");
        }
        let [warning] = &said(0.5)[..] else { panic!() };
        assert!(warning.contains("every 0.6 us; write 0.4 us or 0.6 us"), "{warning}");
        let [warning] = &said(0.05)[..] else { panic!() };
        assert!(warning.contains("every 0.2 us; write 0.2 us, or"), "{warning}");
    }
}
