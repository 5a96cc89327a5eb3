//! A route from a scenario, uploaded as a mission and flown to its end: take-off, a stop, a smooth
//! point, another speed, a landing that nobody asks for.

use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::End;
use hil_sim::fly::pilot::Answers;
use hil_sim::fly::run::Flight;
use hil_sim::hil::Target;

use crate::common::{Recorded, fly};

const SCENARIO: &str = r#"
duration_s = 150.0
cable = {}
ground = {}
initial = { position = [0.6, 0.2, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }
request = [{ at_s = 0.0, do = "idle" }, { at_s = 1.0, do = "hold" }, { at_s = 14.0, do = "follow" }]
controller = { law = "follow", rate_hz = 250.0, observer = { payload = 6.0, rod = 6.0, torque = 6.0 } }

[path]
kind = "route"
points = [[0.0, 0.0, -5.0], [6.0, 0.0, -5.0], [6.0, 5.0, -6.0], [2.0, 6.0, -5.5], [0.0, 5.0, -5.0]]
corner_m = [2.0, 2.0, 1.5, "smooth", 2.0]
speed = [1.5, 1.0, 1.5, 1.5, 1.5]
stops = [{ index = 1, dwell_s = 3.0 }]
end = "land"
"#;

pub fn scenario() -> Scenario {
    Scenario::parse("route", SCENARIO).expect("a scenario")
}

/// How near to a stop the load is at rest, m: at 10 mm/s, which the stop's rate of 0.5/s makes 20
/// mm away, and a millimetre.
const STOPS: f64 = 0.021;

/// Thrusts, torques and ζ by their bits; how near the route passes the smooth point, m; and the
/// pilot.
pub type Flown<A> = (Vec<[u32; 8]>, f64, A);

/// Flies it, and looks whether it was flown.
pub fn flown<A: Answers>(answers: A) -> Flown<A> {
    let mut pilot = Recorded::new(answers);
    let Flight { log, end, results, .. } = fly(&scenario(), &mut pilot);
    assert!(matches!(end, End::Landed(_)), "{end:?}");
    let nearest = |point: [f64; 3]| {
        let distance = |at: [f64; 3]| at.iter().zip(point).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        log.iter().map(|sample| distance(sample.x[..3].try_into().unwrap())).fold(f64::INFINITY, f64::min)
    };
    for point in [[6.0, 0.0, -5.0], [0.0, 5.0, -5.0]] {
        assert!(nearest(point) < STOPS, "{point:?} is passed at {} m", nearest(point));
    }
    assert!(results.load_touchdown_m_s.is_some_and(|speed| speed < crate::mission::TOUCHDOWN), "{results:?}");
    // It comes down where the route ends, give or take the footprint of the load.
    let [n1, n2, ..] = log.last().unwrap().x;
    assert!(n1.hypot(n2 - 5.0) < 0.3, "landed at {n1}, {n2}");
    (pilot.commands, nearest([2.0, 6.0, -5.5]), pilot.inner)
}

/// Flies it on a target.
pub fn flown_there(mut target: Target) -> Flown<Target> {
    target.prepare(&scenario()).unwrap();
    let (commands, near, mut target) = flown(target);
    assert!(target.take_failure().is_none());
    (commands, near, target)
}
