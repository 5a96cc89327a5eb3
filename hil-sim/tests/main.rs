//! The simulator's tests, as one program: what they have in common is compiled and linked once.

mod calibrate;
mod campaign;
mod check;
mod cli;
mod curves;
mod estimate;
mod fit;
mod formula;
mod ground;
mod gusts;
mod hunt;
mod instruments;
mod keys;
mod mission;
mod multibody;
mod path;
mod rate_loop;
mod readme;
mod replay;
mod route;
mod tethered;
mod tune;
mod ulog;

/// A file beside this one that no `mod` names would be no test.
#[test]
fn every_file_is_part_of_the_program() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let main = include_str!("main.rs");
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if path.extension().is_some_and(|extension| extension == "rs") && name != "main" {
            assert!(main.contains(&format!("mod {name};")), "{} is not named", path.display());
        }
    }
}
