//! Flights from the ground to the ground: whole missions by the one controller, what is measured of
//! their landings, what counts as a crash, and the campaign of them.

use controller::{Fault, Mode, Request};
use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::{Control, End, Entry, Moment, Plan, fly};
use hil_sim::fly::pilot::Pilot;
use hil_sim::fly::run::{Arithmetic, fly_simply};
use hil_sim::study::campaign::{self, Campaign, Verdict, fly_run};
use hil_sim::world::Seed;

const STANDING: &str = "{ position = [0.8, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }";
const HANGING: &str = "{ position = [0.0, 0.0, -6.0] }";

/// The paper's vehicle with 2 m of cable, as it `begins`, over such `ground`; `more` are keys
/// before all tables.
fn text(begins: &str, ground: &str, requests: &str, more: &str) -> String {
    format!(
        r#"
        duration_s = 90.0
        path = {{ kind = "circle", radius = 4.0, p3 = -6.0, speed = 1.0 }}
        initial = {begins}
        request = [{requests}]
        {more}
        [ground]
        {ground}
        [controller]
        law = "follow"
        rate_hz = 250.0
        poles = [[-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5], [-2, -3]]
        observer = {{ payload = 4.0, rod = 4.0, torque = 4.0 }}
        limits = {{ thrust = [1.5, 65.0], torque = [3.0, 3.0, 1.0] }}
        "#
    )
}

fn parsed(text: &str) -> Scenario {
    Scenario::parse("ground.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// With the load beside the UAV, both on level ground.
fn scenario(requests: &str, more: &str) -> Scenario {
    parsed(&text(STANDING, "", requests, more))
}

/// Flies it; how it ended, and the modes on the way.
fn flown(scenario: &Scenario, watch: &mut dyn FnMut(&Moment<'_>)) -> (End, Vec<Mode>) {
    let mut pilot = Pilot::<f32>::new(&scenario.controller).expect("it can be set up");
    let start = controller::State::from_paper(&scenario.initial);
    let (seed, control) = (Seed::default(), Control::alone());
    let plan = Plan { start, seed, entry: Entry::Hover, ground_p3: None, distance_every: 50, control };
    let mut modes: Vec<Mode> = Vec::new();
    let end = fly(scenario, &plan, &mut pilot, &mut |moment| {
        if let Some(decision) = moment.decision
            && modes.last() != Some(&decision.mode)
        {
            modes.push(decision.mode);
        }
        watch(moment);
    });
    (end, modes)
}

const WHOLE: &str = r#"{ at_s = 0.0, do = "idle" }, { at_s = 1.0, do = "hold" }, { at_s = 12.0, do = "follow" },
    { at_s = 30.0, do = "hold" }, { at_s = 40.0, do = "land" }"#;

/// No touch is harder than this, m/s, and a payload is set down no further from its place, m.
const SOFT: f64 = 0.6;
const IN_PLACE: f64 = 0.5;

#[test]
fn a_mission_goes_off_the_ground_along_the_path_and_back() {
    let scenario = scenario(WHOLE, "");
    let mut touchdown = None;
    let (end, modes) = flown(&scenario, &mut |moment| touchdown = Some(*moment.touchdown));
    let whole = [Mode::Idle, Mode::TakeOff, Mode::Hold, Mode::Join, Mode::Follow, Mode::Hold, Mode::Land, Mode::Off];
    assert_eq!(modes, whole);
    assert!(matches!(end, End::Landed(t_s) if t_s < 90.0), "{end:?}");
    let touchdown = touchdown.expect("it was watched");
    assert!(touchdown.uav_m_s.is_some_and(|speed| (0.1..SOFT).contains(&speed)), "{touchdown:?}");
    assert!(touchdown.load_m_s.is_some_and(|speed| (0.1..SOFT).contains(&speed)), "{touchdown:?}");
    assert!(touchdown.load_place_m.is_some_and(|distance| distance < IN_PLACE), "{touchdown:?}");
    // The metrics of `run` are the same.
    let results = fly_simply(&scenario, Arithmetic::F32).unwrap().results;
    let of_run = [results.uav_touchdown_m_s, results.load_touchdown_m_s];
    for (run, seen) in of_run.into_iter().zip([touchdown.uav_m_s, touchdown.load_m_s]) {
        assert!((run.unwrap() - seen.unwrap()).abs() < 0.05, "{run:?} {seen:?}");
    }
}

/// Whenever it is asked to land, it stands in the end: from every moment of a take-off, and from
/// the way to the path and along it.
#[test]
fn a_landing_may_be_asked_for_at_any_moment() {
    for at_s in [1.5_f64, 3.0, 5.0, 6.5, 7.5, 9.0, 13.0, 15.0, 20.0, 28.0] {
        let requests = format!(
            r#"{{ at_s = 0.0, do = "idle" }}, {{ at_s = 1.0, do = "hold" }}, {{ at_s = {}, do = "follow" }}, {{ at_s = {at_s}, do = "land" }}"#,
            at_s.min(12.0)
        );
        let mut touchdown = None;
        let (end, modes) = flown(&scenario(&requests, ""), &mut |moment| touchdown = Some(*moment.touchdown));
        assert!(matches!(end, End::Landed(_)), "land at {at_s} s: {end:?}, {modes:?}");
        let touchdown = touchdown.expect("it was watched");
        for speed in [touchdown.uav_m_s, touchdown.load_m_s].into_iter().flatten() {
            assert!(speed < SOFT, "land at {at_s} s: {touchdown:?}");
        }
    }
}

/// What may go wrong on the way down, and is no crash.
#[test]
fn it_lands_softly_whatever_the_cable_the_ground_and_the_sensors_do() {
    for more in [
        "cable = { snagged = { at_s = 42.0, for_s = 3.0 } }",
        "cable = { hooked = { at_s = 0.0, for_s = 43.0 } }",
        "cable = { hook = [0.0, 0.0, 0.1], ea = 500.0, damping = 4.0 }",
        "sensors = { uav_position = { noise = 0.05 }, uav_velocity = { noise = 0.1 } }",
        "sensors = { accelerometer = false }",
        "sensors = { position = { nan = { at_s = 38.0, for_s = 60.0 } } }",
        // Load, rod, the UAV itself and everything, lost or wrong for a while on the way down.
        "sensors = { position = { drop_out = { at_s = 42.0, for_s = 2.0 } } }",
        "sensors = { position = { freeze = { at_s = 42.0, for_s = 2.0 } }, velocity = { freeze = { at_s = 42.0, for_s = 2.0 } } }",
        "sensors = { rod = { nan = { at_s = 46.0, for_s = 60.0 } } }",
        "sensors = { uav_position = { nan = { at_s = 42.0, for_s = 2.0 } } }",
        "sensors = { attitude = { nan = { at_s = 42.0, for_s = 0.3 } } }",
        "sensors = { attitude = { nan = { at_s = 38.0, for_s = 60.0 } } }",
        "sensors = { attitude = { freeze = { at_s = 42.0, for_s = 60.0 } } }",
        "actuators = { thrust_scale = 0.85 }",
        "environment = { uav_force = [1.0, 0.0, -2.0] }",
    ] {
        let mut touchdown = None;
        let (end, modes) = flown(&scenario(WHOLE, more), &mut |moment| touchdown = Some(*moment.touchdown));
        assert!(matches!(end, End::Landed(_)), "{more}: {end:?}, {modes:?}");
        assert!(touchdown.and_then(|t| t.uav_m_s).is_some_and(|speed| speed < SOFT), "{more}: {touchdown:?}");
    }
}

/// A cable that stretches by 5 % holds the UAV up for a moment when the load has been set down, by
/// what it pulled before. The UAV does not make good for that: it comes down at 0.4 m/s, as it
/// should, and a quarter more.
#[test]
fn a_uav_on_a_stretching_cable_comes_down_no_faster() {
    let mut touchdown = None;
    let scenario = scenario(WHOLE, "cable = { ea = 98.0, damping = 0.1 }");
    let (end, modes) = flown(&scenario, &mut |moment| touchdown = Some(*moment.touchdown));
    assert!(matches!(end, End::Landed(_)), "{end:?}, {modes:?}");
    assert!(touchdown.and_then(|t| t.uav_m_s).is_some_and(|speed| speed < 0.5), "{touchdown:?}");
}

/// A load that stays caught on its way down keeps the UAV in the air, by its cable in the end, be
/// it known by its own navigation or by the rod alone, and be the load seen or not. That is no
/// landing: the rotors go on, the vehicle holds and says why. By its own navigation it lands once
/// the load is free; by the rod alone it then knows nothing of itself until the cable is taut again,
/// and whether it is caught up with by a load that falls past it is chance.
#[test]
fn a_load_that_is_caught_ends_in_hold_and_not_with_rotors_off() {
    const AGAIN: &str = r#"{ at_s = 75.0, do = "hold" }, { at_s = 76.0, do = "land" }"#;
    let start = r#"{ at_s = 0.0, do = "hold" }, { at_s = 40.0, do = "land" }"#;
    const FREED: &[f64] = &[70.0, 900.0];
    const KEPT: &[f64] = &[900.0];
    for (begun, requests, sensors, ends) in [
        (STANDING, WHOLE, "", FREED),
        (STANDING, WHOLE, "sensors = { accelerometer = false }", FREED),
        (STANDING, WHOLE, "sensors = { rod = { nan = { at_s = 43.0, for_s = 900.0 } } }", FREED),
        (HANGING, start, "sensors = { uav = false, accelerometer = false }", KEPT),
    ] {
        for until_s in ends {
            let name = format!("{sensors} caught until {until_s} s");
            let more = format!("cable = {{ snagged = {{ at_s = 42.0, for_s = {:?} }} }}\n{sensors}", until_s - 42.0);
            let text = text(begun, "", &format!("{requests}, {AGAIN}"), &more).replace("90.0", "140.0");
            let (mut flies, mut faults) = (false, Vec::new());
            let (end, modes) = flown(&parsed(&text), &mut |moment| {
                let Some(decision) = moment.decision else { return };
                flies |= !matches!(decision.mode, Mode::Off | Mode::Idle);
                let [_, stands] = moment.body.touching();
                assert!(!flies || stands || decision.mode != Mode::Off, "{name}: off at {} s", moment.t_s);
                if decision.mode == Mode::Hold
                    && moment.request == Request::Land
                    && faults.last() != Some(&decision.fault)
                {
                    faults.push(decision.fault);
                }
            });
            println!("{name}: {end:?} {modes:?} {faults:?}");
            assert!(faults.contains(&Some(Fault::Caught)), "{name}: {faults:?}");
            let lands = matches!(end, End::Landed(_));
            assert_eq!(lands, *until_s < 900.0, "{name}: {end:?} {modes:?}");
        }
    }
}

/// Nobody tells how high the ground is, how it slopes, nor what the payload comes to stand on.
#[test]
fn it_lands_softly_on_ground_that_is_not_told() {
    for ground in [
        "p3 = -1.5",
        "slope = [0.17, 0.0]",
        "slope = [-0.1, 0.15]",
        "box_height = 1.0",
        "box_height = -1.0",
        "box_height = 0.5\nslope = [0.0, -0.1]",
    ] {
        let mut touchdown = None;
        let text = text(STANDING, ground, WHOLE, "");
        let (end, modes) = flown(&parsed(&text), &mut |moment| touchdown = Some(*moment.touchdown));
        println!("{ground}: {end:?} {touchdown:?}");
        assert!(matches!(end, End::Landed(_)), "{ground}: {end:?}, {modes:?}");
        let touchdown = touchdown.expect("it was watched");
        for speed in [touchdown.uav_m_s, touchdown.load_m_s] {
            assert!(speed.is_some_and(|speed| speed < SOFT), "{ground}: {touchdown:?}");
        }
    }
}

/// In wind, whatever the payload weighs against what is told, and whatever the rotors give of what
/// they are told.
#[test]
fn it_lands_softly_in_wind_with_wrong_masses_and_rotors() {
    let air = "{ wind = [3.0, 4.0, 0.0], gusts = { speed_at_6m = 5.0 } }";
    for (told, thrust) in [(0.5, 1.0), (0.75, 0.85), (0.25, 0.85), (0.25, 1.15), (0.75, 1.15)] {
        let more = format!("environment = {{ air = {air} }}\n actuators = {{ thrust_scale = {thrust:?} }}");
        let mut scenario = scenario(WHOLE, &more);
        scenario.controller.vehicle.payload_mass = told;
        let mut touchdown = None;
        let (end, modes) = flown(&scenario, &mut |moment| touchdown = Some(*moment.touchdown));
        assert!(matches!(end, End::Landed(_)), "told {told} kg, thrust {thrust}: {end:?}, {modes:?}");
        let touchdown = touchdown.expect("it was watched");
        println!("told {told} kg, thrust {thrust}: {touchdown:?}");
        for speed in [touchdown.uav_m_s, touchdown.load_m_s] {
            assert!(speed.is_some_and(|speed| speed < SOFT), "told {told} kg, thrust {thrust}: {touchdown:?}");
        }
    }
}

/// Whatever fails while the load is on its way down, or is not as it was told, from take-off to
/// rotors off.
#[test]
fn it_lands_softly_whatever_fails_on_the_way() {
    for fault in [
        "sensors = { position = { nan = { at_s = 2.0, for_s = 2.0 } } }",
        "sensors = { position = { nan = { at_s = 42.0, for_s = 100.0 } } }",
        "sensors = { rod = { freeze = { at_s = 25.0, for_s = 100.0 } } }",
        "sensors = { rod = { drop_out = { at_s = 42.0, for_s = 100.0 } } }",
        "sensors = { rod = { bias = [0.1, 0.05, 0.0] } }",
        "sensors = { uav_position = { nan = { at_s = 42.0, for_s = 100.0 } } }",
        "sensors = { uav_position = { freeze = { at_s = 44.0, for_s = 2.5 } } }",
        "sensors = { body_rate = { nan = { at_s = 45.0, for_s = 1.0 } } }",
        "sensors = { body_rate = { freeze = { at_s = 43.0, for_s = 4.0 } } }",
        "sensors = { body_rate = { drop_out = { at_s = 3.0, for_s = 100.0 } } }",
        "sensors = { attitude = { freeze = { at_s = 45.0, for_s = 0.3 } } }",
        "cable = { snagged = { at_s = 43.0, for_s = 3.0 } }",
        "actuators = { latency_s = 0.04 }",
        "actuators = { thrust_scale = 0.8 }",
        "environment = { air = { wind = [4.0, 3.0, 0.0], gusts = { speed_at_6m = 8.0 } } }",
        "environment = { payload_step = { at_s = 44.0, mass = 1.0 } }",
    ] {
        let mut touchdown = None;
        let (end, modes) = flown(&scenario(WHOLE, fault), &mut |moment| touchdown = Some(*moment.touchdown));
        assert!(matches!(end, End::Landed(_)), "{fault}: {end:?}, {modes:?}");
        let touchdown = touchdown.expect("it was watched");
        println!("{fault}: {touchdown:?}");
        for speed in [touchdown.uav_m_s, touchdown.load_m_s] {
            assert!(speed.is_some_and(|speed| speed < SOFT), "{fault}: {touchdown:?}");
        }
    }
}

/// A sensor that is lost or wrong for two seconds on the path costs less than a metre of height, m,
/// and then the path is followed again.
#[test]
fn two_seconds_without_a_measurement_cost_no_height() {
    const HEIGHT: f64 = 1.0;
    let follow = r#"{ at_s = 0.0, do = "idle" }, { at_s = 1.0, do = "hold" }, { at_s = 12.0, do = "follow" }"#;
    for channels in [
        &["position"] as &[_],
        &["position", "velocity"],
        &["rod"],
        &["rod", "rod_rate"],
        &["rod_rate"],
        &["body_rate"],
    ] {
        for wrong in ["nan", "drop_out", "freeze"] {
            let tables = channels
                .iter()
                .map(|channel| format!("{channel} = {{ {wrong} = {{ at_s = 30.0, for_s = 2.0 }} }}"))
                .collect::<Vec<_>>();
            let scenario = scenario(follow, &format!("sensors = {{ {} }}", tables.join(", ")));
            let length = scenario.vehicle.rod_length;
            // p3 of the UAV and the mode, when all was well.
            let (mut before, mut lost, mut last) = (None, 0.0_f64, Mode::Off);
            flown(&scenario, &mut |moment| {
                let p3 = moment.state.position.z - length * moment.state.rod.z;
                if let Some(decision) = moment.decision {
                    last = decision.mode;
                    if moment.t_s < 30.0 {
                        before = Some((p3, last));
                    }
                    lost = before.map_or(lost, |(before, _)| lost.max(p3 - before));
                }
            });
            println!("{channels:?} {wrong}: {lost:.2} m lost");
            assert!(before.is_some_and(|(_, mode)| mode == Mode::Follow), "{channels:?} {wrong}: {before:?}");
            assert!(lost < HEIGHT, "{channels:?} {wrong}: {lost} m lost");
            assert_eq!(last, Mode::Follow, "{channels:?} {wrong}");
        }
    }
}

#[test]
fn a_touch_that_is_no_landing_is_a_crash() {
    let off = r#"{ at_s = 0.0, do = "idle" }, { at_s = 1.0, do = "hold" }, { at_s = 12.0, do = "off" }"#;
    let (end, _) = flown(&scenario(off, ""), &mut |_| {});
    assert!(matches!(end, End::Crashed(t_s) if (12.0..14.0).contains(&t_s)), "{end:?}");
    // A ground that is told to bear less than a landing's speed.
    let mut brittle = scenario(WHOLE, "");
    brittle.ground.as_mut().expect("there is ground").crash_speed = 0.1;
    let (end, _) = flown(&brittle, &mut |_| {});
    assert!(matches!(end, End::Crashed(_)), "{end:?}");
}

#[test]
fn pause_and_go_on_are_asked_for_like_everything() {
    let requests = r#"{ at_s = 0.0, do = "idle" }, { at_s = 1.0, do = "hold" }, { at_s = 12.0, do = "follow" },
        { at_s = 30.0, speed_factor = 0.0 }, { at_s = 42.0, speed_factor = 1.0 }"#;
    let mut scenario = scenario(requests, "");
    scenario.duration_s = 55.0;
    let (mut paused, mut gone_on) = (f64::INFINITY, 0.0_f64);
    flown(&scenario, &mut |moment| {
        let velocity = &moment.state.velocity;
        let speed = velocity.dot(velocity).sqrt();
        if (38.0..42.0).contains(&moment.t_s) {
            paused = paused.min(speed);
        }
        if moment.t_s > 50.0 {
            gone_on = gone_on.max(speed);
        }
    });
    assert!(paused < 0.05 && (gone_on - 1.0).abs() < 0.05, "{paused} {gone_on}");
}

#[test]
fn what_is_asked_for_is_checked() {
    let error = |text: &str| Scenario::parse("ground.toml", text).unwrap_err().to_string();
    assert!(
        error("request = [{ at_s = 5.0, do = \"land\" }, { at_s = 4.0, do = \"off\" }]").contains("request[1].at_s")
    );
    assert!(error("request = [{ at_s = 5.0 }]").contains("request[0].do"));
    assert!(error("request = [{ at_s = 50.0, do = \"land\" }]").contains("50 is outside 0 to 10"));
    assert!(error("request = [{ at_s = 5.0, do = \"fly\" }]").contains("fly"));
    assert!(error("controller = { parameters = { POL_DESCENT = -1.0 } }").contains("POL_DESCENT"));
    assert!(error("controller = { parameters = { VEH_M_LOAD = 1.0 } }").contains("VEH_M_LOAD"));
}

/// Loads on 10 to 12 m of rope that gusts carried half a metre to a metre away, while the UAV
/// itself stayed where it was. What is left is the faster part of the gusts.
#[test]
fn a_load_on_a_long_rope_is_set_down_in_its_place_in_gusts() {
    let campaign = Campaign::parse(campaign::builtin("ground-to-ground").expect("it is built in")).unwrap();
    for (batch, run) in [(1, 219), (2, 634), (2, 922)] {
        let row = fly_run(&campaign, Seed { batch, run }, Control::alone(), None);
        let row = row.unwrap().expect("nobody interrupts it");
        println!("{batch}, {run}: {:?}", row.load_place_m);
        assert_eq!(row.verdict, Verdict::Good, "{row:?}");
        assert!(row.load_place_m.is_some_and(|distance| distance < IN_PLACE / 2.0), "{row:?}");
    }
}

/// A few missions of the built-in campaign: any vehicle, rope, wind and wrong number.
#[test]
fn the_campaign_from_ground_to_ground_lands_in_its_place() {
    let campaign = Campaign::parse(campaign::builtin("ground-to-ground").expect("it is built in")).unwrap();
    assert_eq!(land_in_place(&campaign, 12), 0);
    // What was drawn is as various as the campaign says.
    let lengths: Vec<f64> =
        (0..200).map(|run| campaign.draw(Seed { batch: 3, run }).unwrap().scenario.vehicle.rod_length).collect();
    assert!(lengths.iter().any(|length| *length < 1.0) && lengths.iter().any(|length| *length > 12.0));
}

/// The same without a sensor on the load.
#[test]
fn the_campaign_on_satellite_fixes_lands_in_its_place() {
    let campaign = Campaign::parse(campaign::builtin("ground-to-ground-rtk").expect("it is built in")).unwrap();
    assert!(campaign.draw(Seed { batch: 3, run: 0 }).unwrap().scenario.estimator.is_some());
    assert_eq!(land_in_place(&campaign, 6), 0);
}

/// The same on cables that stretch by 0.5 to 5 % under their load, with a twentieth of critical
/// damping, of which nothing is told.
#[test]
fn the_campaign_on_cables_that_stretch_lands_in_its_place() {
    let rigid = campaign::builtin("ground-to-ground").expect("it is built in");
    let ea = "9.81*load/(0.005*10^(draw_bearing/(2*pi)))";
    let damping = format!("0.1*sqrt({ea}/rope*load*load_uav/(load + load_uav))");
    let stretched = format!(
        "{rigid}\n\"cable.ea\" = {{ formula = \"{ea}\" }}\n\"cable.damping\" = {{ formula = \"{damping}\" }}"
    );
    // One in thirty-six drives a bounce until the cable is slack, and returns to the path.
    assert!(land_in_place(&Campaign::parse(&stretched).unwrap(), 12) <= 2);
}

/// Flies the first `runs` of the campaign: all land softly, with the load in its place. Returns how
/// many left the law on the way.
fn land_in_place(campaign: &Campaign, runs: u64) -> usize {
    let rows: Vec<_> = (0..runs)
        .map(|run| {
            let row = fly_run(campaign, Seed { batch: 3, run }, Control::alone(), None);
            row.unwrap().expect("nobody interrupts it")
        })
        .collect();
    for row in &rows {
        assert_eq!(row.verdict, Verdict::Good, "{row:?}");
        let worst = row.uav_touchdown_m_s.into_iter().chain(row.load_touchdown_m_s).fold(0.0, f64::max);
        assert!(worst < SOFT, "{row:?}");
    }
    let left = rows.iter().filter(|row| row.falls > 0).count();
    let summary = campaign::summarize(3, rows.into_iter().map(Ok::<_, ()>)).unwrap().0;
    assert_eq!((summary.success_rate, summary.crashed, summary.lost), (1.0, 0, 0));
    assert!(summary.worst_load_place_m.is_some_and(|distance| distance < IN_PLACE));
    left
}
