//! What makes scenes and the command line easy to use: new scenes, the schema, what is explained, how things are said.

mod json;
mod mistakes;
mod new;
mod schema;
mod voice;
