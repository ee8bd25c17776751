//! Displacements, stresses and frequencies against solutions without finite elements.

mod advise;
mod built_in;
mod command;
mod cure;
mod estimate;
mod impact;
mod large;
mod layers;
mod loads;
mod modes;
mod onset;
mod pagano;
mod patch;
mod preload;
mod scene;
mod slender;
mod softness;
mod strip;
mod study;
mod substructures;
mod supports;
mod symmetry;
mod transverse;
mod triangles;
mod waves;
mod worth;
