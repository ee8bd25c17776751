//! Tests of the whole: the command, what it refuses, what it finds.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod accuracy;
mod advise;
mod architecture;
mod asked;
mod bad_input;
mod book;
mod comfort;
mod command_line;
mod criteria;
mod decks;
mod effects;
mod envelope;
mod extremes;
mod fields;
mod forged;
mod free;
mod impactors;
mod indices;
mod invariance;
mod job;
mod kills;
mod mesh;
mod modal;
mod model;
mod overlooked;
mod page;
mod parameters;

mod regions;
mod registry;
mod report;
mod restart;
mod separation;
mod snapshots;
mod strangers;
mod study;
mod support;
mod tiling;
mod triangles;
mod two_level;
mod validation;
mod words;
