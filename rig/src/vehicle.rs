//! `VEH_*`: the vehicle as the law knows it.

use controller::{OutOfRange, Range, Real, Vehicle, VehicleParams, ranges};

use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::{parameter, run};

const INERTIA: [Range; 3] = ranges::INERTIA;

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::of("VEH_M_LOAD", ranges::PAYLOAD_MASS, "kg", "Payload mass."),
    Entry::of("VEH_M_UAV", ranges::UAV_MASS, "kg", "UAV mass without the payload."),
    Entry::of("VEH_ROD", ranges::ROD_LENGTH, "m", "Length of the cable, taut."),
    Entry::of("VEH_J1", INERTIA[0], "kg.m^2", "Moment of inertia about b1 (forward)."),
    Entry::of("VEH_J2", INERTIA[1], "kg.m^2", "Moment of inertia about b2 (right)."),
    Entry::of("VEH_J3", INERTIA[2], "kg.m^2", "Moment of inertia about b3 (down)."),
    Entry::of("VEH_G", ranges::GRAVITY, "m/s^2", "Gravity."),
];

impl<T: Real> Parameters<T> {
    /// The vehicle as the law knows it.
    ///
    /// # Errors
    /// A number is out of range, by its parameter's name.
    pub fn vehicle(&self) -> Result<Vehicle<T>, OutOfRange<T>> {
        Vehicle::new(VehicleParams {
            payload_mass: self.get(parameter!("VEH_M_LOAD")),
            uav_mass: self.get(parameter!("VEH_M_UAV")),
            rod_length: self.get(parameter!("VEH_ROD")),
            inertia: self.run(run!("VEH_J1" to "VEH_J3")),
            gravity: self.get(parameter!("VEH_G")),
        })
        .map_err(self.naming(&["VEH_"]))
    }
}
