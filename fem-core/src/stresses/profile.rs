//! Stresses along a line through the thickness.

use crate::contracts::element::ElementError;
use crate::plates::plate::Plate;
pub use crate::stresses::around::Mirrors;
use crate::stresses::around::{Neighbour, neighbours};
use crate::stresses::equilibrium::{Balance, Fit};
use crate::stresses::field::{Field, Spot};
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::{Global, Ply, Strain6, Stress6};

/// State at a height of a profile. Interfaces appear twice, once per ply.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfilePoint {
    /// Ply, counted from the bottom.
    pub ply: usize,
    /// Height, m.
    pub z: f64,
    /// Displacement, m.
    pub displacement: [f64; 3],
    /// Stress in the plate's frame from strains, Pa.
    pub global: Stress6<Global>,
    /// The same in the ply's frame, Pa.
    pub in_ply: Stress6<Ply>,
    /// σ₃₃, σ₂₃, σ₃₁ of the plate's frame from equilibrium with the in-plane stresses, Pa.
    pub equilibrium: Option<[f64; 3]>,
    /// The stress with its transverse components by the better way, in the plate's and in the ply's frame, Pa.
    pub better: (Stress6<Global>, Stress6<Ply>),
}

/// A way to transverse stresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// From strains, as the element has them.
    Strains,
    /// From equilibrium with the stresses in the plane.
    Equilibrium,
}

impl Way {
    /// What results call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Strains => "strains",
            Self::Equilibrium => "equilibrium",
        }
    }
}

/// The better way to a transverse stress, and what it misses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The way.
    pub way: Way,
    /// From strains, the largest jump at an interface or difference from what is known at a face; from equilibrium, the part of
    /// the in-plane stresses that the fit misses, or, of shear in a solid whose strains miss little, of the force across. Over the largest such stress.
    pub missed: f64,
}

/// The states along a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// From the bottom up.
    pub points: Vec<ProfilePoint>,
    /// How σ₃₃ was found.
    pub normal: Choice,
    /// How σ₂₃ and σ₃₁ were found.
    pub shear: Choice,
    /// Forces and moments, those across as the shear was found; of a shell those of its strains.
    pub resultants: Resultants,
}

/// Forces and moments per length of what is cut along the lines x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultants {
    /// ∫ σ dz of the components 11, 22, 12, N/m.
    pub membrane: [f64; 3],
    /// ∫ σ z dz of the same, about z = 0, N.
    pub bending: [f64; 3],
    /// ∫ τ dz of the components 31, 23, N/m.
    pub shear: [f64; 2],
}

/// A line through the thickness at a point of the plane.
#[derive(Debug, Clone)]
pub struct Profile {
    /// Quads that meet at the point, with its natural coordinates in each.
    places: Vec<(usize, [f64; 2])>,
    /// Quads of other regions that meet there.
    beyond: usize,
    /// Quads around it, for derivatives.
    around: Vec<Neighbour>,
}

/// Gauss points through a ply for resultants: large strains of cubic displacements are of sixth degree in z.
const PLY_POINTS: usize = 4;

impl Profile {
    /// The line at `point`; `None` outside the plate. Where regions of different plies meet it is in the one of the first cell
    /// that holds the point.
    pub fn at(plate: &Plate, mirrors: &Mirrors, point: [f64; 2]) -> Option<Self> {
        let quads = &plate.plane.quads;
        let place = |q: usize| Some((q, plate.plane.cell(q).locate(point)?));
        let mut places: Vec<(usize, [f64; 2])> = (0..quads.len()).filter_map(place).collect();
        let region = plate.region(places.first()?.0);
        let all = places.len();
        places.retain(|(quad, _)| plate.region(*quad) == region);
        let beyond = all - places.len();
        let around = neighbours(plate, mirrors, point, places.iter().map(|p| p.0).collect());
        Some(Self { places, beyond, around })
    }

    /// The quads that meet at the point.
    pub fn quads(&self) -> impl ExactSizeIterator<Item = usize> {
        self.places.iter().map(|p| p.0)
    }

    /// Whether regions of other plies meet the line, whose stresses are others.
    pub fn is_between_regions(&self) -> bool {
        self.beyond > 0
    }

    /// The state of `field` at `points` heights of every ply, its faces included: means over the cells that meet at the
    /// point. The pressures on the bottom and the top face, Pa, are known.
    ///
    /// With `equilibrium`, and on its own accord where there are cells enough, transverse stresses are also integrated from
    /// the bottom face, where the pressure is p:
    ///
    /// τ(z) = −∫ (∂σ₁₁/∂x + ∂σ₁₂/∂y) dz, likewise along y;  σ₃₃(z) = −p − ∫ (∂τ₁₃/∂x + ∂τ₂₃/∂y) dz
    ///
    /// The in-plane derivatives are those of a bicubic fitted to the stresses in the centres of the cells around the point,
    /// where the parts of a displacement that an element interpolates linearly have their best slopes; behind an edge of
    /// symmetry lie their images. What τ misses at the stress-free top is taken off linearly, what σ₃₃ misses of the
    /// pressure there as s² (3 − 2s), s the height over the thickness.
    ///
    /// Where both ways are there and the cells around tell a bicubic, σ₃₃ is that from equilibrium. So is shear in a shell,
    /// which meets faces and interfaces even where it is wrong; in a solid it is that which misses less ([`Choice`]): of equilibrium
    /// what its fit misses, or, where strains miss less than 1 %, its force across of theirs.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn sample(
        &self,
        field: &Field<'_>,
        points: usize,
        equilibrium: Option<bool>,
        pressures: [f64; 2],
    ) -> Result<Sampled, ElementError> {
        let laminate = field.laminate(self.places[0].0);
        let z = laminate.boundaries();
        let mut all = Vec::new();
        for ply in 0..laminate.plies.len() {
            for i in 0..points.max(2) {
                let share = i as f64 / (points.max(2) - 1) as f64;
                let height = z[ply] + share * (z[ply + 1] - z[ply]);
                let (global, displacement) = self.mean(field, ply, height)?;
                let in_ply = global.to_ply(laminate.plies[ply].angle);
                let better = (global, in_ply);
                all.push(ProfilePoint { ply, z: height, displacement, global, in_ply, equilibrium: None, better });
            }
        }
        let fit = Fit::new(&self.around, field.plate().info().is_section());
        let balance = match equilibrium.unwrap_or(fit.determined) {
            true => {
                let heights: Vec<_> = all.iter().map(|p| (p.ply, p.z)).collect();
                Some(fit.integrate(field, pressures, &heights)?)
            }
            false => None,
        };
        for (point, found) in all.iter_mut().zip(balance.iter().flat_map(|b| &b.stresses)) {
            point.equilibrium = Some(*found);
        }
        let trusted = balance.as_ref().filter(|_| fit.determined);
        let (mut resultants, shell) = (self.resultants(field)?, field.plate().info().is_shell());
        let (normal, shear) = choose(&all, trusted, pressures, resultants.shear, shell);
        if let Some(balance) = trusted.filter(|_| shear.way == Way::Equilibrium && !shell) {
            resultants.shear = balance.forces;
        }
        for point in &mut all {
            let Some(found) = point.equilibrium else { continue };
            for (k, choice) in [normal, shear, shear].into_iter().enumerate() {
                if choice.way == Way::Equilibrium {
                    point.better.0.0[TRANSVERSE[k]] = found[k];
                }
            }
            point.better.1 = point.better.0.to_ply(laminate.plies[point.ply].angle);
        }
        Ok(Sampled { points: all, normal, shear, resultants })
    }

    /// Forces and moments per length of the stresses of strains, integrated through every ply exactly.
    fn resultants(&self, field: &Field<'_>) -> Result<Resultants, ElementError> {
        let mut sum = Resultants { membrane: [0.0; 3], bending: [0.0; 3], shear: [0.0; 2] };
        for (ply, z) in field.laminate(self.places[0].0).boundaries().windows(2).enumerate() {
            let half = 0.5 * (z[1] - z[0]);
            for &(t, w) in gauss_legendre(PLY_POINTS) {
                let height = z[0] + half * (1.0 + t);
                let (s, _) = self.mean(field, ply, height)?;
                for (k, s) in [s.s11(), s.s22(), s.s12()].into_iter().enumerate() {
                    sum.membrane[k] += half * w * s;
                    sum.bending[k] += half * w * s * height;
                }
                sum.shear[0] += half * w * s.s31();
                sum.shear[1] += half * w * s.s23();
            }
        }
        Ok(sum)
    }

    /// Mean stress and displacement over the cells that meet at the point.
    fn mean(&self, field: &Field<'_>, ply: usize, z: f64) -> Result<(Stress6<Global>, [f64; 3]), ElementError> {
        let n = self.places.len() as f64;
        let (mut strain, mut displacement) = ([0.0; 6], [0.0; 3]);
        for &(quad, at) in &self.places {
            let (e, d) = field.at(Spot { quad, at, ply, z })?;
            strain.iter_mut().zip(e.0).for_each(|(m, e)| *m += e / n);
            displacement.iter_mut().zip(d).for_each(|(m, d)| *m += d / n);
        }
        Ok((field.stress(self.places[0].0, (ply, z), &Strain6::new(strain)), displacement))
    }
}

/// Shear below this share of what the stresses around make is small where it is, as by symmetry, and its errors with it.
const NOTABLE: f64 = 0.1;

/// Places of σ₃₃, σ₂₃, σ₃₁ in the order of stresses.
const TRANSVERSE: [usize; 3] = [2, 4, 5];

/// What strains miss at most where their force across counts as known: those of a thin plate in wide cells miss faces and force.
const SURE: f64 = 0.01;

/// The better ways to σ₃₃ and to shear.
fn choose(
    points: &[ProfilePoint],
    balance: Option<&Balance>,
    [bottom, top]: [f64; 2],
    forces: [f64; 2],
    shell: bool,
) -> (Choice, Choice) {
    let [s33, s23, s31] = TRANSVERSE;
    let largest =
        |of: &[usize]| points.iter().flat_map(|p| of.iter().map(|k| p.global.0[*k].abs())).fold(0.0, f64::max);
    // What strains miss, Pa.
    let missed = |k: usize, [bottom, top]: [f64; 2]| {
        let between = points.windows(2).filter(|pair| pair[0].ply != pair[1].ply);
        let jumps = between.map(|pair| (pair[1].global.0[k] - pair[0].global.0[k]).abs());
        let faces = points.first().map(|p| p.global.0[k] + bottom).into_iter();
        let faces = faces.chain(points.last().map(|p| p.global.0[k] + top)).map(f64::abs);
        jumps.chain(faces).fold(0.0, f64::max)
    };
    let share = |missed: f64, scale: f64| if missed == 0.0 { 0.0 } else { missed / scale };
    let scale = balance.map_or(0.0, |b| NOTABLE * b.scale[0]);
    let shear = Choice {
        way: Way::Strains,
        missed: share(missed(s23, [0.0; 2]).max(missed(s31, [0.0; 2])), largest(&[s23, s31]).max(scale)),
    };
    let normal = Choice {
        way: Way::Strains,
        missed: share(missed(s33, [bottom, top]), largest(&[s33]).max(bottom.abs()).max(top.abs())),
    };
    let Some(balance) = balance else { return (normal, shear) };
    let fitted = Choice { way: Way::Equilibrium, missed: balance.misfit };
    // Of a pressure that goes straight through, little comes from changes in the plane; where none is, shear is what counts.
    let [shear_scale, normal_scale] = balance.scale;
    let pressure = bottom.abs().max(top.abs());
    let part = share(normal_scale, if pressure > 0.0 { pressure } else { shear_scale }).min(1.0);
    let normal = Choice { missed: fitted.missed * part, ..fitted };
    if shell || shear.missed > SURE {
        return (normal, if shell || fitted.missed < shear.missed { fitted } else { shear });
    }
    // Strains that meet all faces have the force across: beside an edge slopes may be off by a constant share that no fit shows.
    let height = points.last().map_or(0.0, |p| p.z) - points.first().map_or(0.0, |p| p.z);
    let size = forces.iter().chain(&balance.forces).fold(scale * height, |most, force| most.max(force.abs()));
    let apart = forces.iter().zip(balance.forces).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let fitted = Choice { missed: fitted.missed.max(share(apart, size)), ..fitted };
    (normal, if fitted.missed < shear.missed { fitted } else { shear })
}
