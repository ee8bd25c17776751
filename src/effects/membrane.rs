//! Membrane stiffening: the plate is stretched as it deflects.

use super::{SWITCHES, Switch, read_switch};
use crate::effect::{
    AdviceRule, Answer, Body, Effect, EffectInfo, EffectPlugin, Exclusion, Expected, Facts, Feature, Hindsight,
    Marched, Nature, Number, Wish,
};
use crate::error::Error;
use crate::forecast::{Demand, Size, nominal};
use fem_core::assembly::{LargePlate, MembraneStrains, Separable, Symmetric};
use fem_core::functional::Functional;
use fem_core::structure::SolveError;
use fem_dynamics::reduce::{MembraneForms, MembranePlate, Stretch};
use fem_io::scene::{Form, SceneError, SceneValue, key, words};

/// Strains are those of large deflections: of the element in a full plate, of a few patterns of membrane stress in a reduced one.
#[derive(Debug, Clone, Copy)]
pub struct Membrane;

/// A (w/h)², from which on a linear plate is wrong by more than 5 %.
const THRESHOLD: f64 = 0.05;

/// What decides.
const FORMULA: &str = "A (w/h)^2";

impl EffectPlugin for Membrane {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "membrane",
            Form::Words(&words(&SWITCHES)),
            r#""auto""#,
            "membrane stiffening: strains of large deflections",
        )
        .default(r#""off""#),
        source: "von Karman 1910",
        columns: &[],
        advice: Some(AdviceRule {
            formula: FORMULA,
            number: stiffening,
            threshold: THRESHOLD,
            acts_above: true,
            answer: Some(answer),
            hindsight: Some(hindsight),
        }),
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        read_switch(value, Switch::On, Self)
    }
}

impl Effect for Membrane {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const EXCLUDED: &[Exclusion] = &[
            Exclusion::new(
                Feature::PlyLawsAlone,
                "membrane stiffening is that of linear elastic plies, but plies follow a law",
                "leave it out, or the `law` of the material, or have delaminations grow beside them",
            ),
            Exclusion::new(Feature::Modes, "natural modes are those of small vibrations", "leave `membrane` out"),
            Exclusion::new(
                Feature::Substructures,
                "condensed substructures are linear",
                "leave `substructures` out and name a reduction, for example: reduction = { method = \"ritz\", vectors = 40 }",
            ),
            Exclusion::new(
                Feature::EquilibriumProfile,
                "`equilibrium` integrates stresses of small displacements",
                "leave `equilibrium` out, or `effects.membrane`",
            )
            .unless_auto(),
        ];
        EXCLUDED
    }

    fn check(&self, facts: &Facts<'_>) -> Result<(), SceneError> {
        if facts.element.large_deflections().is_some() {
            return Ok(());
        }
        Err(facts.refuse(
            format!("the element `{}` does not support large deflections", facts.scene.element.name.value),
            "use an element that does, such as `hermite-prism` or `mitc4`, or leave `membrane` out",
        ))
    }

    fn goes_with_growth(&self) -> bool {
        true
    }

    fn alter(&self, nature: &mut Nature) {
        nature.large = true;
    }

    fn memory(&self, body: &Body<'_>, demand: &Demand) -> f64 {
        let all = body.plate.ndof() as f64;
        match demand.contacts {
            Some(contacts) => {
                let [strains, forms] = [STRAINS, FORMS].map(|count| (count * contacts) as f64);
                let (n, motions) = (demand.unknowns as f64, demand.vectors - demand.answers);
                // Forces and shapes of the strains; they and the motions before the elimination of constraints.
                let fields = Demand::BASES * strains * n + (strains + motions as f64) * all;
                // Stresses of the strains, while they are turned as well.
                let judged = 2.0 * strains * (6 * demand.sites) as f64;
                8.0 * (fields + judged + forms * (motions * motions) as f64)
            }
            // A copy of mesh and constraints as well.
            None => {
                PER_PLACE * (body.plate.kept_cells().count() * body.plate.info().ndof()) as f64
                    + Demand::PER_UNKNOWN * all
            }
        }
    }

    fn on_structure(&mut self, body: &Body<'_>, plate: &mut Marched) -> Result<(), Error> {
        let Marched { full, reduced, stretched, contacts, springs } = plate;
        match reduced {
            Some(reduced) => {
                let stiffened = MembranePlate::new(full, reduced, (contacts, springs), &MembraneOf(*body));
                *stretched = Some(stiffened.map_err(SolveError::other)?);
            }
            None => {
                let element = dyn_clone::clone_box(body.element);
                let large = LargePlate::new(body.plate, element, body.constraints);
                full.stiffen(large);
                if !springs.is_empty() {
                    let mut held = Symmetric::zero(full.matrices().0.pattern().clone());
                    for spring in &*springs {
                        held.add_spring(spring.stiffness, &spring.at).map_err(SolveError::other)?;
                    }
                    full.carry(&held);
                }
            }
        }
        Ok(())
    }

    fn stretch(
        &self,
        body: &Body<'_>,
        plate: &mut Separable,
        contacts: &[Functional],
        step: f64,
    ) -> Result<Option<Stretch>, Error> {
        let vectors = Stretch::vectors(body.plate.symmetry().name().is_some());
        let springs = plate.parts().springs.clone();
        let stretch = Stretch::new(plate, (contacts, &springs), (step, vectors), &MembraneOf(*body));
        Ok(Some(stretch.map_err(SolveError::other)?))
    }
}

/// The quadratic strains of a plate.
struct MembraneOf<'a>(Body<'a>);

impl MembraneOf<'_> {
    fn of(&self, fields: &[f64]) -> MembraneStrains<'_> {
        let Body { plate, element, constraints, .. } = self.0;
        MembraneStrains::new(plate, element, constraints, fields)
    }
}

impl MembraneForms for MembraneOf<'_> {
    fn gram(&self, fields: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.of(fields).gram().map_err(SolveError::other)
    }

    fn forces(&self, fields: &[f64], combinations: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.of(fields).forces(combinations).map_err(SolveError::other)
    }

    fn forms(
        &self,
        fields: &[f64],
        combinations: &[f64],
        shapes: Option<&[f64]>,
        modes: &[f64],
    ) -> Result<Vec<f64>, SolveError> {
        self.of(fields).forms(combinations, shapes, modes).map_err(SolveError::other)
    }
}

/// Places of a cell's unknowns, kept in lists that have grown, bytes per unknown of a cell.
const PER_PLACE: f64 = 96.0;
/// Of a reduced plate, per contact: membrane strains, and forms of these and of its stresses.
const STRAINS: usize = 35;
const FORMS: usize = 70;

fn stiffening(expected: &Expected) -> f64 {
    expected.coefficient * (expected.deflection / expected.thickness).powi(2)
}

fn answer(expected: &Expected, size: &Size) -> Answer {
    let number = stiffening(expected);
    let choice = match (expected.surrounded, number > THRESHOLD) {
        (false, _) => "off: the supports do not surround the impact",
        (_, true) => "on: effects.membrane = \"on\" or \"auto\"",
        (_, false) => "off: the plate stays linear",
    };
    let [linear, stretched] = expected.forces;
    Answer {
        question: "membrane",
        numbers: vec![
            Number::new(FORMULA, format!("{number:.4}"))
                .threshold(format!("{THRESHOLD}: a linear force is wrong by more than that"))
                .source("Timoshenko and Woinowsky-Krieger; w from the energy balance, Shivakumar 1985"),
            Number::new("A", format!("{:.3}", expected.coefficient)).source("circle under a central load"),
            Number::new("w/h", format!("{:.3}", expected.deflection / expected.thickness))
                .source("until the march ends"),
            Number::new("peak force, linear and not", format!("{linear:.1} N and {stretched:.1} N"))
                .source("of the whole impact, without inertia"),
        ],
        choice: choice.into(),
        effect: "membrane stiffening",
        error: Some(format!("without it the force is wrong by about {:.1} %", 100.0 * number)),
        cost: Some(cost(size)),
    }
}

/// Turns of Newton's method in an implicit step, and steps that one tangent serves.
const TURNS: f64 = 3.0;
const KEPT: f64 = 20.0;
/// Time of an internal force over that of a stiffness.
const FORCE: f64 = 1.0 / 3.0;
/// Of a reduced plate: seconds per cell of the strains of its modes and of their work, directions of these that are solved
/// for, patterns of stress, and seconds per entry of their forms and turn (case 5 of the report's table 1, 60 vectors).
const CELL: f64 = 2e-4;
const DIRECTIONS: u64 = 20;
const PATTERNS: f64 = 13.0;
const ENTRY: f64 = 8e-10;

/// A march by Newton's method over the linear one: [`TURNS`] internal forces and solves a step, of a full plate a new
/// tangent every [`KEPT`] steps, of a reduced one the patterns of its membrane stresses before.
fn cost(size: &Size) -> f64 {
    let seconds = |size: &Size| nominal(size).iter().sum::<f64>();
    let steps = size.work.steps as f64;
    if size.reduced {
        let mut more = *size;
        more.work.solves += DIRECTIONS;
        let modes = size.marched as f64;
        let turns = TURNS * steps * PATTERNS * modes * modes * ENTRY;
        return 1.0 + (seconds(&more) - seconds(size) + size.cells as f64 * CELL + turns) / seconds(size);
    }
    let [assemble, factor, stresses, solves, judge] = nominal(size);
    let turns = TURNS * (solves + steps * FORCE * assemble);
    let tangents = steps / KEPT * (assemble + factor);
    (assemble + factor + stresses + turns + tangents + judge) / seconds(size)
}

fn hindsight(run: &Hindsight, acted: bool, decided: bool) -> Option<String> {
    let Hindsight { reached, coefficient, held, deflection, at, since, lawful } = *run;
    let instead = match (lawful, at) {
        (false, _) => "switch it on with `effects.membrane = \"on\"`, or \"auto\"",
        (true, Some(_)) => "beside plies that follow a law it needs `effects.delamination = \"growth\"`",
        (true, None) => "at rest it is not offered beside plies that follow a law",
    };
    let remedy = format!("(A (w/h)^2, A = {coefficient} for an edge {held}): {instead}");
    match (at, since) {
        (Some(at), Some(since)) if !acted => Some(format!(
            "without membrane stiffening the force is wrong by more than {:.0} % from {:.4} ms on and by about {:.0} % at \
             {:.4} ms, when the plate deflects by {deflection:.2} thicknesses {remedy}",
            100.0 * THRESHOLD,
            since * 1e3,
            100.0 * reached,
            at * 1e3
        )),
        (None, _) if !acted && reached > THRESHOLD => Some(format!(
            "without membrane stiffening the load under which the plate deflects by {deflection:.2} thicknesses is wrong by \
             about {:.0} % {remedy}",
            100.0 * reached
        )),
        (Some(_), None) if acted && decided => Some(format!(
            "the advisor switched membrane stiffening on, and A (w/h)^2 came to {reached:.4} only: `effects.membrane = \
             \"off\"` keeps the force right within {:.0} %",
            100.0 * THRESHOLD
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Hindsight, hindsight};

    #[test]
    fn the_remedy_is_one_that_the_scene_takes() {
        let remedy = |lawful, at| {
            let run =
                Hindsight { reached: 0.2, coefficient: 0.3, held: "clamped", deflection: 0.8, at, since: at, lawful };
            hindsight(&run, false, false).unwrap_or_default()
        };
        assert!(remedy(false, Some(1e-3)).contains("membrane = \"on\""));
        assert!(remedy(true, Some(1e-3)).contains("delamination = \"growth\""));
        assert!(remedy(true, None).contains("not offered"));
    }
}
