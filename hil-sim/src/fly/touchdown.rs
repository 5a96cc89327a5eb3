//! How payload and UAV come to the ground, and whether that is a landing or a crash.

use controller::{Mode, Request, Vector3};
use serde::{Deserialize, Serialize};

use crate::world::{Body, Ground};

/// Time over which the payload's place is averaged until a landing is asked for, s: about a swing.
const AVERAGED_S: f64 = 2.0;

/// Slower than this, m/s, bodies stand; and for so long they must, s, for the flight to be over.
const STILL: f64 = 0.05;
const STANDING_S: f64 = 1.0;

/// A UAV on the ground that is tilted by more than 60° has tipped over.
const TIPPED: f64 = 0.5;

/// What is measured of a flight that comes to the ground.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Touchdown {
    /// The fastest that the UAV's centre of mass sank when a foot came to the ground, m/s.
    pub uav_m_s: Option<f64>,
    /// The fastest that the payload sank when it came to the ground, m/s.
    pub load_m_s: Option<f64>,
    /// Level distance of the payload from its place, m: where it was, on average over 2 s, when the
    /// landing was asked for.
    pub load_place_m: Option<f64>,
}

/// Watches both bodies and the ground.
pub(super) struct Watch {
    ground: Option<Ground>,
    period: f64,
    pub(super) touchdown: Touchdown,
    /// Whether payload and UAV touched at the last sample, and how fast they sank.
    before: Option<([bool; 2], [f64; 2])>,
    /// The payload's mean place, and where it was when a landing was asked for.
    mean: Option<Vector3<f64>>,
    place: Option<Vector3<f64>>,
    has_flown: bool,
    standing_s: f64,
}

impl Watch {
    pub(super) fn new(ground: Option<Ground>, period: f64) -> Self {
        Self {
            ground,
            period,
            touchdown: Touchdown::default(),
            before: None,
            mean: None,
            place: None,
            has_flown: false,
            standing_s: 0.0,
        }
    }

    /// Looks at `body`; `true` if it has crashed: come to the ground faster than it stands, or
    /// tipped over on it.
    #[inline]
    pub(super) fn has_crashed(&mut self, body: &Body) -> bool {
        self.ground.is_some_and(|ground| self.crashes(&ground, body))
    }

    /// The same over this `ground`.
    fn crashes(&mut self, ground: &Ground, body: &Body) -> bool {
        let (touching, bodies) = (body.touching(), body.bodies());
        let sinking = [bodies.velocity.z, bodies.uav_velocity.z];
        let mut is_hard = false;
        if let Some((touched, sank)) = self.before.replace((touching, sinking)) {
            let [load, uav] = [0, 1].map(|i| (touching[i] && !touched[i]).then_some(sank[i].max(0.0)));
            let faster = |so_far: Option<f64>, now: Option<f64>| match (so_far, now) {
                (Some(so_far), Some(now)) => Some(so_far.max(now)),
                (so_far, now) => so_far.or(now),
            };
            self.touchdown.load_m_s = faster(self.touchdown.load_m_s, load);
            self.touchdown.uav_m_s = faster(self.touchdown.uav_m_s, uav);
            is_hard = uav.is_some_and(|speed| speed > ground.crash_speed);
        }
        let [_, uav_touches] = touching;
        is_hard || ground.depth(&bodies.uav_position) >= 0.0 || uav_touches && bodies.attitude.m33 < TIPPED
    }

    /// Notes what is asked for and what the vehicle does; `true` once it has flown, its rotors are
    /// off, and both bodies stand. Where there is no ground there is no landing.
    #[inline]
    pub(super) fn has_landed(&mut self, body: &Body, request: Request, mode: Mode) -> bool {
        self.ground.is_some() && self.stands(body, request, mode)
    }

    /// The same over ground.
    fn stands(&mut self, body: &Body, request: Request, mode: Mode) -> bool {
        let position = body.position();
        let mean = self.mean.get_or_insert(position);
        *mean += (position - *mean) * (self.period / AVERAGED_S);
        if request == Request::Land {
            self.place.get_or_insert(*mean);
        } else if mode != Mode::Off {
            self.place = None;
        }
        self.touchdown.load_place_m = self.place.map(|place| (position.x - place.x).hypot(position.y - place.y));
        self.has_flown |= !matches!(mode, Mode::Off | Mode::Idle);
        let is_still = |velocity: &Vector3<f64>| velocity.dot(velocity) < STILL * STILL;
        let stands = self.has_flown
            && mode == Mode::Off
            && body.touching() == [true; 2]
            && is_still(&body.bodies().velocity)
            && is_still(&body.uav_velocity());
        self.standing_s = if stands { self.standing_s + self.period } else { 0.0 };
        self.standing_s > STANDING_S
    }
}
