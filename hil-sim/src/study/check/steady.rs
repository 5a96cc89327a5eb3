//! The vehicle's state and inputs under a payload's motion, by differential flatness: the law's own
//! inverse.
//!
//! With s = p̈ − g e3 = λ q the rod is −s/|s| (the cable pulls, λ < 0); κ b3 = q̈ − c s
//! gives thrust and b3; b3 and ψ give the attitude, ḃ3 and ψ̇ the body rate. The controller's
//! [lift](controller::lift()) and [lower](controller::lower()) then give the margins and the
//! torque.

use super::probe::Motion;
use controller::Yaw;
use controller::lift;
use controller::lower;
use controller::{Analytic, Command, Disturbance, Series, State, Vector3, Vehicle};

/// One instant of a motion of the payload.
#[derive(Clone, Copy, Debug)]
pub struct Steady {
    /// The vehicle's state.
    pub state: State<f64>,
    /// Thrust and torque.
    pub command: Command<f64>,
    /// ζ = (p̈3, …, p3⁽⁵⁾), m/s²⁺ᵏ.
    pub zeta: [f64; 4],
    /// λ, the payload's specific force along the rod, m/s².
    pub lambda: f64,
    /// κ = T/(m_Q L), 1/s².
    pub kappa: f64,
    /// q·b3.
    pub b3_rod: f64,
    /// cos²φ.
    pub cos_phi_squared: f64,
}

impl Steady {
    /// The state and inputs that give the payload `motion` and the UAV the yaw ψ, ψ̇, ψ̈; `None`
    /// where the payload would be in free fall, or the UAV without thrust.
    pub fn of(vehicle: &Vehicle<f64>, motion: &Motion, yaw: &[f64; 3]) -> Option<Self> {
        let params = vehicle.params();
        let coupling = vehicle.total_mass() / (params.uav_mass * params.rod_length);
        let derivatives = derivatives(motion);

        let mut s: [Series<f64, 5>; 3] =
            [0, 1, 2].map(|axis| Series::from_derivatives([2, 3, 4, 5, 6].map(|k| derivatives[k][axis])));
        s[2] = s[2] - params.gravity;
        let rod = unit(s).map(|component| -component);
        let bend: [Series<f64, 3>; 3] = [0, 1, 2].map(|axis| {
            let acceleration: Series<f64, 3> = rod[axis].differentiate::<4>().differentiate();
            acceleration - s[axis].truncate() * coupling
        });
        let b3 = unit(bend);

        let mut state = State::from_paper(&{
            let mut x = [0.0; 16];
            x[5] = (-b3[1].value()).asin();
            x[6] = b3[0].value().atan2(b3[2].value());
            x[7] = yaw[0];
            x
        });
        state.position = derivatives[0];
        state.velocity = derivatives[1];
        state.rod = at(&rod, 0);
        state.rod_rate = at(&rod, 1);
        let b3_dot = at(&b3, 1);
        state.body_rate.x = -state.attitude.column(1).dot(&b3_dot);
        state.body_rate.y = state.attitude.column(0).dot(&b3_dot);
        // Yaw rate is linear in ω3 with factor 1.
        state.body_rate.z = yaw[1] - Yaw::of(&state).rate;

        let zeta = [2, 3, 4, 5].map(|k: usize| derivatives[k].z);
        let still = Disturbance::none();
        let lifted = lift(vehicle, &state, &zeta, &still);
        let now = Yaw::of(&state);
        let torque = lower(vehicle, &state, &lifted, &now, &derivatives[6], yaw[2], &still.torque);
        let steady = Self {
            state,
            command: Command { thrust: lifted.thrust(vehicle), torque },
            zeta,
            lambda: lifted.lambda[0],
            kappa: lifted.kappa,
            b3_rod: lifted.b3_rod,
            cos_phi_squared: now.cos_phi_squared,
        };
        let finite = steady.command.thrust.is_finite()
            && torque.iter().chain(&state.body_rate).chain(&state.rod_rate).all(|value| value.is_finite());
        finite.then_some(steady)
    }

    /// Where the UAV is, N, m.
    #[must_use]
    pub fn uav_position(&self, vehicle: &Vehicle<f64>) -> Vector3<f64> {
        self.state.position - self.state.rod * vehicle.params().rod_length
    }

    /// Angle of the rod from straight down, rad.
    #[must_use]
    pub fn rod_angle(&self) -> f64 {
        self.state.rod.z.clamp(-1.0, 1.0).acos()
    }

    /// Angle of b3 from straight down, rad.
    #[must_use]
    pub fn tilt(&self) -> f64 {
        self.state.attitude.m33.clamp(-1.0, 1.0).acos()
    }
}

/// p, ṗ, p̈, … from Taylor coefficients.
fn derivatives(motion: &Motion) -> Motion {
    let mut derivatives = *motion;
    let mut factorial = 1.0;
    for (k, derivative) in derivatives.iter_mut().enumerate().skip(1) {
        factorial *= k as f64;
        *derivative *= factorial;
    }
    derivatives
}

/// A vector along its direction: v/|v|.
fn unit<const N: usize>(v: [Series<f64, N>; 3]) -> [Series<f64, N>; 3] {
    let per_length = (v[0].square() + v[1].square() + v[2].square()).rsqrt();
    v.map(|component| component * per_length)
}

/// The k-th derivative of a vector.
fn at<const N: usize>(v: &[Series<f64, N>; 3], k: usize) -> Vector3<f64> {
    Vector3::new(v[0].derivative(k), v[1].derivative(k), v[2].derivative(k))
}
