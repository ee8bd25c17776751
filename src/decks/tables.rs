//! Tables of an analysis and of a back substitution, and their part of the listing.

use super::axes::unlike;
use super::back::{Found, Place};
use super::fits::misfits;
use super::listing::{Listing, index};
use super::march::Print;
use super::model::Model;
use super::project::Project;
use crate::error::Error;
use fem_io::deck::{Freedom, ImpactDeck, MarchCard, Set};
use fem_io::plot::{Series, Style};
use fem_io::tables::TableValue;

/// What was found of one print step of one substructure.
#[derive(Debug)]
pub(super) struct Substituted<'a> {
    pub(super) asked: &'a Set,
    /// All degrees of freedom of the piece.
    pub(super) u: Vec<f64>,
    /// Elements, from 1, with their places.
    pub(super) found: Vec<(usize, Vec<Found>)>,
}

const KINDS: [&str; 3] = ["u", "v", "a"];

/// Lowest frequencies that are printed.
const FREQUENCIES: usize = 10;

impl Listing {
    /// Counts and cross reference of a model; what is odd about its governors.
    pub(super) fn model(&mut self, deck: &ImpactDeck, project: &Project) {
        self.count("substructures", deck.substructures.len());
        self.count("nodes", deck.freedom.nodes.len());
        self.totals(&deck.freedom, "governors", "other masters");
        self.cross_reference(&deck.freedom, "governor", "master");
        let per_node = deck.freedom.directions.len();
        let labelled = per_node == 6 || per_node == 12;
        let slopes = |dof: &&usize| labelled && !deck.freedom.directions[**dof % per_node].ends_with('0');
        if let Some(dof) = deck.freedom.kept.iter().find(slopes) {
            let name = deck.freedom.phrase(*dof);
            self.warn(format!("{name} governs, a derivative: it has hardly any inertia, hence a high frequency"));
        }
        unlike(deck, project).into_iter().for_each(|text| self.warn(text));
        misfits(deck, project).into_iter().for_each(|text| self.warn(text));
        let mut seen: Vec<&str> = Vec::new();
        for piece in &deck.substructures {
            let name = piece.name.value.as_str();
            let Some(matrices) = project.matrices(name).filter(|_| labelled && !seen.contains(&name)) else { continue };
            seen.push(name);
            let labels = matrices.masters.iter().zip(deck.freedom.directions.iter().cycle());
            if let Some(((node, own), label)) = labels.into_iter().find(|((_, own), label)| own != *label) {
                self.warn(format!(
                    "`{name}`: what is called {label} here is {own} of its node {node}; labels are positions"
                ));
            }
        }
    }

    /// Frequencies on the governors, and what the step makes of the highest one.
    pub(super) fn frequencies(&mut self, model: &Model, march: &MarchCard, growth: Option<f64>) {
        self.line("\ncircular frequencies on the governors");
        let lowest: String = model.omega.iter().take(FREQUENCIES).map(|omega| format!("{omega:>14.6e}")).collect();
        self.line(&lowest);
        self.line(&format!("highest frequency times DELTA {:.4}", model.omega_step(march)));
        if let Some(growth) = growth {
            self.warn(format!("INTALG {} has no stable step: the fastest mode grows {growth:.2}-fold", march.order));
        }
    }

    /// Contact, impactor and governors at every print step.
    pub(super) fn history(&mut self, project: &Project, deck: &ImpactDeck, prints: &[Print]) -> Result<(), Error> {
        let mut header: Vec<String> =
            ["print_step", "step", "t", "F", "delta", "delta_max"].map(str::to_owned).to_vec();
        header.extend(KINDS.map(|kind| format!("{kind} impactor")));
        for kind in KINDS {
            header.extend(deck.freedom.kept.iter().map(|dof| format!("{kind} {}", deck.freedom.name(*dof))));
        }
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let rows = prints.iter().enumerate().map(|(i, print)| {
            let governors = print.motion.iter().flat_map(|x| deck.freedom.kept.iter().map(|dof| x[*dof]));
            let numbers = [print.time, print.force].into_iter().chain(print.indentation).chain(print.impactor);
            let numbers = numbers.chain(governors).map(TableValue::Number);
            [index(i), TableValue::Count(print.step as u64)].into_iter().chain(numbers).collect()
        });
        let units = [self.unit([1, 0]), self.unit([0, 1])];
        self.line(&format!(
            "\n    step          time    force{}  indentation{}      largest     impactor",
            units[0], units[1]
        ));
        for print in prints {
            let [delta, largest] = print.indentation;
            self.line(&format!(
                "{:>8}{:>14.5e}{:>14.5e}{delta:>14.5e}{largest:>14.5e}{:>14.5e}",
                print.step, print.time, print.force, print.impactor[0]
            ));
        }
        self.table(project, "history", &header, rows)?;
        let curve = |label: &str, of: &dyn Fn(&Print) -> f64| Series {
            label: label.to_owned(),
            points: prints.iter().map(|print| (print.time, of(print))).collect(),
            style: Style::Solid,
        };
        let struck = curve("struck", &|print| print.motion[0][deck.struck]);
        let impactor = curve("impactor", &|print| print.impactor[0]);
        if self.units().is_some() {
            // The pictures of any impact, in SI units, stand for these.
            return Ok(());
        }
        self.picture(project, "force", "Contact force", vec![curve("force", &|print| print.force)])?;
        self.picture(project, "displacement", "Displacement", vec![impactor, struck])
    }

    /// Displacements, velocities and accelerations of all degrees of freedom at every print step, as far as they are printed.
    pub(super) fn motion(
        &mut self,
        project: &Project,
        deck: &ImpactDeck,
        march: &MarchCard,
        prints: &[Print],
    ) -> Result<(), Error> {
        let printed: Vec<usize> = (0..3).filter(|kind| march.prints[*kind]).collect();
        if printed.is_empty() {
            return Ok(());
        }
        let freedom = &deck.freedom;
        let mut header = vec!["print_step", "node", "dir"];
        header.extend(printed.iter().map(|kind| KINDS[*kind]));
        let rows = prints.iter().enumerate().flat_map(|(i, print)| {
            let printed = &printed;
            (0..freedom.ndof()).map(move |dof| {
                let mut row = vec![index(i)];
                row.extend(named(freedom, dof));
                row.extend(printed.iter().map(|kind| TableValue::Number(print.motion[*kind][dof])));
                row
            })
        });
        self.table(project, "motion", &header, rows)
    }

    /// Displacements, stresses and strains, and failure indices.
    pub(super) fn substitution(
        &mut self,
        project: &Project,
        freedom: &Freedom,
        all: &[Substituted<'_>],
    ) -> Result<(), Error> {
        let start = |one: &Substituted<'_>| {
            [TableValue::Count(one.asked.step as u64), TableValue::Count(one.asked.substructure as u64)]
        };
        let displacements = all.iter().filter(|one| one.asked.prints.displacements).flat_map(|one| {
            (0..freedom.ndof()).map(move |dof| {
                let mut row = start(one).to_vec();
                row.extend(named(freedom, dof));
                row.push(TableValue::Number(one.u[dof]));
                row
            })
        });
        if all.iter().any(|one| one.asked.prints.displacements) {
            self.table(project, "displacements", &["ndisp", "nsubs", "node", "dir", "u"], displacements)?;
        }
        let places: Vec<Row<'_>> = all.iter().flat_map(rows).collect();
        if places.is_empty() {
            return Ok(());
        }
        let stress_rows = places.iter().map(|row| {
            let mut values = start(row.one).to_vec();
            values.push(TableValue::Count(row.element as u64));
            let texts = [row.found.place.name(), row.found.which.as_str(), row.axes, row.quantity];
            values.extend(texts.map(TableValue::Text));
            values.extend(row.values.map(TableValue::Number));
            values
        });
        let header =
            ["ndisp", "nsubs", "element", "where", "which", "axes", "quantity", "xx", "yy", "zz", "xy", "yz", "zx"];
        self.table(project, "stress", &header, stress_rows)?;
        self.print_places(&places);
        let judged = all.iter().filter(|one| quantities(one.asked).next().is_some()).flat_map(|one| {
            let places = one.found.iter().flat_map(|(element, found)| found.iter().map(move |found| (*element, found)));
            places.filter(|(_, found)| found.place != Place::Surface).map(move |(element, found)| {
                let mut values = start(one).to_vec();
                values.push(TableValue::Count(element as u64));
                values.extend([found.place.name(), found.which.as_str()].map(TableValue::Text));
                values.extend(found.indices.map(|index| index.map_or(TableValue::Text(""), TableValue::Number)));
                values
            })
        });
        let header = ["ndisp", "nsubs", "element", "where", "which", "eq38", "eq39", "eq40", "eq41", "eq42"];
        if judged.clone().next().is_some() {
            self.table(project, "failure", &header, judged)?;
        }
        let others = all.iter().flat_map(|one| {
            let places = one.found.iter().flat_map(|(element, found)| found.iter().map(move |found| (*element, found)));
            places.flat_map(move |(element, found)| {
                found.others.iter().map(move |(criterion, mode, index)| {
                    let mut values = start(one).to_vec();
                    values.push(TableValue::Count(element as u64));
                    values.extend([found.place.name(), &found.which, criterion, mode].map(TableValue::Text));
                    values.push(TableValue::Index(*index));
                    values
                })
            })
        });
        let header = ["ndisp", "nsubs", "element", "where", "which", "criterion", "mode", "index"];
        if others.clone().next().is_some() {
            self.table(project, "indices", &header, others)?;
        }
        Ok(())
    }

    fn print_places(&mut self, places: &[Row<'_>]) {
        let unit = self.unit([1, -2]);
        self.line(&format!(
            "\nmeans over elements; stresses{unit}, engineering strains: xx yy zz xy yz zx, or 11 22 33 12 23 31"
        ));
        let mut last = (0, 0);
        for row in places {
            let at = (row.one.asked.step, row.one.asked.substructure);
            if at != last {
                self.line(&format!("\nprint step {}, substructure {}", at.0, at.1));
                last = at;
            }
            let values: String = row.values.iter().map(|value| format!("{value:>13.4e}")).collect();
            let place = format!("{} {}", row.found.place.name(), row.found.which);
            self.line(&format!("element {:<5}{place:<16}{:<7}{:<7}{values}", row.element, row.axes, row.quantity));
        }
    }
}

/// Node and direction.
fn named(freedom: &Freedom, dof: usize) -> [TableValue<'_>; 2] {
    let per_node = freedom.directions.len();
    let node = TableValue::Count(u64::from(freedom.nodes[dof / per_node]));
    [node, TableValue::Text(&freedom.directions[dof % per_node])]
}

/// One line of stresses or strains.
#[derive(Debug)]
struct Row<'a> {
    one: &'a Substituted<'a>,
    element: usize,
    found: &'a Found,
    axes: &'static str,
    quantity: &'static str,
    values: [f64; 6],
}

/// Which axes and quantities are printed: global before local, stress before strain.
fn quantities(asked: &Set) -> impl Iterator<Item = (&'static str, &'static str)> {
    let prints = asked.prints;
    let all = [
        (prints.global_stress, "global", "stress"),
        (prints.global_strain, "global", "strain"),
        (prints.local_stress, "local", "stress"),
        (prints.local_strain, "local", "strain"),
    ];
    all.into_iter().filter(|(printed, ..)| *printed).map(|(_, axes, quantity)| (axes, quantity))
}

fn rows<'a>(one: &'a Substituted<'a>) -> impl Iterator<Item = Row<'a>> {
    let places = one.found.iter().flat_map(|(element, found)| found.iter().map(move |found| (*element, found)));
    places.flat_map(move |(element, found)| {
        quantities(one.asked).map(move |(axes, quantity)| {
            let values = match (axes, quantity) {
                ("global", "stress") => found.stress.0,
                ("global", _) => found.strain.0,
                (_, "stress") => found.local_stress.0,
                _ => found.local_strain.0,
            };
            Row { one, element, found, axes, quantity, values }
        })
    })
}
