//! `VEH_*`: the vehicle as the law knows it.

use controller::{OutOfRange, Real, Vehicle, VehicleParams};

use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::{parameter, run};

const INERTIA: (f64, f64) = (1e-6, 1e3);

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::real("VEH_M_LOAD", "payload_mass", "kg", 0.5, (1e-3, 1e3), "Payload mass."),
    Entry::real("VEH_M_UAV", "uav_mass", "kg", 2.5, (1e-2, 1e3), "UAV mass without the payload."),
    Entry::real("VEH_ROD", "rod_length", "m", 2.0, (0.05, 100.0), "Length of the cable, taut."),
    Entry::real("VEH_J1", "inertia[0]", "kg.m^2", 0.03, INERTIA, "Moment of inertia about b1 (forward)."),
    Entry::real("VEH_J2", "inertia[1]", "kg.m^2", 0.03, INERTIA, "Moment of inertia about b2 (right)."),
    Entry::real("VEH_J3", "inertia[2]", "kg.m^2", 0.05, INERTIA, "Moment of inertia about b3 (down)."),
    Entry::real("VEH_G", "gravity", "m/s^2", 9.81, (0.1, 30.0), "Gravity."),
];

pub(crate) fn vehicle<T: Real>(parameters: &Parameters<T>) -> Result<Vehicle<T>, OutOfRange<T>> {
    Vehicle::new(VehicleParams {
        payload_mass: parameters.get(parameter!("VEH_M_LOAD")),
        uav_mass: parameters.get(parameter!("VEH_M_UAV")),
        rod_length: parameters.get(parameter!("VEH_ROD")),
        inertia: parameters.run(run!("VEH_J1" to "VEH_J3")),
        gravity: parameters.get(parameter!("VEH_G")),
    })
    .map_err(parameters.naming("VEH_"))
}
