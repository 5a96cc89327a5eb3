//! The controller made of named numbers: its table, and its rotors.

mod rotors;
mod table;
