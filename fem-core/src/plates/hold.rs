//! Supports by name: which unknowns of which nodes they hold, in axes of which turn.

use crate::plates::axes::Turns;
use crate::plates::constraint::Equation;
use crate::plates::mesh::{Course, Group, PlaneMesh};
use crate::plates::plate::Plate;
use crate::plates::support::{Levels, turned};
use crate::words::dof::Dof;

/// What a support by name holds of an edge: displacements that are zero over a line, a face or a body of the plate, and so are their
/// derivatives along it.
///
/// Along an edge that turns with the curvature κ towards its left normal n, u_t = 0 says ∂u_t/∂t + κ u_n = 0: a plate that moves along its
/// normal is stretched along its edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SupportKind {
    /// Neither moves nor turns: u_n = u_t = 0 over the height, and w = 0 at its middle, as in plate theory: thickness is free. A face
    /// that is held in all of its points is stiffer by the zone, about as wide as the plate is thick, in which plies cannot contract.
    Clamped,
    /// No deflection, and none along the edge: w = u_t = 0; free to turn about the edge and to move along its normal (the hard support
    /// of plate theory, SS-1 of laminates).
    SimplySupported,
    /// Nothing moves at one height; free to turn about it.
    Hinged,
    /// No deflection, w = 0.
    Roller,
    /// A plane of symmetry: u_n = 0, and u_t and w are even.
    Symmetry,
    /// Clamped but for the deflection: u_n = u_t = 0 over the height.
    Guided,
    /// Nothing is held.
    Free,
    /// No deflection towards the support, from which the plate may lift off: by springs that only push.
    Rest,
}

use SupportKind::{Clamped, Free, Guided, Hinged, Rest, Roller, SimplySupported, Symmetry};

/// Sine of the angle between two edges of one plane.
const SAME_LINE: f64 = 1e-6;

impl SupportKind {
    /// All of them by name.
    pub const ALL: [(&str, Self); 8] = [
        ("clamped", Clamped),
        ("simply-supported", SimplySupported),
        ("hinged", Hinged),
        ("roller", Roller),
        ("symmetry", Symmetry),
        ("guided", Guided),
        ("free", Free),
        ("rest", Rest),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// The levels that it acts on unless a scene says otherwise.
    pub fn levels(self) -> Levels {
        match self {
            Clamped | SimplySupported | Symmetry | Guided | Free => Levels::All,
            Hinged | Roller => Levels::MidPlane,
            Rest => Levels::Bottom,
        }
    }

    /// Why it cannot act there, and what to write instead.
    pub fn refuses(self, mesh: &PlaneMesh, group: &Group, levels: Levels) -> Option<[&'static str; 2]> {
        match self {
            Hinged if levels == Levels::All => Some([
                "a hinge holds the plate at one height: held at all of them it does not turn",
                "write at = \"mid-plane\", \"bottom\" or \"top\", or kind = \"clamped\"",
            ]),
            Rest if matches!(levels, Levels::All | Levels::MidPlane) => Some([
                "a plate rests on one of its faces",
                "write at = \"bottom\", or at = \"top\" of what presses from above",
            ]),
            Symmetry if levels != Levels::All => {
                Some(["a plane of symmetry cuts the plate through", "leave `at` out, or write at = \"all\""])
            }
            SimplySupported | Symmetry if group.edges.is_empty() && !group.nodes.is_empty() => Some([
                "this kind of support is of edges, for what it holds depends on their direction",
                "name a group of edges, or another kind: \"clamped\", \"hinged\" or \"roller\"",
            ]),
            Symmetry => {
                let courses = mesh.courses(group);
                let angles: Vec<f64> = courses.values().flatten().map(|course| course.angle).collect();
                let bent = angles.iter().any(|angle| (angle - angles[0]).sin().abs() > SAME_LINE);
                bent.then_some([
                    "a plane of symmetry is straight",
                    "give each straight part of the edge a support of its own",
                ])
            }
            _ => None,
        }
    }

    /// Whether displacement 1 (along the edge), 2 (across it) or 3 (the deflection) is held.
    pub fn holds(self, n: u8) -> bool {
        match self {
            Clamped | Hinged => true,
            Guided => n != 3,
            Free | Rest => false,
            SimplySupported => n != 2,
            Roller => n == 3,
            Symmetry => n == 2,
        }
    }

    /// Whether what it holds in the plane depends on the direction of the edge.
    fn is_directed(self) -> bool {
        self.holds(1) != self.holds(2)
    }
}

/// Unknowns of some nodes that are held.
#[derive(Debug, Clone, PartialEq)]
pub struct Hold {
    /// Columns of the nodes.
    pub columns: Vec<u32>,
    /// Their levels.
    pub levels: Vec<usize>,
    /// The unknowns, in axes turned about z by `angle`, radians.
    pub dofs: Vec<Dof>,
    /// Turn of these axes.
    pub angle: f64,
    /// κ: the derivative U11 is held at −κ U20 instead of 0, 1/m.
    pub curvature: f64,
    /// What is held of them.
    pub what: What,
}

/// What a [`Hold`] holds of its unknowns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// Each of them.
    Each,
    /// What lies at z = 0 on the line between its two levels.
    Between,
    /// Nothing but their jumps between layers that have come apart.
    Jumps,
}

impl Hold {
    /// What `kind` holds of `group` at `levels`, node by node, in axes along the edge.
    ///
    /// Middles of sides that stand for a curve are off it: there the deflection is left to the nodes beside them, unless the plate is
    /// clamped.
    pub fn of_kind(plate: &Plate, group: &Group, kind: SupportKind, at: Levels, turns: &mut Turns) -> Vec<Self> {
        let courses = plate.plane.courses(group);
        let curved = |node: u32| courses.get(&node).is_some_and(|all| all.iter().any(|course| course.curvature != 0.0));
        let mut known = Vec::new();
        let mut holds = Vec::new();
        for column in plate.columns_of_group(group) {
            let Ok(levels) = at.of(plate, column as usize) else { continue };
            let all_levels = levels.len();
            // Held at one height, the deflection leaves a clamped plate its thickness, which the plies change as they are stretched.
            let middle: Vec<usize> =
                Self::middle(plate, column as usize, &levels).into_iter().map(|(level, _)| level).collect();
            let of_deflection = if kind == Clamped { &middle } else { &levels };
            let chord = plate.ends(column as usize).map(|ends| {
                let [p, q] = ends.map(|node| plate.plane.points[node as usize]);
                (ends, Course::straight((q[1] - p[1]).atan2(q[0] - p[0])))
            });
            let off = kind != Clamped
                && chord.is_some_and(|(ends, _)| {
                    // The middle of a chord is off the curve, that of a bent side is on it.
                    group.quads.is_empty() && ends.into_iter().all(curved) && !plate.plane.bends.contains_key(&ends)
                });
            let own: Vec<Course> = match chord {
                Some((_, chord)) => vec![chord],
                None => courses.get(&column).cloned().unwrap_or_default(),
            };
            let alone = [Course::straight(0.0)];
            for (k, course) in if own.is_empty() { &alone[..] } else { &own }.iter().enumerate() {
                let curvature = if kind.is_directed() { settle(&mut known, course.curvature) } else { 0.0 };
                let angle = turns.settle(course.angle);
                for (displacements, levels) in [(1..3, &levels), (3..4, of_deflection)] {
                    let between = displacements.start == 3 && kind == Clamped && levels.len() == 2;
                    let mut dofs = Vec::new();
                    for n in displacements {
                        // One edge at a corner says all of what does not depend on its direction.
                        let values = kind.holds(n) && !(n == 3 && off) && (k == 0 || (n < 3 && kind.is_directed()));
                        let all = [
                            (0, values),
                            (1, kind.holds(n) && !own.is_empty()),
                            (2, kind == Symmetry && n != 2),
                            (3, values && at == Levels::All && levels.len() == all_levels && !between),
                        ];
                        dofs.extend(all.into_iter().filter(|(_, held)| *held).filter_map(|(m, _)| Dof::new(n, m)));
                    }
                    if !dofs.is_empty() {
                        holds.push(Self {
                            columns: vec![column],
                            levels: levels.clone(),
                            dofs,
                            angle,
                            curvature,
                            what: if between { What::Between } else { What::Each },
                        });
                    }
                }
            }
            // Layers that have come apart are pressed together by a clamp, which has only one middle.
            let apart = |level: &usize| plate.dofs_at(column as usize, *level, Dof::SOLID[8]).nth(1).is_some();
            let levels: Vec<usize> = levels.into_iter().filter(|level| kind == Clamped && apart(level)).collect();
            if levels.is_empty() {
                continue;
            }
            let jumps = |dofs, angle| Self {
                columns: vec![column],
                levels: levels.clone(),
                dofs,
                angle,
                curvature: 0.0,
                what: What::Jumps,
            };
            holds.push(jumps(vec![Dof::SOLID[8]], 0.0));
            holds.extend(
                own.iter().map(|course| jumps(Dof::new(3, 1).into_iter().collect(), turns.settle(course.angle))),
            );
        }
        holds
    }

    /// Those of `levels` at which the deflection of a plate is held whose thickness is free, with their shares in it: that in the middle
    /// of the plate that is there, or the two about it.
    pub fn middle(plate: &Plate, column: usize, levels: &[usize]) -> Vec<(usize, f64)> {
        let [bottom, top] = plate.outer_levels(column).map(|level| plate.levels[level]);
        let height = |level: usize| plate.levels[level] - 0.5 * (bottom + top);
        let nearest = |levels: &mut dyn Iterator<Item = usize>| {
            levels.min_by(|a, b| height(*a).abs().total_cmp(&height(*b).abs()))
        };
        let Some(one) = nearest(&mut levels.iter().copied()) else { return Vec::new() };
        let mut beyond = levels.iter().copied().filter(|level| height(*level) * height(one) < 0.0);
        match nearest(&mut beyond).filter(|_| !plate.same_height(height(one), 0.0)) {
            None => vec![(one, 1.0)],
            Some(other) => {
                let (low, high) = (one.min(other), one.max(other));
                let (z0, z1) = (height(low), height(high));
                vec![(low, z1 / (z1 - z0)), (high, z0 / (z0 - z1))]
            }
        }
    }

    /// The same as equations.
    pub fn equations(&self, plate: &Plate, origin: &str) -> Vec<Equation> {
        match self.what {
            What::Each => {}
            What::Between => return self.equations_between(plate, origin),
            What::Jumps => return self.equations_of_jumps(plate, origin),
        }
        let mut equations = Vec::new();
        for (column, level, dof) in self.each() {
            let origin = format!("{origin}: {dof} at {}", plate.describe_column(column));
            let mut each = turned(plate, column, level, dof, self.angle);
            if let Some(across) = Dof::new(2, 0).filter(|_| self.curvature != 0.0 && (dof.n(), dof.m()) == (1, 1)) {
                let moves = turned(plate, column, level, across, self.angle);
                for (terms, moves) in each.iter_mut().zip(moves) {
                    terms.extend(moves.iter().map(|(unknown, factor)| (*unknown, self.curvature * factor)));
                }
            }
            equations.extend(each.into_iter().map(|terms| Equation {
                terms,
                value: 0.0,
                origin: origin.clone(),
                holds: true,
            }));
        }
        equations
    }

    fn equations_between(&self, plate: &Plate, origin: &str) -> Vec<Equation> {
        let mut equations = Vec::new();
        for column in &self.columns {
            let shares = Self::middle(plate, *column as usize, &self.levels);
            for dof in &self.dofs {
                let at = |(level, share): (usize, f64)| {
                    // Of layers that have come apart there, of one: clamped they stay together.
                    let own = turned(plate, *column as usize, level, *dof, self.angle);
                    own.into_iter()
                        .take(1)
                        .flatten()
                        .map(move |(unknown, factor)| (unknown, share * factor))
                        .collect::<Vec<_>>()
                };
                equations.push(Equation {
                    terms: shares.iter().copied().flat_map(at).collect(),
                    value: 0.0,
                    origin: format!("{origin}: {dof} at {}", plate.describe_column(*column as usize)),
                    holds: true,
                });
            }
        }
        equations.retain(|equation| !equation.terms.is_empty());
        equations
    }

    fn equations_of_jumps(&self, plate: &Plate, origin: &str) -> Vec<Equation> {
        let mut equations = Vec::new();
        for (column, level, dof) in self.each() {
            let mut each = turned(plate, column, level, dof, self.angle).into_iter();
            let Some(first) = each.next() else { continue };
            equations.extend(each.map(|other| Equation {
                terms: other.into_iter().chain(first.iter().map(|(unknown, factor)| (*unknown, -factor))).collect(),
                value: 0.0,
                origin: format!("{origin}: jump of {dof} at {}", plate.describe_column(column)),
                holds: true,
            }));
        }
        equations
    }

    /// Column, level and name of each unknown, one after the other.
    pub fn each(&self) -> impl Iterator<Item = (usize, usize, Dof)> {
        let nodes = self.columns.iter().flat_map(|column| self.levels.iter().map(|level| (*column as usize, *level)));
        nodes.flat_map(|(column, level)| self.dofs.iter().map(move |dof| (column, level, *dof)))
    }
}

/// Curvatures that differ by less are one, relative: what rounding of coordinates makes of it.
const SAME_CURVATURE: f64 = 1e-6;

/// What stands for a curvature: one that came before, up to rounding and sign.
fn settle(known: &mut Vec<f64>, curvature: f64) -> f64 {
    let size = curvature.abs();
    let before = known.iter().find(|other| (*other - size).abs() <= SAME_CURVATURE * size);
    let settled = before.copied().unwrap_or_else(|| {
        known.push(size);
        size
    });
    settled.copysign(curvature)
}
