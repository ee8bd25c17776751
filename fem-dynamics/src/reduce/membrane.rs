//! A reduced plate whose deflections stretch it.

use super::directions::Directions;
use super::forms::Forms;
use super::motions::{Inverse, Motions};
use super::{Expansion, Modal, Reduced};
use crate::vector::{axpy, dot};
use fem_core::energy::Energy;
use fem_core::functional::{Functional, orthogonalise};
use fem_core::reduction::ReductionError;
use fem_core::springs::SupportSpring;
use fem_core::structure::{Nonlinear, SolveError, Structure, Tangent, Tangents};
use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView, SymmetricEigen};
use pulp::Arch;
use std::sync::Arc;

/// Membrane strains below this share of the largest (of the energy, at deflections of a static contact) are left out.
const NEGLIGIBLE: f64 = 1e-10;

/// Share of the largest force of a pattern below which what is left of an unknown's balance is rounding.
const BALANCED: f64 = 1e-8;

/// Energy of a pattern's tension that lies in a deflection of the contacts, over that of the tension alone, from which on the plate counts
/// as one that its tension bends. Of symmetric laminates it is 1e-4 and less, what the squeeze under the contact makes of it; of
/// `[0_4/90_4/45_8]` 3e-2, of a plate held at its lower face 1e-1.
const BENT: f64 = 1e-3;

/// What the modes of a plate would do in its plane because it is stretched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum InPlane {
    /// Is theirs.
    OfModes,
    /// Follows at once, as all the rest.
    AtOnce,
}

/// Quadratic strains of deflections, ε(q) = Σ over pairs i ≤ j of qᵢ qⱼ ε_ij for some displacement fields, and what they do.
/// Pairs count by rows of the upper triangle, fields are columns of independent displacements.
pub trait MembraneForms {
    /// ∫ ε_pᵀ C ε_p′ dV of all pairs of `fields`; `pairs × pairs`.
    ///
    /// # Errors
    /// A cell that cannot be integrated.
    fn gram(&self, fields: &[f64]) -> Result<Vec<f64>, SolveError>;

    /// Forces ∫ Bᵀ C ε dV of ε = Σ over pairs of c_p ε_p, per column c of `combinations`; `ndof × columns`.
    ///
    /// # Errors
    /// As [`MembraneForms::gram`].
    fn forces(&self, fields: &[f64], combinations: &[f64]) -> Result<Vec<f64>, SolveError>;

    /// B_t, per column c of `combinations`: qᵀ B_t q is the work of the stress C (ε + B s) on the quadratic strains of the
    /// deflections Σ qᵢ `modes`ᵢ, s a column of `shapes` or nothing; `modes × modes`, one after the other.
    ///
    /// # Errors
    /// As [`MembraneForms::gram`].
    fn forms(
        &self,
        fields: &[f64],
        combinations: &[f64],
        shapes: Option<&[f64]>,
        modes: &[f64],
    ) -> Result<Vec<f64>, SolveError>;
}

/// A reduced plate with the energy of its stretching,
///
/// W = ½ qᵀ Λ q + Σ_t (c_tᵀ q) b_t + ½ Σ_t σ_t b_t², b_t = qᵀ B_t q.
///
/// The membrane stresses are combinations of few patterns, which the deflections under a static contact call for, of a plate
/// under no membrane tension and more and more; σ_t b_t is how much of each there is, found from its work on the strains of all
/// deflections. In its plane, and through its thickness, the plate follows those strains at once: u = Φ q + Σ a_t s_t,
/// a_t = qᵀ A_t q, the s_t orthogonal to Φ in K. That is static condensation, exact to the fourth order of q. c vanishes for
/// symmetric laminates, but for modes in the plane.
///
/// Of the strains of large deflections only von Kármán's are there; slopes are small beside 1.
#[derive(Debug, Clone)]
pub struct MembranePlate {
    modal: Modal,
    motions: Arc<Motions>,
    /// B_t, of the motions.
    forms: Forms,
    /// σ_t
    stiffness: Vec<f64>,
    /// c_t of the motions, [`Forms::stride`] numbers each; empty where none matters.
    couplings: Vec<f64>,
    /// c_tᵀ q
    coupled: Vec<f64>,
    /// Inverse of the tangent, which serves many steps.
    inverse: Option<Inverse>,
    /// y, q of the motions.
    y: Vec<f64>,
    /// B_t y, [`Forms::stride`] numbers each.
    products: Vec<f64>,
    /// b_t.
    values: Vec<f64>,
    /// Room for products, and for sums of them.
    padded: Vec<f64>,
    weights: Vec<f64>,
    sum: Vec<f64>,
    solution: Vec<f64>,
}

/// What a plate does beside its modes because they stretch it.
#[derive(Debug, Clone)]
pub struct Companions {
    /// The displacements Σ a_t s_t.
    displaced: Followers,
    patterns: Arc<TensionPatterns>,
}

/// Displacements Σ a_t s_t, a_t = qᵀ A_t q.
#[derive(Debug, Clone)]
pub struct Followers {
    motions: Arc<Motions>,
    /// A_t, one after the other, of the motions.
    forms: Vec<f64>,
    /// s_t, `ndof × terms`.
    shapes: Vec<f64>,
    terms: usize,
}

/// The strains of the membrane stresses of a [`MembranePlate`], Σ b_t (ε_t + B s_t): ε_t a combination of those of pairs of deflections.
///
/// Stresses are those of these strains beside the modes'. What else the squares of slopes are is stretching that the plate gives way to in
/// its plane, nearly all of it, by displacements that are not known: without them its stresses would be large and would not be there.
#[derive(Debug, Clone)]
pub struct TensionPatterns {
    pub(super) deflections: Vec<f64>,
    pub(super) combinations: Vec<f64>,
    pub(super) follow: Followers,
    pub(super) torn: Torn,
}

impl TensionPatterns {
    /// The deflections, independent unknowns, one after the other.
    pub fn deflections(&self) -> &[f64] {
        &self.deflections
    }

    /// Of each pattern, shares of the strains of their pairs, `pairs × patterns`.
    pub fn combinations(&self) -> &[f64] {
        &self.combinations
    }

    /// b_t and s_t.
    pub fn follow(&self) -> &Followers {
        &self.follow
    }
}

/// What the stresses of each pattern do on layers that are told apart: forces r_t = ∫ Bᵀ C (ε_t + B s_t) dV, none on the plate that holds
/// together, whose s_t is in equilibrium, but on the two sides of what ties its layers, which carries them.
#[derive(Debug, Clone, Default)]
pub(super) struct Torn {
    unknowns: Vec<usize>,
    /// `patterns × unknowns`.
    forces: Vec<f64>,
    patterns: usize,
}

impl Torn {
    /// Of the `forces` ∫ Bᵀ C ε_t dV and the displacements `shapes` s_t, `ndof × patterns`.
    fn of(structure: &dyn Structure, mut forces: DMatrix<f64>, shapes: &DMatrix<f64>) -> Self {
        let largest = forces.amax();
        structure.add_stiffness(1.0, shapes.as_slice(), forces.as_mut_slice());
        let carried = |i: &usize| forces.row(*i).amax() > BALANCED * largest;
        let unknowns: Vec<usize> = (0..forces.nrows()).filter(carried).collect();
        let patterns = forces.ncols();
        let forces = unknowns.iter().flat_map(|i| forces.row(*i).iter().copied().collect::<Vec<_>>()).collect();
        Self { unknowns, forces, patterns }
    }

    fn rows(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.unknowns.iter().copied().zip(self.forces.chunks_exact(self.patterns.max(1)))
    }

    /// r_tᵀ u
    pub(super) fn works(&self, u: &[f64], works: &mut Vec<f64>) {
        works.clear();
        works.resize(self.patterns, 0.0);
        self.rows().for_each(|(i, row)| axpy(u[i], row, works));
    }

    /// Adds Σ b_t r_t.
    pub(super) fn add(&self, amounts: &[f64], force: &mut [f64]) {
        self.rows().for_each(|(i, row)| force[i] += dot(row, amounts));
    }
}

impl Companions {
    /// Adds to u = Φ q + … what the stretching adds ([`Followers::complete`]).
    pub fn complete(&self, modes: usize, q: &[f64], u: &mut [f64]) {
        self.displaced.complete(modes, q, u);
    }

    /// What its membrane stresses are made of.
    pub fn patterns(&self) -> &Arc<TensionPatterns> {
        &self.patterns
    }
}

impl Followers {
    fn new(motions: &Arc<Motions>, forms: Vec<f64>, shapes: &DMatrix<f64>) -> Self {
        Self { motions: Arc::clone(motions), forms, shapes: shapes.as_slice().to_vec(), terms: shapes.ncols() }
    }

    /// Adds to u = Φ q what the stretching adds, of one field, or of several of `modes` coordinates each, one after the other.
    pub fn complete(&self, modes: usize, q: &[f64], u: &mut [f64]) {
        let amounts: Vec<f64> = q.chunks_exact(modes.max(1)).flat_map(|q| self.amounts(q)).collect();
        let sizes = [u.len() * modes / q.len().max(1), self.terms];
        if !amounts.is_empty() {
            Arch::new().dispatch(Expansion { basis: &self.shapes, sizes, q: &amounts, u });
        }
    }

    /// Number of terms.
    pub fn terms(&self) -> usize {
        self.terms
    }

    /// s_t, `ndof × terms`.
    pub fn shapes(&self) -> &[f64] {
        &self.shapes
    }

    /// a_t
    pub fn amounts(&self, q: &[f64]) -> impl Iterator<Item = f64> {
        let mut y = Vec::new();
        self.motions.of(q, &mut y);
        let count = y.len();
        self.forms.chunks_exact(count * count).map(move |form| {
            // The forms are symmetric.
            let columns = form.chunks_exact(count).enumerate();
            columns.map(|(j, column)| y[j] * (column[j] * y[j] + 2.0 * dot(&column[j + 1..], &y[j + 1..]))).sum()
        })
    }

    /// Adds to `g` what works on a_t do on q: Σ f_t 2 A_t q.
    pub(super) fn add_works(&self, q: &[f64], works: impl Iterator<Item = f64>, g: &mut [f64]) {
        let mut y = Vec::new();
        self.motions.of(q, &mut y);
        let mut of_motions = vec![0.0; y.len()];
        for (form, work) in self.forms.chunks_exact(y.len() * y.len()).zip(works) {
            form.chunks_exact(y.len()).zip(&y).for_each(|(column, y)| axpy(2.0 * work * y, column, &mut of_motions));
        }
        self.motions.add(&of_motions, g);
    }
}

impl MembranePlate {
    /// Finds how the modes of `reduced` that the static response to `contacts` calls for stretch the plate `structure`, which lies on
    /// `springs`, and what it does beside them.
    ///
    /// # Errors
    /// A structure that is not held, a cell that cannot be integrated.
    pub fn new(
        structure: &mut dyn Structure,
        reduced: &Reduced,
        (contacts, springs): (&[Functional], &[SupportSpring]),
        stretching: &dyn MembraneForms,
    ) -> Result<(Self, Companions), ReductionError> {
        Self::with_plane(structure, reduced, (contacts, springs), stretching, InPlane::OfModes)
    }

    /// The same, with what the modes would do in the plane of the plate.
    ///
    /// # Errors
    /// As [`MembranePlate::new`]; where all follows at once, a plate that its tension bends.
    pub(super) fn with_plane(
        structure: &mut dyn Structure,
        reduced: &Reduced,
        (contacts, springs): (&[Functional], &[SupportSpring]),
        stretching: &dyn MembraneForms,
        in_plane: InPlane,
    ) -> Result<(Self, Companions), ReductionError> {
        let n = reduced.ndof;
        // Free motions bend nothing: as if they were infinitely stiff.
        let stiff = |k: &f64| if *k > 0.0 { *k } else { f64::INFINITY };
        let bending: Vec<f64> = reduced.modal.stiffness.iter().map(stiff).collect();
        let loads: Vec<Vec<f64>> = contacts.iter().map(|contact| reduced.restrict(contact)).collect();
        let one_sided = || springs.iter().filter(|spring| spring.one_sided);
        let pushing: Vec<_> = one_sided().map(|spring| (reduced.restrict(&spring.at), spring.stiffness)).collect();
        let Directions { vectors, reach } = Directions::new(&bending, &loads, &pushing);
        let basis = DMatrixView::from_slice(&reduced.basis, n, bending.len());
        let fields = basis * &vectors;
        let m = vectors.ncols();
        let pairs = (0..m).flat_map(|i| (i..m).map(move |j| (i, j)));
        // In units of the deflections of a static contact all pairs are comparable.
        let scale: Vec<f64> = pairs.map(|(i, j)| reach[i] * reach[j]).collect();

        let gram = stretching.gram(fields.as_slice())?;
        let p = scale.len();
        let scaled = DMatrix::from_fn(p, p, |i, j| 0.5 * (gram[i + p * j] + gram[j + p * i]) * scale[i] * scale[j]);
        let (strains, energies) = largest(scaled)?;
        let terms = strains.ncols();
        let combinations = DMatrix::from_fn(p, terms, |i, t| scale[i] * strains[(i, t)]);
        let forces = stretching.forces(fields.as_slice(), combinations.as_slice())?;
        let forces = DMatrix::from_vec(n, terms, forces);

        let mut shapes = -forces.clone();
        structure.solve_shifted(0.0, shapes.as_mut_slice(), terms)?;
        let couplings = match in_plane {
            InPlane::OfModes => basis.transpose() * &forces,
            InPlane::AtOnce => DMatrix::zeros(bending.len(), terms),
        };
        // K⁻¹ beside Φ.
        shapes += basis * DMatrix::from_fn(bending.len(), terms, |r, t| couplings[(r, t)] / bending[r]);
        let released = forces.transpose() * &shapes;
        let left = DMatrix::from_diagonal(&energies) + (&released + released.transpose()) * 0.5;
        let (turn, stiffness) = largest(left)?;
        let shapes_of_left = &shapes * &turn;
        if in_plane == InPlane::AtOnce && bends(structure, contacts, &shapes_of_left, stiffness.max())? {
            return Err(ReductionError::Solve(SolveError::other(BENDS)));
        }
        let couplings = couplings * &turn;
        // What the modes that a term is coupled to give way by.
        let taken = couplings.column_iter().flat_map(|c| c.into_iter().zip(&bending).map(|(c, k)| c * c / k));
        let coupled = taken.fold(0.0, f64::max) > NEGLIGIBLE * stiffness.max();
        let couplings = if coupled { couplings } else { DMatrix::zeros(bending.len(), 0) };
        let motions = match in_plane {
            InPlane::OfModes => {
                let answers = orthogonalise(one_sided().map(|spring| spring.at.clone()).collect()).len();
                Motions::new(&reduced.modal, (&pushing, answers), (&couplings, NEGLIGIBLE * stiffness.max()))
            }
            InPlane::AtOnce => Motions::default(),
        };
        let motions = Arc::new(motions);
        let count = motions.count(bending.len());
        let moving = motions.fields(&reduced.basis);
        let forms = |combinations: &DMatrix<f64>, shapes: Option<&DMatrix<f64>>| {
            let shapes = shapes.map(DMatrix::as_slice);
            stretching.forms(fields.as_slice(), combinations.as_slice(), shapes, &moving).map_err(ReductionError::from)
        };
        // The work of a stress on its own strains is σ_t, respectively the energy: per that, it counts how much there is.
        let counted = |mut forms: Vec<f64>, of: &DVector<f64>| {
            for (form, value) in forms.chunks_exact_mut(count * count).zip(of) {
                form.iter_mut().for_each(|f| *f /= value);
            }
            forms
        };
        let turned = &combinations * &turn;
        let of_left = counted(forms(&turned, Some(&shapes_of_left))?, &stiffness);
        let packed = Forms::new(count, &of_left);
        let plate = Self {
            modal: reduced.modal.clone(),
            motions: Arc::clone(&motions),
            couplings: padded_columns(motions.of_all(couplings), packed.stride()),
            coupled: vec![0.0; stiffness.len()],
            weights: vec![0.0; stiffness.len()],
            sum: Vec::new(),
            products: vec![0.0; packed.stride() * stiffness.len()],
            forms: packed,
            values: vec![0.0; stiffness.len()],
            stiffness: stiffness.as_slice().to_vec(),
            inverse: None,
            y: Vec::new(),
            padded: Vec::new(),
            solution: Vec::new(),
        };
        let forms = counted(forms(&combinations, None)?, &energies);
        let torn = match in_plane {
            InPlane::OfModes => Torn::default(),
            InPlane::AtOnce => Torn::of(structure, &forces * &turn, &shapes_of_left),
        };
        let patterns = TensionPatterns {
            torn,
            deflections: fields.as_slice().to_vec(),
            combinations: turned.as_slice().to_vec(),
            follow: Followers::new(&motions, of_left, &shapes_of_left),
        };
        let displaced = Followers::new(&motions, forms, &shapes);
        Ok((plate, Companions { displaced, patterns: Arc::new(patterns) }))
    }

    /// The same plate with other modes in bending, as many.
    pub fn with(&self, modal: Modal) -> Self {
        Self { modal, inverse: None, ..self.clone() }
    }

    /// The same plate, stretched by the slowest half of the motions that stretch it.
    #[must_use]
    pub fn stretched_by_half(&self) -> Self {
        Self { forms: self.forms.of_the_first(self.motions() / 2), ..self.clone() }
    }

    /// How many motions stretch it: its modes, or fewer.
    pub fn motions(&self) -> usize {
        self.motions.count(self.modal.ndof())
    }

    /// Finds B_t y, b_t and c_tᵀ q.
    fn stretch(&mut self, q: &[f64]) {
        self.motions.of(q, &mut self.y);
        self.forms.products(&self.y, &mut self.padded, &mut self.products);
        self.forms.values(&self.padded, &self.products, &mut self.values);
        self.coupled.fill(0.0);
        self.forms.values(&self.padded, &self.couplings, &mut self.coupled);
    }

    /// Adds to `force` what the stretching does beside the bending, ∂W/∂q − Λ q, where each b_t does the work w_t of `works` besides;
    /// returns its energy.
    pub(super) fn add_tension(&mut self, q: &[f64], works: &[f64], force: &mut [f64]) -> f64 {
        self.stretch(q);
        self.coupled.iter_mut().zip(works).for_each(|(coupled, work)| *coupled += work);
        let mut energy = 0.0;
        for t in 0..self.values.len() {
            let (value, tension) = (self.values[t], self.tension(t));
            // ½ σ b² + (cᵀ q + w) b
            energy += value * (tension - 0.5 * self.stiffness[t] * value);
            self.weights[t] = 2.0 * tension;
        }
        self.sum.clear();
        self.sum.resize(self.forms.stride(), 0.0);
        self.forms.add_columns(&self.weights, &self.products, &mut self.sum);
        self.forms.add_columns(&self.values, &self.couplings, &mut self.sum);
        self.motions.add(&self.sum, force);
        energy
    }

    /// The amounts b_t, once the plate is stretched.
    pub(super) fn amounts(&self) -> &[f64] {
        &self.values
    }

    /// c_t of term `t`, if there are any.
    fn coupling(&self, t: usize) -> &[f64] {
        let stride = self.forms.stride();
        self.couplings.get(t * stride..t * stride + self.motions()).unwrap_or_default()
    }

    /// ∂W/∂b_t, once the plate is stretched.
    fn tension(&self, t: usize) -> f64 {
        self.stiffness[t] * self.values[t] + self.coupled[t]
    }
}

/// The columns of a matrix, `stride` numbers each.
fn padded_columns(matrix: DMatrix<f64>, stride: usize) -> Vec<f64> {
    matrix.resize_vertically(stride, 0.0).as_slice().to_vec()
}

/// What is in the way where tension bends a plate.
const BENDS: &str = "its tension would bend this plate, and a plate whose delaminations grow has to stay as it is under tension alone: make \
                     the laminate symmetric, and hold the plate against motion in its plane at all levels alike or at none, or leave \
                     `effects.membrane` out";

/// Whether tensions, with the displacements `shapes` and up to the stiffness `largest`, deflect a plate where it is struck.
fn bends(
    structure: &mut dyn Structure,
    contacts: &[Functional],
    shapes: &DMatrix<f64>,
    largest: f64,
) -> Result<bool, SolveError> {
    let mut bends = false;
    for contact in contacts {
        let mut response = vec![0.0; shapes.nrows()];
        contact.add_to(1.0, &mut response);
        structure.solve_shifted(0.0, &mut response, 1)?;
        let most = BENT * largest * contact.of(&response);
        bends |= shapes.as_slice().chunks_exact(shapes.nrows()).any(|shape| contact.of(shape).powi(2) > most);
    }
    Ok(bends)
}

/// Eigenvectors and eigenvalues that are not negligible beside the largest, descending.
fn largest(matrix: DMatrix<f64>) -> Result<(DMatrix<f64>, DVector<f64>), ReductionError> {
    if !matrix.iter().all(|v| v.is_finite()) {
        return Err(ReductionError::NotFinite("the membrane energy of the modes"));
    }
    let eigen = SymmetricEigen::new(matrix);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let top = order.first().map_or(0.0, |i| eigen.eigenvalues[*i]);
    order.retain(|i| eigen.eigenvalues[*i] > NEGLIGIBLE * top);
    let values = DVector::from_iterator(order.len(), order.iter().map(|i| eigen.eigenvalues[*i]));
    Ok((eigen.eigenvectors.select_columns(&order), values))
}

impl Structure for MembranePlate {
    fn ndof(&self) -> usize {
        self.modal.ndof()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.modal.add_stiffness(scale, x, y);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.modal.add_mass(scale, x, y);
    }

    fn add_damping(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.modal.add_damping(scale, x, y);
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        self.modal.solve_shifted(shift, x, columns)
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        self.modal.solve_mass(x)
    }

    fn solve_damped(&mut self, cm: f64, cc: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        self.modal.solve_damped(cm, cc, x, columns)
    }

    fn solve_damped_mass(&mut self, cc: f64, x: &mut [f64]) -> Result<(), SolveError> {
        self.modal.solve_damped_mass(cc, x)
    }

    fn damping_rate(&self, omega: f64) -> f64 {
        self.modal.damping_rate(omega)
    }

    fn highest_frequency(&mut self) -> Result<f64, SolveError> {
        self.modal.highest_frequency()
    }

    fn nonlinear(&mut self) -> Option<&mut dyn Nonlinear> {
        Some(self)
    }
}

impl Nonlinear for MembranePlate {
    fn internal(&mut self, q: &[f64], _points: &[f64], force: &mut [f64]) -> Result<Energy, SolveError> {
        let mut energy = 0.0;
        for ((f, k), q) in force.iter_mut().zip(&self.modal.stiffness).zip(q) {
            *f = k * q;
            energy += 0.5 * k * q * q;
        }
        energy += self.add_tension(q, &[], force);
        Ok(Energy { stored: energy, dissipated: 0.0 })
    }

    fn tangents(&mut self) -> Option<&mut dyn Tangents> {
        Some(self)
    }
}

impl Tangents for MembranePlate {
    fn linearise(&mut self, Tangent { cm, cc, u: q, .. }: &Tangent) -> Result<(), SolveError> {
        self.stretch(q);
        let n = self.motions();
        let mut tangent = DMatrix::zeros(n, n);
        for (t, product) in self.products.chunks_exact(self.forms.stride().max(1)).enumerate() {
            let product = DVectorView::from_slice(product, n);
            tangent += self.forms.matrix(t) * (2.0 * self.tension(t));
            tangent.ger(4.0 * self.stiffness[t], &product, &product, 1.0);
            let coupling = self.coupling(t);
            if !coupling.is_empty() {
                let coupling = DVectorView::from_slice(coupling, n);
                tangent.ger(2.0, &coupling, &product, 1.0);
                tangent.ger(2.0, &product, &coupling, 1.0);
            }
        }
        let own = self.modal.stiffness.iter().zip(&self.modal.mass).enumerate().map(|(i, (k, mass))| {
            // A free motion without inertia stays where it is: no force is there to answer one along it.
            let own = if *k == 0.0 && *mass == 0.0 { f64::INFINITY } else { k + cm * mass };
            own + cc * self.modal.damping.get(i).unwrap_or(&0.0)
        });
        self.inverse = None;
        self.inverse = Some(self.motions.inverse(&own.collect::<Vec<f64>>(), tangent)?);
        Ok(())
    }

    fn solve_linearised(&mut self, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        let Self { inverse, padded, solution, .. } = self;
        let inverse = inverse.as_ref().ok_or(SolveError::NotLinearised)?;
        for column in x.chunks_exact_mut(self.modal.ndof()).take(columns) {
            inverse.solve(column, [&mut *padded, &mut *solution]);
        }
        Ok(())
    }
}
