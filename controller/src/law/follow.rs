//! The path-following law (11), (13), with the paper's integral action (15).
//!
//! State, ζ → [lift](mod@crate::law::lift) → outputs along the [path](crate::path) → ν → one 3×3 system → [lower](mod@crate::law::lower) →
//! u_ζ, τ. Relative degrees are {6, 6, 5, 2}: ξ has 19 numbers.

use model::{Command, Disturbance, OutOfRange, Real, State, Vehicle, Yaw};

use crate::flight::approach::{Approach, ApproachLimits, Pace};
use crate::flight::envelope::Margins;
use crate::law::gains::{self, GainError};
use crate::law::lift::{Lift, lift};
use crate::law::lower::lower;
use crate::path::{Outputs, Path};
use crate::sampled::actuator::{Actuation, ActuatorLimits};
use crate::sampled::observer::ObserverParams;
use crate::sampled::sampler::{Ahead, Sampler, Sampling};

/// The gains of (13) and (15), low order first: ν = −K ξ − (K̃ ξ̃, 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains<T> {
    /// Of h1, ḣ1, …, h1⁽⁵⁾.
    pub k1: [T; 6],
    /// Of h2, ḣ2, …, h2⁽⁵⁾.
    pub k2: [T; 6],
    /// Of h3, …, h3⁽⁴⁾.
    pub k3: [T; 5],
    /// Of h4, ḣ4.
    pub k4: [T; 2],
    /// Of ∫h1, ∫h2, ∫h3; zeros switch integral action off.
    pub integral: [T; 3],
}

impl<T: Real> Gains<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Gains<U> {
        Gains {
            k1: self.k1.map(T::cast),
            k2: self.k2.map(T::cast),
            k3: self.k3.map(T::cast),
            k4: self.k4.map(T::cast),
            integral: self.integral.map(T::cast),
        }
    }

    /// `Ok` if every closed loop is stable, integral action included.
    pub fn check(&self) -> Result<(), GainError<T>> {
        gains::check::<_, 6, 7>(1, &self.k1, self.integral[0])?;
        gains::check::<_, 6, 7>(2, &self.k2, self.integral[1])?;
        gains::check::<_, 5, 6>(3, &self.k3, self.integral[2])?;
        gains::check::<_, 2, 3>(4, &self.k4, T::zero())
    }
}

/// The outputs and their derivatives (the normal form's coordinates), 19 numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Xi<T> {
    /// h1, …, h1⁽⁵⁾.
    pub h1: [T; 6],
    /// h2, …, h2⁽⁵⁾.
    pub h2: [T; 6],
    /// h3 = ρ·v − v_d, …, h3⁽⁴⁾, m/s¹⁺ᵏ.
    pub h3: [T; 5],
    /// h4 = ψ − ψ_d in (−π, π], and ḣ4; rad, rad/s.
    pub h4: [T; 2],
}

/// What a law answers: the command, and the numbers it came from as telemetry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution<T, X> {
    /// Thrust (9) and torque (11).
    pub command: Command<T>,
    /// The compensator's input, m/s⁶.
    pub u_zeta: T,
    /// Outputs and derivatives.
    pub xi: X,
    /// ν of (13), the wanted highest derivatives of the outputs.
    pub nu: [T; 4],
    /// Distances from the singularities.
    pub margins: Margins<T>,
}

/// Evaluates the law at `state`, ζ, the integrals ξ̃ = ∫(h1, h2, h3) and a known disturbance as they are, without looking ahead.
pub fn law<T: Real, P: Path<T> + ?Sized>(
    vehicle: &Vehicle<T>,
    path: &mut P,
    gains: &Gains<T>,
    state: &State<T>,
    zeta: &[T; 4],
    integral: &[T; 3],
    disturbance: &Disturbance<T>,
) -> Solution<T, Xi<T>> {
    let lift = lift(vehicle, state, zeta, disturbance);
    let outputs = path.outputs(&lift.position);
    let yaw = Yaw::of(state);
    let mut solution = Solution::default();
    solution.read(gains, integral, &yaw, &outputs);
    solution.answer(vehicle, state, disturbance, &lift, &yaw, &outputs);
    solution
}

impl<T: Real, X: Default> Default for Solution<T, X> {
    /// All zeros.
    fn default() -> Self {
        let (u_zeta, nu) = (T::zero(), [T::zero(); 4]);
        Self { command: Command::zero(), u_zeta, xi: X::default(), nu, margins: Margins::default() }
    }
}

impl<T: Real, X> Solution<T, X> {
    /// Neither command nor u_ζ is infinite or NaN.
    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        let Command { thrust, torque } = &self.command;
        (*thrust + torque.x + torque.y + torque.z + self.u_zeta).is_finite()
    }
}

impl<T: Real> Solution<T, Xi<T>> {
    /// ξ and ν, from the path's outputs. Here and below each number is written where it stays, so that none is copied.
    #[inline(always)]
    fn read(&mut self, gains: &Gains<T>, integral: &[T; 3], yaw: &Yaw<T>, outputs: &Outputs<T>) {
        let [s1, s2] = &outputs.surfaces;
        let s3 = &outputs.speed_error;
        self.xi.h1 = core::array::from_fn(|k| s1.derivative(k));
        self.xi.h2 = core::array::from_fn(|k| s2.derivative(k));
        self.xi.h3 = core::array::from_fn(|k| s3.derivative(k));
        self.xi.h4 = [(yaw.angle - outputs.yaw.value()).wrap_angle(), yaw.rate - outputs.yaw.derivative(1)];
        let xi = &self.xi;
        self.nu = [
            -(dot(&gains.k1, &xi.h1) + gains.integral[0] * integral[0]),
            -(dot(&gains.k2, &xi.h2) + gains.integral[1] * integral[1]),
            -(dot(&gains.k3, &xi.h3) + gains.integral[2] * integral[2]),
            -dot(&gains.k4, &xi.h4),
        ];
    }

    /// The command and u_ζ that give ν, and the margins.
    #[inline(always)]
    fn answer(
        &mut self,
        vehicle: &Vehicle<T>,
        state: &State<T>,
        disturbance: &Disturbance<T>,
        lift: &Lift<T>,
        yaw: &Yaw<T>,
        outputs: &Outputs<T>,
    ) {
        // ν − b̄ is what p⁽⁶⁾ has to give.
        let [s1, s2] = &outputs.surfaces;
        let [nu1, nu2, nu3, nu4] = self.nu;
        let (position_6, path_det) =
            outputs.solve([nu1 - s1.derivative(6), nu2 - s2.derivative(6), nu3 - outputs.speed_error.derivative(5)]);
        let yaw_2 = nu4 + outputs.yaw.derivative(2);
        self.u_zeta = position_6.z;
        self.margins = Margins {
            q3: state.rod.z,
            q_b3: lift.b3_rod,
            lambda: lift.lambda[0],
            kappa: lift.kappa,
            path_det,
            reach: outputs.reach_margin,
            cos_phi_squared: yaw.cos_phi_squared,
        };
        self.command.thrust = lift.thrust(vehicle);
        self.command.torque = lower(vehicle, state, lift, yaw, &position_6, yaw_2, &disturbance.torque);
    }
}

/// Σ aₖ bₖ.
#[inline]
pub(crate) fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

/// Why a controller could not be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetupError<T> {
    /// A parameter is out of range.
    Range(OutOfRange<T>),
    /// The gains do not make a stable loop.
    Gains(GainError<T>),
}

impl<T: Real> SetupError<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> SetupError<U> {
        match self {
            Self::Range(error) => SetupError::Range(error.cast()),
            Self::Gains(error) => SetupError::Gains(error.cast()),
        }
    }
}

impl<T> From<OutOfRange<T>> for SetupError<T> {
    fn from(error: OutOfRange<T>) -> Self {
        Self::Range(error)
    }
}

impl<T> From<GainError<T>> for SetupError<T> {
    fn from(error: GainError<T>) -> Self {
        Self::Gains(error)
    }
}

impl<T: Real> core::fmt::Display for SetupError<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::Gains(error) => error.fmt(f),
        }
    }
}

impl<T: Real> core::error::Error for SetupError<T> {}

/// How long integral action waits after the thrust was limited, s: five time constants of a pole at −1.
const RECOVERY: f64 = 5.0;

/// The path-following controller: the law at a fixed rate.
#[derive(Clone, Debug)]
pub struct Follower<T, P, A = ActuatorLimits<T>> {
    path: P,
    gains: Gains<T>,
    integral: [T; 3],
    /// The last answer, kept where it was made.
    solution: Solution<T, Xi<T>>,
    /// Time since the thrust was limited, s.
    unsaturated: T,
    approach: Approach<T>,
    sampler: Sampler<T, A>,
}

impl<T: Real, P: Path<T>> Follower<T, P> {
    /// A controller at hover (ζ = 0), with gains that have been found stable; without limits or observers, as the paper's.
    pub fn new(vehicle: Vehicle<T>, path: P, gains: Gains<T>, sampling: Sampling<T>) -> Result<Self, SetupError<T>> {
        gains.check()?;
        let sampler = Sampler::new(vehicle, &sampling)?;
        let mut gains = gains;
        if sampling.look_ahead {
            // ξ̃ is kept for the sample and the law acts h/2 later: ξ̃(h/2) = ξ̃ + (h/2) h_i.
            let lead = sampling.period * T::lit(0.5);
            gains.k1[0] += gains.integral[0] * lead;
            gains.k2[0] += gains.integral[1] * lead;
            gains.k3[0] += gains.integral[2] * lead;
        }
        Ok(Self {
            path,
            gains,
            integral: [T::zero(); 3],
            solution: Solution::default(),
            unsaturated: T::lit(RECOVERY),
            approach: Approach::none(),
            sampler,
        })
    }

    /// With limits on what is commanded.
    pub fn with_limits(self, limits: ActuatorLimits<T>) -> Result<Self, SetupError<T>> {
        self.with_actuation(limits)
    }
}

impl<T: Real, P: Path<T>, A: Actuation<T>> Follower<T, P, A> {
    /// With `actuation` in place of the one it has: [`Rotors`](crate::sampled::allocation::Rotors), say.
    pub fn with_actuation<B: Actuation<T>>(self, actuation: B) -> Result<Follower<T, P, B>, SetupError<T>> {
        let Self { path, gains, integral, solution, unsaturated, approach, sampler } = self;
        let sampler = sampler.with_actuation(actuation)?;
        Ok(Follower { path, gains, integral, solution, unsaturated, approach, sampler })
    }

    /// Changes what the actuators can apply, in flight too.
    pub fn set_actuation(&mut self, actuation: A) -> Result<(), OutOfRange<T>> {
        self.sampler.set_actuation(actuation)
    }

    /// What turns its commands into thrust and torque.
    pub fn actuation(&self) -> &A {
        self.sampler.actuation()
    }

    /// With disturbance observers, reset.
    pub fn with_observer(mut self, params: &ObserverParams<T>) -> Result<Self, SetupError<T>> {
        self.sampler.set_observer(params)?;
        Ok(self)
    }

    /// Starts from a stated ζ with integrals and disturbances at zero. Hover is ζ = 0.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) {
        self.sampler.start(state, zeta);
        self.begin(state);
    }

    /// Takes over from whatever applied `applied` until now, without a bump: thrust goes on from there with the payload's vertical
    /// acceleration, and the torque's step against it fades. Integrals and disturbances start at zero.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) {
        self.sampler.take_over(state, applied);
        self.begin(state);
    }

    /// Joins the path from afar, within `limits`: [takes over](Self::take_over), and slides the path from where the payload is to where it
    /// belongs. `false` if a limit is out of range ([`ApproachLimits::pace`] says which), or no point of the path was found.
    pub fn join(&mut self, state: &State<T>, applied: Command<T>, limits: &ApproachLimits<T>) -> bool {
        let Ok(pace) = limits.pace(self.sampler.vehicle()) else { return false };
        self.sampler.take_over(state, applied);
        self.rejoin(state, &pace)
    }

    /// Joins the path from what is being commanded, with what is known of disturbances.
    pub(crate) fn rejoin(&mut self, state: &State<T>, pace: &Pace<T>) -> bool {
        if !self.approach.join(&mut self.path, pace, state) {
            return false;
        }
        self.sampler.carry_on(state);
        self.integral = [T::zero(); 3];
        true
    }

    fn begin(&mut self, state: &State<T>) {
        self.integral = [T::zero(); 3];
        self.approach = Approach::at(&mut self.path, &state.position);
    }

    /// The command for the coming hold, from the state sampled now. Call once every period.
    ///
    /// This is the bare law: near its singularities it answers what it must. [`Supervisor`](crate::flight::supervisor::Supervisor) is total.
    #[inline]
    pub fn step(&mut self, sampled: &State<T>) -> Solution<T, Xi<T>> {
        let ahead = self.sampler.sample(sampled);
        self.evaluate(&ahead);
        let command = self.accept();
        Solution { command, ..self.solution }
    }

    /// The law's answer for the coming hold.
    #[inline(always)]
    pub(crate) fn evaluate(&mut self, ahead: &Ahead<T>) {
        let Ahead { state, zeta } = ahead;
        let (vehicle, disturbance) = (self.sampler.vehicle(), self.sampler.disturbance());
        let mut lift = lift(vehicle, state, zeta, disturbance);
        let fading = self.approach.leave(self.sampler.horizon(), &mut lift.position);
        let mut outputs = self.path.outputs(&lift.position);
        if let Some(fading) = fading {
            self.approach.fade(&fading, &mut outputs);
        }
        let yaw = Yaw::of(state);
        self.solution.read(&self.gains, &self.integral, &yaw, &outputs);
        self.solution.answer(vehicle, state, disturbance, &lift, &yaw, &outputs);
    }

    /// Takes the answer: limits and sends its command, and moves on by a period.
    #[inline(always)]
    pub(crate) fn accept(&mut self) -> Command<T> {
        let period = self.sampler.period();
        self.approach.advance(period);
        let Solution { command, u_zeta, margins, xi, .. } = &self.solution;
        let applied = self.sampler.commit(*command, *u_zeta, margins.q3 * margins.q_b3);
        // What the actuators can't give, no integral may ask for ever louder; nor count the way back for an error that stays.
        self.unsaturated = if self.sampler.is_saturated() { T::zero() } else { self.unsaturated + period };
        if self.unsaturated >= T::lit(RECOVERY) {
            let Xi { h1: [h1, ..], h2: [h2, ..], h3: [h3, ..], .. } = *xi;
            for (integral, h) in self.integral.iter_mut().zip([h1, h2, h3]) {
                *integral += period * h;
            }
        }
        applied
    }

    /// The law's last answer, all zeros before the first; its command is what it was before the limits.
    pub fn solution(&self) -> &Solution<T, Xi<T>> {
        &self.solution
    }

    pub(crate) fn sampler(&mut self) -> &mut Sampler<T, A> {
        &mut self.sampler
    }

    /// ζ when the next command begins to act (the next sample, without latency and lag).
    pub fn zeta(&self) -> &[T; 4] {
        self.sampler.zeta()
    }

    /// The approach under way, if any.
    pub fn approach(&self) -> &Approach<T> {
        &self.approach
    }

    /// ξ̃ = ∫(h1, h2, h3) up to the next sample.
    pub fn integral(&self) -> &[T; 3] {
        &self.integral
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
