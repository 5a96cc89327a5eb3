//! Independent witnesses of the law and of the plant: the paper's equations in the paper's own
//! coordinates, differentiated by machine. Nothing of the project is a dependency of this crate, so
//! no formula of its can come from the code it checks. Numbers in brackets are equations of
//! `docs/theory.md`.

pub mod jet;
pub mod law;
pub mod plant;
