//! What leads navigation astray, and that it finds back.

use std::f64::consts::FRAC_PI_2;

use estimator::{Fix, Imu, Matrix3, Motion, Navigation, NavigationParams, Vector3};

const PERIOD: f64 = 0.002;
const G: f64 = 9.81;
/// A circle's radius, m, and how fast it is flown, rad/s.
const RADIUS: f64 = 5.0;
const RATE: f64 = 0.5;

/// A level UAV on a circle, at its `heading`.
struct Uav {
    time: f64,
    heading: f64,
    yaw_rate: f64,
    /// By how much its receiver is off, m.
    jump: f64,
}

impl Uav {
    fn direction(&self) -> [f64; 2] {
        let (sin, cos) = (RATE * self.time).sin_cos();
        [cos, sin]
    }

    fn attitude(&self) -> Matrix3<f64> {
        let (sin, cos) = self.heading.sin_cos();
        Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
    }

    fn motion(&self) -> Motion<f64> {
        let [cos, sin] = self.direction();
        let attitude = self.attitude();
        let acceleration = Vector3::new(-cos, -sin, 0.0) * (RADIUS * RATE * RATE);
        Motion {
            position: Vector3::new(cos, sin, -2.0) * RADIUS,
            velocity: Vector3::new(-sin, cos, 0.0) * (RADIUS * RATE),
            attitude,
            body_rate: Vector3::new(0.0, 0.0, self.yaw_rate),
            specific_force: attitude.transpose() * (acceleration - Vector3::new(0.0, 0.0, G)),
        }
    }
}

/// `navigation` through so many `seconds` with a receiver and a compass, by a gyro that is wrong by
/// a half per cent, with axes off by a degree, while the UAV turns as `yaw_rate` says: the angle,
/// rad, by which its attitude is off at the end, and the most that its velocity was, m/s.
fn off_after(
    navigation: &mut Navigation<f64>,
    uav: &mut Uav,
    seconds: f64,
    yaw_rate: impl Fn(f64) -> f64,
) -> (f64, f64) {
    let wrong = Matrix3::new(1.005, -0.017, 0.017, 0.017, 1.005, -0.017, -0.017, 0.017, 1.005);
    let mut fastest = 0.0_f64;
    for step in 1..=(seconds / PERIOD) as u64 {
        let Motion { position, velocity, body_rate, specific_force, .. } = uav.motion();
        if step % 50 == 0 {
            let fix = Fix {
                position: Some(position + Vector3::x() * uav.jump),
                velocity: Some(velocity),
                position_accuracy: [0.012, 0.02],
                velocity_accuracy: [0.04, 0.06],
                age: 0.0,
            };
            // One that is refused is one of those that lead to a restart.
            let _ = navigation.fix(&fix);
        }
        if step % 25 == 0 {
            navigation.heading(uav.heading).unwrap();
        }
        let found = navigation.step(Some(&Imu { body_rate: wrong * body_rate, specific_force }));
        fastest = fastest.max((found.velocity - velocity).amax());
        uav.yaw_rate = yaw_rate(step as f64 * PERIOD);
        uav.time += PERIOD;
        uav.heading += uav.yaw_rate * PERIOD;
    }
    let off = navigation.motion().attitude * uav.attitude().transpose();
    (((off.trace() - 1.0) / 2.0).clamp(-1.0, 1.0).acos(), fastest)
}

/// A gyro's errors grow with what it reads. A filter that puts them down to its bias keeps that,
/// and turns away from the truth when the spin has ended.
#[test]
fn a_spin_does_not_mislead_it() {
    let mut uav = Uav { time: 0.0, heading: 0.3, yaw_rate: 0.0, jump: 0.0 };
    let mut navigation = Navigation::new(NavigationParams::every(PERIOD), &uav.motion(), [0.02, 0.1]).unwrap();
    off_after(&mut navigation, &mut uav, 5.0, |_| 0.0);
    // Up to 30 rad/s and back in two seconds: five turns.
    off_after(&mut navigation, &mut uav, 2.0, |t| 30.0 * (FRAC_PI_2 * t).sin());
    let (off, _) = off_after(&mut navigation, &mut uav, 8.0, |_| 0.0);
    // Measured: 0.002; with a bias of 0.02 rad/s that only the spin has made, 0.045.
    assert!(off < 0.01, "{off}");
    assert_eq!(navigation.health().resets, 0);
}

/// A heading that is off by half a right angle, and believed.
#[test]
fn an_attitude_that_leads_it_astray_is_not_believed() {
    let mut uav = Uav { time: 0.0, heading: 0.3, yaw_rate: 0.0, jump: 0.0 };
    let (sin, cos) = 0.8_f64.sin_cos();
    let turned = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    let motion = uav.motion();
    let misled = Motion { attitude: turned * motion.attitude, ..motion };
    let mut params = NavigationParams::every(PERIOD);
    params.noise.start_heading = 0.01;
    let mut navigation = Navigation::new(params, &misled, [0.02, 0.1]).unwrap();
    let (off, _) = off_after(&mut navigation, &mut uav, 20.0, |_| 0.0);
    // Measured: 0.022 after one restart; 0.5 after three where each believes the attitude anew.
    assert!(off < 0.05, "{off}");
    assert_eq!(navigation.health().resets, 1);
}

/// A receiver that finds itself half a metre from where a vehicle was told to start: one whose
/// velocity is not known well yet.
#[test]
fn a_jump_is_no_velocity() {
    let mut uav = Uav { time: 0.0, heading: 0.3, yaw_rate: 0.0, jump: 0.5 };
    let mut navigation = Navigation::new(NavigationParams::every(PERIOD), &uav.motion(), [0.02, 0.1]).unwrap();
    let (_, faster) = off_after(&mut navigation, &mut uav, 5.0, |_| 0.0);
    // Measured: 0.003; where the filter's doubt grows until it takes the jump in, 0.6.
    assert!(faster < 0.05, "{faster}");
    assert_eq!(navigation.health().resets, 1);
    assert!((navigation.motion().position - uav.motion().position - Vector3::x() * uav.jump).amax() < 0.05);
}
