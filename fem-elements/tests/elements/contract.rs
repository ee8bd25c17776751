//! Every element keeps the contract, with every parameter.

use fem_core::element::{Cell, Element, ElementInfo};
use fem_core::testkit::check_element;
use fem_elements::{HermiteHex, HermitePrism, Hex20, Mass, Mitc4, PlaneState, WebsterBeam, Wedge15};

#[test]
fn all_elements() {
    let mut all: Vec<Box<dyn Element>> =
        vec![Box::new(Hex20::new(3).unwrap()), Box::new(Mitc4::default()), Box::new(Wedge15::default())];
    for mass in [Mass::Cubic, Mass::Linear] {
        all.push(Box::new(HermiteHex::new(mass)));
        for order in [3, 4, 7] {
            all.push(Box::new(HermitePrism::new(mass, order).unwrap()));
            for state in [PlaneState::Stress, PlaneState::Strain] {
                all.push(Box::new(WebsterBeam::new(state, mass, order).unwrap()));
            }
        }
    }
    for element in all {
        check_element(&*element).unwrap_or_else(|why| panic!("{element:?}: {why}"));
    }
}

/// The prism with a fault.
#[derive(Debug, Clone)]
struct Faulty {
    prism: HermitePrism,
    info: ElementInfo,
    fault: fn(&Cell<'_>, [f64; 3], &mut [f64]),
}

impl Element for Faulty {
    fn info(&self) -> &ElementInfo {
        &self.info
    }
    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        let jacobian = self.prism.strain_operator(cell, slice, xi, b);
        (self.fault)(cell, xi, b);
        jacobian
    }
    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.prism.shape(cell, xi, n)
    }
}

#[test]
fn faults_are_found() {
    let faulty = |change: fn(&mut ElementInfo), fault: fn(&Cell<'_>, [f64; 3], &mut [f64])| {
        let prism = HermitePrism::new(Mass::Cubic, 4).unwrap();
        let mut info = *prism.info();
        change(&mut info);
        check_element(&Faulty { prism, info, fault }).unwrap_err()
    };
    for (why, words) in [
        (faulty(|i| i.in_plane_order = 2, |_, _, _| {}), "zero eigenvalues"),
        (faulty(|i| i.ply_order = 2, |_, _, _| {}), "zero eigenvalues"),
        // A shear of tensors instead of engineering strain.
        (faulty(|_| {}, |_, _, b| b.chunks_exact_mut(6).for_each(|b| b[3] *= 0.5)), "strain component 3"),
        // A derivative unknown with a wrong factor.
        (faulty(|_| {}, |_, _, b| b[6] *= 1.1), "strain component 0"),
    ] {
        assert!(why.contains(words), "{why:?} does not say {words:?}");
    }
}

/// An element with another form on triangles than its own.
#[derive(Debug, Clone)]
struct Beside {
    element: Hex20,
    wedge: Box<dyn Element>,
}

impl Element for Beside {
    fn info(&self) -> &ElementInfo {
        self.element.info()
    }
    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.element.strain_operator(cell, slice, xi, b)
    }
    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.element.shape(cell, xi, n)
    }
    fn triangular(&self) -> Option<&dyn Element> {
        Some(&*self.wedge)
    }
}

/// The wedge, whose displacements between nodes are others.
#[derive(Debug, Clone, Default)]
struct Bulging(Wedge15);

impl Element for Bulging {
    fn info(&self) -> &ElementInfo {
        self.0.info()
    }
    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.0.strain_operator(cell, slice, xi, b)
    }
    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        let jacobian = self.0.shape(cell, xi, n);
        n[0] += (1.0 - xi[1] * xi[1]) * xi[1];
        jacobian
    }
}

#[test]
fn forms_on_triangles_that_do_not_fit_are_found() {
    let element = Hex20::new(3).unwrap();
    let all: [(Box<dyn Element>, &str); 2] = [
        (Box::new(Hex20::new(3).unwrap()), "needs an element for quadrilaterals"),
        (Box::<Bulging>::default(), "cells of both shapes part by"),
    ];
    for (wedge, words) in all {
        let why = check_element(&Beside { element: element.clone(), wedge }).unwrap_err();
        assert!(why.contains(words), "{words:?}: {why}");
    }
}
