//! Drag, thrust scale, wind and tilt of the thrust's axis, by least squares.
//!
//! With means over blocks of a fifth of a second, and what the load weighs known,
//!
//! ```text
//! UAV:   m_Q R f = −k_T T b3 + m_L (g e3 − v̇) + F_L + F_Q + m_Q R l
//! load:  (1 − q qᵀ) (m_L (v̇ − g e3) − F_L) = 0
//! F_Q = (c₁ + c₂ |ρ|) ρ,  ρ = w − v_Q,     F_L = c_L |ρ_L| ρ_L,  ρ_L = w − v
//! ```
//!
//! Unknown are k_T, c₁, c₂, c_L, the steady horizontal wind w, and l = (l₁, l₂, 0).

use controller::Vector3;
use nalgebra::{DMatrix, DVector};

use super::log::Sample;

/// Unknowns, in order.
pub(super) const UNKNOWNS: usize = 8;
/// Of a block, s.
const BLOCK_S: f64 = 0.2;
/// Steps of Gauss and Newton: from rest each more than doubles the digits.
const STEPS: usize = 20;

/// What a block of samples is in the mean.
pub(super) struct Block {
    /// R f, T b3, b1 and b2 in N.
    force: Vector3<f64>,
    thrust: Vector3<f64>,
    axes: [Vector3<f64>; 2],
    uav_velocity: Vector3<f64>,
    velocity: Vector3<f64>,
    /// v̇ − g e3 of the load.
    load_force: Vector3<f64>,
    rod: Vector3<f64>,
}

/// Cuts a log into blocks; a gap in it ends one.
pub(super) fn blocks(samples: &[Sample], gravity: f64) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut begin = 0;
    while begin < samples.len() {
        let end = begin + samples[begin..].partition_point(|sample| sample.t_s < samples[begin].t_s + BLOCK_S - 1e-9);
        if let (Some(after), true) = (samples.get(end), end - begin >= 4) {
            let block = &samples[begin..end];
            let span = after.t_s - block[0].t_s;
            let mean = |of: &dyn Fn(&Sample) -> Vector3<f64>| {
                block.iter().map(of).fold(Vector3::zeros(), |sum, x| sum + x) / block.len() as f64
            };
            let axis = |s: &Sample, i: usize| -> Vector3<f64> { s.attitude.column(i).into() };
            let rod = mean(&|s| s.position - s.uav_position);
            let mut load_force = (after.velocity - block[0].velocity) / span;
            load_force.z -= gravity;
            if span < 2.0 * BLOCK_S {
                blocks.push(Block {
                    force: mean(&|s| s.attitude * s.specific_force),
                    thrust: mean(&|s| axis(s, 2) * s.thrust),
                    axes: [mean(&|s| axis(s, 0)), mean(&|s| axis(s, 1))],
                    uav_velocity: mean(&|s| s.uav_velocity),
                    velocity: mean(&|s| s.velocity),
                    load_force,
                    rod: rod / rod.dot(&rod).sqrt().max(1e-6),
                });
            }
        }
        begin = end.max(begin + 1);
    }
    blocks
}

/// Of the unknowns: values, and standard deviations.
pub(super) struct Fitted {
    pub(super) values: [f64; UNKNOWNS],
    pub(super) deviations: [f64; UNKNOWNS],
}

/// F_Q and F_L.
fn drags(block: &Block, x: &[f64]) -> [Vector3<f64>; 2] {
    let wind = Vector3::new(x[4], x[5], 0.0);
    let (uav, load) = (wind - block.uav_velocity, wind - block.velocity);
    [uav * (x[1] + x[2] * uav.dot(&uav).sqrt()), load * (x[3] * load.dot(&load).sqrt())]
}

/// Six residuals a block, N.
fn residuals(blocks: &[Block], x: &[f64], [uav_mass, load_mass]: [f64; 2]) -> DVector<f64> {
    let mut all = Vec::with_capacity(6 * blocks.len());
    for block in blocks {
        let [on_uav, on_load] = drags(block, x);
        let tilt = block.axes[0] * x[6] + block.axes[1] * x[7];
        let uav =
            (block.force - tilt) * uav_mass + block.thrust * x[0] + block.load_force * load_mass - on_load - on_uav;
        let pull = block.load_force * load_mass - on_load;
        let load = pull - block.rod * block.rod.dot(&pull);
        all.extend(uav.iter().chain(&load));
    }
    DVector::from_vec(all)
}

/// Least squares, each of the two equations by its own scatter; `None` of a log that leaves the
/// sums singular.
pub(super) fn fit(blocks: &[Block], masses: [f64; 2]) -> Option<Fitted> {
    // Drag in the middle of what vehicles have: from none at all the wind has no slope.
    let mut x = [1.0, 0.05, 0.02, 0.005, 0.0, 0.0, 0.0, 0.0];
    let mut weights = [1.0; 2];
    let mut deviations = [f64::INFINITY; UNKNOWNS];
    for step in 0..STEPS {
        let base = residuals(blocks, &x, masses);
        if step > 1 {
            weights = [0, 1].map(|part| 1.0 / scatter(&base, part).max(1e-9));
        }
        let weight = |row: usize| weights[(row % 6) / 3];
        let mut jacobian = DMatrix::zeros(base.len(), UNKNOWNS);
        for k in 0..UNKNOWNS {
            let by = 1e-6;
            let mut other = x;
            other[k] += by;
            let moved = (residuals(blocks, &other, masses) - &base) / by;
            for row in 0..base.len() {
                jacobian[(row, k)] = moved[row] * weight(row);
            }
        }
        let weighted = DVector::from_fn(base.len(), |row, _| base[row] * weight(row));
        let inverse = (jacobian.transpose() * &jacobian).try_inverse()?;
        let change = &inverse * (jacobian.transpose() * &weighted);
        for (x, change) in x.iter_mut().zip(change.iter()) {
            *x -= change.clamp(-2.0, 2.0);
        }
        let (left, inflation) = (scatter_of(&weighted), inflation(&weighted));
        deviations = core::array::from_fn(|k| inverse[(k, k)].max(0.0).sqrt() * left * inflation);
    }
    x.iter().all(|x| x.is_finite()).then_some(Fitted { values: x, deviations })
}

/// Root mean square of the UAV's (0) or the load's (1) residuals.
fn scatter(residuals: &DVector<f64>, part: usize) -> f64 {
    let mine = residuals.iter().enumerate().filter(|(row, _)| (row % 6) / 3 == part);
    let (sum, count) = mine.fold((0.0, 0), |(sum, count), (_, r)| (sum + r * r, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

fn scatter_of(residuals: &DVector<f64>) -> f64 {
    (residuals.dot(residuals) / residuals.len().max(1) as f64).sqrt()
}

/// Neighbouring blocks share gusts: by how much deviations grow for it, √((1 + r)/(1 − r)) with the
/// correlation r from one block to the next.
fn inflation(residuals: &DVector<f64>) -> f64 {
    let shifted: f64 = residuals.iter().zip(residuals.iter().skip(6)).map(|(a, b)| a * b).sum();
    let r = (shifted / residuals.dot(residuals).max(1e-30)).clamp(0.0, 0.99);
    ((1.0 + r) / (1.0 - r)).sqrt()
}
