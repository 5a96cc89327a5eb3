//! The numbers that the figures should measure, for the table and for the tests.

use serde::Deserialize;
use std::collections::BTreeMap;

use crate::fly::metrics::Results;

/// Reference numbers of the built-in scenarios.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// By scenario.
    pub runs: BTreeMap<String, Results>,
    /// Of scenarios with one number changed.
    pub variants: Vec<Variant>,
}

/// A scenario with one number changed, and what it should measure.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// The scenario.
    pub scenario: String,
    /// Time that the obstacle holds, s.
    pub hold_s: Option<f64>,
    /// v_d of a circle, m/s.
    pub speed: Option<f64>,
    /// What it should measure.
    pub results: Results,
}

impl Reference {
    /// The numbers that come with the program.
    #[must_use]
    pub fn builtin() -> Self {
        toml::from_str(include_str!("../../scenarios/reference.toml")).expect("a test reads this file")
    }
}

#[cfg(test)]
mod tests {
    use super::Reference;
    use crate::describe::scenario::FIGURES;

    #[test]
    fn every_figure_has_its_numbers() {
        let reference = Reference::builtin();
        let named: Vec<&str> = reference.runs.keys().map(String::as_str).collect();
        let mut figures: Vec<&str> = FIGURES.iter().map(|(name, _)| *name).collect();
        figures.sort_unstable();
        assert_eq!(named, figures);
    }
}
