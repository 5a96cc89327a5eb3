//! `ENV_*`, `APP_*`, `POL_*`: the envelope, the approach to a path and the supervisor's policy.

use controller::{ApproachLimits, Band, EnvelopeParams, Lost, Policy, Real};

use crate::entry::{Entry, Name};
use crate::parameters::Parameters;
use crate::table::concatenated;
use crate::{parameter, run};

const ANGLE: (f64, f64) = (0.05, 1.5);
const SHARE: (f64, f64) = (0.0, 1.0);

/// `<name>_WARN` and `<name>_LIM`.
const fn band(
    name: &str,
    field: &'static str,
    unit: &'static str,
    [warning, limit]: [f64; 2],
    range: (f64, f64),
    [warning_text, limit_text]: [&'static str; 2],
) -> [Entry<f64>; 2] {
    let name = Name::new(name);
    let limit = Entry { name: name.with("_LIM"), ..Entry::real("X", field, unit, limit, range, limit_text) };
    // An angle may be warned of from the start.
    let range = (0.0, range.1);
    let warning = Entry { name: name.with("_WARN"), ..Entry::real("X", field, unit, warning, range, warning_text) };
    [warning, limit]
}

const WIDE: [f64; 2] = [0.96, 1.22];

pub(crate) const ENTRIES: &[Entry<f64>] = &concatenated::<26>(&[
    &band(
        "ENV_ROD",
        "rod_angle",
        "rad",
        WIDE,
        ANGLE,
        [
            "Angle of the rod from the vertical: warned of.",
            "Angle of the rod from the vertical: the law is left for hold.",
        ],
    ),
    &band(
        "ENV_AXIS",
        "thrust_angle",
        "rad",
        WIDE,
        ANGLE,
        [
            "Angle of the thrust axis from the rod: warned of.",
            "Angle of the thrust axis from the rod: the law is left for hold.",
        ],
    ),
    &band(
        "ENV_ROLL",
        "roll",
        "rad",
        WIDE,
        ANGLE,
        ["Roll of the yaw's chart: warned of.", "Roll of the yaw's chart: the law is left for hold."],
    ),
    &band(
        "ENV_TENS",
        "tension",
        "",
        [0.25, 0.1],
        SHARE,
        [
            "Tension of the rod, as a share of the payload's weight: warned of below.",
            "Tension of the rod, as a share of the payload's weight: below, the law is left for hold.",
        ],
    ),
    &band(
        "ENV_T",
        "thrust",
        "",
        [0.25, 0.1],
        SHARE,
        [
            "Thrust, as a share of hover's: warned of below.",
            "Thrust, as a share of hover's: below, the law is left for hold.",
        ],
    ),
    &band(
        "ENV_PATH",
        "path",
        "",
        [0.2, 0.1],
        SHARE,
        [
            "Determinant of the path's system, as a share of its value on the path: warned of below.",
            "Determinant of the path's system, as a share of its value on the path: below, hold.",
        ],
    ),
    &band(
        "ENV_REACH",
        "reach",
        "",
        [0.2, 0.05],
        SHARE,
        [
            "What is left of the path's reach, as a share: warned of below.",
            "What is left of the path's reach, as a share: below, the law is left for hold.",
        ],
    ),
    &[
        Entry::real("APP_SPEED", "speed", "m/s", 3.0, (0.01, 100.0), "Joining the path: speed of the slide."),
        Entry::real("APP_ACC", "acceleration", "m/s^2", 1.5, (0.01, 100.0), "Joining the path: acceleration."),
        Entry::real("APP_TILT", "tilt", "rad", 0.35, (0.01, 1.2), "Joining the path: tilt of the thrust."),
        Entry::real("APP_ROD", "rod_angle", "rad", 0.35, (0.01, 1.2), "Joining the path: angle of the rod."),
        Entry::real("APP_T_MIN", "min_thrust", "", 0.7, (0.0, 0.999), "Joining the path: least thrust over hover's."),
        Entry::real(
            "APP_T_MAX",
            "max_thrust",
            "",
            1.3,
            (1.001, 10.0),
            "Joining the path: largest thrust over hover's.",
        ),
        Entry::real(
            "POL_COAST",
            "coast",
            "s",
            0.1,
            (0.0, 10.0),
            "How long the last command goes on without a state.",
        ),
        Entry::real(
            "POL_SINK",
            "lost",
            "",
            0.9,
            (-1.0, 1.0),
            "Then: thrust over hover's, without torque, until a good state; negative: rotors cut until disarmed.",
        ),
        Entry::switch("POL_RESUME", "resume", true, "Go back to the path from hold without being asked again."),
        Entry::real("POL_CALM", "calm", "s", 1.0, (0.0, 100.0), "How long the vehicle must have been calm for that."),
        Entry::real("POL_DESCENT", "descent", "m/s", 0.5, (0.01, 10.0), "Speed of a landing."),
        Entry::real(
            "POL_LOAD_LOST",
            "payload_lost",
            "",
            0.3,
            (-1.0, 0.95),
            "Share of the payload's mass below which it counts as lost; negative: never.",
        ),
    ],
]);

pub(crate) fn envelope<T: Real>(parameters: &Parameters<T>) -> EnvelopeParams<T> {
    let band = |[warning, limit]: [T; 2]| Band { warning, limit };
    let [rod_angle, thrust_angle, roll, tension, thrust, path, reach] = [
        run!("ENV_ROD_WARN" to "ENV_ROD_LIM"),
        run!("ENV_AXIS_WARN" to "ENV_AXIS_LIM"),
        run!("ENV_ROLL_WARN" to "ENV_ROLL_LIM"),
        run!("ENV_TENS_WARN" to "ENV_TENS_LIM"),
        run!("ENV_T_WARN" to "ENV_T_LIM"),
        run!("ENV_PATH_WARN" to "ENV_PATH_LIM"),
        run!("ENV_REACH_WARN" to "ENV_REACH_LIM"),
    ]
    .map(|run| band(parameters.run(run)));
    EnvelopeParams { rod_angle, thrust_angle, roll, tension, thrust, path, reach }
}

pub(crate) fn approach<T: Real>(parameters: &Parameters<T>) -> ApproachLimits<T> {
    ApproachLimits {
        speed: parameters.get(parameter!("APP_SPEED")),
        acceleration: parameters.get(parameter!("APP_ACC")),
        tilt: parameters.get(parameter!("APP_TILT")),
        rod_angle: parameters.get(parameter!("APP_ROD")),
        min_thrust: parameters.get(parameter!("APP_T_MIN")),
        max_thrust: parameters.get(parameter!("APP_T_MAX")),
    }
}

pub(crate) fn policy<T: Real>(parameters: &Parameters<T>) -> Policy<T> {
    let sink = parameters.get(parameter!("POL_SINK"));
    Policy {
        coast: parameters.get(parameter!("POL_COAST")),
        lost: if sink < T::zero() { Lost::Cut } else { Lost::Sink(sink) },
        resume: parameters.is_on(parameter!("POL_RESUME")),
        calm: parameters.get(parameter!("POL_CALM")),
        descent: parameters.get(parameter!("POL_DESCENT")),
        payload_lost: parameters.get(parameter!("POL_LOAD_LOST")),
    }
}
