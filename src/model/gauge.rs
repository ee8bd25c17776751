//! Places whose failure indices are kept over time.

use super::{Builder, NamedCriterion};
use fem_core::failure::Site;
use fem_core::laminate::Laminate;
use fem_core::plate::Plate;
use fem_failure::scan::PlyOrInterface;
use fem_io::scene::{Depth, IndexWatch, SceneError};

/// A place whose indices are kept over time: one cell at one depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Gauge {
    /// The quad: of those that hold the place the one whose centre is nearest, the first of equals, or the one that
    /// represents it in a symmetric plate.
    pub quad: usize,
    /// Ply or interface.
    pub place: PlyOrInterface,
    /// The criteria, by their numbers in the model.
    pub criteria: Vec<usize>,
}

/// Most histories: one picture shows them all, beside a line at failure.
const MOST: usize = 39;

impl Builder<'_> {
    pub(super) fn gauges(
        &self,
        plate: &Plate,
        laminates: &[Laminate],
        watched: &[usize],
        criteria: &[NamedCriterion],
    ) -> Result<Vec<Gauge>, SceneError> {
        let failure = &self.scene.failure;
        if criteria.is_empty() {
            return Ok(Vec::new());
        }
        let gauges = failure.watch.iter().map(|watch| self.gauge(plate, laminates, watched, criteria, watch));
        let gauges = gauges.collect::<Result<Vec<_>, _>>()?;
        let histories: usize = gauges.iter().map(|gauge| gauge.criteria.len()).sum();
        if histories > MOST {
            let message = format!("`failure.watch` asks for {histories} histories, a criterion at a place each");
            let help = format!("name one `criterion` per place, or fewer places: at most {MOST} histories are kept");
            return Err(self.error(&failure.watch[0].at, message, help));
        }
        Ok(gauges)
    }

    fn gauge(
        &self,
        plate: &Plate,
        laminates: &[Laminate],
        watched: &[usize],
        criteria: &[NamedCriterion],
        watch: &IndexWatch,
    ) -> Result<Gauge, SceneError> {
        let (point, _) = self.point(plate, &watch.at)?;
        let mesh = &plate.plane;
        let from_centre = |quad: usize| {
            let c = mesh.corners(quad).centroid();
            (c[0] - point[0]).hypot(c[1] - point[1])
        };
        let is_watched = |q: &usize| watched.binary_search(&plate.symmetry().quad(*q)).is_ok();
        let holds = |q: &usize| mesh.corners(*q).locate(point).is_some();
        let holding = || (0..mesh.quads.len()).filter(is_watched).filter(holds);
        let nearest = holding().map(from_centre).fold(f64::INFINITY, f64::min);
        // At a node of a symmetric mesh several are equally near: the first of them, whatever the last bit says.
        let quad = holding().find(|q| from_centre(*q) <= nearest * (1.0 + 1e-9)).ok_or_else(|| {
            let [x, y] = point.map(|v| v * 1e3);
            let message = format!("({x:.4}, {y:.4}) mm lies in no cell whose stresses are computed");
            self.error(&watch.at, message, "choose a place on the plate and within `failure.radius` of the impact")
        })?;

        let plies = laminates[plate.region(quad)].plies.len();
        let (place, fits) = match watch.depth.value {
            Depth::Ply(k) => (PlyOrInterface::Ply(k as u16), k < plies),
            Depth::Interface(k) => (PlyOrInterface::Interface(k as u16), k + 1 < plies),
        };
        if !fits {
            let message = format!("the laminate has {plies} plies");
            return Err(self.error(&watch.depth, message, "plies are counted from 1 at the bottom"));
        }
        let looks = |k: &usize| {
            let site = criteria[*k].1.info().site;
            // Without a resin the laminate has no interface to look at.
            site == place.site() && (site == Site::Ply || self.scene.interface.is_some())
        };
        let asked = (0..criteria.len()).filter(|k| watch.criterion.is_none_or(|asked| asked == *k));
        let criteria: Vec<usize> = asked.filter(looks).collect();
        if criteria.is_empty() {
            let (places, help) = match place.site() {
                Site::Ply => ("plies", "watch an `interface`, or choose another criterion"),
                Site::Interface => ("interfaces", "watch a `ply`, or choose another criterion"),
            };
            let which = if watch.criterion.is_some() {
                "the criterion named here judges no"
            } else {
                "none of the criteria judges"
            };
            return Err(self.error(&watch.depth, format!("{which} {places}"), help));
        }
        Ok(Gauge { quad: plate.symmetry().quad(quad), place, criteria })
    }
}
