//! How a replay compares with its log.

use controller::{Command, State};
use serde::Serialize;

use super::filter::Found;

/// A replay beside its log.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Replayed {
    /// What the law was given: the estimate, or the load as it is logged.
    pub given: &'static str,
    /// Thrust replayed less logged, N.
    pub thrust_n: Option<Difference>,
    /// Torque likewise, N m: the length of the difference.
    pub torque_nm: Option<Difference>,
    /// From the logged load to the estimated one, m.
    pub load_m: Option<Difference>,
    /// From the logged rod to the estimated one, degrees.
    pub rod_deg: Option<Difference>,
    /// What the log lacks, and what can't be said without it.
    pub unsaid: Vec<String>,
}

/// How far two things are apart over a log.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Root mean square.
    pub rms: f64,
    /// Largest.
    pub max: f64,
}

/// Sums on the way to a [`Difference`].
#[derive(Default)]
struct Sum {
    squares: f64,
    count: f64,
    max: f64,
}

impl Sum {
    fn push(&mut self, value: f64) {
        if value.is_finite() {
            self.squares += value * value;
            self.count += 1.0;
            self.max = self.max.max(value.abs());
        }
    }

    fn finish(&self) -> Option<Difference> {
        (self.count > 0.0).then(|| Difference { rms: (self.squares / self.count).sqrt(), max: self.max })
    }
}

/// Collects a [`Replayed`], period by period.
#[derive(Default)]
pub struct Agreement {
    thrust: Sum,
    torque: Sum,
    load: Sum,
    rod: Sum,
}

impl Agreement {
    /// Takes what was replayed and logged: commands, and the load.
    pub fn push(&mut self, commands: Option<(Command<f64>, Command<f64>)>, loads: Option<(State<f64>, Found)>) {
        if let Some((replayed, logged)) = commands {
            self.thrust.push(replayed.thrust - logged.thrust);
            let apart = replayed.torque - logged.torque;
            self.torque.push(apart.dot(&apart).sqrt());
        }
        if let Some((logged, Found { state, .. })) = loads {
            let apart = state.position - logged.position;
            self.load.push(apart.dot(&apart).sqrt());
            let cross = logged.rod.cross(&state.rod);
            self.rod.push(libm::atan2(cross.dot(&cross).sqrt(), logged.rod.dot(&state.rod)).to_degrees());
        }
    }

    /// All of it.
    pub fn finish(&self, is_estimated: bool, unsaid: &[String]) -> Replayed {
        Replayed {
            given: if is_estimated { "the estimate" } else { "the logged load" },
            thrust_n: self.thrust.finish(),
            torque_nm: self.torque.finish(),
            load_m: self.load.finish(),
            rod_deg: self.rod.finish(),
            unsaid: unsaid.to_vec(),
        }
    }
}

impl Replayed {
    /// In sentences: how it compares, and what can't be said.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let rows = [
            ("thrust, replayed less logged", self.thrust_n, "N"),
            ("torque, replayed less logged", self.torque_nm, "N m"),
            ("load, estimated from logged", self.load_m, "m"),
            ("rod, estimated from logged", self.rod_deg, "°"),
        ];
        let compared = rows.into_iter().filter_map(|(what, difference, unit)| {
            let Difference { rms, max } = difference?;
            Some(format!("{what}: {rms:.3} {unit} in the root mean square, {max:.3} {unit} at most"))
        });
        let given = format!("the law was given {}", self.given);
        std::iter::once(given).chain(compared).chain(self.unsaid.iter().cloned()).collect()
    }
}
