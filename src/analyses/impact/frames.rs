//! Which steps of a march are frames.

use fem_io::scene::Fields;

/// Steps of a march that are frames, ascending: those nearest to the multiples of `every`, s, if there is one, and to
/// the times of `fields`. A march has that many steps of that length, s.
pub(crate) fn frames(fields: Option<&Fields>, every: Option<f64>, (steps, dt): (u64, f64)) -> Vec<u64> {
    let nearest = |t: f64| (t / dt).round() as u64;
    let regular = every.map(|every| every.max(dt));
    let regular = regular.into_iter().flat_map(|every| (0_u32..).map(move |k| f64::from(k) * every));
    let regular = regular.map(nearest).take_while(|step| *step <= steps);
    let single = fields.iter().flat_map(|fields| &fields.times).map(|t| nearest(*t).min(steps));
    let mut frames: Vec<u64> = regular.chain(single).collect();
    frames.sort_unstable();
    frames.dedup();
    frames
}
