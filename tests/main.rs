//! The tests of few files, as one program: what they have in common is compiled and linked once.

mod approach;
mod eval;
mod eval_paths;
mod figures;
mod golden_law;
mod golden_plant;
mod golden_witness;
mod lift;
mod link;
mod observer;
mod paths;
mod plant_properties;
mod series;
mod timing;
mod trajectories;

/// A file beside this one that no `mod` names would be no test.
#[test]
fn every_file_is_part_of_the_program() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).to_owned();
    let main = include_str!("main.rs");
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if path.extension().is_some_and(|extension| extension == "rs") && name != "main" {
            assert!(main.contains(&format!("mod {name};")), "{} is not named", path.display());
        }
    }
}
