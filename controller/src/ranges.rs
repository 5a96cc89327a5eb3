//! Every parameter's range and default in one table. The constructors check against it, the
//! constructors that take no numbers are made of its defaults, and a parameter table of named
//! numbers can be built on it.

use model::Range;
pub use model::ranges::*;

/// [`Sampling::period`](crate::Sampling::period), s.
pub const PERIOD: Range = Range::new("period", 1e-4, 0.2, 0.002);
/// [`Sampling::latency`](crate::Sampling::latency), s, and no more than
/// [`MAX_DELAY`](crate::MAX_DELAY) periods.
pub const LATENCY: Range = Range::new("latency", 0.0, 0.5, 0.0);
/// [`Sampling::rotor_lag`](crate::Sampling::rotor_lag), s.
pub const ROTOR_LAG: Range = Range::new("rotor_lag", 0.0, 0.5, 0.0);

/// [`Gains::spread`](crate::Gains::spread): the poles' scale, 1/s.
pub const BANDWIDTH: Range = Range::new("bandwidth", 0.05, 20.0, 1.0);
/// Distance of a pole from zero, 1/s.
pub const POLE: Range = Range::new("pole", 0.0, 1e3, 1.0);

/// [`ObserverParams::payload_bandwidth`](crate::ObserverParams::payload_bandwidth), rad/s; 0 is
/// off, here and below.
pub const PAYLOAD_BANDWIDTH: Range = Range::new("payload_bandwidth", 0.0, 100.0, 4.0);
/// [`ObserverParams::along_bandwidth`](crate::ObserverParams::along_bandwidth), rad/s; 0 is
/// `payload_bandwidth`.
pub const ALONG_BANDWIDTH: Range = Range::new("along_bandwidth", 0.0, 100.0, 0.0);
/// [`ObserverParams::cable_stiffness`](crate::ObserverParams::cable_stiffness), N; 0 is a cable
/// that does not stretch.
pub const CABLE_STIFFNESS: Range = Range::new("cable_stiffness", 0.0, 1e8, 0.0);
/// [`ObserverParams::rod_bandwidth`](crate::ObserverParams::rod_bandwidth), rad/s.
pub const ROD_BANDWIDTH: Range = Range::new("rod_bandwidth", 0.0, 100.0, 4.0);
/// [`ObserverParams::torque_bandwidth`](crate::ObserverParams::torque_bandwidth), rad/s.
pub const TORQUE_BANDWIDTH: Range = Range::new("torque_bandwidth", 0.0, 100.0, 4.0);
/// [`ObserverParams::payload_bound`](crate::ObserverParams::payload_bound), m/s²: about 1.5 g.
pub const PAYLOAD_BOUND: Range = Range::new("payload_bound", 0.0, 1e3, 15.0);
/// [`ObserverParams::rod_bound`](crate::ObserverParams::rod_bound), 1/s²: about 1 g/m.
pub const ROD_BOUND: Range = Range::new("rod_bound", 0.0, 1e3, 10.0);
/// [`ObserverParams::torque_lever`](crate::ObserverParams::torque_lever), m.
pub const TORQUE_LEVER: Range = Range::new("torque_lever", 0.0, 1e3, 0.1);

/// A warning's and a limit's range, where the warning lies on the safe side of the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandRange {
    /// Of the warning.
    pub warning: Range,
    /// Of the limit.
    pub limit: Range,
}

/// 55° and 70°, in rad.
const fn angle(field: &'static str) -> BandRange {
    BandRange { warning: Range::new(field, 0.0, 1.5, 0.96), limit: Range::new(field, 0.05, 1.5, 1.22) }
}

/// Of a share that ends at 1.
const fn share(field: &'static str, warning: f64, limit: f64) -> BandRange {
    BandRange { warning: Range::new(field, 0.0, 1.0, warning), limit: Range::new(field, 0.0, 1.0, limit) }
}

/// [`EnvelopeParams::rod_angle`](crate::EnvelopeParams::rod_angle), rad.
pub const ENVELOPE_ROD_ANGLE: BandRange = angle("rod_angle");
/// [`EnvelopeParams::thrust_angle`](crate::EnvelopeParams::thrust_angle), rad.
pub const ENVELOPE_THRUST_ANGLE: BandRange = angle("thrust_angle");
/// [`EnvelopeParams::roll`](crate::EnvelopeParams::roll), rad.
pub const ENVELOPE_ROLL: BandRange = angle("roll");
/// [`EnvelopeParams::tension`](crate::EnvelopeParams::tension), a share of the payload's weight.
pub const ENVELOPE_TENSION: BandRange = share("tension", 0.25, 0.1);
/// [`EnvelopeParams::thrust`](crate::EnvelopeParams::thrust), a share of the hover thrust.
pub const ENVELOPE_THRUST: BandRange = share("thrust", 0.25, 0.1);
/// [`EnvelopeParams::path`](crate::EnvelopeParams::path), a share of its value on the path.
pub const ENVELOPE_PATH: BandRange = share("path", 0.2, 0.1);
/// [`EnvelopeParams::reach`](crate::EnvelopeParams::reach), a share of the path's reach.
pub const ENVELOPE_REACH: BandRange = share("reach", 0.2, 0.05);

/// [`ApproachLimits::speed`](crate::ApproachLimits::speed), m/s.
pub const APPROACH_SPEED: Range = Range::new("speed", 0.01, 100.0, 3.0);
/// [`ApproachLimits::acceleration`](crate::ApproachLimits::acceleration), m/s².
pub const APPROACH_ACCELERATION: Range = Range::new("acceleration", 0.01, 100.0, 1.5);
/// [`ApproachLimits::tilt`](crate::ApproachLimits::tilt), rad: 20°.
pub const APPROACH_TILT: Range = Range::new("tilt", 0.01, 1.2, 0.35);
/// [`ApproachLimits::rod_angle`](crate::ApproachLimits::rod_angle), rad: 20°.
pub const APPROACH_ROD_ANGLE: Range = Range::new("rod_angle", 0.01, 1.2, 0.35);
/// [`ApproachLimits::min_thrust`](crate::ApproachLimits::min_thrust), a share of the hover thrust.
pub const APPROACH_MIN_THRUST: Range = Range::new("min_thrust", 0.0, 0.999, 0.7);
/// [`ApproachLimits::max_thrust`](crate::ApproachLimits::max_thrust), a share of the hover thrust.
pub const APPROACH_MAX_THRUST: Range = Range::new("max_thrust", 1.001, 100.0, 1.3);

/// [`Policy::coast`](crate::Policy::coast), s.
pub const COAST: Range = Range::new("coast", 0.0, 10.0, 0.1);
/// [`Lost::Sink`](crate::Lost::Sink), a share of the hover thrust.
pub const SINK: Range = Range::new("lost", 0.0, 1.0, 0.9);
/// [`Policy::calm`](crate::Policy::calm), s.
pub const CALM: Range = Range::new("calm", 0.0, 100.0, 1.0);
/// [`Policy::rise`](crate::Policy::rise), m/s.
pub const RISE: Range = Range::new("rise", 0.01, 10.0, 0.4);
/// [`Policy::clear`](crate::Policy::clear), m.
pub const CLEAR: Range = Range::new("clear", 0.0, 1000.0, 1.0);
/// [`Policy::descent`](crate::Policy::descent), m/s.
pub const DESCENT: Range = Range::new("descent", 0.01, 10.0, 0.4);
/// [`Policy::aside`](crate::Policy::aside), m.
pub const ASIDE: Range = Range::new("aside", 0.0, 100.0, 0.6);
/// [`Policy::payload_lost`](crate::Policy::payload_lost), a share of the payload's mass; negative:
/// never.
pub const PAYLOAD_LOST: Range = Range::new("payload_lost", -1.0, 0.95, 0.3);

/// [`ActuatorLimits::min_thrust`](crate::ActuatorLimits::min_thrust), N.
pub const MIN_THRUST: Range = Range::new("min_thrust", -1e6, 1e6, 0.0);
/// [`ActuatorLimits::max_thrust`](crate::ActuatorLimits::max_thrust), N, from the least on.
pub const MAX_THRUST: Range = Range::new("max_thrust", -1e6, 1e6, 60.0);
/// [`ActuatorLimits::max_torque`](crate::ActuatorLimits::max_torque), N·m.
pub const MAX_TORQUE: [Range; 3] = [
    Range::new("max_torque[0]", 0.0, 1e6, 3.0),
    Range::new("max_torque[1]", 0.0, 1e6, 3.0),
    Range::new("max_torque[2]", 0.0, 1e6, 1.0),
];

/// [`RotorParams::thrust_coefficient`](crate::RotorParams::thrust_coefficient), N/(rad/s)².
pub const THRUST_COEFFICIENT: Range = Range::new("thrust_coefficient", 1e-10, 1.0, 2e-5);
/// [`RotorParams::torque_coefficient`](crate::RotorParams::torque_coefficient), N·m/(rad/s)².
pub const TORQUE_COEFFICIENT: Range = Range::new("torque_coefficient", 1e-12, 1.0, 4e-7);
/// [`RotorParams::min_speed`](crate::RotorParams::min_speed), rad/s, and no more than 0.9 of the
/// largest.
pub const MIN_SPEED: Range = Range::new("min_speed", 0.0, 1e5, 100.0);
/// [`RotorParams::max_speed`](crate::RotorParams::max_speed), rad/s.
pub const MAX_SPEED: Range = Range::new("max_speed", 1.0, 1e5, 1100.0);
/// [`Place::x`](crate::Place::x) and [`Place::y`](crate::Place::y), m.
pub const ROTOR_PLACE: [Range; 2] = [Range::new("x", -100.0, 100.0, 0.25), Range::new("y", -100.0, 100.0, 0.25)];
/// The arm of a ring of rotors, m.
pub const ROTOR_ARM: Range = Range::new("arm", 0.01, 100.0, 0.25);

/// Speed along a curve, m/s; negative flies it the other way.
pub const SPEED: Range = Range::new("speed", -100.0, 100.0, 1.0);
/// [`CurvatureLimited`](crate::CurvatureLimited): largest centripetal acceleration, m/s².
pub const CENTRIPETAL: Range = Range::new("acceleration", 0.01, 100.0, 1.0);
/// [`FixedYaw`](crate::FixedYaw), rad.
pub const YAW: Range = Range::new("yaw", -100.0, 100.0, 0.0);
/// [`PointingAt`](crate::PointingAt): p1 and p2 of the line, m.
pub const POINTING: [Range; 2] = [Range::new("x", -1e5, 1e5, 0.0), Range::new("y", -1e5, 1e5, 0.0)];
/// [`Linear`](crate::Linear): the value at the origin, in m/s or rad.
pub const LINEAR_VALUE: Range = Range::new("value", -1e3, 1e3, 0.0);
/// [`Linear`](crate::Linear): each component of its gradient, per m.
pub const LINEAR_GRADIENT: Range = Range::new("gradient", -1e3, 1e3, 0.0);

/// Radius of a [`Circle`](crate::Circle), m.
pub const RADIUS: Range = Range::new("radius", 0.01, 1e5, 5.0);
/// Its p3, m: negative is above the origin.
pub const P3: Range = Range::new("p3", -1e5, 1e5, -10.0);
/// Half-axis a of a curve, m.
pub const HALF_AXIS_A: Range = Range::new("a", 0.01, 1e5, 5.0);
/// Half-axis b of a curve, m.
pub const HALF_AXIS_B: Range = Range::new("b", 0.01, 1e5, 4.0);
/// Half-axis a of [`Bent`](crate::Bent), m: its wave is a sine, whose argument has a range.
pub const BENT_HALF_AXIS_A: Range = Range::new("a", 0.01, 1e3, 5.0);
/// Its half-axis b, m.
pub const BENT_HALF_AXIS_B: Range = Range::new("b", 0.01, 1e3, 4.0);
/// Height c0 of a draped curve at p1 = 0, m.
pub const HEIGHT: Range = Range::new("c0", -1e5, 1e5, -10.0);
/// Slope c1 of the plane that an ellipse or superellipse lies in.
pub const SLOPE: Range = Range::new("c1", -100.0, 100.0, 0.0);
/// Half of a [`Superellipse`](crate::Superellipse)'s exponent.
pub const HALF_EXPONENT: Range = Range::new("half_exponent", 1.0, 10.0, 2.0);
/// A component of a centre or of a Fourier coefficient, m.
pub const COORDINATE: Range = Range::new("coordinate", -1e5, 1e5, 0.0);
