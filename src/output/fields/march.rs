//! Fields of a march, written as it goes on.

use super::{PHASE, State, Writer};
use crate::analyses::impact::March;
use crate::error::Error;
use crate::model::Model;
use fem_io::files::OutputDir;

/// Writes the frames of a march below a folder of results; the time that it takes is a phase of the march.
#[derive(Debug)]
pub(crate) struct MarchFields<'a> {
    model: &'a Model,
    dir: &'a OutputDir,
    /// From the first frame on.
    writer: Option<Writer<'a>>,
}

impl<'a> MarchFields<'a> {
    /// For a march of `model` with results in `dir`.
    pub(crate) fn new(model: &'a Model, dir: &'a OutputDir) -> Self {
        Self { model, dir, writer: None }
    }

    /// Takes the present step of `march`, where it is a frame; several frames may wait to be written together, until
    /// [`MarchFields::flush`] at the latest.
    ///
    /// # Errors
    /// A folder that cannot be written. A frame that makes no sense stops the march.
    pub(crate) fn take(&mut self, march: &mut March<'_>) -> Result<(), Error> {
        let Some(number) = march.frame() else { return Ok(()) };
        march.beside(PHASE, |march| {
            let (u, v, stressed) = (march.displacements(), march.velocities(), march.stressed());
            if self.writer.is_none() {
                self.writer = Writer::new(self.model, self.dir, march.frame_times())?;
            }
            let Some(writer) = &mut self.writer else { return Ok(()) };
            let maxima = if writer.shows_plies() { march.maxima()? } else { Vec::new() };
            let maxima = Some(maxima.as_slice());
            let (points, interfaces) = (Some(march.points()), Some(march.interfaces()));
            let state = State { maxima, stressed: stressed.as_ref(), points, interfaces, ..State::of(&u) };
            writer.take(number, State { velocities: v.as_deref(), ..state })
        })
    }

    /// Writes the frames that wait: before the march is saved, since a march that goes on from there takes them no more.
    ///
    /// # Errors
    /// As [`MarchFields::take`].
    pub(crate) fn flush(&mut self, march: &mut March<'_>) -> Result<(), Error> {
        match &mut self.writer {
            Some(writer) => march.beside(PHASE, |_| writer.flush()),
            None => Ok(()),
        }
    }
}
