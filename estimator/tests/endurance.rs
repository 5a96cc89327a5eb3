//! A day in single precision: the covariance stays positive, and nothing drifts. And it stays
//! positive whatever noise is told.
//!
//! `cargo test` flies the first half hour. `ESTIMATOR_HOURS=24 cargo test -p estimator --test
//! endurance -- --nocapture` flies the day; `docs/estimator.md` has its figures.

use estimator::{Drag, Fix, Imu, Matrix3, Motion, Navigation, NavigationParams, Payload, PayloadParams, Vector3};
use model::VehicleParams;

const PERIOD: f32 = 0.002;
const G: f32 = 9.81;
/// Flown where nothing else is asked for, h.
const HOURS: f64 = 0.5;

/// Least eigenvalue's sign by a Cholesky factorization in f64 of the matrix scaled to a unit
/// diagonal; the least pivot.
#[expect(clippy::needless_range_loop, reason = "two sides of a matrix")]
fn least_pivot<const N: usize>(p: &[[f32; N]; N]) -> f64 {
    let mut a = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            a[i][j] = f64::from(p[i][j]) / (f64::from(p[i][i]) * f64::from(p[j][j])).sqrt();
        }
    }
    let mut least = f64::INFINITY;
    for k in 0..N {
        let pivot = a[k][k];
        least = least.min(pivot);
        for i in k + 1..N {
            let factor = a[i][k] / pivot;
            for j in k + 1..N {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    least
}

/// From 0 to 1.
fn uniform(random: &mut u64) -> f32 {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    (*random >> 40) as f32 / (1 << 24) as f32
}

/// A normal enough number: the sum of four uniform ones, scaled.
fn noise(random: &mut u64) -> f32 {
    let mut sum = 0.0;
    for _ in 0..4 {
        sum += 2.0 * uniform(random) - 1.0;
    }
    sum * 0.866
}

/// Hover in noise, both filters, one behind the other.
#[test]
fn hours_of_hovering() {
    let hours = std::env::var("ESTIMATOR_HOURS").map_or(HOURS, |hours| hours.parse().expect("a number of hours"));
    let start = Motion::at_rest(Vector3::new(3.0, -2.0, -10.0), G);
    let mut navigation = Navigation::<f32>::new(NavigationParams::every(PERIOD), &start, [0.02, 0.1]).unwrap();
    let mut payload = Payload::new(PayloadParams::of(&VehicleParams::paper(), PERIOD)).unwrap();
    let mut random = 77;
    // 0.015 m/s²/√Hz and 7e-4 rad/s/√Hz at 500 Hz.
    let (force, rate) = (0.335, 0.0157);
    let mut worst = [f64::INFINITY; 2];
    let (mut off, mut swing) = (0.0_f32, 0.0_f32);
    for step in 0..(hours * 3600.0 * 500.0) as u64 {
        let mut vector = |deviation: f32| Vector3::from_fn(|_, _| deviation * noise(&mut random));
        let imu = Imu {
            body_rate: vector(rate) + Vector3::new(0.002, -0.001, 0.003),
            specific_force: vector(force) + Vector3::new(0.02, 0.01, -0.03 - G),
        };
        if step % 50 == 0 {
            let fix = Fix {
                position: Some(start.position + vector(0.012)),
                velocity: Some(vector(0.04)),
                position_accuracy: [0.012, 0.02],
                velocity_accuracy: [0.04, 0.06],
                age: 0.1,
            };
            navigation.fix(&fix).unwrap();
        }
        if step % 25 == 0 {
            navigation.heading(0.03 * noise(&mut random)).unwrap();
        }
        let motion = navigation.step(Some(&imu));
        let estimate = payload.step(Some(&motion), Some(3.0 * G));
        if step % 5000 == 4999 {
            worst[0] = worst[0].min(least_pivot(&navigation.covariance()));
            worst[1] = worst[1].min(least_pivot(&payload.covariance()));
            off = off.max((motion.position - start.position).amax());
            swing = swing.max(estimate.state.rod.x.abs().max(estimate.state.rod.y.abs()));
        }
    }
    eprintln!("least pivots {worst:?}, off {off} m, rod {swing} rad");
    assert!(worst[0] > 0.0 && worst[1] > 0.0, "{worst:?}");
    // Five of the deviations that each filter has of itself, 8 mm and 0.8°: of a day's 8,640
    // samples none is likely to be beyond.
    assert!(off < 0.04, "{off}");
    assert!(swing < 0.07, "{swing}");
}

/// Deviations drawn from their whole ranges, four decades for most, cables of 0.3 to 30 m, a UAV
/// that tilts, turns and shakes, a hundred cycles each, half of them with a load that is seen now
/// and then.
#[test]
fn positive_whatever_noise_is_told() {
    let mut random = 5;
    let mut worst = f64::INFINITY;
    for run in 0..1000 {
        // Between two powers of ten, each decade as likely.
        let mut between = |least: f32, most: f32| 10.0_f32.powf(least + (most - least) * uniform(&mut random));
        let mut params = PayloadParams::of(&VehicleParams::paper(), PERIOD);
        params.cable_length = between(-0.5, 1.5);
        params.payload_drag = Drag::of_area(between(-3.0, 0.0));
        params.uav_drag = Drag::of_area(between(-3.0, 0.0));
        params.noise.accelerometer = between(-4.0, 0.0);
        params.noise.lateral = between(-3.0, 1.0);
        params.noise.axial = between(-3.0, 1.0);
        params.noise.rod = between(-5.0, 0.0);
        params.noise.start_rod = between(-2.0, 0.0);
        params.noise.start_rate = between(-2.0, 1.0);
        let mut payload = Payload::new(params).unwrap();
        let shake = 10.0 * params.noise.accelerometer;
        for step in 0..3000 {
            let mut vector = |deviation: f32| Vector3::from_fn(|_, _| deviation * noise(&mut random));
            let (angle, force) = (0.4 * (0.004 * step as f32).sin(), vector(shake));
            let (sin, cos) = angle.sin_cos();
            let motion = Motion {
                attitude: Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos),
                specific_force: force + Vector3::new(0.0, 0.0, -G),
                ..Motion::at_rest(Vector3::new(0.0, 0.0, -10.0), G)
            };
            payload.step(Some(&motion), Some(3.0 * G));
            if run % 2 == 0 && step % 90 < 30 {
                payload.observe(&estimator::LoadMeasurement::Direction(Vector3::z() + vector(0.01), 0.01), 0.0);
            }
            worst = worst.min(least_pivot(&payload.covariance()));
        }
    }
    eprintln!("least pivot {worst:e}");
    assert!(worst > 0.0, "{worst:e}");
}
