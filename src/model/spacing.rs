//! Times apart that a scene asks for, and those that steps allow.

use fem_io::scene::MarchSpec;

/// Share by which times may differ from what is asked without a word: a step is shortened a little where the end does not fit it.
const APART: f64 = 0.01;

/// A warning of every interval, s, by its key, that is no whole number of steps of `march` and does not go beyond its end.
pub(super) fn check(march: &MarchSpec, intervals: &[(&str, Option<f64>)]) -> Vec<String> {
    let (steps, dt) = march.steps();
    let apart = |(key, asked): &(&str, Option<f64>)| {
        let asked = asked.filter(|asked| *asked < steps as f64 * dt)?;
        let count = asked / dt;
        let nearest = count.round().max(1.0);
        let us = |count: f64| format!("{:.4} us", count * dt * 1e6);
        let others = if count < 1.0 { us(1.0) } else { format!("{} or {}", us(count.floor()), us(count.ceil())) };
        ((nearest - count).abs() > APART * count).then(|| {
            format!(
                "`{key}` is {:.4} us, no whole number of steps of {}: it is done every {}; write {others}, or another \
                 `march.step`",
                asked * 1e6,
                us(1.0),
                us(nearest)
            )
        })
    };
    intervals.iter().filter_map(apart).collect()
}
