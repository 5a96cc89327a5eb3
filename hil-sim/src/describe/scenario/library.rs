//! The scenarios that come with the program, kept in it so that it flies them from anywhere.

use super::{Scenario, ScenarioError};

macro_rules! scenarios {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../scenarios/", $name, ".toml")))),*]
    };
}

/// The paper's figures by name, in their order, with the text of their files.
pub const FIGURES: &[(&str, &str)] = scenarios![
    "fig2a",
    "fig2b",
    "fig3a",
    "fig3b",
    "fig3b-equal-poles",
    "fig5",
    "fig5-no-integral",
    "fig6",
    "fig6-no-integral",
];

/// Curves of every kind: each from off the path, and again with the law told half and one and a
/// half times the payload's mass.
pub const CURVES: &[(&str, &str)] = scenarios![
    "tilted-circle",
    "tilted-circle-light",
    "tilted-circle-heavy",
    "sloped-ellipse",
    "sloped-ellipse-light",
    "sloped-ellipse-heavy",
    "superellipse",
    "superellipse-light",
    "superellipse-heavy",
    "bent",
    "bent-light",
    "bent-heavy",
    "vertical-ellipse",
    "vertical-ellipse-light",
    "vertical-ellipse-heavy",
    "knot",
    "knot-light",
    "knot-heavy",
    "building",
    "building-light",
    "building-heavy",
];

/// Routes: what a curve that closes without crossing itself can't be.
pub const ROUTES: &[(&str, &str)] = scenarios!["figure-eight", "survey-rows", "helix", "a-to-b", "two-kilometres"];

/// A vehicle on the ground with a mission about home, which a ground station flies unless another
/// is named.
pub const STATION: &str = "ground-station";

const OTHERS: &[(&str, &str)] = scenarios!["ground-station", "on-instruments"];

/// The scenario of this name, if there is one.
///
/// # Errors
/// [`ScenarioError`] as for any file.
pub fn builtin(name: &str) -> Option<Result<Scenario, ScenarioError>> {
    let (name, text) = all().find(|(known, _)| *known == name)?;
    Some(Scenario::parse(&format!("hil-sim/scenarios/{name}.toml"), text))
}

/// The names of all.
pub fn builtin_names() -> impl Iterator<Item = &'static str> {
    all().map(|(name, _)| *name)
}

fn all() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    FIGURES.iter().chain(CURVES).chain(ROUTES).chain(OTHERS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_scenario_is_valid() {
        for name in builtin_names() {
            let scenario = builtin(name).expect("it is in the list").unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(scenario.name, *name);
        }
    }
}
