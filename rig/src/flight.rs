//! `ENV_*`, `APP_*`, `POL_*`: the envelope, the approach to a path and the supervisor's policy.

use controller::ranges::BandRange;
use controller::{ApproachLimits, Band, EnvelopeParams, Lost, Policy, Range, Real, ranges};

use crate::entry::{Entry, Name};
use crate::parameters::Parameters;
use crate::table::concatenated;
use crate::{parameter, run};

/// `<name>_WARN` and `<name>_LIM`.
const fn band(
    name: &str,
    range: BandRange,
    unit: &'static str,
    [warning, limit]: [&'static str; 2],
) -> [Entry<f64>; 2] {
    let name = Name::new(name);
    [
        Entry { name: name.with("_WARN"), ..Entry::of("X", range.warning, unit, warning) },
        Entry { name: name.with("_LIM"), ..Entry::of("X", range.limit, unit, limit) },
    ]
}

/// Negative where the rotors are cut instead.
const SINK: Range = Range::new(ranges::SINK.field, -1.0, ranges::SINK.max, ranges::SINK.default);

pub(crate) const ENTRIES: &[Entry<f64>] = &concatenated::<29>(&[
    &band(
        "ENV_ROD",
        ranges::ENVELOPE_ROD_ANGLE,
        "rad",
        ["Angle of the rod from the vertical: warned of.", "Angle of the rod from the vertical: left for hold."],
    ),
    &band(
        "ENV_AXIS",
        ranges::ENVELOPE_THRUST_ANGLE,
        "rad",
        [
            "Angle of the thrust axis from the rod: warned of.",
            "Angle of the thrust axis from the rod: left for hold.",
        ],
    ),
    &band(
        "ENV_ROLL",
        ranges::ENVELOPE_ROLL,
        "rad",
        ["Roll of the yaw's chart: warned of.", "Roll of the yaw's chart: left for hold."],
    ),
    &band(
        "ENV_TENS",
        ranges::ENVELOPE_TENSION,
        "",
        [
            "Tension of the rod over the payload's weight: warned of below.",
            "Tension of the rod over the payload's weight: left for hold below.",
        ],
    ),
    &band(
        "ENV_T",
        ranges::ENVELOPE_THRUST,
        "",
        ["Thrust over hover's: warned of below.", "Thrust over hover's: left for hold below."],
    ),
    &band(
        "ENV_PATH",
        ranges::ENVELOPE_PATH,
        "",
        [
            "Determinant of the path's system over its value on the path: warned of below.",
            "Determinant of the path's system over its value on the path: left for hold below.",
        ],
    ),
    &band(
        "ENV_REACH",
        ranges::ENVELOPE_REACH,
        "",
        [
            "What is left of the path's reach, as a share: warned of below.",
            "What is left of the path's reach, as a share: left for hold below.",
        ],
    ),
    &[
        Entry::of("APP_SPEED", ranges::APPROACH_SPEED, "m/s", "Joining the path: speed of the slide."),
        Entry::of("APP_ACC", ranges::APPROACH_ACCELERATION, "m/s^2", "Joining the path: acceleration."),
        Entry::of("APP_TILT", ranges::APPROACH_TILT, "rad", "Joining the path: tilt of the thrust."),
        Entry::of("APP_ROD", ranges::APPROACH_ROD_ANGLE, "rad", "Joining the path: angle of the rod."),
        Entry::of("APP_T_MIN", ranges::APPROACH_MIN_THRUST, "", "Joining the path: least thrust over hover's."),
        Entry::of("APP_T_MAX", ranges::APPROACH_MAX_THRUST, "", "Joining the path: largest thrust over hover's."),
        Entry::of("POL_COAST", ranges::COAST, "s", "How long the last command goes on without a state."),
        Entry::of(
            "POL_SINK",
            SINK,
            "",
            "Then: thrust over hover's, without torque, until a good state; negative: rotors cut until disarmed.",
        ),
        Entry::switch("POL_RESUME", "resume", true, "Go back to the path from hold without being asked again."),
        Entry::of("POL_CALM", ranges::CALM, "s", "How long the vehicle must have been calm for that."),
        Entry::of("POL_RISE", ranges::RISE, "m/s", "Speed of a take-off."),
        Entry::of("POL_CLEAR", ranges::CLEAR, "m", "How much higher than the cable is long a take-off rises."),
        Entry::of("POL_DESCENT", ranges::DESCENT, "m/s", "Speed of a landing."),
        Entry::of("POL_ASIDE", ranges::ASIDE, "m", "How far from the load the UAV lands, if the cable lets it."),
        Entry::of(
            "POL_LOAD_LOST",
            ranges::PAYLOAD_LOST,
            "",
            "Share of the payload's mass below which it counts as lost; negative: never.",
        ),
    ],
]);

impl<T: Real> Parameters<T> {
    /// The envelope.
    #[must_use]
    pub fn envelope(&self) -> EnvelopeParams<T> {
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
        .map(|run| band(self.run(run)));
        EnvelopeParams { rod_angle, thrust_angle, roll, tension, thrust, path, reach }
    }

    /// How a path is joined.
    #[must_use]
    pub fn approach(&self) -> ApproachLimits<T> {
        ApproachLimits {
            speed: self.get(parameter!("APP_SPEED")),
            acceleration: self.get(parameter!("APP_ACC")),
            tilt: self.get(parameter!("APP_TILT")),
            rod_angle: self.get(parameter!("APP_ROD")),
            min_thrust: self.get(parameter!("APP_T_MIN")),
            max_thrust: self.get(parameter!("APP_T_MAX")),
        }
    }

    /// What the supervisor does when.
    #[must_use]
    pub fn policy(&self) -> Policy<T> {
        let sink = self.get(parameter!("POL_SINK"));
        Policy {
            coast: self.get(parameter!("POL_COAST")),
            lost: if sink < T::zero() { Lost::Cut } else { Lost::Sink(sink) },
            resume: self.is_on(parameter!("POL_RESUME")),
            calm: self.get(parameter!("POL_CALM")),
            rise: self.get(parameter!("POL_RISE")),
            clear: self.get(parameter!("POL_CLEAR")),
            descent: self.get(parameter!("POL_DESCENT")),
            aside: self.get(parameter!("POL_ASIDE")),
            payload_lost: self.get(parameter!("POL_LOAD_LOST")),
        }
    }
}
