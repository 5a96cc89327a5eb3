//! Exactly at the paper's singular configurations, around them, and upside down: a defined mode, a
//! bounded command, and back to the path.

use controller::{Fault, Margin, Matrix3, Mode, Policy, Request, Sampling, State, Vector3};

use crate::flight::{CIRCLE, Flight, PERIOD, deviation, supervisor};

const LAG: f64 = 0.05;
const HOVER: f64 = 29.43;

/// The rotation by `angle` about the unit vector `axis`, by Rodrigues' formula.
fn turned(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    let cross = Matrix3::new(0.0, -axis.z, axis.y, axis.z, 0.0, -axis.x, -axis.y, axis.x, 0.0);
    Matrix3::identity() + cross * sin + cross * cross * (1.0 - cos)
}

/// High over the ground, near the path.
fn at_rest() -> State<f64> {
    State::at_rest(Vector3::new(CIRCLE[0], 0.5, CIRCLE[1]))
}

/// A name, a state, and the thrust that is being applied, N.
type Case = (&'static str, State<f64>, f64);

fn configurations() -> Vec<Case> {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let quarter = core::f64::consts::FRAC_PI_2;
    let with_rod = |rod: Vector3<f64>| State { rod, ..at_rest() };
    let with_attitude = |attitude| State { attitude, ..at_rest() };
    // λ = 0 under thrust: κ b3·q = −|q̇|², with κ = T/(m_Q L) and b3·q = cos 100°.
    let leaning = turned(y, 100.0_f64.to_radians());
    let rate = (HOVER / 5.0 * -100.0_f64.to_radians().cos()).sqrt();
    vec![
        ("alpha = pi/2", with_rod(-y), HOVER),
        ("alpha = -pi/2", with_rod(y), HOVER),
        ("beta = pi/2", with_rod(x), HOVER),
        ("beta = -pi/2", with_rod(-x), HOVER),
        ("rod up", with_rod(-z), HOVER),
        ("b3 across the rod, pitch", with_attitude(turned(y, quarter)), HOVER),
        ("b3 across the rod, cos phi = 0", with_attitude(turned(x, quarter)), HOVER),
        ("cos phi = 0, the other way, rod along it", State { rod: y, ..with_attitude(turned(x, -quarter)) }, HOVER),
        ("upside down", with_attitude(turned(x, 2.0 * quarter)), HOVER),
        ("upside down, rod up", State { rod: -z, ..with_attitude(turned(y, 2.0 * quarter)) }, HOVER),
        ("free fall, T = 0", at_rest(), 0.0),
        ("free fall under thrust", State { rod_rate: y * rate, ..with_attitude(leaning) }, HOVER),
        ("centre of the circle", State::at_rest(Vector3::new(0.0, 0.0, CIRCLE[1])), HOVER),
        ("axis of the circle", State::at_rest(Vector3::new(0.0, 0.0, CIRCLE[1] - 3.0)), HOVER),
        (
            "tumbling",
            State { body_rate: Vector3::new(6.0, -5.0, 4.0), rod_rate: Vector3::new(3.0, 2.0, 0.0), ..at_rest() },
            HOVER,
        ),
    ]
}

/// `state`, turned and moved by up to `size` in ways that differ from case to case.
fn nearby(state: &State<f64>, size: f64, case: usize) -> State<f64> {
    let angle = case as f64 * 2.399;
    let axis = Vector3::new(angle.sin(), angle.cos(), 0.0);
    let (rod, body) = (turned(axis, size), turned(-axis.yxz(), size));
    State {
        position: state.position + axis * size,
        rod: rod * state.rod,
        rod_rate: rod * state.rod_rate,
        attitude: body * state.attitude,
        ..*state
    }
}

/// Flies from `state`, the law asked to follow from there, and gives the height that the UAV loses,
/// m.
fn recovers(name: &str, state: &State<f64>, applied: f64) -> f64 {
    let sampling = Sampling { rotor_lag: LAG as f32, ..Sampling::every(PERIOD as f32) };
    let mut flight = Flight::new(supervisor(sampling, Policy::default()), state, 0.5, applied, LAG);
    let height = flight.body.uav_position().z;
    let mut lowest = height;
    let mut followed = 0.0;
    for _ in 0..(90.0 / PERIOD) as usize {
        let output = flight.step(Request::Follow);
        assert!(matches!(output.mode, Mode::Hold | Mode::Join | Mode::Follow), "{name}: {:?}", output.mode);
        lowest = lowest.max(flight.body.uav_position().z);
        followed = if output.mode == Mode::Follow { followed + PERIOD } else { 0.0 };
        if followed > 10.0 {
            let off = deviation(&flight.body.state().position);
            assert!(off < 0.05, "{name}: {off} m off the path");
            return lowest - height;
        }
    }
    panic!("{name}: not on the path after 90 s, but in {:?}", flight.supervisor.mode());
}

#[test]
fn the_path_is_reached_from_every_singular_configuration_and_around() {
    for (case, (name, state, applied)) in configurations().into_iter().enumerate() {
        for size in [0.0, 1e-7, 1e-3, 0.1] {
            let lost = recovers(name, &nearby(&state, size, case), applied);
            println!("{name} {size:e}: {lost:.2} m lost");
            // Half a turn takes 0.6 s, in which a fall is 1.8 m and 6 m/s; to stop that at 1 g
            // takes as much again. And the path below the axis is 3 m down.
            assert!(lost < 4.0, "{name} {size:e}: {lost} m lost");
        }
    }
}

#[test]
fn the_law_itself_hands_over_where_it_is_singular() {
    for (name, state, _) in configurations() {
        let mut law = supervisor(Sampling::every(PERIOD as f32), Policy::default());
        // ζ1 = g asks for free fall, ζ = 0 for hover.
        for zeta in [0.0, 9.81] {
            law.start(&state.cast(), [zeta, 0.0, 0.0, 0.0]).unwrap();
            let output = law.step(Some(&state.cast()), Request::Follow);
            crate::flight::assert_bounded(&output);
            let is_regular = zeta == 0.0 && name == "free fall, T = 0";
            if is_regular {
                assert_eq!(output.mode, Mode::Follow, "{name}");
            } else {
                assert_eq!(output.mode, Mode::Hold, "{name} with zeta {zeta}");
                assert!(
                    matches!(output.fault, Some(Fault::Margin(_) | Fault::NotFinite)),
                    "{name}: {:?}",
                    output.fault
                );
            }
            // And what it saw there leaves no trace: the next good state is flown like a first one.
            let good: State<f32> = at_rest().cast();
            let mut fresh = supervisor(Sampling::every(PERIOD as f32), Policy::default());
            let applied = controller::Command::of_thrust(HOVER as f32);
            law.take_over(&good, applied).unwrap();
            fresh.take_over(&good, applied).unwrap();
            for request in [Request::Hold, Request::Follow, Request::Follow] {
                assert_eq!(law.step(Some(&good), request), fresh.step(Some(&good), request), "{name}");
            }
        }
    }
}

#[test]
fn margins_name_the_singularity() {
    let fault = |state: &State<f64>, zeta| {
        let mut law = supervisor(Sampling::every(PERIOD as f32), Policy::default());
        law.start(&at_rest().cast(), [zeta, 0.0, 0.0, 0.0]).unwrap();
        law.step(Some(&state.cast()), Request::Follow).fault
    };
    let leaning = |angle: f64| State { rod: Vector3::new(angle.sin(), 0.0, angle.cos()), ..at_rest() };
    assert_eq!(fault(&leaning(1.3), 0.0), Some(Fault::Margin(Margin::RodAngle)));
    assert_eq!(
        fault(&State { attitude: turned(Vector3::y(), 1.3), ..at_rest() }, 0.0),
        Some(Fault::Margin(Margin::ThrustAngle))
    );
    let near_axis = State::at_rest(Vector3::new(0.05 * CIRCLE[0], 0.0, CIRCLE[1]));
    assert_eq!(fault(&near_axis, 0.0), Some(Fault::Margin(Margin::Path)));
    let falling = fault(&at_rest(), 9.0);
    assert!(matches!(falling, Some(Fault::Margin(Margin::Tension | Margin::Thrust))), "{falling:?}");
}
