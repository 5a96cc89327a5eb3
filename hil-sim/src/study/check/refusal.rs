//! Why a curve cannot be flown, and where.

use controller::Vector3;
use std::fmt;

/// A place on a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// In N, m.
    pub position: Vector3<f64>,
    /// Arc length from where the walk started, m.
    pub arc: f64,
    /// Of a route, the leg, which is numbered by the waypoint that it begins at.
    pub leg: Option<usize>,
}

impl Place {
    /// A place of a curve, which has no legs.
    #[must_use]
    pub fn of_curve(position: Vector3<f64>, arc: f64) -> Self {
        Self { position, arc, leg: None }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = [0, 1, 2].map(|axis| self.position[axis]);
        match self.leg {
            None => write!(f, "({x:.3}, {y:.3}, {z:.3}) m, {:.3} m along the curve", self.arc),
            Some(leg) => write!(f, "leg {leg}, ({x:.3}, {y:.3}, {z:.3}) m, {:.3} m along the route", self.arc),
        }
    }
}

/// What is wrong with a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// No point with h1 = h2 = 0 was found.
    NoCurve,
    /// ∇h1 × ∇h2 = 0 wherever a point was looked for.
    Parallel,
    /// A formula has no finite value, or no finite derivatives, beyond here.
    Undefined,
    /// The derivatives that the law needs do not exist here.
    NotSmooth,
    /// The curve stops: no further point of it is near.
    Ends,
    /// It goes on without coming back.
    Open,
    /// It goes on within bounds without coming back.
    Endless,
    /// The tangent jumps by `turn` rad.
    Kink {
        /// Angle between the tangents on both sides, rad.
        turn: f64,
    },
    /// The tangent is continuous, a higher derivative by arc length is not.
    Jump {
        /// Its order: 2 for the curvature.
        order: usize,
    },
    /// ∇h1 × ∇h2 = 0: the curve crosses itself, or the surfaces touch without cutting.
    Irregular,
    /// It comes back to a point it has passed, `other` m along.
    Crossing {
        /// Arc length of the other branch, m.
        other: f64,
    },
    /// The prescribed speed is zero here, or changes sign.
    Stops,
    /// The prescribed speed jumps, or a derivative of it by arc length.
    SpeedJumps {
        /// The order: 0 for the speed itself.
        order: usize,
    },
    /// The same of the yaw.
    YawJumps {
        /// The order: 0 for the yaw itself.
        order: usize,
    },
    /// The payload would be in free fall, or the UAV without thrust.
    FreeFall,
}

impl Reason {
    /// The refusal with this reason at a place.
    #[must_use]
    pub fn at(self, place: Place) -> Refusal {
        Refusal { reason: self, place }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCurve => f.write_str("no point with h1 = h2 = 0 found, searching from here outwards"),
            Self::Parallel => f.write_str(
                "∇h1 × ∇h2 = 0 wherever it was tried, searching from here outwards: no two surfaces that cut each other",
            ),
            Self::Undefined => f.write_str("a formula is not defined"),
            Self::NotSmooth => f.write_str("six derivatives do not exist"),
            Self::Ends => f.write_str("the curve ends, or its surfaces are not smooth"),
            Self::Open => f.write_str("the curve does not close"),
            Self::Endless => f.write_str("the curve does not close within the longest walk"),
            Self::Kink { turn } if *turn > 3.0 => f.write_str("the curve crosses itself or turns back on itself"),
            Self::Kink { turn } => write!(f, "a kink of {:.2} degrees", turn.to_degrees()),
            Self::Jump { order: 2 } => f.write_str("the curvature jumps"),
            Self::Jump { order } => write!(f, "the curve's derivative of order {order} jumps"),
            Self::Irregular => f.write_str("∇h1 × ∇h2 = 0: the curve crosses itself, or its surfaces only touch"),
            Self::Crossing { other } => write!(f, "the curve crosses itself: the same point lies {other:.3} m along"),
            Self::Stops => f.write_str("the prescribed speed is zero"),
            Self::SpeedJumps { order: 0 } => f.write_str("the prescribed speed jumps"),
            Self::SpeedJumps { order } => write!(f, "the prescribed speed's derivative of order {order} jumps"),
            Self::YawJumps { order: 0 } => f.write_str("the prescribed yaw jumps"),
            Self::YawJumps { order } => write!(f, "the prescribed yaw's derivative of order {order} jumps"),
            Self::FreeFall => {
                f.write_str("the prescribed motion leaves the payload in free fall or the UAV without thrust")
            }
        }
    }
}

/// A curve that cannot be flown.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{reason}, at {place}")]
pub struct Refusal {
    /// What is wrong.
    pub reason: Reason,
    /// Where.
    pub place: Place,
}
