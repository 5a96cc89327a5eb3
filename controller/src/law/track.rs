//! The trajectory-tracking law of Section V, the baseline: y = (p, ψ) follows a reference in time.
//!
//! The same lift and lower with p⁽⁶⁾ = p_ref⁽⁶⁾ − Σ kⱼ (p − p_ref)⁽ʲ⁾. Relative degrees are {6, 6, 6, 2}.

use model::{Command, Disturbance, Real, Series, State, Vehicle, Yaw};
use nalgebra::Vector3;

use crate::flight::envelope::Margins;
use crate::law::follow::{SetupError, Solution, dot};
use crate::law::gains::{self, GainError};
use crate::law::lift::{PositionSeries, lift};
use crate::law::lower::lower;
use crate::sampled::actuator::ActuatorLimits;
use crate::sampled::observer::ObserverParams;
use crate::sampled::sampler::{Ahead, Sampler, Sampling};

/// Gains of the tracking law, low order first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackGains<T> {
    /// Of the errors of p1, p2, p3 and their derivatives to order 5.
    pub position: [[T; 6]; 3],
    /// Of the errors of ψ, ψ̇.
    pub yaw: [T; 2],
}

impl<T: Real> TrackGains<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> TrackGains<U> {
        TrackGains { position: self.position.map(|row| row.map(T::cast)), yaw: self.yaw.map(T::cast) }
    }

    /// `Ok` if every closed loop is stable.
    pub fn check(&self) -> Result<(), GainError<T>> {
        for (output, k) in (1..).zip(&self.position) {
            gains::check::<_, 6, 7>(output, k, T::zero())?;
        }
        gains::check::<_, 2, 3>(4, &self.yaw, T::zero())
    }
}

/// A reference for the payload and the yaw, as Taylor series in time about now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference<T> {
    /// p_ref in N, m, orders 0 to 6.
    pub position: PositionSeries<T>,
    /// ψ_ref, rad, orders 0 to 2.
    pub yaw: Series<T, 3>,
}

impl<T: Real> Reference<T> {
    /// Section V's circle, y_ref = (r sin a, r cos a, p3, 0) at phase a (rad) with ȧ = `rate`, rad/s.
    pub fn circle(radius: T, p3: T, rate: T, phase: T) -> Self {
        let (sin, cos) = phase.sin_cos();
        let rate_2 = rate * rate;
        let (rate_3, rate_4) = (rate_2 * rate, rate_2 * rate_2);
        // The derivatives of (sin, cos) go round: each is the rate times the one a quarter turn on.
        let powers = [T::one(), rate, -rate_2, -rate_3, rate_4, rate_4 * rate, -(rate_3 * rate_3)];
        let wave = |even: T, odd: T| {
            let [p0, p1, p2, p3, p4, p5, p6] = powers;
            let [even, odd] = [radius * even, radius * odd];
            Series::from_derivatives([p0 * even, p1 * odd, p2 * even, p3 * odd, p4 * even, p5 * odd, p6 * even])
        };
        Self { position: [wave(sin, cos), wave(cos, -sin), Series::constant(p3)], yaw: Series::constant(T::zero()) }
    }

    /// The same reference about the instant `dt` later, by its truncated series.
    #[inline]
    pub fn shift(&self, dt: T) -> Self {
        Self { position: self.position.map(|p| p.shift(dt)), yaw: self.yaw.shift(dt) }
    }
}

/// The tracked outputs and their derivatives; the reference is not subtracted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackXi<T> {
    /// p to p⁽⁵⁾ in N, a row for each of p1, p2, p3; m/sᵏ.
    pub position: [[T; 6]; 3],
    /// ψ, ψ̇; rad, rad/s.
    pub yaw: [T; 2],
}

/// Evaluates the tracking law at `state`, ζ and a known disturbance as they are.
#[inline(always)]
pub fn law<T: Real>(
    vehicle: &Vehicle<T>,
    gains: &TrackGains<T>,
    reference: &Reference<T>,
    state: &State<T>,
    zeta: &[T; 4],
    disturbance: &Disturbance<T>,
) -> Solution<T, TrackXi<T>> {
    let lift = lift(vehicle, state, zeta, disturbance);
    let yaw = Yaw::of(state);

    let [x, y, z] = &reference.position;
    let [k1, k2, k3] = &gains.position;
    let [p1, p2, p3] = &lift.position;
    let wanted = |k: &[T; 6], p: &Series<T, 7>, reference: &Series<T, 7>| {
        let error = derivatives(&(*p - *reference));
        reference.derivative(6) - dot(k, &error)
    };
    let position_6 = Vector3::new(wanted(k1, p1, x), wanted(k2, p2, y), wanted(k3, p3, z));
    let yaw_error = [(yaw.angle - reference.yaw.value()).wrap_angle(), yaw.rate - reference.yaw.derivative(1)];
    let yaw_2 = reference.yaw.derivative(2) - dot(&gains.yaw, &yaw_error);

    Solution {
        command: Command {
            thrust: lift.thrust(vehicle),
            torque: lower(vehicle, state, &lift, &yaw, &position_6, yaw_2, &disturbance.torque),
        },
        u_zeta: position_6.z,
        xi: TrackXi { position: [p1, p2, p3].map(derivatives), yaw: [yaw.angle, yaw.rate] },
        nu: [position_6.x, position_6.y, position_6.z, yaw_2],
        margins: Margins {
            q3: state.rod.z,
            q_b3: lift.b3_rod,
            lambda: lift.lambda[0],
            kappa: lift.kappa,
            path_det: T::one(),
            reach: T::one(),
            cos_phi_squared: yaw.cos_phi_squared,
        },
    }
}

/// Derivatives 0 to 5.
#[inline]
fn derivatives<T: Real>(p: &Series<T, 7>) -> [T; 6] {
    core::array::from_fn(|k| p.derivative(k))
}

/// The trajectory-tracking controller: the law at a fixed rate.
#[derive(Clone, Debug)]
pub struct Tracker<T> {
    gains: TrackGains<T>,
    sampler: Sampler<T>,
}

impl<T: Real> Tracker<T> {
    /// A controller at hover (ζ = 0), with gains that have been found stable; without limits or observers.
    pub fn new(vehicle: Vehicle<T>, gains: TrackGains<T>, sampling: Sampling<T>) -> Result<Self, SetupError<T>> {
        gains.check()?;
        Ok(Self { gains, sampler: Sampler::new(vehicle, &sampling)? })
    }

    /// With disturbance observers, reset.
    pub fn with_observer(mut self, params: &ObserverParams<T>) -> Result<Self, SetupError<T>> {
        self.sampler.set_observer(params)?;
        Ok(self)
    }

    /// With limits on what is commanded.
    pub fn with_limits(mut self, limits: ActuatorLimits<T>) -> Result<Self, SetupError<T>> {
        self.sampler.set_actuation(limits)?;
        Ok(self)
    }

    /// Starts from a stated ζ with disturbances at zero. Hover is ζ = 0.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) {
        self.sampler.start(state, zeta);
    }

    /// Takes over from whatever applied `applied` until now, without a bump in thrust.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) {
        self.sampler.take_over(state, applied);
    }

    /// The command for the coming hold, from the state sampled now and the reference about now. Call once every period.
    #[inline]
    pub fn step(&mut self, sampled: &State<T>, reference: &Reference<T>) -> Solution<T, TrackXi<T>> {
        let reference = reference.shift(self.sampler.horizon());
        let Ahead { state, zeta } = self.sampler.sample(sampled);
        let (vehicle, disturbance) = (self.sampler.vehicle(), self.sampler.disturbance());
        let mut solution = law(vehicle, &self.gains, &reference, &state, &zeta, disturbance);
        solution.command =
            self.sampler.commit(solution.command, solution.u_zeta, solution.margins.q3 * solution.margins.q_b3);
        solution
    }

    /// ζ when the next command begins to act (the next sample, without latency and lag).
    pub fn zeta(&self) -> &[T; 4] {
        self.sampler.zeta()
    }

    /// The disturbances found up to the last sample.
    pub fn disturbance(&self) -> &Disturbance<T> {
        self.sampler.disturbance()
    }

    /// The vehicle as the law knows it.
    pub fn vehicle(&self) -> &Vehicle<T> {
        self.sampler.vehicle()
    }
}
