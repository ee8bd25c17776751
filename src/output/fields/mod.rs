//! Fields over the plate as files of VTK, frame by frame: `fields/` in the folder of the results.
//!
//! | series | cells | what they tell |
//! | --- | --- | --- |
//! | `plate` | those of the elements | displacement and, in a march, velocity |
//! | `plies` | one per ply and quad | stress in the axes of the ply and indices, as the criteria see them |
//! | `interfaces` | one per interface and quad | tractions and indices |
//!
//! `all.pvd` lists the frames of all series, `names.json` says what numbers in them count, and `view.py` draws them.
//!
//! A frame is a state of the whole plate, also where a symmetry computes a part of it. Files depend on nothing but
//! the state, so that a resumed march writes what one in one piece writes.

mod damaged;
mod lattice;
mod march;
mod names;
mod plate;
mod plies;
mod size;
mod so_far;

pub(crate) use march::MarchFields;
pub(crate) use size::{Expected, expected};

use crate::analyses::Stressed;
use crate::analyses::impact::Maximum;
use crate::analyses::{buckling, modes, statics, stress};
use crate::cost::{Phase, Stopwatch};
use crate::error::Error;
use crate::model::Model;
use fem_io::files::OutputDir;
use fem_io::scene::FieldSeries;
use fem_io::tables::write_json;
use fem_io::vtu::{Array, Contents, Grid, Member, write_collection};
use names::Names;
use plate::Plate;
use plies::Plies;
use std::f64::consts::TAU;

/// Folder of the files.
const FOLDER: &str = "fields";

/// Name of the time that writing takes.
const PHASE: &str = "fields";

/// Draws the files with PyVista.
const SCRIPT: &str = include_str!("view.py");

/// A state of the plate, in its unknowns before elimination of constraints.
#[derive(Debug, Clone, Copy)]
struct State<'a> {
    displacements: &'a [f64],
    /// What stresses follow from, where that is not the displacements alone.
    stressed: Option<&'a Stressed>,
    velocities: Option<&'a [f64]>,
    /// States of plies that follow laws; without them plies are linear elastic.
    points: Option<&'a [f64]>,
    /// States of interfaces that may open.
    interfaces: Option<&'a [f64]>,
    /// Of a natural mode its frequency, Hz, of buckling its load factor, by the name of the field.
    figure: Option<(&'static str, f64)>,
    /// In a march what the criteria have found up to now.
    maxima: Option<&'a [Maximum]>,
}

impl<'a> State<'a> {
    /// Displacements alone.
    fn of(displacements: &'a [f64]) -> Self {
        Self {
            displacements,
            stressed: None,
            velocities: None,
            points: None,
            interfaces: None,
            figure: None,
            maxima: None,
        }
    }
}

/// Grids of all series and what is needed to fill them, made once.
#[derive(Debug)]
struct Layout<'a> {
    plate: Option<Plate<'a>>,
    plies: Option<Plies<'a>>,
}

impl<'a> Layout<'a> {
    /// `None` where the scene asks for no fields.
    fn new(model: &'a Model) -> Result<Option<Self>, Error> {
        let Some(plan) = &model.fields else { return Ok(None) };
        let plate = plan.series.contains(&FieldSeries::Plate).then(|| Plate::new(model, plan));
        let [plies, interfaces] =
            [FieldSeries::Plies, FieldSeries::Interfaces].map(|series| plan.series.contains(&series));
        let plies = if plies || interfaces { Some(Plies::new(model, plan, plies, interfaces)?) } else { None };
        Ok(Some(Self { plate, plies }))
    }

    fn has(&self, series: FieldSeries) -> bool {
        match series {
            FieldSeries::Plate => self.plate.is_some(),
            _ => self.plies.as_ref().is_some_and(|plies| plies.has(series)),
        }
    }
}

/// Most frames that wait to be written together: strain operators are made once for all of them.
const BATCH: usize = 16;

/// Most bytes of values that are found together; fewer frames wait where points are many.
const STORE: usize = 64 << 20;

/// The files of a run.
#[derive(Debug)]
struct Writer<'a> {
    layout: Layout<'a>,
    dir: OutputDir,
    /// Times of all frames.
    times: Vec<f64>,
    waiting: Vec<Waiting>,
}

/// A frame that waits to be written.
#[derive(Debug)]
struct Waiting {
    number: usize,
    displacements: Vec<f64>,
    stressed: Option<Stressed>,
    velocities: Option<Vec<f64>>,
    points: Option<Vec<f64>>,
    interfaces: Option<Vec<f64>>,
    figure: Option<(&'static str, f64)>,
    /// What the criteria had found, for `plies` and for `interfaces`.
    so_far: Vec<(FieldSeries, Vec<Array>)>,
}

impl<'a> Writer<'a> {
    /// Makes the folder below `results` for frames at `times`, s, or whatever numbers them; `None` where the scene
    /// asks for no fields.
    ///
    /// # Errors
    /// A folder that cannot be made, a criterion whose material lacks a constant.
    fn new(model: &'a Model, results: &OutputDir, times: Vec<f64>) -> Result<Option<Self>, Error> {
        let Some(layout) = Layout::new(model)? else { return Ok(None) };
        let dir = results.folder(FOLDER)?;
        write_json(&dir, "names.json", &Names::of(model))?;
        dir.write("view.py", |out| out.write_all(SCRIPT.as_bytes()))?;
        Ok(Some(Self { layout, dir, times, waiting: Vec::new() }))
    }

    /// Takes frame `number`, counted from 0; it may wait for others, until [`Writer::flush`] at the latest.
    ///
    /// # Errors
    /// As [`Writer::flush`].
    fn take(&mut self, number: usize, state: State<'_>) -> Result<(), Error> {
        let State { displacements, figure, maxima, .. } = state;
        let [velocities, points, interfaces] =
            [state.velocities, state.points, state.interfaces].map(|values| values.map(<[f64]>::to_vec));
        let (displacements, stressed) = (displacements.to_vec(), state.stressed.cloned());
        let Layout { plate, plies } = &self.layout;
        let so_far = plies.as_ref().zip(maxima).map_or_else(Vec::new, |(plies, maxima)| plies.so_far(maxima));
        self.waiting.push(Waiting { number, displacements, stressed, velocities, points, interfaces, figure, so_far });
        let of_frame =
            plate.as_ref().map_or(0, Plate::bytes_of_frame) + plies.as_ref().map_or(0, Plies::bytes_of_frame);
        let most = (STORE / of_frame.max(1)).clamp(1, BATCH);
        if self.waiting.len() < most { Ok(()) } else { self.flush() }
    }

    fn shows_plies(&self) -> bool {
        self.layout.plies.is_some()
    }

    /// Writes the frames that wait, and the series up to them.
    ///
    /// # Errors
    /// A cell that the element refuses, a number that is not finite, a stress that a criterion does not take, a
    /// folder that cannot be written.
    fn flush(&mut self) -> Result<(), Error> {
        let waiting = std::mem::take(&mut self.waiting);
        let Self { layout: Layout { plate, plies }, dir, times, .. } = self;
        let frames = waiting.iter().map(|waiting| {
            let Waiting { number, displacements, stressed, figure, so_far, .. } = waiting;
            let [velocities, points, interfaces] =
                [&waiting.velocities, &waiting.points, &waiting.interfaces].map(Option::as_deref);
            let stressed = stressed.as_ref();
            let state =
                State { displacements, stressed, velocities, points, interfaces, figure: *figure, maxima: None };
            Frame { dir, times: &times[..=*number], state, so_far }
        });
        let frames: Vec<Frame<'_>> = frames.collect();
        if let Some(plate) = plate {
            plate.write(&frames)?;
        }
        match plies {
            Some(plies) if !frames.is_empty() => plies.write(&frames)?,
            _ => {}
        }
        let Some(last) = frames.last() else { return Ok(()) };
        let series = [FieldSeries::Plate, FieldSeries::Plies, FieldSeries::Interfaces];
        let written: Vec<FieldSeries> = series.into_iter().filter(|series| self.layout.has(*series)).collect();
        last.list("all", &written)
    }
}

/// Writes the one frame of a static analysis below `dir`, where the scene asks for fields; what it took.
///
/// # Errors
/// As [`Writer::new`] and [`Writer::flush`].
pub(crate) fn write_static(
    dir: &OutputDir,
    model: &Model,
    solution: &statics::StaticSolution,
) -> Result<Option<Phase>, Error> {
    let mut stopwatch = Stopwatch::default();
    let Some(mut writer) = Writer::new(model, dir, vec![0.0])? else { return Ok(None) };
    writer.take(0, State { points: Some(&stress::virgin(model)), ..State::of(&solution.u) })?;
    writer.flush()?;
    stopwatch.lap(PHASE);
    Ok(stopwatch.phases().first().cloned())
}

/// Writes a frame for each natural mode below `dir`, where the scene asks for fields; what it took. The time of a
/// frame is the number of its mode.
///
/// # Errors
/// As [`Writer::new`] and [`Writer::flush`].
pub(crate) fn write_modes(
    dir: &OutputDir,
    model: &Model,
    solution: &modes::ModesSolution,
) -> Result<Option<Phase>, Error> {
    let found = &solution.modes;
    write_shapes(dir, model, &found.shapes, found.omega.iter().map(|omega| ("frequency_Hz", omega / TAU)))
}

/// The same of each shape of buckling.
///
/// # Errors
/// As [`write_modes`].
pub(crate) fn write_buckling(
    dir: &OutputDir,
    model: &Model,
    solution: &buckling::BucklingSolution,
) -> Result<Option<Phase>, Error> {
    let found = &solution.buckling;
    write_shapes(dir, model, &found.shapes, found.factors.iter().map(|factor| ("load_factor", *factor)))
}

fn write_shapes(
    dir: &OutputDir,
    model: &Model,
    shapes: &[f64],
    figures: impl ExactSizeIterator<Item = (&'static str, f64)>,
) -> Result<Option<Phase>, Error> {
    let mut stopwatch = Stopwatch::default();
    let numbers = (1..=figures.len()).map(|number| number as f64).collect();
    let Some(mut writer) = Writer::new(model, dir, numbers)? else { return Ok(None) };
    let mut u = vec![0.0; model.plate.ndof()];
    let shapes = shapes.chunks_exact(model.constraints.ndof().max(1));
    for (number, (shape, figure)) in shapes.zip(figures).enumerate() {
        model.constraints.expand(shape, &mut u);
        writer.take(number, State { figure: Some(figure), ..State::of(&u) })?;
    }
    writer.flush()?;
    stopwatch.lap(PHASE);
    Ok(stopwatch.phases().first().cloned())
}

/// A frame that is written.
struct Frame<'a> {
    dir: &'a OutputDir,
    /// Times of all frames up to this one.
    times: &'a [f64],
    state: State<'a>,
    so_far: &'a [(FieldSeries, Vec<Array>)],
}

/// Name of the file of a frame, whose number counts from 1.
fn file(series: FieldSeries, number: usize) -> String {
    format!("{}-{number:04}.vtu", series.name())
}

impl Frame<'_> {
    fn time(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Writes the file of a series, and the list of its files.
    fn write(&self, series: FieldSeries, grid: &Grid, contents: Contents<'_>) -> Result<(), Error> {
        let mut field = vec![Array::precise("TimeValue", 1, &[self.time()])];
        field.extend(self.state.figure.map(|(name, figure)| Array::precise(name, 1, &[figure])));
        grid.write(self.dir, &file(series, self.times.len()), Contents { field: &field, ..contents })?;
        self.list(series.name(), &[series])
    }

    /// Writes the list `name` of these series up to this frame.
    fn list(&self, name: &str, series: &[FieldSeries]) -> Result<(), Error> {
        let parts = |(number, time): (usize, &f64)| {
            let member =
                |(part, series): (usize, &FieldSeries)| Member { time: *time, part, file: file(*series, number) };
            series.iter().enumerate().map(member).collect::<Vec<_>>()
        };
        let members: Vec<Member> = (1..).zip(self.times).flat_map(parts).collect();
        Ok(write_collection(self.dir, &format!("{name}.pvd"), &members)?)
    }
}
