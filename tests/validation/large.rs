//! Large deflections of plates against von Kármán's theory.

use super::scene::{Plate, Side, isotropic};
use fem::Plan;
use fem::core::assembly::{LargePlate, Symbolic, pattern};
use fem::core::dof::Dof;
use fem::core::reduction::Functional;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Deflection over thickness in the middle of a quarter of a square plate of 100 x 100 x 1 mm under q a⁴/(E h⁴), the energy's
/// decrements, and seconds.
fn middle(plate: &Plate, q: f64) -> (f64, Vec<f64>) {
    let plate = plate.clone().pressure(&format!("{}", 70e3 * 1e-8 * q));
    let model = plate.model("static");
    let Plan::Static { forces } = &model.plan else { panic!() };
    let pattern = Arc::new(pattern(&model.plate, &model.constraints));
    let mut large = LargePlate::new(&model.plate, model.element.clone(), &model.constraints, &pattern).unwrap();
    let nodal: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|f| f.1 != 0.0).collect();
    let mut load = vec![0.0; large.ndof()];
    Functional(model.constraints.restrict(&nodal)).add_to(1.0, &mut load);
    let start = std::time::Instant::now();
    let u = vec![0.0; load.len()];
    let found = large.equilibrium(Symbolic::new(pattern).unwrap(), &load, u, NonZeroUsize::MIN).unwrap();
    eprintln!(
        "{} unknowns, {} cells, {:.3} s, {:?}",
        load.len(),
        large.cells(),
        start.elapsed().as_secs_f64(),
        found.decrements
    );
    let mut all = vec![0.0; model.plate.ndof()];
    model.constraints.expand(&found.u, &mut all);
    let corner = model.plate.columns.iter().position(|c| c.iter().all(|x| (x - 50e-3).abs() < 1e-9)).unwrap();
    let level = model.plate.mid_level().unwrap();
    let w = model.plate.dofs_at(corner, level, Dof::new(3, 0).unwrap()).next().unwrap();
    (-all[w] / 1e-3, found.decrements)
}

#[test]
fn a_clamped_square() {
    for cells in [4, 6, 8] {
        let plate = Plate::new(&isotropic(70.0, 0.316, 2.7), "[0_2]", 0.5, vec![1, 1])
            .rectangle([50.0; 2], [cells; 2])
            .sides([Side::Clamped, Side::Symmetric, Side::Clamped, Side::Symmetric]);
        for (q, w) in [(17.79, 0.2361698062), (95.0, 0.9018229813), (402.0, 1.855964104)] {
            let (got, _) = middle(&plate, q);
            eprintln!("{cells} {q}: {got} {w} {:.3e}", got / w - 1.0);
        }
    }
}
