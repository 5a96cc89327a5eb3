//! `OBS_*`: the disturbance observers.

use controller::{ObserverParams, Real};

use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::run;

const BANDWIDTH: (f64, f64) = (0.0, 100.0);
const BOUND: (f64, f64) = (0.0, 1e3);

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::real(
        "OBS_W_LOAD",
        "payload_bandwidth",
        "rad/s",
        4.0,
        BANDWIDTH,
        "Bandwidth of the observer of the force on the payload; 0 is off.",
    ),
    Entry::real(
        "OBS_W_ROD",
        "rod_bandwidth",
        "rad/s",
        4.0,
        BANDWIDTH,
        "Bandwidth of the observer of the rod's acceleration beyond the model's; 0 is off.",
    ),
    Entry::real(
        "OBS_W_TAU",
        "torque_bandwidth",
        "rad/s",
        4.0,
        BANDWIDTH,
        "Bandwidth of the observer of the torque on the UAV; 0 is off.",
    ),
    Entry::real(
        "OBS_MAX_LOAD",
        "payload_bound",
        "m/s^2",
        15.0,
        BOUND,
        "Largest force on the payload that may be found, as an acceleration.",
    ),
    Entry::real("OBS_MAX_ROD", "rod_bound", "1/s^2", 10.0, BOUND, "Largest acceleration of the rod."),
    Entry::real("OBS_MAX_TAU", "torque_bound", "N.m", 1.0, BOUND, "Largest torque."),
];

pub(crate) fn observer<T: Real>(parameters: &Parameters<T>) -> ObserverParams<T> {
    let [payload_bandwidth, rod_bandwidth, torque_bandwidth, payload_bound, rod_bound, torque_bound] =
        parameters.run(run!("OBS_W_LOAD" to "OBS_MAX_TAU"));
    ObserverParams { payload_bandwidth, rod_bandwidth, torque_bandwidth, payload_bound, rod_bound, torque_bound }
}
