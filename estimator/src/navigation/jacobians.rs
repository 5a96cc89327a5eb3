//! (10), (12), (13) and (14) against central differences of what they come from, at random states.

use super::aiding::{Clock, Kind, Waiting};
use super::predict::{Covariance, Spread};
use super::strapdown::{ERRORS, Strapdown, index};
use super::*;
use crate::covariance::at;
use crate::random::Random;

fn draw(random: &mut Random) -> Strapdown<f64> {
    let unit = |v: Vector3<f64>| v / v.dot(&v).sqrt();
    let b3 = unit(Vector3::new(0.4 * random.next(), 0.4 * random.next(), 1.0));
    let b2 = unit(b3.cross(&random.vector(1.0)));
    Strapdown {
        position: random.vector(10.0),
        velocity: random.vector(3.0),
        attitude: Matrix3::from_columns(&[b2.cross(&b3), b2, b3]),
        gyro_bias: random.vector(0.01),
        accelerometer_bias: random.vector(0.1),
        body_rate: random.vector(2.0),
        force: random.vector(5.0) + Vector3::new(0.0, 0.0, -9.81),
        acceleration: Vector3::zeros(),
    }
}

fn moved(state: &Strapdown<f64>, component: usize, by: f64) -> Strapdown<f64> {
    let mut error = [0.0; ERRORS];
    error[component] = by;
    let mut moved = *state;
    moved.inject(&error);
    moved
}

fn acceleration(state: &Strapdown<f64>) -> Vector3<f64> {
    state.attitude * state.force + Vector3::new(0.0, 0.0, 9.81)
}

/// Differences of fourth order over ±1e-3 and ±2e-3: truncation of some 1e-12 (an injection turns
/// exactly to second order, straightened to third), rounding of 1e-15 over 1e-3.
const STEP: f64 = 1e-3;
const BAR: f64 = 1e-8;

fn derivative(f: impl Fn(f64) -> Vector3<f64>) -> Vector3<f64> {
    (f(-2.0 * STEP) - f(2.0 * STEP) + (f(STEP) - f(-STEP)) * 8.0) / (12.0 * STEP)
}

/// What a kind of measurement says of a state, for a point at `lever` (or moving by it) `age` ago.
fn measured(
    kind: Kind,
    state: &Strapdown<f64>,
    about: &Strapdown<f64>,
    lever: &Vector3<f64>,
    age: f64,
) -> Vector3<f64> {
    let only = |x: f64| Vector3::new(x, 0.0, 0.0);
    let (a, reach) = (acceleration(state), state.attitude * lever);
    match kind {
        Kind::Position => state.position - state.velocity * age + a * (0.5 * age * age) + reach,
        Kind::Velocity => state.velocity - a * age + reach,
        Kind::Height => only(-state.position.z),
        Kind::Heading => only(state.attitude.m21.atan2(state.attitude.m11)),
        Kind::Attitude => {
            let turn = state.attitude * about.attitude.transpose();
            // The sine's vector: to first order the angle's, and odd, so that its even orders
            // vanish.
            Vector3::new(turn.m32 - turn.m23, turn.m13 - turn.m31, turn.m21 - turn.m12) * 0.5
        }
    }
}

#[test]
fn jacobians_equal_central_differences() {
    let mut random = Random(17);
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let state = draw(&mut random);
        let (lever, age) = (random.vector(0.5), 0.15 + 0.15 * random.next());
        for kind in Kind::ALL {
            let mut waiting = Waiting::none();
            let clock = Clock::every(0.002);
            waiting.add(&Vector3::zeros(), [1.0; 2], age, &lever, &clock);
            for axis in 0..kind.scalars() {
                let h = waiting.scalar(kind, axis, &state, &clock).h;
                for component in 0..ERRORS {
                    let difference =
                        derivative(|by| measured(kind, &moved(&state, component, by), &state, &lever, age));
                    worst = worst.max((h[component] - difference[axis]).abs());
                }
            }
        }
        // (10): Φ − 1 of one second is F.
        let f = flow(&state, 1.0);
        for component in 0..ERRORS {
            let pull = derivative(|by| acceleration(&moved(&state, component, by)));
            // Ṙ Rᵀ of the true state less that of the nominal one turned by the error.
            let turn = derivative(|by| {
                let state_moved = moved(&state, component, by);
                state_moved.attitude * (state_moved.body_rate - state.body_rate)
            });
            for axis in 0..3 {
                worst = worst.max((f[index::VELOCITY + axis][component] - pull[axis]).abs());
                worst = worst.max((f[index::ATTITUDE + axis][component] - turn[axis]).abs());
            }
        }
    }
    assert!(worst < BAR, "{worst:e}");
}

/// F Δt of (10), read off a covariance: with P = 1, two moves give Φ Φᵀ + Q, whose part beside the
/// diagonal blocks is linear in F where Φ is triangular.
fn flow(state: &Strapdown<f64>, step: f64) -> [[f64; ERRORS]; ERRORS] {
    let mut f = [[0.0; ERRORS]; ERRORS];
    let spread = Spread::new(&quiet(), step);
    for component in 0..ERRORS {
        // P = e eᵀ: the column of Φ is the column of Φ P Φᵀ over its entry at e, which stays 1.
        let mut deviations = [0.0; ERRORS];
        deviations[component] = 1.0;
        let mut covariance: Covariance<f64> = Covariance::diagonal(&deviations);
        let force = state.attitude * state.force;
        spread.move_with_attitude(&mut covariance, &force);
        spread.move_with_biases(&mut covariance, &state.attitude, &Vector3::zeros());
        for i in 0..ERRORS {
            f[i][component] = (covariance.get(i, component) - if i == component { 1.0 } else { 0.0 }) / step;
        }
    }
    f
}

/// No noise to speak of: squares of 1e-6.
fn quiet() -> NavigationNoise<f64> {
    NavigationNoise {
        accelerometer: 0.0,
        gyro: 0.0,
        gyro_walk: 0.0,
        accelerometer_walk: 0.0,
        ..NavigationNoise::default()
    }
}

#[test]
fn the_covariance_moves_as_a_dense_product_has_it() {
    let mut random = Random(19);
    for _ in 0..100 {
        let state = draw(&mut random);
        let step = 0.03;
        let noise = NavigationNoise::<f64>::default();
        // Φ, column by column, from unit vectors: those are held to differences above.
        let f = flow(&state, step);
        let factor: [[f64; ERRORS]; ERRORS] = [(); ERRORS].map(|()| [(); ERRORS].map(|()| random.next()));
        let mut p = [[0.0; ERRORS]; ERRORS];
        let mut covariance: Covariance<f64> = Covariance::diagonal(&[0.0; ERRORS]);
        for i in 0..ERRORS {
            for j in 0..=i {
                p[i][j] = (0..ERRORS).map(|k| factor[i][k] * factor[j][k]).sum();
                p[j][i] = p[i][j];
                covariance.0[at(i, j)] = p[i][j];
            }
        }
        let force = state.attitude * state.force;
        let spread = Spread::new(&noise, step);
        spread.move_with_attitude(&mut covariance, &force);
        spread.move_with_biases(&mut covariance, &state.attitude, &Vector3::zeros());
        let phi = |i: usize, k: usize| f[i][k] * step + if i == k { 1.0 } else { 0.0 };
        for i in 0..ERRORS {
            for j in 0..=i {
                let added = match i {
                    3..6 => noise.accelerometer,
                    6..9 => noise.gyro,
                    // Biases whose variance is beyond the start's don't walk.
                    _ => 0.0,
                };
                let dense: f64 = (0..ERRORS)
                    .flat_map(|k| (0..ERRORS).map(move |l| (k, l)))
                    .map(|(k, l)| phi(i, k) * p[k][l] * phi(j, l))
                    .sum::<f64>()
                    + if i == j { added * added * step } else { 0.0 };
                // Sums of 225 products of numbers up to some 10.
                assert!((covariance.get(i, j) - dense).abs() < 1e-11, "{i} {j}: {} {dense}", covariance.get(i, j));
            }
        }
    }
}
