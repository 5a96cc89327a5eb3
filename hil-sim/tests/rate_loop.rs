//! The law above an autopilot's own rate loop, as `[actuators.rate_loop]` puts it into the world.

use controller::State;
use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::{Control, End, Entry, Plan, fly};
use hil_sim::fly::pilot::Pilot;
use hil_sim::world::Seed;

/// A common autopilot: 100 setpoints a second that act 20 ms late, motors of 30 ms, a loop of 30
/// ms.
fn scenario(path: &str, initial: &str, more: &str, rate_loop: &str) -> Scenario {
    let text = format!(
        r#"
        duration_s = 75.0
        path = {path}
        initial = {initial}
        {more}
        [controller]
        law = "follow"
        rate_hz = 100.0
        latency_s = 0.02
        poles = [[-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5], [-2, -3]]
        observer = {{ payload = 4.0, rod = 4.0, torque = 4.0 }}
        limits = {{ thrust = [1.5, 65.0], torque = [3.0, 3.0, 1.0] }}
        supervised = true
        {rate_loop}
        [actuators]
        latency_s = 0.02
        lag_s = 0.03
        rate_loop = {{ rate_hz = 1000.0, time_constant_s = [0.03, 0.03, 0.03] }}
        "#
    );
    Scenario::parse("rate-loop.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Flies it; how it ended, and the largest d_C from `judged_from_s` on.
fn flown(scenario: &Scenario, judged_from_s: f64) -> (End, f64) {
    let mut pilot = Pilot::<f32>::new(&scenario.controller).expect("it can be set up");
    let start = State::from_paper(&scenario.initial);
    let (seed, control) = (Seed::default(), Control::alone());
    let plan = Plan { start, seed, entry: Entry::Hover, ground_p3: None, distance_every: 5, control };
    let mut largest = 0.0_f64;
    let end = fly(scenario, &plan, &mut pilot, &mut |moment| {
        if moment.t_s >= judged_from_s {
            largest = largest.max(moment.distance_m.unwrap_or_default());
        }
    });
    (end, largest)
}

const CIRCLE: &str = r#"{ kind = "circle", radius = 5.0, p3 = -10.0, speed = 1.0 }"#;
const ROUTE: &str = r#"{ kind = "route", points = [[5, 0, -10], [5, 15, -10], [-10, 15, -12], [-10, 0, -10]], corner_m = 5.0, closed = true, speed = 1.0 }"#;

#[test]
fn the_path_is_kept_through_a_loop_that_the_law_knows() {
    for path in [CIRCLE, ROUTE] {
        let (end, largest) = flown(&scenario(path, "{ position = [6.0, 0.0, -10.0] }", "", ""), 30.0);
        assert_eq!(end, End::Complete, "{path}");
        assert!(largest < 1e-3, "{largest} m from {path}");
    }
}

#[test]
fn a_loop_of_another_time_constant_is_told_so() {
    let start = "{ position = [6.0, 0.0, -10.0] }";
    let [known, believed_quick] = ["", "rate_loop_s = [0.0, 0.0, 0.0]"].map(|told| {
        let (end, largest) = flown(&scenario(CIRCLE, start, "", told), 30.0);
        assert_eq!(end, End::Complete);
        largest
    });
    assert!(believed_quick > 2.0 * known, "{believed_quick} m, {known} m");
}

#[test]
fn a_mission_goes_from_the_ground_to_the_ground_through_the_loop() {
    let more = r#"request = [{ at_s = 0.0, do = "idle" }, { at_s = 1.0, do = "hold" }, { at_s = 12.0, do = "follow" },
            { at_s = 35.0, do = "hold" }, { at_s = 42.0, do = "land" }]
        ground = {}"#;
    let initial = "{ position = [0.8, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }";
    let path = r#"{ kind = "circle", radius = 4.0, p3 = -6.0, speed = 1.0 }"#;
    let (end, _) = flown(&scenario(path, initial, more, ""), 0.0);
    assert!(matches!(end, End::Landed(_)), "{end:?}");
}

#[test]
fn a_loop_that_is_not_there_has_no_time_constants() {
    let text = "[controller]\nrate_loop_s = [0.03, 0.03, 0.03]\n";
    let error = Scenario::parse("rate-loop.toml", text).expect_err("nothing to give setpoints to").to_string();
    assert!(error.contains("controller.rate_loop_s") && error.contains("[actuators.rate_loop]"), "{error}");
}
