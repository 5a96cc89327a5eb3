//! Lift and lower against the flow they speak of: every derivative the lift states is the rate of
//! the one before it, and the torque that lower gives makes the sixth what was asked for. With
//! disturbances that grow.

use controller::Disturbance;
use controller::Yaw;
use controller::dynamics::Model;
use controller::lower;
use controller::propagate;
use controller::{Command, Matrix3, State, Vector3, Vehicle, VehicleParams};
use controller::{Lift, lift};
use proptest::prelude::*;

/// Half the central difference's step, s. Its square times the third derivative of the fifth, some
/// 3e6 m/s^8 here, and rounding of the fifth, up to 1e3 m/s^5, over the step are both below 1e-6.
const STEP_S: f64 = 1e-6;
/// Of the larger of 1 and the sixth derivative asked for: 30 times the worst of 300,000 cases.
const BOUND: f64 = 1e-5;

fn vector(half: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-half..half, -half..half, -half..half].prop_map(Vector3::from)
}

fn disturbance() -> impl Strategy<Value = Disturbance<f64>> {
    (vector(3.0), vector(2.0), vector(0.2), vector(3.0), vector(2.0)).prop_map(
        |(payload, rod, torque, payload_rate, rod_rate)| Disturbance { payload, rod, torque, payload_rate, rod_rate },
    )
}

/// exp(v^) to second order.
fn turn(v: Vector3<f64>) -> Matrix3<f64> {
    let skew = Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0);
    Matrix3::identity() + skew + skew * skew * 0.5
}

/// All that moves.
#[derive(Clone, Copy)]
struct Moment {
    state: State<f64>,
    zeta: [f64; 4],
    disturbance: Disturbance<f64>,
}

impl Moment {
    /// `dt` later, to second order, as the lift says.
    fn moved(&self, lift: &Lift<f64>, omega_dot: &Vector3<f64>, u_zeta: f64, dt: f64) -> Self {
        let (state, half) = (&self.state, 0.5 * dt * dt);
        let (acceleration, jerk) = (lift.derivative(2), lift.derivative(3));
        let mut disturbance = self.disturbance;
        disturbance.payload += disturbance.payload_rate * dt;
        disturbance.rod += disturbance.rod_rate * dt;
        Self {
            state: State {
                position: state.position + state.velocity * dt + acceleration * half,
                velocity: state.velocity + acceleration * dt + jerk * half,
                rod: state.rod + state.rod_rate * dt + lift.rod_2 * half,
                rod_rate: state.rod_rate + lift.rod_2 * dt + lift.rod_3 * half,
                attitude: state.attitude * turn(state.body_rate * dt + omega_dot * half),
                body_rate: state.body_rate + omega_dot * dt,
            },
            zeta: propagate(&self.zeta, u_zeta, dt),
            disturbance,
        }
    }
}

proptest! {
    #[test]
    fn every_derivative_is_the_rate_of_the_one_before(
        angles in [-0.5..0.5, -0.5..0.5, -0.4..0.4, -0.4..0.4, -3.0..3.0],
        rates in [-0.6..0.6, -0.6..0.6, -0.8..0.8, -0.8..0.8, -0.8..0.8],
        velocity in vector(2.0),
        zeta in [-2.0..2.0, -2.0..2.0, -2.0..2.0, -2.0..2.0],
        disturbance in disturbance(),
        position_6 in vector(30.0),
        yaw_2 in -3.0..3.0,
    ) {
        let vehicle = Vehicle::new(VehicleParams::<f64>::paper()).expect("Table I");
        let ([alpha, beta, phi, theta, psi], [alpha_dot, beta_dot, o1, o2, o3]) = (angles, rates);
        let [v1, v2, v3] = velocity.into();
        let state = State::from_paper(&[
            1.0, 2.0, -3.0, alpha, beta, phi, theta, psi, v1, v2, v3, alpha_dot, beta_dot, o1, o2, o3,
        ]);
        let mut disturbance = disturbance;
        // As the model has it.
        disturbance.rod -= state.rod * state.rod.dot(&disturbance.rod);
        let now = Moment { state, zeta, disturbance };
        let lifted = |moment: &Moment| lift(&vehicle, &moment.state, &moment.zeta, &moment.disturbance);
        let here = lifted(&now);
        let torque =
            lower(&vehicle, &state, &here, &Yaw::of(&state), &position_6, yaw_2, &disturbance.torque);
        let command = Command { thrust: here.thrust(&vehicle), torque };
        let model = Model::at(&vehicle, &state).acceleration(&command, &disturbance);

        let size = position_6.amax().max(1.0);
        let apart = |a: &Vector3<f64>, b: &Vector3<f64>| (a - b).amax() / size;
        prop_assert!(apart(&model.payload, &here.derivative(2)) < 1e-12);
        prop_assert!(apart(&model.rod, &here.rod_2) < 1e-12);

        let [before, after] =
            [-STEP_S, STEP_S].map(|dt| now.moved(&here, &model.body, position_6.z, dt));
        let (earlier, later) = (lifted(&before), lifted(&after));
        let rate = |a: &Vector3<f64>, b: &Vector3<f64>| (b - a) * (0.5 / STEP_S);
        for order in 2..5 {
            let found = rate(&earlier.derivative(order), &later.derivative(order));
            prop_assert!(apart(&found, &here.derivative(order + 1)) < BOUND, "order {order}: {found}");
        }
        prop_assert!(apart(&rate(&earlier.rod_2, &later.rod_2), &here.rod_3) < BOUND);
        prop_assert!(((later.kappa - earlier.kappa) * (0.5 / STEP_S) - here.kappa_dot).abs() / size < BOUND);
        prop_assert!(apart(&rate(&earlier.derivative(5), &later.derivative(5)), &position_6) < BOUND);
        let yaw_rate = |moment: &Moment| Yaw::of(&moment.state).rate;
        prop_assert!(((yaw_rate(&after) - yaw_rate(&before)) * (0.5 / STEP_S) - yaw_2).abs() / size < BOUND);
    }
}
