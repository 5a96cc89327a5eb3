//! The supervised law: its modes, its totality, and what it does at singularities and limits.

mod flight;
mod joining;
mod misuse;
mod modes;
mod saturation;
mod singular;
mod totality;
mod tracking;
mod trap;
