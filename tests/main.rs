//! Tests of the whole: the command, what it refuses, what it finds.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod accuracy;
mod advise;
mod bad_input;
mod book;
mod command_line;
mod criteria;
mod effects;
mod envelope;
mod impactors;
mod indices;
mod modal;
mod model;
mod page;
mod registry;
mod report;
mod restart;
mod snapshots;
mod study;
mod support;
mod two_level;
mod validation;
