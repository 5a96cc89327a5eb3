//! The Jacobians of the filter against central differences of the equations they come from, at
//! random states.

use std::vec::Vec;

use super::params::PayloadParams;
use super::pendulum::{Pendulum, Pivot};
use super::state::{ERRORS, PayloadState, index};
use super::thrust::{Axis, Linearized, Window};
use super::*;
use crate::covariance::at;
use crate::drag::Drag;
use crate::random::Random;
use model::VehicleParams;

struct Drawn {
    params: PayloadParams<f64>,
    state: PayloadState<f64>,
    pivot: Pivot<f64>,
    attitude: Matrix3<f64>,
    velocity: Vector3<f64>,
    force: Vector3<f64>,
    thrust: f64,
}

fn draw(random: &mut Random) -> Drawn {
    let mut params = PayloadParams::of(&VehicleParams::paper(), 0.002);
    params.cable_length = 2.5 + 1.5 * random.next();
    params.uav_drag = Drag { linear: 0.2 + 0.2 * random.next(), quadratic: 0.03 };
    params.payload_drag = Drag { linear: 0.1 + 0.1 * random.next(), quadratic: 0.01 + 0.005 * random.next() };
    let mut state = PayloadState::hanging();
    state.set_rod([0.6 * random.next(), 0.6 * random.next()], [random.next(), random.next()]);
    state.residual = [random.next(), random.next()];
    state.offset = [random.next(), random.next()];
    state.thrust_scale = 1.0 + 0.2 * random.next();
    state.mass_ratio = 0.4 * random.next();
    let velocity = random.vector(2.0);
    // Air so fast that the derivative of drag is the true one: its floor is on purpose no
    // derivative.
    state.wind = [14.0 + 2.0 * random.next(), 2.0 * random.next()];
    let b3 = Vector3::new(0.4 * random.next(), 0.4 * random.next(), 1.0);
    let b3 = b3 / b3.dot(&b3).sqrt();
    let right = b3.cross(&random.vector(1.0));
    let b2 = right / right.dot(&right).sqrt();
    Drawn {
        params,
        state,
        pivot: Pivot {
            velocity: velocity + random.vector(0.1),
            specific_force: Vector3::new(0.0, 0.0, -9.81) + random.vector(3.0),
        },
        attitude: Matrix3::from_columns(&[b2.cross(&b3), b2, b3]),
        velocity,
        force: random.vector(3.0),
        thrust: 30.0 + 5.0 * random.next(),
    }
}

impl Drawn {
    fn moved(&self, component: usize, by: f64) -> PayloadState<f64> {
        let mut error = [0.0; ERRORS];
        error[component] = by;
        let mut state = self.state;
        state.inject(&error);
        state
    }

    /// q̈_h.
    fn acceleration(&self, state: &PayloadState<f64>) -> [f64; 2] {
        let pendulum = Pendulum::new(&self.params, state);
        let pull = pendulum.pull(&self.params, &self.pivot, &state.rod, &state.rod_rate);
        [pull.acceleration.x, pull.acceleration.y]
    }

    /// f − l − model of (3).
    fn residual(&self, state: &PayloadState<f64>) -> Vector3<f64> {
        let pendulum = Pendulum::new(&self.params, state);
        let pull = pendulum.pull(&self.params, &self.pivot, &state.rod, &state.rod_rate);
        let mut window = Window::empty();
        window.add(&self.params, state, (&pendulum, &pull), &self.attitude, &self.velocity, &self.force, self.thrust);
        window.mean(1.0).residual
    }
}

/// Differences of fourth order over ±1e-4 and ±2e-4: truncation of some 1e-12, rounding of 1e-15
/// over 1e-4.
const STEP: f64 = 1e-4;
const BAR: f64 = 1e-8;

/// The derivative of `f` at 0.
fn derivative<const N: usize>(f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let [a, b, c, d] = [f(-2.0 * STEP), f(-STEP), f(STEP), f(2.0 * STEP)];
    core::array::from_fn(|i| (a[i] - d[i] + 8.0 * (c[i] - b[i])) / (12.0 * STEP))
}

#[test]
fn jacobians_equal_central_differences() {
    let mut random = Random(7);
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let drawn = draw(&mut random);
        let pendulum = Pendulum::new(&drawn.params, &drawn.state);
        let rows = pendulum
            .sensitivity(&drawn.params, &drawn.pivot, &drawn.state)
            .acceleration(&drawn.params, &drawn.state.rod);
        let mean = Mean { residual: Vector3::zeros(), thrust: drawn.thrust, is_full: true };
        let about = Linearized::about(&drawn.params, &drawn.state, &pendulum, &drawn.pivot, &drawn.velocity);
        let h = [Axis::First, Axis::Second, Axis::Thrust].map(|axis| {
            let body = drawn.attitude.column(axis as usize).into();
            about.scalar(&drawn.params, axis, &body, &mean, 0.04, false).0.h
        });
        for component in 0..ERRORS {
            let swing = derivative(|by| drawn.acceleration(&drawn.moved(component, by)));
            let residual = derivative(|by| drawn.residual(&drawn.moved(component, by)).into());
            let entry = match component {
                0..8 => Some(component),
                index::MASS => Some(8),
                _ => None,
            };
            for axis in 0..2 {
                let analytic = entry.map_or(0.0, |entry| rows[axis][entry]);
                worst = worst.max((analytic - swing[axis]).abs());
            }
            for axis in 0..3 {
                worst = worst.max((h[axis][component] + residual[axis]).abs());
            }
        }
    }
    assert!(worst < BAR, "{worst:e}");
}

#[test]
fn the_covariance_moves_as_a_dense_product_has_it() {
    let mut random = Random(11);
    for _ in 0..100 {
        let drawn = draw(&mut random);
        let step = 0.02;
        let spread = Spread::new(&drawn.params, step);
        let rows = Pendulum::new(&drawn.params, &drawn.state)
            .sensitivity(&drawn.params, &drawn.pivot, &drawn.state)
            .acceleration(&drawn.params, &drawn.state.rod);
        let factor: Vec<[f64; ERRORS]> = (0..ERRORS).map(|_| [(); ERRORS].map(|()| random.next())).collect();
        let mut p = [[0.0; ERRORS]; ERRORS];
        let mut phi = p;
        let mut q = p;
        for i in 0..ERRORS {
            for j in 0..ERRORS {
                p[i][j] = (0..ERRORS).map(|k| factor[i][k] * factor[j][k]).sum();
            }
            phi[i][i] = 1.0;
        }
        let noise = &drawn.params.noise;
        for k in 4..8 {
            let (deviation, time) =
                if k < 6 { (noise.wind, noise.wind_time) } else { (noise.residual, noise.residual_time) };
            phi[k][k] = 1.0 - step / time;
            q[k][k] = deviation * deviation * (1.0 - phi[k][k] * phi[k][k]);
        }
        for a in 0..2 {
            for (entry, column) in [0, 1, 2, 3, 4, 5, 6, 7, 11].into_iter().enumerate() {
                phi[2 + a][column] += rows[a][entry] * step;
            }
            // The rod by the new rate.
            for column in 0..ERRORS {
                phi[a][column] += step * phi[2 + a][column];
            }
            // Walks go no further than the start's deviation.
            let most = [noise.offset, [noise.thrust, noise.mass][a]].map(|deviation: f64| deviation.powi(2));
            for (k, walk, most) in [(8 + a, noise.offset_walk, most[0]), (10 + a, noise.scale_walk, most[1])] {
                q[k][k] = if p[k][k] < most { walk.powi(2) * step } else { 0.0 };
            }
            let rod = [drawn.state.rod.x, drawn.state.rod.y];
            for b in 0..2 {
                let same = if a == b { 1.0 } else { 0.0 };
                let pivot = (noise.accelerometer / drawn.params.cable_length).powi(2);
                q[2 + a][2 + b] = (noise.rod.powi(2) * same + pivot * (same - rod[a] * rod[b])) * step;
            }
        }
        let mut moved = Covariance::diagonal(&[0.0; ERRORS]);
        for i in 0..ERRORS {
            for j in 0..=i {
                moved.0[at(i, j)] = p[i][j];
            }
        }
        spread.advance(&mut moved, &rows, &drawn.state.rod);
        for i in 0..ERRORS {
            for j in 0..ERRORS {
                let dense: f64 = (0..ERRORS)
                    .flat_map(|k| (0..ERRORS).map(move |l| (k, l)))
                    .map(|(k, l)| phi[i][k] * p[k][l] * phi[j][l])
                    .sum::<f64>()
                    + q[i][j];
                // Sums of 144 products of numbers up to some 10.
                assert!((moved.get(i, j) - dense).abs() < 1e-12, "{i} {j}: {} {dense}", moved.get(i, j));
            }
        }
    }
}
