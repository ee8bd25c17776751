//! Supports that leave motions, and equations that repeat, contradict or follow each other.

use crate::case::{Case, Room};
use crate::plates::{SHELL, SOLIDS, middles, model, nearest, on, probe, rectangle, said, solve, with_nodes};
use crate::scene::{AS4, Plate, Side};
use fem::core::constraint::{ConstraintError, Constraints, Equation};
use fem::core::mesh::PlaneMesh;
use fem::{Error, output};
use std::fmt::Write as _;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Algebra.case(
            "motions left free",
            "all 63 combinations of the six rigid motions; elements with and without derivatives, and the shell",
            "combinations that are not refused by the names of all their motions (the 8 with no translation held: as having no \
             support)",
            0.0,
            free_motions,
        ),
        Room::Algebra.case(
            "supports that all but leave a motion free",
            "two of three supported nodes 1e-3 to 1e-10 of the plate apart, under a pull that asks nothing of them; elements with and \
             without derivatives, and the shell",
            "plates that are neither refused by name, nor warned of, nor right to 0.1 %",
            0.0,
            near_hinges,
        ),
        Room::Algebra.case(
            "chains of equations",
            "100 ties with ratios from 0.01 to 100, forward, backward and without order",
            "error of a factor between two unknowns",
            1e-12,
            chains,
        ),
        Room::Algebra.case(
            "equations that repeat, contradict or run in a circle",
            "2 to 100 of them",
            "sets that are not solved, or refused by the names of their equations, as they should be",
            0.0,
            sets,
        ),
    ]
}

const NAMES: [&str; 6] = [
    "translation along x",
    "translation along y",
    "translation along z",
    "rotation about x",
    "rotation about y",
    "rotation about z",
];

/// mm.
const SIDE: f64 = 20.0;

fn plate(element: &str) -> Plate {
    let layers = if element == SHELL { vec![2] } else { vec![1, 1] };
    Plate::new(AS4, "[30_2]", 0.5, layers).element(element).sides([Side::Free; 4])
}

/// Without the restraint that a plate of the catalogue comes with.
fn unrestrained(plate: &Plate) -> String {
    plate.text("static").replace("[[support]]\nrestrain = 'rigid-motions'\n", "")
}

fn fix(group: &str, dof: &str) -> String {
    format!("[[support]]\ngroup = '{group}'\nat = 'mid-plane'\nfix = ['{dof}']\n")
}

fn tie(group: &str, dof: &str) -> String {
    let term = |group, factor| format!("{{ group = '{group}', at = 'mid-plane', dof = '{dof}', factor = {factor} }}");
    format!("[[equation]]\nterms = [{}, {}]\n", term(group, 1), term("o", -1))
}

fn free_motions() -> f64 {
    let mut mesh = rectangle([SIDE; 2], [2, 2]);
    for (name, at) in [("o", [0.5, 0.5]), ("a", [1.0, 0.5]), ("b", [0.5, 1.0])] {
        let node = nearest(&mesh, at.map(|x| x * SIDE));
        mesh = with_nodes(mesh, name, &[node]);
    }
    let stops: [String; 6] =
        [fix("o", "U10"), fix("o", "U20"), fix("o", "U30"), tie("b", "U30"), tie("a", "U30"), tie("a", "U20")];
    let mut missed = 0;
    for element in [SOLIDS[0], SOLIDS[2], SHELL] {
        for free in 0..64_u32 {
            let is_free = |i: &usize| free & (1 << i) != 0;
            let mut plate = plate(element).pressure("1");
            (0..6).filter(|i| !is_free(i)).for_each(|i| plate.more += &stops[i]);
            let names: Vec<&str> = (0..6).filter(is_free).map(|i| NAMES[i]).collect();
            let meshed = on(plate, &mesh);
            let found = model(&unrestrained(&meshed.plate));
            // Without any translation held the scene has no support at all.
            let words = match free & 7 {
                7 => "`support` is missing".to_owned(),
                _ => format!("free: {}", names.join(", ")),
            };
            missed += usize::from(match found {
                Ok(_) => free != 0,
                Err(error) => free == 0 || !said(&error).ends_with(&words),
            });
        }
    }
    missed as f64
}

/// Three nodes hold the plate, two of them all but in one place. Under a pull that asks nothing of the supports.
fn near_hinges() -> f64 {
    let mut silent = 0;
    for apart in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 3e-9, 1e-9, 1e-10] {
        let line = [0.0, 0.5, 0.5 + apart, 1.0].map(|x| x * SIDE);
        let mut mesh = PlaneMesh::rectangle(&line, &[0.0, 0.5 * SIDE, SIDE]);
        for (name, node) in [("o", 5), ("a", 6), ("b", 9)] {
            mesh = with_nodes(mesh, name, &[node]);
        }
        for element in [SOLIDS[0], SOLIDS[2], SHELL] {
            let mut plate = plate(element);
            for (n, group) in [(10.0, "x-max"), (-10.0, "x-min")] {
                plate = plate.load(&format!("force_per_length = ['{n} N/mm', '0 N/mm', '0 N/mm']\ngroup = '{group}'"));
            }
            for (group, dof) in [("o", "U10"), ("o", "U20"), ("o", "U30"), ("a", "U20"), ("a", "U30"), ("b", "U30")] {
                let _ = write!(plate.more, "{}", fix(group, dof));
            }
            let wide = middles(&mesh).into_iter().filter(|[x, _]| (x - 0.5 * SIDE).abs() > 0.1 * SIDE);
            let meshed = on(wide.fold(plate, probe), &mesh);
            silent += usize::from(match solve(&unrestrained(&meshed.plate)) {
                Ok((model, solution)) => {
                    let warned = output::statics::StaticSummary::new(&model, &solution)
                        .warnings
                        .join("; ")
                        .contains("condition");
                    let right = |p: &fem::core::profile::ProfilePoint| (p.global.0[0] * 1e-6 / 10.0 - 1.0).abs() < 1e-3;
                    !warned && !solution.profiles.iter().flatten().all(right)
                }
                Err(Error::IllConditioned { .. }) => false,
                Err(error) => {
                    let said = said(&error);
                    let free = said.contains("free: ") && said.contains("rotation about y") && said.contains("about z");
                    !free && !["nodes ", "cell ", "not held there"].iter().any(|words| said.contains(words))
                }
            });
        }
    }
    silent as f64
}

fn equation(terms: &[(usize, f64)], number: usize) -> Equation {
    Equation { terms: terms.to_vec(), value: 0.0, origin: format!("equation {number}"), holds: false }
}

fn eliminate(n: usize, equations: &[Equation]) -> Result<Constraints, ConstraintError> {
    Constraints::eliminate(&(0..n).collect::<Vec<_>>(), equations)
}

/// uᵢ₊₁ = r uᵢ.
fn chain(n: usize, ratio: f64) -> Vec<Equation> {
    (0..n).map(|i| equation(&[(i + 1, 1.0), (i, -ratio)], i)).collect()
}

fn chains() -> f64 {
    let n = 100;
    let mut worst = 0.0_f64;
    for ratio in [0.01, 0.5, 0.9, 1.0, 1.1, 2.0, 100.0] {
        for order in 0..3 {
            let mut equations = chain(n, ratio);
            match order {
                0 => {}
                1 => equations.reverse(),
                _ => equations = (0..n).map(|i| equations[i * 37 % n].clone()).collect(),
            }
            let mut u = vec![0.0; n + 1];
            match eliminate(n + 1, &equations) {
                Ok(solved) => solved.expand(&[1.0], &mut u),
                Err(why) => panic!("{ratio}, order {order}: {why}"),
            }
            let off = (0..n).map(|i| (u[i + 1] / u[i] / ratio - 1.0).abs());
            worst = crate::plates::worst(off.chain([worst]));
        }
    }
    worst
}

fn sets() -> f64 {
    let mut wrong = 0;
    for n in [2, 10, 100] {
        // A chain, and once more the whole of it.
        let twice = [chain(n, 1.5), chain(n, 1.5)].concat();
        let solved = eliminate(n + 1, &twice);
        wrong += usize::from(!solved.is_ok_and(|c| c.redundant.len() == n && c.ndof() == 1));
        // A circle that closes, and one that does not.
        let close = |last: f64| [chain(n, 1.2), vec![equation(&[(0, 1.0), (n, -last)], n)]].concat();
        let closes = eliminate(n + 1, &close(1.2_f64.powi(-(n as i32))));
        wrong += usize::from(!closes.is_ok_and(|c| c.redundant == [format!("equation {n}")]));
        let open = eliminate(n + 1, &close(1.0)).map_err(|why| why.to_string());
        let named = |why: &String| why.contains(&format!("equation {n} and")) && why.contains("cycle");
        wrong += usize::from(!open.as_ref().is_err_and(named));
        // Both ends held at different values.
        let mut held = chain(n, 1.0);
        held.push(Equation { value: 0.0, holds: true, ..equation(&[(0, 1.0)], n) });
        held.push(Equation { value: 1e-3, holds: true, ..equation(&[(n, 1.0)], n + 1) });
        let torn = eliminate(n + 1, &held).map_err(|why| why.to_string());
        let named = |why: &String| why.contains(&format!("equation {} contradicts", n + 1)) && why.contains("1.000e-3");
        wrong += usize::from(!torn.as_ref().is_err_and(named));
    }
    wrong as f64
}
