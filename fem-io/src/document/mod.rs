//! A document of keys and values as people write it, with the place of each: what scenes and files of materials have in
//! common.

mod faults;
pub(crate) mod keys;
pub(crate) mod reader;
pub(crate) mod source;
pub(crate) mod tree;
