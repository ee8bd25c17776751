//! A full plate whose deflections stretch it.

use super::membrane::{InPlane, TensionPatterns};
use super::{Companions, MembraneForms, MembranePlate, Reduced, Ritz};
use crate::vector::{axpy, dot};
use fem_core::energy::Energy;
use fem_core::functional::Functional;
use fem_core::reduction::{Reduction, ReductionError};
use fem_core::springs::SupportSpring;
use fem_core::structure::{Nonlinear, SolveError, Stretching, Structure};
use std::sync::Arc;

/// The fastest modes of the share of the displacements that stretches a plate, in radians a step: those that explicit steps would follow.
const FASTEST: f64 = 2.0;

/// Share of the static deflection under a contact that these modes hold, at least: with less of it they are no measure of how the plate
/// stretches. One mode held 83 % on a plate of 48 x 40 x 3 mm at 25 us; of the coupons of `benches/t700-m21` 96 % are held at 4 us.
const HELD: f64 = 0.9;

/// What is in the way where they do not.
const TOO_LONG: &str = "the step is too long for the deflections that stretch the plate, most of which vibrate faster than it can follow: \
                        shorten `march.step`, or leave `effects.membrane` out";

/// Static deflections under unit forces at the contacts.
fn flexibilities(reduced: &Reduced, contacts: &[Functional]) -> Vec<f64> {
    let of = |contact| reduced.restrict(contact).iter().zip(reduced.modal.compliances()).map(|(p, c)| p * c * p).sum();
    contacts.iter().map(of).collect()
}

/// How a full plate is stretched: as its share in few vectors Φ is, with Φᵀ M Φ = 1.
///
/// Tension follows the deflection of the plate as a whole, which few vectors hold; what they leave out, ripples beside the contact or
/// two faces that move apart, stretches nothing. In its plane the plate follows at once as one that holds together; what its layers carry
/// over to each other for that, Σ b_t r_t, acts on their displacements where they come apart.
#[derive(Debug, Clone)]
pub struct Stretch {
    membrane: MembranePlate,
    share: Arc<Share>,
}

/// The share q = Φᵀ M u of displacements in the vectors Φ, and what the stretching adds to u.
#[derive(Debug)]
pub struct Share {
    /// M Φ, `ndof × modes`.
    weights: Vec<f64>,
    modes: usize,
    companions: Companions,
}

impl Share {
    fn of(&self, u: &[f64], q: &mut [f64]) {
        q.iter_mut().zip(self.weights.chunks_exact(u.len())).for_each(|(q, column)| *q = dot(column, u));
    }

    /// q
    pub fn coordinates(&self, u: &[f64]) -> Vec<f64> {
        let mut q = vec![0.0; self.modes];
        self.of(u, &mut q);
        q
    }

    /// What its membrane stresses are made of.
    pub fn patterns(&self) -> &Arc<TensionPatterns> {
        self.companions.patterns()
    }

    /// Adds to the displacements `u` of the full plate what it does in its plane, and through its thickness, because it is stretched.
    pub fn complete(&self, u: &mut [f64]) {
        let mut q = vec![0.0; self.modes];
        self.of(u, &mut q);
        self.companions.complete(self.modes, &q, u);
    }
}

impl Stretching for Share {
    fn deflections(&self) -> &[f64] {
        &self.companions.patterns().deflections
    }

    fn combinations(&self) -> &[f64] {
        &self.companions.patterns().combinations
    }

    fn expand(&self, u: &[f64], completed: &mut [f64], amounts: &mut Vec<f64>) {
        let mut q = vec![0.0; self.modes];
        self.of(u, &mut q);
        completed.copy_from_slice(u);
        let follow = &self.companions.patterns().follow;
        amounts.clear();
        amounts.extend(follow.amounts(&q));
        amounts.iter().zip(follow.shapes().chunks_exact(u.len())).for_each(|(b, shape)| axpy(*b, shape, completed));
    }

    fn tear(&self, u: &[f64], force: &mut [f64]) {
        let mut q = vec![0.0; self.modes];
        self.of(u, &mut q);
        let amounts: Vec<f64> = self.companions.patterns().follow.amounts(&q).collect();
        self.companions.patterns().torn.add(&amounts, force);
    }

    fn restrict(&self, u: &[f64], on_completed: &[f64], on_amounts: &[f64], force: &mut [f64]) {
        let (mut q, mut g) = (vec![0.0; self.modes], vec![0.0; self.modes]);
        self.of(u, &mut q);
        let follow = &self.companions.patterns().follow;
        let works = on_amounts
            .iter()
            .zip(follow.shapes().chunks_exact(u.len()))
            .map(|(own, shape)| own + dot(shape, on_completed));
        follow.add_works(&q, works, &mut g);
        axpy(1.0, on_completed, force);
        g.iter().zip(self.weights.chunks_exact(u.len())).for_each(|(g, column)| axpy(*g, column, force));
    }
}

impl Stretch {
    /// Vectors that a plate needs of which a `symmetry` leaves a part, or that is whole.
    ///
    /// A plate that breaks asks for many: the force of `benches/t700-m21/scene-25J.toml`, a half, at 0.8 ms is 3.8 % off with 30, 0.3 % with
    /// 60 and 0.01 % with 90, against 140. Of a whole plate rounding makes many vectors antisymmetric, and a blow beside its middle needs
    /// those: one of 48 x 40 x 1.2 mm, deflected by three thicknesses, is 2.4 % off with 90 in the force and 22 % in the area that comes
    /// off, 0.2 % and 0.3 % with 250, against its quarter, which 60 and 90 leave alike.
    pub fn vectors(symmetry: bool) -> usize {
        if symmetry { 90 } else { 250 }
    }

    /// Finds the stretching of `structure`, which lies on `springs` and is struck at `contacts`, for steps of `step`, s, as its share in so
    /// many `vectors` has it.
    ///
    /// # Errors
    /// A structure that is not held, or that its tension bends; a step too long for it; a cell that cannot be integrated.
    pub fn new(
        structure: &mut dyn Structure,
        (contacts, springs): (&[Functional], &[SupportSpring]),
        (step, vectors): (f64, usize),
        stretching: &dyn MembraneForms,
    ) -> Result<Self, ReductionError> {
        let basis = Ritz::krylov(vectors).basis(structure, contacts, &[])?;
        let reduced = Reduced::project(structure, &basis)?;
        drop(basis);
        let all = flexibilities(&reduced, contacts);
        let reduced = reduced.up_to(FASTEST / step);
        if flexibilities(&reduced, contacts).iter().zip(&all).any(|(kept, all)| !(*kept >= HELD * all)) {
            return Err(ReductionError::Solve(SolveError::other(TOO_LONG)));
        }
        let (membrane, companions) =
            MembranePlate::with_plane(structure, &reduced, (contacts, springs), stretching, InPlane::AtOnce)?;
        let mut weights = vec![0.0; reduced.basis.len()];
        structure.add_mass(1.0, &reduced.basis, &mut weights);
        let share = Share { weights, modes: reduced.modal.ndof(), companions };
        Ok(Self { membrane, share: Arc::new(share) })
    }

    /// Its share in the vectors.
    pub fn share(&self) -> Arc<Share> {
        self.share.clone()
    }
}

/// A full plate with the forces of its stretching: f(u) + M Φ g + Σ b_t r_t, g(Φᵀ M u, r_tᵀ u) those of the [`MembranePlate`] beside its
/// modes', r_t what its stresses do on layers that come apart.
///
/// They have a potential and are smooth in space. The plate is one whose steps take the undamaged K in the place of a tangent: its tension
/// is explicit in them, stable while it raises no frequency of the vectors to near 2/Δt.
#[derive(Debug)]
pub struct StretchedPlate {
    plate: Box<dyn Structure>,
    stretch: Stretch,
    q: Vec<f64>,
    g: Vec<f64>,
    works: Vec<f64>,
}

impl StretchedPlate {
    /// `plate`, stretched.
    pub fn new(plate: Box<dyn Structure>, stretch: Stretch) -> Self {
        let modes = stretch.share.modes;
        Self { plate, stretch, q: vec![0.0; modes], g: vec![0.0; modes], works: Vec::new() }
    }
}

impl Structure for StretchedPlate {
    fn ndof(&self) -> usize {
        self.plate.ndof()
    }

    fn name(&self, i: usize) -> String {
        self.plate.name(i)
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.plate.add_stiffness(scale, x, y);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.plate.add_mass(scale, x, y);
    }

    fn free_motions(&self) -> &[f64] {
        self.plate.free_motions()
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        self.plate.solve_shifted(shift, x, columns)
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        self.plate.solve_mass(x)
    }

    fn states(&self) -> usize {
        self.plate.states()
    }

    fn nonlinear(&mut self) -> Option<&mut dyn Nonlinear> {
        Some(self)
    }

    fn revision(&self) -> u64 {
        self.plate.revision()
    }

    fn work(&self) -> (u64, u64) {
        self.plate.work()
    }
}

impl Nonlinear for StretchedPlate {
    fn internal(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, SolveError> {
        let Self { plate, stretch: Stretch { membrane, share }, q, g, works } = self;
        let mut energy = match plate.nonlinear() {
            Some(plate) => plate.internal(u, points, force)?,
            None => {
                force.fill(0.0);
                plate.add_stiffness(1.0, u, force);
                Energy { stored: 0.5 * dot(u, force), dissipated: 0.0 }
            }
        };
        share.of(u, q);
        g.fill(0.0);
        share.patterns().torn.works(u, works);
        energy.stored += membrane.add_tension(q, works, g);
        share.patterns().torn.add(membrane.amounts(), force);
        g.iter().zip(share.weights.chunks_exact(u.len())).for_each(|(g, column)| axpy(*g, column, force));
        Ok(energy)
    }

    fn commit(&mut self, u: &[f64], points: &mut [f64]) -> Result<(), SolveError> {
        self.plate.nonlinear().map_or(Ok(()), |plate| plate.commit(u, points))
    }
}
