//! Effects of an impact that a scene switches on.

mod damping;
mod delamination;
mod foundation;
mod gravity;
mod inertia;
mod laws;
mod membrane;
mod off;
mod preload;

use crate::support::{impact_of, root};
use fem::analyses::impact::{Outcome, Sizes};
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Error, Model, Registry};

const EDGES: [&str; 4] = [
    "[[support]]\ngroup = 'x-min'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n",
    "[[support]]\ngroup = 'x-max'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n",
    "[[support]]\ngroup = 'y-min'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n",
    "[[support]]\ngroup = 'y-max'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n",
];
const TAPE: &str = "[materials.tape]\nlibrary = 'AS4/3502'\n";

/// A simply supported plate of 60 mm by 40 mm, 1 mm thick, struck in its middle.
#[derive(Debug, Clone)]
struct Struck {
    damage: &'static str,
    effects: &'static str,
    impactor: &'static str,
    contact: &'static str,
    reduction: &'static str,
    march: String,
    material: &'static str,
    more: &'static str,
}

impl Struck {
    fn new(effects: &'static str) -> Self {
        Self {
            damage: "off",
            effects,
            impactor: "mass = '20 g', velocity = '2 m/s'",
            contact: "law = 'hertz', k = '1e4 N/mm^1.5'",
            reduction: "method = 'ritz', vectors = 30",
            march: "integrator = 'newmark', step = '0.5 us', end = '400 us'".into(),
            material: TAPE,
            more: "",
        }
    }

    fn march(self, march: &str) -> Self {
        Self { march: march.to_owned(), ..self }
    }

    fn text(&self) -> String {
        let Self { damage, effects, impactor, contact, reduction, march, material, more } = self;
        format!(
            "title = 'effects'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [12, 8] }}\n\
             element = {{ kind = 'mitc4' }}\n\
             impactor = {{ {impactor}, at = {{ x = '30 mm', y = '20 mm' }} }}\ncontact = {{ {contact} }}\n\
             effects = {{ damage = '{damage}', {effects} }}\nreduction = {{ {reduction} }}\nmarch = {{ {march} }}\n\
             laminate = {{ plies = '[0/90/90/0]', material = 'tape', ply_thickness = '0.25 mm', layers = 1 }}\n{material}{}{more}",
            EDGES.concat()
        )
    }

    fn model(&self) -> Result<Model, Error> {
        Model::new(scene::parse(&self.text(), &root().join("scene.toml"))?, &Registry::standard())
    }

    fn run(&self) -> Result<(Sizes, Outcome), Error> {
        let (_, found) = impact_of(scene::parse(&self.text(), &root().join("scene.toml"))?)?;
        Ok((found.sizes, found.outcome))
    }

    fn outcome(&self) -> Outcome {
        self.run().unwrap().1
    }

    fn history(&self) -> Vec<HistoryRow> {
        self.outcome().history
    }

    /// What it is refused with, and how that helps.
    #[track_caller]
    fn refused(&self, words: &[&str]) {
        let error = self.run().expect_err("it is refused");
        let said = said(error);
        for words in words {
            assert!(said.contains(words), "{words:?} is not in {said}");
        }
    }
}

/// An error with its help, on one line.
fn said(error: Error) -> String {
    let report = format!("{:?}", miette::Report::new(error));
    report.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

/// Root of the sum of squared differences over that of squares.
fn difference(a: &[HistoryRow], b: &[HistoryRow], value: impl Fn(&HistoryRow) -> f64) -> f64 {
    assert_eq!(a.len(), b.len());
    let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
    let apart = square(&mut a.iter().zip(b).map(|(a, b)| value(a) - value(b)));
    (apart / square(&mut b.iter().map(&value))).sqrt()
}

fn force(row: &HistoryRow) -> f64 {
    row.impactors[0].contact_force_n
}

fn deflection(row: &HistoryRow) -> f64 {
    row.impactors[0].plate_displacement_m
}
