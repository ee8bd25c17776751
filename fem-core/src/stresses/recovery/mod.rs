//! Stresses of plies and interfaces from displacements.

mod cubic;
mod slopes;

pub use slopes::Tension;

use crate::contracts::element::{Element, ElementError, ElementInfo, Part, Point, Scratch, Stack, form};
use crate::plates::laminate::Laminate;
use crate::plates::laws::{Asked, CellAnswer, CellOperators, Patterns, PlyLaws};
use crate::plates::plate::Plate;
use crate::plates::window::{Centre, Mean, Source};
use crate::words::material::Material;
use crate::words::tensor::{Matrix6, Ply, Stress6, strain_rotation};
use pulp::{Arch, Simd, WithSimd};
use std::borrow::Cow;
use std::ops::Range;

/// Where in its height a ply is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlyHeights {
    /// By its mean (report eq. 12), which holds nothing of the bending across the ply.
    Mean,
    /// At both faces, where stresses of bending are largest, and in the middle, where those of shear are.
    Faces,
    /// As [`PlyHeights::Faces`] where the ply is thicker than an eighth of its laminate, by its mean otherwise: that of an outer
    /// ply is below the stress at its face by its share of the thickness, if the laminate is bent and all plies are alike.
    Auto,
}

impl PlyHeights {
    /// Largest share of its laminate that a ply of [`PlyHeights::Auto`] has to be judged by its mean; eight equal plies are.
    const THIN: f64 = 0.125 * (1.0 + 1e-6);

    /// Parts of a ply between the natural heights `q` that is so large a `share` of its laminate.
    fn parts(self, q: [f64; 2], share: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Faces => {}
            Self::Auto if share > Self::THIN => {}
            Self::Mean | Self::Auto => return vec![q],
        }
        [q[0], 0.5 * (q[0] + q[1]), q[1]].map(|q| [q, q]).to_vec()
    }

    /// At how many heights the plies of `laminate` are judged, all together.
    pub fn sites(self, laminate: &Laminate) -> usize {
        let thickness = laminate.thickness();
        laminate.plies.iter().map(|ply| self.parts([-1.0, 1.0], ply.thickness / thickness).len()).sum()
    }
}

/// Strains that stresses follow from, where a displacement field is recovered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strains {
    /// Those of small displacements.
    Small,
    /// Green and Lagrange's, of the element. They are wrong for displacements that do not answer all of them: where a plate turns by θ
    /// it thins by ½ θ² across, and one in few vectors has no displacement for that, only a [`Tension`].
    Large,
}

/// Where in the thickness a stress is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Layer of cells, counted from the bottom of its region.
    pub layer: usize,
    /// Ply (or, for an interface, the ply below it), counted from the bottom of its region.
    pub ply: usize,
    /// True for the resin between `ply` and the one above.
    pub interface: bool,
    /// Height, m: of the interface, or in the ply.
    pub z: f64,
    /// Angle of the axes of the stress, radians.
    pub angle: f64,
    /// Material.
    pub material: usize,
    part: Part,
    /// The other side of an interface within a layer whose strains jump from ply to ply: the resin takes the mean of both.
    beside: Option<Part>,
    /// Strain in the plate's frame to stress in the station's.
    to_stress: Matrix6,
}

impl Station {
    /// The ply, or the face of the ply below or above an interface, among those of its layer.
    pub fn part(&self) -> &Part {
        &self.part
    }

    /// Parts of the cell whose strains are taken, each with its share.
    fn parts(&self) -> impl Iterator<Item = (Part, f64)> + use<> {
        let share = if self.beside.is_some() { 0.5 } else { 1.0 };
        [Some(self.part), self.beside].into_iter().flatten().map(move |part| (part, share))
    }
}

/// Stresses of every ply (report eqs 12, 13: means, or at its [heights](PlyHeights)) and at every interface (eq. 14), for a set of windows, each of which lies in one region.
///
/// Sites are ordered window by window, each with all stations from the bottom up. Interfaces between layers of cells are taken
/// from both sides, because derivatives may jump there, and so are those within a shell, whose shear strains jump between plies.
#[derive(Debug, Clone)]
pub struct Recovery {
    /// Stations through the thickness of every region.
    regions: Vec<Vec<Station>>,
    /// Region of each window.
    region_of: Vec<usize>,
    /// First site of each window, and the number of all at the end.
    starts: Vec<usize>,
    /// Where each window lies.
    pub centres: Vec<Centre>,
    /// Shares of each window, by positions in `sources`.
    windows: Vec<Vec<(usize, f64)>>,
    /// Whose strains are needed.
    sources: Vec<Source>,
    strains: Strains,
}

impl Recovery {
    /// Watches `windows`. Interfaces are watched when the resin between plies is given. `laminates` are those of the regions of the plate.
    pub fn new(
        plate: &Plate,
        (laminates, heights): (&[Laminate], PlyHeights),
        materials: &[Material],
        resin: Option<usize>,
        windows: &[Mean],
    ) -> Self {
        let mut sources: Vec<Source> = windows.iter().flat_map(|window| window.shares.iter().map(|s| s.0)).collect();
        sources.sort_unstable();
        sources.dedup();
        let position = |source: &Source| sources.partition_point(|s| s < source);
        let shares = |window: &Mean| window.shares.iter().map(|(source, share)| (position(source), *share)).collect();
        let centres: Vec<Centre> = windows.iter().map(|window| window.centre).collect();
        let of_region = |(region, laminate)| stations(plate, region, (laminate, heights), materials, resin);
        let regions: Vec<Vec<Station>> = laminates.iter().enumerate().map(of_region).collect();
        let region_of: Vec<usize> = centres.iter().map(|centre| plate.region(centre.quad)).collect();
        let windows = windows.iter().map(shares).collect();
        let mut starts = vec![0];
        region_of.iter().for_each(|region| starts.push(starts[starts.len() - 1] + regions[*region].len()));
        Self { regions, region_of, starts, centres, windows, sources, strains: Strains::Small }
    }

    /// The same of other strains.
    #[must_use]
    pub fn of(self, strains: Strains) -> Self {
        Self { strains, ..self }
    }

    /// Stations over the `i`-th window.
    pub fn stations_over(&self, i: usize) -> &[Station] {
        &self.regions[self.region_of[i]]
    }

    /// Region of the `i`-th window.
    pub fn region_over(&self, i: usize) -> usize {
        self.region_of[i]
    }

    /// Stations of a region.
    pub fn stations_of(&self, region: usize) -> &[Station] {
        &self.regions[region]
    }

    /// Sites over the `i`-th window, one for each of [`Recovery::stations_over`].
    pub fn sites_over(&self, i: usize) -> Range<usize> {
        self.starts[i]..self.starts[i + 1]
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.starts[self.centres.len()]
    }

    /// First strain of each source, counted in stations of its region, and the number of all at the end.
    fn places(&self, plate: &Plate) -> Vec<usize> {
        let mut places = vec![0];
        for source in &self.sources {
            places.push(places[places.len() - 1] + self.regions[plate.region(source.quad)].len());
        }
        places
    }

    /// Stresses for several displacement fields at once: `u` is `ndof × fields` (before elimination of constraints), `out`
    /// is `6·sites × fields`; six components per site in the site's axes, which under large deflections turn with the plate.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn stresses(
        &self,
        plate: &Plate,
        element: &dyn Element,
        u: &[f64],
        fields: usize,
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        match self.strains {
            Strains::Small => self.small_stresses(plate, element, u, fields, out),
            Strains::Large => self.large_stresses(plate, element, u, fields, out),
        }
    }

    /// Those of small displacements, whatever the strains.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn small_stresses(
        &self,
        plate: &Plate,
        element: &dyn Element,
        u: &[f64],
        fields: usize,
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        let form_over = |source: &Source| form(element, plate.plane.quads[source.quad].domain());
        let cubics: Option<Vec<_>> = self.sources.iter().map(|source| form_over(source).cubic_strains()).collect();
        if let Some(elements) = cubics {
            return self.stresses_of_cubics(plate, &elements, u, fields, out);
        }
        let places = self.places(plate);
        let mut strains = vec![0.0; 6 * places[self.sources.len()] * fields];
        let mut rest = strains.as_mut_slice();
        let (mut operators, mut scratch, mut dofs) = (Vec::new(), Scratch::default(), Vec::new());
        let mut local = Vec::new();
        let layers = self.parts_of_layers();
        for source in &self.sources {
            let element = form_over(source);
            let (quad, plane, n) = (source.quad, points(element.info(), *source), element.info().ndof());
            local.resize(n * fields, 0.0);
            for (layer, Parts { parts, shares, stations }) in layers[plate.region(quad)].iter().enumerate() {
                let number = plate.cell_over(quad, layer);
                let cell = plate.cell(number);
                operators.resize(6 * n * parts.len(), 0.0);
                element.mean_strains(&cell, parts, &plane, &mut scratch, &mut operators)?;
                plate.cell_dofs(number, &mut dofs);
                // Fields run fastest here and in the strains: one operation serves several of them.
                for (dof, local) in dofs.iter().zip(local.chunks_exact_mut(fields)) {
                    let of_dof = u[*dof..].iter().step_by(plate.ndof());
                    local.iter_mut().zip(of_dof).for_each(|(local, u)| *local = *u);
                }
                let (of_layer, next) = rest.split_at_mut(6 * fields * stations);
                rest = next;
                for (operator, (station, share)) in operators.chunks_exact_mut(6 * n).zip(shares) {
                    let here = &mut of_layer[6 * fields * station..6 * fields * (station + 1)];
                    if *share < 1.0 {
                        operator.iter_mut().for_each(|b| *b *= share);
                    }
                    if let Ok(strain) = <&mut [f64; 6]>::try_from(&mut *here) {
                        add_product(operator, &local, strain);
                        continue;
                    }
                    Arch::new().dispatch(AddProducts { operator, local: &local, fields, strains: here });
                }
            }
        }
        self.averaged(&places, &strains, fields, out);
        Ok(())
    }

    /// Stresses S = C E.
    fn large_stresses(
        &self,
        plate: &Plate,
        element: &dyn Element,
        u: &[f64],
        fields: usize,
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        let layers = self.parts_of_layers();
        let places = self.places(plate);
        let mut strains = vec![0.0; 6 * places[self.sources.len()] * fields];
        let (mut rest, mut dofs, mut local, mut of_parts) =
            (strains.as_mut_slice(), Vec::new(), Vec::new(), Vec::new());
        for source in &self.sources {
            let element = form(element, plate.plane.quads[source.quad].domain());
            let Some(large) = element.large_deflections() else { return Err(ElementError(NO_LARGE.into())) };
            let (quad, plane) = (source.quad, points(element.info(), *source));
            for (layer, Parts { parts, shares, stations }) in layers[plate.region(quad)].iter().enumerate() {
                let number = plate.cell_over(quad, layer);
                plate.cell_dofs(number, &mut dofs);
                local.resize(dofs.len() * fields, 0.0);
                for (local, u) in local.chunks_exact_mut(dofs.len()).zip(u.chunks_exact(plate.ndof())) {
                    local.iter_mut().zip(&dofs).for_each(|(local, dof)| *local = u[*dof]);
                }
                of_parts.resize(6 * parts.len() * fields, 0.0);
                large.mean_large_strains(&plate.cell(number), parts, &plane, &local, &mut of_parts)?;
                let (here, next) = rest.split_at_mut(6 * stations * fields);
                for (field, of_parts) in of_parts.chunks_exact(6 * parts.len()).enumerate() {
                    for (strain, (station, share)) in of_parts.chunks_exact(6).zip(shares) {
                        let means = here[6 * station * fields + field..].iter_mut().step_by(fields);
                        means.zip(strain).for_each(|(mean, e)| *mean += share * e);
                    }
                }
                rest = next;
            }
        }
        self.averaged(&places, &strains, fields, out);
        Ok(())
    }

    /// Puts the stresses of plies that follow `laws` in place of those of linear elasticity: means over the Gauss points of
    /// their cells, whatever the samples, at the displacements `u` (one field, before elimination of constraints) and the states `points`;
    /// with the strains of its `tension` where it has one. Where a symmetry leaves a part of the plate, the rest has its images.
    ///
    /// # Errors
    /// A cell that the element refuses, a law that finds no stress.
    pub fn put_lawful(
        &self,
        plate: &Plate,
        element: &dyn Element,
        laws: &PlyLaws,
        (u, points, tension): (&[f64], &[f64], Option<Tension<'_>>),
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        let (mut means, mut firsts) = (Vec::new(), Vec::new());
        let (mut answer, mut dofs) = (CellAnswer::default(), Vec::new());
        let mut images = Vec::new();
        for Source { quad, .. } in &self.sources {
            firsts.push(means.len());
            images.push(plate.symmetry().operation(plate, *quad));
            for cell in plate.cells_over(plate.symmetry().quad(*quad)) {
                plate.cell_dofs(cell, &mut dofs);
                let local: Vec<f64> = dofs.iter().map(|dof| u[*dof]).collect();
                let states = &points[laws.states_of(cell)];
                let operators = CellOperators::new(element, &plate.cell(cell))?;
                let strains = tension.map(|tension| tension.of_cell(plate, element, cell));
                let stretched = strains.as_ref().map(|strains| Patterns { strains, amounts: &[1.0] });
                let asked = Asked { plate, element, cell, operators: &operators, u: &local, stretched, states };
                laws.respond(asked, false, &mut answer)?;
                means.push(answer.means.clone());
            }
        }
        for (i, window) in self.windows.iter().enumerate() {
            let sites = self.sites_over(i);
            let out = out[6 * sites.start..6 * sites.end].chunks_exact_mut(6);
            for (station, out) in self.stations_over(i).iter().zip(out) {
                let of = |source: &usize| means[firsts[*source] + station.layer][station.part.slice];
                let lawful = !station.interface && window.iter().any(|(source, _)| of(source).1 > 0.0);
                if lawful {
                    out.fill(0.0);
                    for (source, share) in window {
                        let mean = match images[*source] {
                            None => of(source).0,
                            Some(image) => {
                                let kept = Stress6::<Ply>::new(of(source).0).to_global(station.angle);
                                image.stress(&kept).to_ply(station.angle).0
                            }
                        };
                        out.iter_mut().zip(mean).for_each(|(s, mean)| *s += share * mean);
                    }
                }
            }
        }
        Ok(())
    }

    /// What is asked of the cells of each layer, region by region.
    fn parts_of_layers(&self) -> Vec<Vec<Parts>> {
        let of_layer = |stations: &[Station]| {
            let all =
                stations.iter().enumerate().flat_map(|(at, s)| s.parts().map(move |(part, share)| (part, (at, share))));
            let (parts, shares) = all.unzip();
            Parts { parts, shares, stations: stations.len() }
        };
        let of_region = |stations: &Vec<Station>| stations.chunk_by(|a, b| a.layer == b.layer).map(of_layer).collect();
        self.regions.iter().map(of_region).collect()
    }

    /// Stresses of the strains of the sources, averaged over windows; several fields, which run fastest among the strains.
    fn averaged(&self, places: &[usize], strains: &[f64], fields: usize, out: &mut [f64]) {
        let mut mean = vec![0.0; 6 * fields];
        for (i, window) in self.windows.iter().enumerate() {
            for (s, station) in self.stations_over(i).iter().enumerate() {
                mean.fill(0.0);
                for (source, share) in window {
                    let at = (places[*source] + s) * 6 * fields;
                    mean.iter_mut().zip(&strains[at..]).for_each(|(m, e)| *m += share * e);
                }
                for field in 0..fields {
                    let strain = std::array::from_fn(|c| mean[c * fields + field]);
                    let at = 6 * (field * self.sites() + self.starts[i] + s);
                    out[at..at + 6].copy_from_slice(&crate::words::tensor::apply(&station.to_stress, &strain));
                }
            }
        }
    }
}

const NO_LARGE: &str = "the element knows no large deflections";

/// Points of the plane over which the strains of a source are means.
fn points(info: &ElementInfo, source: Source) -> Cow<'static, [Point]> {
    match source.sample {
        None => Cow::Borrowed(info.plane()),
        Some(k) => Cow::Owned(vec![info.domain.samples()[k]]),
    }
}

/// Parts of the cells of a layer; of each the station that it belongs to, and its share there.
struct Parts {
    parts: Vec<Part>,
    shares: Vec<(usize, f64)>,
    stations: usize,
}

/// What a strain operator makes of several fields, which run fastest.
struct AddProducts<'a> {
    operator: &'a [f64],
    local: &'a [f64],
    fields: usize,
    strains: &'a mut [f64],
}

impl WithSimd for AddProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { operator, local, fields, strains } = self;
        for (column, local) in operator.chunks_exact(6).zip(local.chunks_exact(fields)) {
            for (b, strain) in column.iter().zip(strains.chunks_exact_mut(fields)) {
                if *b != 0.0 {
                    strain.iter_mut().zip(local).for_each(|(e, u)| *e += b * u);
                }
            }
        }
    }
}

/// What a strain operator makes of one field.
fn add_product(operator: &[f64], u: &[f64], strain: &mut [f64; 6]) {
    for (column, u) in operator.as_chunks::<6>().0.iter().zip(u) {
        strain.iter_mut().zip(column).for_each(|(e, b)| *e += b * u);
    }
}

fn stations(
    plate: &Plate,
    region: usize,
    (laminate, heights): (&Laminate, PlyHeights),
    materials: &[Material],
    resin: Option<usize>,
) -> Vec<Station> {
    let stacks = plate.stacks(region);
    let z = laminate.boundaries();
    let thickness = laminate.thickness();
    let product = |c: &Matrix6, angle: f64| -> Matrix6 {
        let r = strain_rotation(angle);
        std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| c[i][k] * r[k][j]).sum()))
    };
    let mut all = Vec::new();
    for (layer, Stack { slices, transverse, .. }) in stacks.iter().enumerate() {
        let range = laminate.plies_of(layer);
        let (first, end) = (range.start, range.end);
        let shares = transverse.is_some() && !plate.info().is_shell();
        let interface = |below: usize, slice: usize, q: f64| {
            resin.map(|material| Station {
                layer,
                ply: below,
                interface: true,
                z: z[below + 1],
                angle: 0.0,
                material,
                part: Part { slice, q: [q, q] },
                beside: (shares && q > -1.0 && q < 1.0).then_some(Part { slice: slice + 1, q: [q, q] }),
                to_stress: materials[material].elastic.stiffness(),
            })
        };
        if first > 0 {
            all.extend(interface(first - 1, 0, -1.0));
        }
        for k in range {
            let ply = &laminate.plies[k];
            let slice = &slices[k - first];
            if k > first && plate.info().is_shell() {
                all.extend(interface(k - 1, k - first, slice.q[0]));
            }
            let to_stress = product(&materials[ply.material].elastic.stiffness(), ply.angle);
            let [low, high] = slice.q;
            let of_part = |q: [f64; 2]| Station {
                layer,
                ply: k,
                interface: false,
                z: z[k] + (z[k + 1] - z[k]) * (0.5 * (q[0] + q[1]) - low) / (high - low),
                angle: ply.angle,
                material: ply.material,
                part: Part { slice: k - first, q },
                beside: None,
                to_stress,
            };
            all.extend(heights.parts(slice.q, ply.thickness / thickness).into_iter().map(of_part));
            if k + 1 < end || end < laminate.plies.len() {
                all.extend(interface(k, k - first, slice.q[1]));
            }
        }
    }
    all
}
