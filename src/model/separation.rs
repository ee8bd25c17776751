//! Interfaces between plies that may open: which, where, and how they hold before they do.

use super::builder::{Builder, build, is_within};
use super::cracks::{CrackRuns, cell_length, extremes};
use crate::effect::Effects;
use crate::registry::{NO_REDUCTION, RegistryError};
use fem_core::assembly::Growth;
use fem_core::constraint::Equation;
use fem_core::element::Element;
use fem_core::interface_law::InterfaceLaw;
use fem_core::interfaces::{InterfaceMaterial, Interfaces, InterfacesError};
use fem_core::laminate::Laminate;
use fem_core::material::{Elastic, Material};
use fem_core::plate::Plate;
use fem_core::plugin::{Built, Dimension, Kind, digits};
use fem_core::ply_law::{LawError, LawPoint};
use fem_core::springs::SupportSpring;
use fem_io::scene::{Analysis, DelaminationSpec, Place, PluginSpec, SceneError, StartingExtent};
use std::collections::{BTreeMap, BTreeSet};

/// What an integrator may miss of it by rounding.
const ROUNDING: f64 = 1e-6;

/// Difference of two distances that is rounding, over the size of the plate.
const SAME_PLACE: f64 = 1e-7;

/// Largest spectral radius for long steps of an integrator under which faces may clap.
const DAMPED: f64 = 0.5;

/// Process zones, and cells, that are open ahead of damage.
const ZONES: f64 = 1.5;

/// Share of Δt² times the stiffness of an interface that damaged faces carry as an added mass (β of the integrators that damp enough).
const ADDED: f64 = 0.4;

/// Added mass above which faces do not come off in time, over that of the plate: at 19 the delaminated area of a coupon was 15 % off, that
/// of a strip at 27 3.5 %, at 108 11 %, and at 430 it was 43 % of what it should have been.
const HEAVY: f64 = 25.0;

/// The same of springs that only push, all together, over the mass of the plate: at 0.08, 0.8 and 8 the force was 4, 7 and 11 % off, as on
/// springs that hold both ways.
const HEAVY_SPRINGS: f64 = 0.1;

/// Jump at which the stiffness of an interface is asked for, m: small against every onset of damage.
const TOUCH: f64 = 1e-15;
const CELLS: f64 = 2.0;

/// Interfaces of a plate that may open.
#[derive(Debug, Clone)]
pub struct Separation {
    /// Cell by cell.
    pub interfaces: Interfaces,
    /// When they open.
    pub growth: Growth,
    /// Supports, and what a symmetry makes of its border.
    pub supports: Vec<Equation>,
    /// Each face between layers of cells that may open, with the number of plies below it.
    pub faces: Vec<(usize, usize)>,
    /// States at the start.
    pub states: Vec<f64>,
    /// Shortest process zone in modes I and II, m, where the law knows it, and the widest cell that may open, m.
    pub zone: Option<([f64; 2], f64)>,
    /// Mass that faces coming off are given by a time step, kg/(m² s²) times its square, and that of the plate, kg/m².
    heavy: [f64; 2],
    /// Quads beside others that may not open.
    pub border: BTreeSet<usize>,
    first: Vec<usize>,
}

impl Separation {
    /// Where the states of each cell of the interfaces begin, and their number at the end.
    pub fn first(&self) -> &[usize] {
        &self.first
    }

    /// Whether something has delaminated at the start.
    pub fn is_cracked(&self) -> bool {
        self.states.iter().any(|state| *state != 0.0)
    }

    /// Number of plies below a face.
    pub fn below(&self, face: usize) -> usize {
        self.faces.iter().find(|(own, _)| *own == face).map_or(0, |(_, below)| *below)
    }

    /// What the user should know of cells against process zones, and of the steps of a march, s.
    pub(super) fn warnings(&self, step: Option<f64>) -> impl Iterator<Item = String> {
        self.wide().into_iter().chain(step.and_then(|step| self.held_together(step)))
    }

    /// The same of `springs` of a plate of this mass, kg.
    pub(super) fn held_down(springs: &[SupportSpring], mass: f64, step: f64) -> Option<String> {
        let stiffness: f64 = springs.iter().filter(|spring| spring.one_sided).map(|spring| spring.stiffness).sum();
        let times = ADDED * step * step * stiffness / mass;
        (times > HEAVY_SPRINGS).then(|| {
            format!(
                "in steps of {} the places where the plate lifts off carry {times:.2} times its mass for the stiffness of what it lies on, \
                 which holds them down: take steps of {}, or {} times that stiffness",
                Dimension::TIME.of(step),
                Dimension::TIME.of(step * (0.5 * HEAVY_SPRINGS / times).sqrt()),
                digits(0.5 * HEAVY_SPRINGS / times)
            )
        })
    }

    fn wide(&self) -> Option<String> {
        let ([opening, shear], cell) = self.zone?;
        let shortest = opening.min(shear);
        (cell > shortest).then(|| {
            format!(
                "interfaces soften over about {} where they open and {} where they slide, and cells up to \
                 {} wide may open: forces ripple, by some 5 % at cells twice as long as that and 10 % at three times; make \
                 them narrower",
                Dimension::LENGTH.of(opening),
                Dimension::LENGTH.of(shear),
                Dimension::LENGTH.of(cell)
            )
        })
    }

    fn held_together(&self, step: f64) -> Option<String> {
        let [added, plate] = self.heavy;
        let times = added * step * step / plate;
        (times > HEAVY).then(|| {
            format!(
                "in steps of {} faces that come off carry {times:.0} times the mass of the plate for the stiffness of the \
                 interface, which holds them together: take steps of {}, or a smaller penalty",
                Dimension::TIME.of(step),
                Dimension::TIME.of(step * (0.2 * HEAVY / times).sqrt())
            )
        })
    }
}

/// Whether a point, m, of a cell is in a delamination; how far a place is from it, m; where it stands in the scene.
type Extent<'s> = (Box<dyn Fn(usize, [f64; 2]) -> bool>, Distance, &'s Place);

/// How far a point is from a delamination, m; negative or zero inside.
type Distance = Box<dyn Fn([f64; 2]) -> f64>;

/// Where a plate is given two sides.
pub(super) struct Split<'a> {
    spec: &'a DelaminationSpec,
    faces: Vec<(usize, usize)>,
    /// The cells at each face.
    quads: Vec<u32>,
}

impl Split<'_> {
    /// The cells that may be damaged, where these are not all.
    pub(super) fn zone(&self) -> Option<&[u32]> {
        self.spec.radius.as_ref().map(|_| &self.quads[..])
    }
}

impl<'a> Builder<'a> {
    /// Lays the layers of cells of `laminate` so that interfaces that may open lie between them, where the scene has none of its own.
    pub(super) fn split(&self, laminates: &mut [Laminate]) -> Result<Option<Split<'a>>, SceneError> {
        let Some(spec) = &self.scene.delamination else { return Ok(None) };
        let [laminate] = laminates else {
            let message = "delaminations that grow are not supported yet in a plate of several laminates";
            return Err(self.error(&spec.law.name, message, "give the plate one laminate, or leave the growth out"));
        };
        let plies = laminate.plies.len();
        let mut below: Vec<usize> = match &spec.interfaces {
            None => laminate.unlike().collect(),
            Some(named) => {
                if let Some(wrong) = named.value.iter().find(|k| k.value + 1 >= plies) {
                    let message = format!("there is no interface {} in a laminate of {plies} plies", wrong.value + 1);
                    let help = format!("interface k lies between the plies k and k + 1: 1 to {}", plies - 1);
                    return Err(self.error(wrong, message, help));
                }
                named.value.iter().map(|k| k.value + 1).collect()
            }
        };
        below.sort_unstable();
        below.dedup();
        let specified = &self.scene.laminates[0];
        if below.is_empty() {
            let message = "all plies are alike, so that no interface may open unless it is named";
            let help = "name some: delamination = { interfaces = [4] }";
            return Err(self.error(&specified.laminate, message, help));
        }
        if !specified.layered {
            let ends = below.iter().copied().chain([plies]);
            let starts = [0].into_iter().chain(below.iter().copied());
            laminate.layers = ends.zip(starts).map(|(end, start)| end - start).collect();
        }
        let mut face_of = vec![None; plies + 1];
        let mut sum = 0;
        for (layer, count) in laminate.layers.iter().enumerate() {
            sum += count;
            face_of[sum] = Some(layer + 1);
        }
        let found = |k: &usize| face_of[*k].map(|face| (face, *k));
        let faces: Vec<(usize, usize)> = below.iter().filter_map(found).collect();
        if faces.len() < below.len() {
            let inside = below.iter().find(|k| face_of[**k].is_none()).copied().unwrap_or_default();
            let message = format!("interface {inside} may open and lies inside a layer of cells");
            let help = "leave `laminate.layers` out, so that layers end where interfaces may open, or name others in \
                        `delamination.interfaces`";
            return Err(self.error(&specified.laminate, message, help));
        }
        Ok(Some(Split { spec, faces, quads: Vec::new() }))
    }

    /// Gives the nodes at the interfaces two sides.
    pub(super) fn separate(&self, split: &mut Split<'_>, plate: &mut Plate) -> Result<(), SceneError> {
        let all = 0..plate.plane.quads.len();
        split.quads = match &split.spec.radius {
            None => all.map(|quad| quad as u32).collect(),
            Some(radius) if self.scene.impact().is_none() => {
                let message = "`delamination.radius` is measured from the impact, and this analysis has none";
                return Err(self.error(radius, message, "leave it out"));
            }
            Some(radius) => {
                let strikes = self.scene.impact().into_iter().flat_map(|impact| &impact.impactors);
                let centres: Vec<[f64; 2]> = strikes
                    .map(|impactor| Ok(self.point(plate, &impactor.at)?.0))
                    .collect::<Result<_, SceneError>>()?;
                let within = is_within(plate, &centres, radius.value);
                let near: Vec<u32> = all.filter(within).map(|quad| quad as u32).collect();
                if near.is_empty() {
                    let message = "no cell has its centre within `delamination.radius` of the impact";
                    return Err(self.error(radius, message, "enlarge the radius or leave it out"));
                }
                near
            }
        };
        split.faces.iter().for_each(|(face, _)| plate.separate(*face, &split.quads));
        Ok(())
    }

    /// The interfaces of a plate that is split.
    pub(super) fn separation(
        &self,
        split: &Split<'_>,
        plate: &Plate,
        element: &dyn Element,
        laminate: &Laminate,
        materials: &[Material],
        supports: Vec<Equation>,
    ) -> Result<Separation, SceneError> {
        let Split { spec, faces, quads } = split;
        let name = &spec.law.name;
        let resin = self.scene.interface.as_ref().map_or(laminate.plies[0].material, |resin| resin.value);
        let law = self.interface_law(&spec.law)?;
        let material = materials[resin].clone();
        let arm = thinnest(laminate, faces);
        let stiffness = material.elastic.stiffness();
        let bending = 12.0 * laminate.effective_bending_stiffness(materials) / laminate.thickness().powi(3);
        let elastic = Elastic { e1: bending, ..material.elastic };
        let runs = CrackRuns::new(plate);
        let widest = quads.iter().map(|quad| runs.through(*quad as usize)).fold(0.0, f64::max);
        let ahead = quads.iter().map(|quad| cell_length(plate, *quad as usize)).fold(widest, f64::max);
        let of = InterfaceMaterial { name: name.value.clone(), law: law.clone(), material };
        let sets: Vec<(usize, Vec<u32>)> = faces.iter().map(|(face, _)| (*face, quads.clone())).collect();
        let interfaces = Interfaces::new(plate, element, of, &sets, spec.points).map_err(|why| match &why {
            InterfacesError::Element => {
                let kind = &self.scene.element.name;
                let message = format!("interfaces of a plate of `{}` cannot open: {why}", kind.value);
                self.error(kind, message, "choose a solid element such as `hermite-prism`")
            }
            InterfacesError::Material(_) => {
                let at = &self.scene.materials[resin];
                let help =
                    "complete the material; or give `laminate.interface` another, with its toughnesses and strengths";
                self.error(at, why.to_string(), help)
            }
            _ => self.error(name, why.to_string(), ""),
        })?;
        let point =
            LawPoint { material: &materials[resin], stiffness: &stiffness, length: widest, thickness: 0.0, means: &[] };
        let zone = law.process_zone(&point, &elastic, arm);
        let shortest = zone.map_or(f64::INFINITY, |[open, slide]| open.min(slide));
        let zones = if shortest.is_finite() { ZONES * shortest } else { 0.0 };
        let margin = spec.margin.unwrap_or((CELLS * ahead).max(zones));
        let growth = Growth { margin, trigger: spec.trigger };
        let mut states = vec![0.0; interfaces.states()];
        self.crack(split, plate, &interfaces, margin, &mut states)?;
        let mut may = vec![false; plate.plane.quads.len()];
        quads.iter().for_each(|quad| may[*quad as usize] = true);
        let mut rim = BTreeSet::new();
        for quad in (0..may.len()).filter(|quad| !may[*quad]) {
            rim.extend(plate.columns_of_quad(quad).iter().copied());
        }
        let touches = |quad: &usize| plate.columns_of_quad(*quad).iter().any(|column| rim.contains(column));
        let border = quads.iter().map(|quad| *quad as usize).filter(touches).collect();
        let first = interfaces.first_states();
        let zone = zone.map(|zone| (zone, widest));
        let stiffness = undamaged(&*law, &point).map_err(|why| self.error(name, why.to_string(), ""))?;
        // No march, no mass.
        let heavy = [ADDED * stiffness, laminate.areal_mass(materials).unwrap_or(f64::INFINITY)];
        Ok(Separation { interfaces, growth, supports, faces: faces.clone(), states, zone, heavy, border, first })
    }

    /// Opens the delaminations that are there at the start.
    fn crack(
        &self,
        Split { spec, faces, .. }: &Split<'_>,
        plate: &Plate,
        interfaces: &Interfaces,
        margin: f64,
        states: &mut [f64],
    ) -> Result<(), SceneError> {
        let first = interfaces.first_states();
        let mut begun: BTreeMap<usize, Vec<(Distance, &Place)>> = BTreeMap::new();
        let symmetry = plate.symmetry();
        let mut images = vec![Vec::new(); plate.plane.quads.len()];
        (0..images.len()).for_each(|quad| images[symmetry.quad(quad)].push(quad));
        for start in &spec.starting {
            let number = start.interface.value + 1;
            let face = faces.iter().find(|(_, below)| *below == number).map(|(face, _)| *face).ok_or_else(|| {
                let known: Vec<String> = faces.iter().map(|(_, below)| below.to_string()).collect();
                let message = format!("interface {number} is none of those that may open");
                self.error(&start.interface, message, format!("they are {}", known.join(", ")))
            })?;
            let (inside, distance, place) = self.extent(plate, &start.extent)?;
            let mut broken = false;
            for (number, cell) in interfaces.cells().iter().enumerate().filter(|(_, cell)| cell.face == face) {
                let own = first[number]..first[number + 1];
                let positions = interfaces.positions(number);
                let within = |quad: usize| positions.iter().any(|p| inside(quad, symmetry.image(plate, quad, *p)));
                if within(cell.quad) || distance(plate.plane.corners(cell.quad).centroid()) < margin {
                    interfaces.crack(number, &mut states[own], |p| inside(cell.quad, p));
                }
                broken = broken || images[cell.quad].iter().any(|quad| within(*quad));
            }
            if !broken {
                let message = "this delamination holds no point of the interface that may open";
                let help = "its centre in the plate and near enough to the impact, its radius more than a cell; or a group of cells";
                return Err(self.scene.source.error_at(place, message, help));
            }
            begun.entry(face).or_default().push((distance, place));
        }
        begun.values().try_for_each(|starts| self.symmetric_starts(plate, starts))
    }

    /// Refuses delaminations of an interface that together lack the symmetry of the plate: they would be others, the images of what lies
    /// in the part that is kept.
    fn symmetric_starts(&self, plate: &Plate, starts: &[(Distance, &Place)]) -> Result<(), SceneError> {
        let away = |quad: usize| {
            let centre = plate.plane.corners(quad).centroid();
            starts.iter().map(|(distance, _)| distance(centre)).fold(f64::INFINITY, f64::min)
        };
        let size = plate.plane.area().sqrt();
        let moved = |quad: usize| (away(quad) - away(plate.symmetry().quad(quad))).abs() > SAME_PLACE * size;
        if (0..plate.plane.quads.len()).any(moved) {
            let message = "the delaminations of this interface lack the `symmetry` of the scene";
            let help = "name their images as well, or leave `symmetry` out: the plate is then computed as a whole";
            return Err(self.scene.source.error_at(starts[0].1, message, help));
        }
        Ok(())
    }

    /// Whether a point of a cell lies in a delamination, and how far a place is from it, m; where it stands in the scene.
    fn extent<'s>(&self, plate: &Plate, extent: &'s StartingExtent) -> Result<Extent<'s>, SceneError> {
        match extent {
            StartingExtent::Disc { at, radius } => {
                let ([x, y], _) = self.point(plate, at)?;
                let (radius, from) = (*radius, move |p: [f64; 2]| (p[0] - x).hypot(p[1] - y));
                Ok((Box::new(move |_, p| from(p) < radius), Box::new(move |p| from(p) - radius), &at.place))
            }
            StartingExtent::Group(name) => {
                let quads: BTreeSet<u32> = self.group(plate, name)?.quads.iter().copied().collect();
                let boxes: Vec<[[f64; 2]; 2]> = quads.iter().map(|quad| extremes(plate, *quad as usize)).collect();
                let from = move |p: [f64; 2]| {
                    let beyond = |b: &[[f64; 2]; 2]| [0, 1].map(|d| (b[0][d] - p[d]).max(p[d] - b[1][d]).max(0.0));
                    boxes.iter().map(beyond).map(|[x, y]| x.hypot(y)).fold(f64::INFINITY, f64::min)
                };
                Ok((Box::new(move |quad, _| quads.contains(&(quad as u32))), Box::new(from), &name.place))
            }
        }
    }

    fn interface_law(&self, spec: &PluginSpec) -> Result<Box<dyn InterfaceLaw>, SceneError> {
        build!(self, spec, InterfaceLaw)
    }

    /// Refuses what does not stand beside delaminations that grow.
    pub(super) fn goes_with_growth(&self, effects: &Effects) -> Result<(), SceneError> {
        let Some(spec) = &self.scene.delamination else { return Ok(()) };
        let name = &spec.law.name;
        let wish = self.scene.effects.delamination.as_ref().map_or(&name.place, |wish| &wish.place);
        let refuse = |place, message: &str, help: &str| Err(self.scene.source.error_at(place, message, help));
        let at_rest = matches!(self.scene.analysis, Analysis::Static(_));
        if self.scene.impact().is_none() && !at_rest {
            let message = "delaminations grow under an impact or loads at rest, and this analysis has none of them";
            return refuse(wish, message, "leave it out");
        }
        if self.scene.substructures.is_some() {
            return refuse(
                wish,
                "condensed `substructures` are linear, and delaminations grow",
                "leave one of them out",
            );
        }
        if let Some(other) = effects.wanted().find(|effect| !effect.goes_with_growth()) {
            let name = other.info().key.name;
            let message = format!("`effects.{name}` does not stand beside delaminations that grow yet");
            return refuse(wish, &message, "leave one of them out");
        }
        let Some(impact) = self.scene.impact() else {
            return self.goes_with_path(effects, wish);
        };
        let reduction = &impact.reduction.name;
        if reduction.value != NO_REDUCTION {
            let help = "march the full plate: reduction = { method = \"none\" }";
            return refuse(&reduction.place, "a reduced plate is linear, and delaminations grow", help);
        }
        let integrator = &impact.march.integrator.name;
        if self.integrator(impact)?.radius_of_long_steps() > DAMPED + ROUNDING {
            let message = format!(
                "`{}` keeps high modes, which faces that close excite until they drown the rest",
                integrator.value
            );
            let help = format!("damp them: integrator = {{ name = \"generalized-alpha\", rho = {DAMPED} }}");
            return Err(self.scene.source.error_at(&integrator.place, message, help));
        }
        Ok(())
    }

    /// Refuses what does not stand beside delaminations that grow under loads at rest.
    fn goes_with_path(&self, effects: &Effects, wish: &Place) -> Result<(), SceneError> {
        if let Some(other) = effects.wanted().next() {
            let message = format!(
                "`effects.{}` does not stand beside delaminations that grow under loads at rest",
                other.info().key.name
            );
            return Err(self.scene.source.error_at(wish, message, "leave one of them out"));
        }
        Ok(())
    }
}

/// Largest stiffness of a virgin interface, Pa/m.
fn undamaged(law: &dyn InterfaceLaw, point: &LawPoint<'_>) -> Result<f64, LawError> {
    let virgin = vec![0.0; law.info().state.len()];
    let (mut new, mut tangent) = (virgin.clone(), [[0.0; 3]; 3]);
    law.respond(point, &[TOUCH, TOUCH, TOUCH], &virgin, &mut new, Some(&mut tangent))?;
    Ok((0..3).map(|k| tangent[k][k]).fold(0.0, f64::max))
}

/// Thickness of the thinnest part of a laminate between two faces that may open, or one of them and the outside, m.
fn thinnest(laminate: &Laminate, faces: &[(usize, usize)]) -> f64 {
    let heights = laminate.boundaries();
    let mut cuts = vec![0];
    cuts.extend(faces.iter().map(|(_, below)| *below));
    cuts.push(laminate.plies.len());
    cuts.windows(2).map(|cut| heights[cut[1]] - heights[cut[0]]).fold(f64::INFINITY, f64::min)
}
