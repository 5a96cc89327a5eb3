//! Rotors as the parameters describe them.

use controller::{Actuation, Command, Vector3};
use rig::{Actuators, Parameters, parameter};

/// Thrust and torque of four duties: the geometry taken forwards.
fn together(parameters: &Parameters<f32>, duties: [f32; 4]) -> Command<f32> {
    let get = |parameter| parameters.get(parameter);
    let (arm, drag) = (get(parameter!("ROT_ARM")), get(parameter!("ROT_KQ")) / get(parameter!("ROT_KT")));
    // Front right, rear left, front left, rear right; the first two turn counter-clockwise.
    let places = [[arm, arm], [-arm, -arm], [arm, -arm], [-arm, arm]];
    let mut sum = Command::zero();
    for ((duty, [x, y]), spin) in duties.into_iter().zip(places).zip([1.0, 1.0, -1.0, -1.0]) {
        let force = get(parameter!("ROT_KT")) * (get(parameter!("ROT_W_MAX")) * duty).powi(2);
        sum.thrust += force;
        sum.torque += Vector3::new(x, y, 0.0).cross(&Vector3::new(0.0, 0.0, -force))
            + Vector3::new(0.0, 0.0, spin * drag * force);
    }
    sum
}

fn distance(a: &Command<f32>, b: &Command<f32>) -> f32 {
    (a.thrust - b.thrust).abs() + (a.torque - b.torque).abs().sum()
}

#[test]
fn what_the_rotors_have_is_given_bit_for_bit() {
    let parameters = Parameters::<f32>::default();
    let actuators = Actuators::new(&parameters).unwrap();
    let wanted = Command { thrust: 30.0, torque: Vector3::new(0.5, -0.7, 0.2) };
    assert_eq!(actuators.apply(&wanted), wanted);
    // Single precision, squared and rooted.
    assert!(distance(&together(&parameters, actuators.duties(&wanted)), &wanted) < 1e-4);
}

#[test]
fn yaw_gives_way_first_then_thrust() {
    let parameters = Parameters::<f32>::default();
    let actuators = Actuators::new(&parameters).unwrap();
    let (thrust, roll) = (59.0, 3.0);
    let wanted = Command { thrust, torque: Vector3::new(roll, 0.0, 1.0) };
    let applied = actuators.apply(&wanted);
    assert_eq!((applied.thrust, applied.torque.x), (thrust, roll));
    assert!(applied.torque.z < 0.9, "{applied:?}");
    assert!(distance(&together(&parameters, actuators.duties(&applied)), &applied) < 1e-4);

    // Without thrust there is roll all the same, and as much thrust as it takes.
    let applied = actuators.apply(&Command { thrust: 0.0, torque: Vector3::new(roll, 0.0, 0.0) });
    assert!(applied.torque.x == roll && applied.thrust > roll / 0.25, "{applied:?}");
}

#[test]
fn nothing_at_all_stops_the_rotors_that_the_least_thrust_lets_idle() {
    let parameters = Parameters::<f32>::default();
    let actuators = Actuators::new(&parameters).unwrap();
    assert_eq!(actuators.duties(&Command::zero()), [0.0; 4]);
    let idle = Command { thrust: actuators.least_thrust(), torque: Vector3::zeros() };
    let least = parameters.get(parameter!("ROT_W_MIN")) / parameters.get(parameter!("ROT_W_MAX"));
    assert!(actuators.duties(&idle).iter().all(|duty| (duty - least).abs() < 1e-6));
}
