//! `LIM_*`, `ROT_*`: from what the law asks for to what the rotors are told.

use controller::{Actuation, ActuatorLimits, Command, OutOfRange, Place, Range, Real, RotorParams, Rotors, ranges};

use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::{parameter, run};

const TORQUE: [Range; 3] = ranges::MAX_TORQUE;
/// Rotors push one way only.
const MIN_THRUST: Range = Range::new("min_thrust", 0.0, ranges::MIN_THRUST.max, ranges::MIN_THRUST.default);

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::of(
        "LIM_T_MIN",
        MIN_THRUST,
        "N",
        "Least thrust that the law may ask for in flight. Roll and pitch may need more or less of it.",
    ),
    Entry::of("LIM_T_MAX", ranges::MAX_THRUST, "N", "Largest thrust; likewise."),
    Entry::of("LIM_TAU_1", TORQUE[0], "N.m", "Largest torque about b1, either way."),
    Entry::of("LIM_TAU_2", TORQUE[1], "N.m", "Largest torque about b2, either way."),
    Entry::of("LIM_TAU_3", TORQUE[2], "N.m", "Largest torque about b3, either way."),
    Entry::of("ROT_ARM", ranges::ROTOR_ARM, "m", "A rotor's distance from the axes b1 and b2 (X configuration)."),
    Entry::of("ROT_KT", ranges::THRUST_COEFFICIENT, "N/(rad/s)^2", "A rotor's thrust over its speed squared."),
    Entry::of("ROT_KQ", ranges::TORQUE_COEFFICIENT, "N.m/(rad/s)^2", "A rotor's drag torque over its speed squared."),
    Entry::of("ROT_W_MIN", ranges::MIN_SPEED, "rad/s", "Least speed of an armed rotor."),
    Entry::of(
        "ROT_W_MAX",
        ranges::MAX_SPEED,
        "rad/s",
        "A rotor's speed at full command; at most 0.9 of it may be the least.",
    ),
];

/// The limits that the pilot sets, and then four rotors, which have the last word.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuators<T> {
    /// Within what the rotors have at most.
    limits: ActuatorLimits<T>,
    rotors: Rotors<T, 4>,
}

impl<T: Real> Actuators<T> {
    /// As `parameters` describes them.
    ///
    /// # Errors
    /// A limit or a rotor's number is out of range, or the rotors have no room for torque.
    pub fn new(parameters: &Parameters<T>) -> Result<Self, OutOfRange<T>> {
        let mut limits = ActuatorLimits {
            min_thrust: parameters.get(parameter!("LIM_T_MIN")),
            max_thrust: parameters.get(parameter!("LIM_T_MAX")),
            max_torque: parameters.run(run!("LIM_TAU_1" to "LIM_TAU_3")),
        };
        limits.check().map_err(parameters.naming(&["LIM_"]))?;
        let rotor = RotorParams {
            thrust_coefficient: parameters.get(parameter!("ROT_KT")),
            torque_coefficient: parameters.get(parameter!("ROT_KQ")),
            min_speed: parameters.get(parameter!("ROT_W_MIN")),
            max_speed: parameters.get(parameter!("ROT_W_MAX")),
        };
        let arm = parameters.get(parameter!("ROT_ARM"));
        let place = |x, y, counter_clockwise| Place { x, y, counter_clockwise };
        // The order of most autopilots: front right, rear left, front left, rear right.
        let places =
            [place(arm, arm, true), place(-arm, -arm, true), place(arm, -arm, false), place(-arm, arm, false)];
        let rotors = Rotors::new(rotor, &places).map_err(parameters.naming(&["ROT_"]))?;
        let [_, largest_torque @ ..] = *rotors.largest();
        for (limit, largest) in limits.max_torque.iter_mut().zip(largest_torque) {
            *limit = limit.min(largest);
        }
        Ok(Self { limits, rotors })
    }

    /// Thrust, and torque about b1, b2 and b3, as shares of what all rotors together could give of
    /// each alone: what mixers that work with normalized numbers take.
    #[must_use]
    pub fn shares(&self, command: &Command<T>) -> [T; 4] {
        let [thrust, roll, pitch, yaw] = *self.rotors.largest();
        let torque = &command.torque;
        [command.thrust / thrust, torque.x / roll, torque.y / pitch, torque.z / yaw]
    }

    /// Rotor speeds as shares of the largest, 0 to 1, for a command as it was
    /// [applied](Actuation::apply). A zero command stops them; at the least thrust they idle.
    #[must_use]
    pub fn duties(&self, applied: &Command<T>) -> [T; 4] {
        if *applied == Command::zero() {
            return [T::zero(); 4];
        }
        self.rotors.duties(applied)
    }
}

impl<T: Real> Actuation<T> for Actuators<T> {
    /// Always: they were checked when they were made.
    fn check(&self) -> Result<(), OutOfRange<T>> {
        Ok(())
    }

    #[inline]
    fn apply(&self, command: &Command<T>) -> Command<T> {
        self.rotors.apply_bounded(&self.limits.apply(command))
    }

    fn least_thrust(&self) -> T {
        self.apply(&Command::zero()).thrust
    }
}
