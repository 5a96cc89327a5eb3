//! The cable's length by its swing, without a look at the load.
//!
//! The pull on the UAV, m_Q R f + k_T T b3 − F_Q, has the rod's direction q; the pendulum says L q̈
//! = u − (q·u) q with u = F_L/m_L − R f. Twice integrated by parts against a bell φ that vanishes
//! at both ends with its slope, no noise is differentiated:
//!
//! ```text
//! L ∫ φ̈ q_h dt = ∫ φ (u − (q·u) q)_h dt
//! ```

use controller::Vector3;
use std::f64::consts::TAU;

use super::log::Sample;

/// Of a bell, s: about one swing of a cable of 2 m.
const BELL_S: f64 = 3.0;
/// Of φ².
const MEAN_SQUARE: f64 = 35.0 / 128.0;
/// A row counts from so many deviations of its noise on, and so many rows are needed.
const CLEAR: f64 = 10.0;
const FEWEST: usize = 4;

/// L, m, and its deviation. `noise` is N_a, `drag` F_Q and F_L/m_L of a sample. `None` of a log
/// that hardly swings.
pub(super) fn length(
    samples: &[Sample],
    uav_mass: f64,
    thrust_scale: f64,
    noise: f64,
    drag: &dyn Fn(&Sample) -> [Vector3<f64>; 2],
) -> Option<[f64; 2]> {
    // A row for each bell and horizontal axis.
    let mut rows = Vec::new();
    let mut begin = 0;
    while let Some(first) = samples.get(begin) {
        let end = samples.partition_point(|sample| sample.t_s <= first.t_s + BELL_S);
        let bell = &samples[begin..end];
        if end < samples.len() && bell.len() as f64 > 20.0 * BELL_S {
            rows.extend(integrate(bell, uav_mass, thrust_scale, drag));
        }
        // Bells overlap by half.
        let next = samples.partition_point(|sample| sample.t_s <= first.t_s + 0.5 * BELL_S);
        begin = next.max(begin + 1);
        if end >= samples.len() {
            break;
        }
    }
    // What is steady, an error of wind or tilt, is taken out by each axis's median.
    let median = |axis: usize, k: usize| {
        let mut values: Vec<f64> = rows.iter().skip(axis).step_by(2).map(|row| row[k]).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or_default()
    };
    let centre = [0, 1].map(|axis| [0, 1].map(|k| median(axis, k)));
    let centred = rows.iter().enumerate().map(|(i, row)| [0, 1].map(|k| row[k] - centre[i % 2][k]));
    // Only what swings says anything of length: noise in ∫ φ̈ q would make the cable short.
    let least = CLEAR * noise * (MEAN_SQUARE * BELL_S).sqrt();
    let swung: Vec<[f64; 2]> = centred.filter(|[_, c]| c.abs() > least).collect();
    if swung.len() < FEWEST {
        return None;
    }
    let (cc, ac) = swung.iter().fold((0.0, 0.0), |(cc, ac), [a, c]| (cc + c * c, ac + a * c));
    let length = cc / ac;
    let left: f64 = swung.iter().map(|[a, c]| (length * a - c).powi(2)).sum();
    // Half of the rows overlap.
    let deviation = length * (2.0 * left / (swung.len() - 1) as f64 / cc).sqrt();
    Some([length, deviation])
}

/// [∫ φ̈ q, ∫ φ (u − (q·u) q)] of one bell, for both horizontal axes.
fn integrate(
    bell: &[Sample],
    uav_mass: f64,
    thrust_scale: f64,
    drag: &dyn Fn(&Sample) -> [Vector3<f64>; 2],
) -> [[f64; 2]; 2] {
    let (from, span) = (bell[0].t_s, bell[bell.len() - 1].t_s - bell[0].t_s);
    let step = span / (bell.len() - 1) as f64;
    let mut sums = [[0.0; 2]; 2];
    for sample in bell {
        let force = sample.attitude * sample.specific_force;
        let [on_uav, on_load] = drag(sample);
        let b3: Vector3<f64> = sample.attitude.column(2).into();
        let pull = force * uav_mass + b3 * (thrust_scale * sample.thrust) - on_uav;
        let q = pull / pull.dot(&pull).sqrt().max(1e-6);
        // φ = (1 − cos)²/4: it vanishes at the ends to the fourth order.
        let angle = TAU * (sample.t_s - from) / span;
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        let phi = 0.25 * (1.0 - cosine).powi(2);
        let curvature = 0.5 * (TAU / span).powi(2) * (sine * sine + (1.0 - cosine) * cosine);
        let u = on_load - force;
        let swung = u - q * q.dot(&u);
        for (axis, sums) in sums.iter_mut().enumerate() {
            sums[0] += curvature * q[axis] * step;
            sums[1] += phi * swung[axis] * step;
        }
    }
    sums
}
