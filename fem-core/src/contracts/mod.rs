//! What a plug-in promises, and what it may ask of a structure.

pub mod contact;
pub mod cubic_strains;
pub mod element;
pub mod failure;
pub mod interface_law;
pub mod large;
pub mod plugin;
pub mod ply_law;
pub mod reduction;
pub mod stack;
pub mod structure;
pub mod time;
pub mod transverse;
