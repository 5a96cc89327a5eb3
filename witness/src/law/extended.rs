//! The extended system (3.8) and the Taylor expansion of its drift.

use crate::jet::{Dual, Scalar, Taylor, dot};
use crate::plant::{self, Input, STATES, VehicleParameters, index};

/// Number of inputs: u_ζ and three torques.
pub const INPUTS: usize = 4;
/// Coefficients kept: the highest relative degree is six.
const COEFFICIENTS: usize = 7;
/// The plant's coordinates and ζ.
const EXTENDED: usize = STATES + 4;

/// A number with its derivatives along the four input fields.
pub type Seeded = Dual<f64, INPUTS>;
/// A function of the extended state, along the drift.
pub type Series = Taylor<Seeded, COEFFICIENTS>;

/// The extended state along the flow of the drift, from one point.
pub struct Expansion {
    /// The plant's coordinates, then ζ.
    pub state: [Series; EXTENDED],
}

impl Expansion {
    /// Expands ẋ = f̄(x), ū = 0, from (x, ζ): each pass through f̄ makes one more coefficient of ẋ
    /// exact, and so one of x.
    pub fn of(vehicle: &VehicleParameters, x: &[f64; STATES], zeta: &[f64; 4]) -> Self {
        let start: [f64; EXTENDED] = std::array::from_fn(|i| if i < STATES { x[i] } else { zeta[i - STATES] });
        let mut seeded = start.map(Seeded::constant);
        for (input, field) in input_fields(vehicle).iter().enumerate() {
            for (coordinate, &along) in seeded.iter_mut().zip(field) {
                coordinate.parts[input] = along;
            }
        }
        let mut state = seeded.map(Series::at);
        for order in 1..COEFFICIENTS {
            let rate = drift(vehicle, &state);
            for (coordinate, rate) in state.iter_mut().zip(rate) {
                coordinate.c[order] = rate.c[order - 1] / order as f64;
            }
        }
        Self { state }
    }

    /// Three coordinates in a row.
    pub fn group(&self, first: usize) -> [Series; 3] {
        [self.state[first], self.state[first + 1], self.state[first + 2]]
    }

    /// T of (3.5) at the expansion's point, N.
    pub fn thrust(&self, vehicle: &VehicleParameters) -> f64 {
        let start: [f64; EXTENDED] = std::array::from_fn(|i| self.state[i].value());
        let (x, zeta) = split(&start);
        thrust(vehicle, &x, zeta[0])
    }
}

/// The constant input fields ḡ of (3.8): u_ζ drives ζ4, τ drives ω.
fn input_fields(vehicle: &VehicleParameters) -> [[f64; EXTENDED]; INPUTS] {
    let mut fields = [[0.0; EXTENDED]; INPUTS];
    fields[0][EXTENDED - 1] = 1.0;
    for axis in 0..3 {
        fields[1 + axis][index::BODY_RATE + axis] = 1.0 / vehicle.inertia[axis];
    }
    fields
}

fn split<S: Copy>(state: &[S; EXTENDED]) -> ([S; STATES], [S; 4]) {
    (std::array::from_fn(|i| state[i]), std::array::from_fn(|i| state[STATES + i]))
}

/// f̄ of (3.8): the plant under the thrust (3.5) and no torque, and the compensator's chain (3.4)
/// without its input.
fn drift<S: Scalar>(vehicle: &VehicleParameters, state: &[S; EXTENDED]) -> [S; EXTENDED] {
    let (x, zeta) = split(state);
    let zero = S::constant(0.0);
    let input = Input { thrust: thrust(vehicle, &x, zeta[0]), torque: [zero; 3] };
    let rate = plant::derivative(vehicle, &x, &input);
    let chain = [zeta[1], zeta[2], zeta[3], zero];
    std::array::from_fn(|i| if i < STATES { rate[i] } else { chain[i - STATES] })
}

/// T of (3.5): the thrust under which v̇3 = ζ1.
fn thrust<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES], zeta1: S) -> S {
    // f11 is the vertical acceleration of the payload without thrust.
    let f11 = plant::drift(vehicle, x)[index::VELOCITY + 2];
    let rod = plant::rod(x);
    let b3 = plant::attitude(x)[2];
    (f11 - zeta1) * vehicle.total_mass() / (rod[2] * dot(rod, b3))
}
