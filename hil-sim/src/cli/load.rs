//! Scenarios as a command line names them: files, or built in.

use hil_sim::describe::scenario::{self, Scenario};
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

/// The built-in scenarios of these lists.
pub fn built_in(lists: &[&[(&str, &str)]]) -> Result<Vec<Scenario>, Box<dyn Error>> {
    let names = lists.iter().copied().flatten().map(|(name, _)| *name);
    Ok(names.filter_map(scenario::builtin).collect::<Result<_, _>>()?)
}

/// Scenarios from files, or built in; each name once.
pub fn all(files: &[PathBuf]) -> Result<Vec<Scenario>, Box<dyn Error>> {
    let mut scenarios: Vec<Scenario> = Vec::new();
    for file in files {
        let scenario = one(file)?;
        if scenarios.iter().any(|other| other.name == scenario.name) {
            return Err(format!("{}: a second scenario named {}", file.display(), scenario.name).into());
        }
        scenarios.push(scenario);
    }
    Ok(scenarios)
}

/// A scenario from a file, or built in.
pub fn one(file: &Path) -> Result<Scenario, Box<dyn Error>> {
    match std::fs::read_to_string(file) {
        Ok(text) => Ok(Scenario::parse(&file.to_string_lossy(), &text)?),
        Err(error) if error.kind() == io::ErrorKind::NotFound => match file.to_str().and_then(scenario::builtin) {
            Some(scenario) => Ok(scenario?),
            None => Err(absent(file, "scenario", scenario::builtin_names())),
        },
        Err(error) => Err(format!("{}: {error}", file.display()).into()),
    }
}

/// That there is no such file, and no built-in `kind` of this name, but others.
pub fn absent<'a>(file: &Path, kind: &str, known: impl Iterator<Item = &'a str>) -> Box<dyn Error> {
    let known: Vec<&str> = known.collect();
    format!("{}: there is no such file, and the built-in {kind}s are {}", file.display(), known.join(", ")).into()
}
