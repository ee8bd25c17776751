//! What slopes add to the stresses of a reduced plate that its deflections stretch.

use super::operator::LANES;
use fem_core::interval::Interval;
use fem_core::recovery::{Response, Slopes};
use fem_core::vectorised::{products, products_of_intervals};
use fem_dynamics::reduce::Companions;
use std::sync::OnceLock;

/// How much a plate follows its stretching beside its modes, and the slopes of these, whose products are strains.
#[derive(Debug)]
pub(super) struct Bent {
    companions: Companions,
    /// Of the modes.
    slopes: Slopes,
    coarse: OnceLock<Coarse>,
}

/// The rows of slopes in single precision, in units of the coordinates.
#[derive(Debug)]
struct Coarse {
    rows: Vec<f32>,
    /// The largest, or 1.
    largest: f64,
}

/// Strains of slopes in samples, and the place they are of.
pub(super) type OfPlace<T> = Option<(usize, [[T; LANES]; 3])>;

impl Bent {
    pub(super) fn new(companions: Companions, slopes: Slopes) -> Self {
        Self { companions, slopes, coarse: OnceLock::new() }
    }

    /// Samples of the modes' coordinates, each with the amounts of what the plate does beside them.
    pub(super) fn extended(&self, samples: &[f64]) -> Vec<f64> {
        let with_amounts = |q: &[f64]| q.iter().copied().chain(self.companions.amounts(q)).collect::<Vec<_>>();
        samples.chunks_exact(self.slopes.fields()).flat_map(with_amounts).collect()
    }

    /// Stress of `site` per unit of each strain.
    pub(super) fn response(&self, site: usize) -> &Response {
        self.slopes.response(site)
    }

    /// ½ w,x², ½ w,y² and w,x w,y at the place of `site`, of which `known` keeps the last.
    pub(super) fn strains<'a>(
        &self,
        site: usize,
        columns: &[[f64; LANES]],
        known: &'a mut OfPlace<f64>,
    ) -> &'a [[f64; LANES]; 3] {
        let (place, modes) = (self.slopes.place(site), self.slopes.fields());
        if known.as_ref().is_none_or(|(of, _)| *of != place) {
            let mut strains = [[0.0; LANES]; 3];
            for (point, share) in self.slopes.points(place) {
                let [x, y] = products(&self.slopes.rows()[2 * modes * point..][..2 * modes], &columns[..modes]);
                for lane in 0..LANES {
                    let [x, y] = [x[lane], y[lane]];
                    strains[0][lane] += 0.5 * share * (x * x);
                    strains[1][lane] += 0.5 * share * (y * y);
                    strains[2][lane] += share * (x * y);
                }
            }
            *known = Some((place, strains));
        }
        &known.get_or_insert((place, [[0.0; LANES]; 3])).1
    }

    /// What holds these strains where coordinates, in their `units`, lie within the `halves` of the `middles`, and small numbers may be
    /// `lost`.
    pub(super) fn ranges<'a>(
        &self,
        site: usize,
        (middles, halves): (&[[f32; LANES]], &[[f32; LANES]]),
        (units, lost): (&[f64], &[f64; LANES]),
        known: &'a mut OfPlace<Interval>,
    ) -> &'a [[Interval; LANES]; 3] {
        const NONE: Interval = Interval { low: 0.0, high: 0.0 };
        let (place, modes) = (self.slopes.place(site), self.slopes.fields());
        if known.as_ref().is_none_or(|(of, _)| *of != place) {
            let Coarse { rows, largest } = self.coarse.get_or_init(|| Coarse::new(&self.slopes, units));
            let mut strains = [[NONE; LANES]; 3];
            for (point, share) in self.slopes.points(place) {
                let rows = &rows[2 * modes * point..][..2 * modes];
                let [sums, reaches] = products_of_intervals::<2, LANES>(rows, &middles[..modes], &halves[..modes]);
                for lane in 0..LANES {
                    let [x, y] = [0, 1].map(|d| {
                        let (middle, half) =
                            (f64::from(sums[d][lane]), f64::from(reaches[d][lane]) + largest * lost[lane]);
                        Interval { low: middle - half, high: middle + half }
                    });
                    let products = [x.squared() * (0.5 * share), y.squared() * (0.5 * share), x * y * share];
                    for (sum, product) in strains.iter_mut().zip(products) {
                        sum[lane] = sum[lane] + product;
                    }
                }
            }
            *known = Some((place, strains));
        }
        &known.get_or_insert((place, [[NONE; LANES]; 3])).1
    }
}

impl Coarse {
    fn new(slopes: &Slopes, units: &[f64]) -> Self {
        let scaled = |row: &[f64]| row.iter().zip(units).map(|(s, unit)| (s * unit) as f32).collect::<Vec<_>>();
        let rows: Vec<f32> = slopes.rows().chunks_exact(slopes.fields().max(1)).flat_map(scaled).collect();
        let largest = rows.iter().fold(1.0, |most, s| f64::from(s.abs()).max(most));
        Self { rows, largest }
    }
}
