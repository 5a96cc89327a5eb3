//! `OBS_*`: the disturbance observers.

use controller::{ObserverParams, Real, ranges};

use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::run;

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::of(
        "OBS_W_LOAD",
        ranges::PAYLOAD_BANDWIDTH,
        "rad/s",
        "Bandwidth of the observer of the force on the payload; 0 is off.",
    ),
    Entry::of(
        "OBS_W_ALONG",
        ranges::ALONG_BANDWIDTH,
        "rad/s",
        "Bandwidth along the cable of the observer of the force on the payload; 0 is OBS_W_LOAD.",
    ),
    Entry::of(
        "OBS_EA",
        ranges::CABLE_STIFFNESS,
        "N",
        "Stiffness EA of the cable, which bounds the bandwidth along it; 0 is a cable that does not stretch.",
    ),
    Entry::of(
        "OBS_W_ROD",
        ranges::ROD_BANDWIDTH,
        "rad/s",
        "Bandwidth of the observer of the rod's acceleration beyond the model's; 0 is off.",
    ),
    Entry::of(
        "OBS_W_TAU",
        ranges::TORQUE_BANDWIDTH,
        "rad/s",
        "Bandwidth of the observer of the torque on the UAV; 0 is off.",
    ),
    Entry::of(
        "OBS_MAX_LOAD",
        ranges::PAYLOAD_BOUND,
        "m/s^2",
        "Largest force on the payload that may be found, as an acceleration.",
    ),
    Entry::of("OBS_MAX_ROD", ranges::ROD_BOUND, "1/s^2", "Largest acceleration of the rod that may be found."),
    Entry::of(
        "OBS_MAX_LEVER",
        ranges::TORQUE_LEVER,
        "m",
        "Lever of the hover thrust that is the largest torque which may be found.",
    ),
];

impl<T: Real> Parameters<T> {
    /// The disturbance observers.
    #[must_use]
    pub fn observer(&self) -> ObserverParams<T> {
        let [
            payload_bandwidth,
            along_bandwidth,
            cable_stiffness,
            rod_bandwidth,
            torque_bandwidth,
            payload_bound,
            rod_bound,
            torque_lever,
        ] = self.run(run!("OBS_W_LOAD" to "OBS_MAX_LEVER"));
        ObserverParams {
            payload_bandwidth,
            along_bandwidth,
            cable_stiffness,
            rod_bandwidth,
            torque_bandwidth,
            payload_bound,
            rod_bound,
            torque_lever,
        }
    }
}
