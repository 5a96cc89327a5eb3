//! A campaign's flight: the supervised law, and the row of the table it leaves.

use controller::{
    ApproachLimits, Command, EnvelopeParams, Follow, Follower, Mode, Policy, Request, SetupError, State,
};
use controller::{Supervisor, Vehicle};
use serde::{Deserialize, Serialize};

use super::file::{ApproachFields, Campaign, Drawn};
use crate::describe::input::Invalid;
use crate::describe::path::FlownPath;
use crate::describe::scenario::{ControllerSpec, Law};
use crate::fly::fault::describe;
use crate::fly::flight::{Control, End, LOST_M, Moment};
use crate::fly::judge::{GOOD_M, Outcome, judge};
use crate::fly::pilot::{Answers, Decision, Observed, Telemetry, padded};
use crate::world::Seed;

/// The supervised law in f32, asked to follow its path from the first step on.
pub struct Supervised {
    supervisor: Supervisor<f32, Follow<f32, FlownPath<f32>>>,
}

impl Supervised {
    /// The controller that `spec` describes, which must be for a path, with these limits for
    /// joining it.
    ///
    /// # Errors
    /// [`SetupError`] if rounding to f32 takes a parameter out of range, or the approach's limits
    /// are.
    pub fn new(spec: &ControllerSpec, approach: &ApproachFields) -> Result<Option<Self>, SetupError<f32>> {
        let Law::Follow { path, gains } = &spec.law else { return Ok(None) };
        let vehicle = Vehicle::new(spec.vehicle.cast())?;
        let sampling = spec.sampling().cast();
        let follower = Follower::new(vehicle, path.build()?, gains.cast(), sampling)?
            .with_observer(spec.observer.cast())?
            .with_limits(spec.limits.cast())?;
        let gentle = ApproachLimits::gentle();
        let or = |given: Option<f64>, other: f32| given.map_or(other, |value| value as f32);
        let radians = |degrees: Option<f64>| degrees.map(f64::to_radians);
        let approach = ApproachLimits {
            speed: or(approach.speed, gentle.speed),
            acceleration: or(approach.acceleration, gentle.acceleration),
            tilt: or(radians(approach.tilt_deg), gentle.tilt),
            rod_angle: or(radians(approach.rod_deg), gentle.rod_angle),
            ..gentle
        };
        let supervisor = Supervisor::new(follower, EnvelopeParams::wide(), approach, Policy::default())?;
        Ok(Some(Self { supervisor }))
    }
}

impl Answers for Supervised {
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]) {
        // A refused state leaves the law as it was, which the flight then shows.
        let _ = self.supervisor.start(&state.cast(), zeta.map(|z| z as f32));
    }

    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>) {
        // A refused state leaves the law as it was, which the flight then shows.
        let _ = self.supervisor.take_over(&state.cast(), applied.cast());
    }

    #[inline]
    fn step(&mut self, state: &State<f64>, _: f64) -> Option<Decision> {
        let state = state.cast();
        let (zeta, integral) = (*self.supervisor.sampler().zeta(), *self.supervisor.law().integral());
        let output = self.supervisor.step(Some(&state), Request::Follow);
        let (found, vehicle) = (self.supervisor.disturbance(), self.supervisor.sampler().vehicle());
        let telemetry = self.supervisor.solution().map(|solution| Telemetry {
            integral: integral.map(f64::from),
            xi: padded([&solution.xi.h1, &solution.xi.h2, &solution.xi.h3, &solution.xi.h4]),
            nu: solution.nu.map(f64::from),
            margins: solution.margins.cast(),
            observed: Observed::new(found, vehicle, &state.rod, solution.margins.lambda),
        });
        Some(Decision {
            command: output.command.cast(),
            zeta: zeta.map(f64::from),
            mode: output.mode,
            fault: output.fault,
            disturbance: Some(found.cast()),
            telemetry,
        })
    }
}

/// What became of a flight.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// d_C below 25 cm throughout the last quarter.
    Good,
    /// Not that, and in hold at the end.
    Held,
    /// Not that, and in another mode at the end.
    Off,
    /// A body came to the ground.
    Crashed,
    /// 100 m from the path.
    Lost,
    /// A state or command was not finite.
    NonFinite,
}

/// A flight's row in the table. Its fields are the table's columns.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The flight's number.
    pub run: u64,
    /// What became of it.
    pub verdict: Verdict,
    /// When it ended, s.
    pub end_s: f64,
    /// The mode at the end.
    pub mode: String,
    /// The first fault, empty if there was none.
    pub first_fault: String,
    /// The last fault that stood, empty if there was none.
    pub last_fault: String,
    /// How often the vehicle fell back to another mode than engage or follow.
    pub falls: u32,
    /// Time in engage, s.
    pub engage_s: f64,
    /// Time in follow, s.
    pub follow_s: f64,
    /// Time from which d_C stayed below 25 cm, s; empty if it did not.
    pub reached_s: Option<f64>,
    /// Largest d_C in the last quarter, m.
    pub dc_max_m: f64,
    /// Root mean square of d_C in the last quarter, m.
    pub dc_rms_m: f64,
    /// d_C at the start, m.
    pub start_distance_m: f64,
    /// Speed at the start, m/s.
    pub start_speed: f64,
    /// Tilt at the start, degrees.
    pub start_tilt_deg: f64,
    /// Rod angle at the start, degrees.
    pub start_rod_deg: f64,
    /// Payload, kg.
    pub payload_mass: f64,
    /// Mean wind, m/s.
    pub wind: f64,
    /// Least q·e3 while the law was asked.
    pub least_q3: f64,
    /// Least q·b3 while the law was asked.
    pub least_q_b3: f64,
    /// Least tension of the rod as the law takes the payload's mass, N.
    pub least_tension: f64,
    /// Least and largest thrust commanded, N.
    pub least_thrust: f64,
    /// Largest thrust commanded, N.
    pub largest_thrust: f64,
    /// Largest torque commanded about an axis, N·m.
    pub largest_torque: f64,
    /// Commands that were not finite.
    pub non_finite: u32,
    /// Commands outside the limits.
    pub out_of_limits: u32,
    /// d_C at sixteen instants, evenly over the flight, m, separated by semicolons.
    pub dc_over_time_m: String,
}

/// Instants at which a row has d_C.
pub const INSTANTS: usize = 16;

/// Flies one flight of a campaign; `watch` sees every period. `None` if it was interrupted.
///
/// # Errors
/// [`Invalid`] if the drawn scenario is not valid or cannot be set up.
pub fn fly_run(
    campaign: &Campaign,
    seed: Seed,
    control: Control<'_>,
    watch: &mut dyn FnMut(&Moment<'_>),
) -> Result<Option<Row>, Invalid> {
    let Drawn { scenario, start } = campaign.draw(seed)?;
    let controller = &scenario.controller;
    let mut pilot = Supervised::new(controller, &campaign.approach)
        .map_err(|error| Invalid::new("scenario", error))?
        .ok_or_else(|| Invalid::new("scenario.controller.law", "not \"follow\""))?;

    // The limits as the controller has them, rounded to f32.
    let limits = controller.limits.cast::<f32>();
    let thrust_range = f64::from(limits.min_thrust)..=f64::from(limits.max_thrust);
    let max_torque = limits.max_torque.map(f64::from);
    let period = 1.0 / controller.rate_hz;
    let mut row = Row {
        run: seed.run,
        start_distance_m: controller.law.distance(start.state.position.into()),
        start_speed: start.state.velocity.dot(&start.state.velocity).sqrt(),
        start_tilt_deg: start.tilt_deg,
        start_rod_deg: start.rod_deg,
        payload_mass: scenario.vehicle.payload_mass,
        wind: scenario.environment.air.map_or(0.0, |air| air.wind.iter().map(|w| w * w).sum::<f64>().sqrt()),
        ..Row::nothing()
    };
    let mut over_time: Vec<f64> = Vec::with_capacity(INSTANTS);
    let (mut mode, mut fault, mut flying) = (Mode::Off, None, false);
    let outcome = judge(&scenario, start.state, seed, campaign.ground_p3, control, &mut pilot, &mut |moment| {
        let Some(decision) = moment.decision else { return };
        let Decision { command, telemetry, .. } = decision;
        mode = decision.mode;
        if let Some(now) = decision.fault
            && fault != Some(now)
        {
            fault = Some(now);
            row.last_fault = describe(now);
            if row.first_fault.is_empty() {
                row.first_fault.clone_from(&row.last_fault);
            }
        }
        let flies = matches!(mode, Mode::Join | Mode::Follow);
        row.falls += u32::from(flying && !flies);
        flying = flies;
        match mode {
            Mode::Join => row.engage_s += period,
            Mode::Follow => row.follow_s += period,
            _ => {}
        }
        if let Some(Telemetry { margins, .. }) = telemetry {
            row.least_q3 = row.least_q3.min(margins.q3);
            row.least_q_b3 = row.least_q_b3.min(margins.q_b3);
            row.least_tension = row.least_tension.min(-margins.lambda * controller.vehicle.payload_mass);
        }
        let finite = command.thrust.is_finite() && command.torque.iter().all(|torque| torque.is_finite());
        let within = thrust_range.contains(&command.thrust)
            && command.torque.iter().zip(max_torque).all(|(torque, limit)| torque.abs() <= limit);
        row.non_finite += u32::from(!finite);
        // Off is no command.
        row.out_of_limits += u32::from(!within && mode != Mode::Off);
        row.least_thrust = row.least_thrust.min(command.thrust);
        row.largest_thrust = row.largest_thrust.max(command.thrust);
        row.largest_torque = row.largest_torque.max(command.torque.amax());
        if let Some(distance) = moment.distance_m {
            if distance < GOOD_M {
                row.reached_s.get_or_insert(moment.t_s);
            } else {
                row.reached_s = None;
            }
            if moment.t_s >= over_time.len() as f64 * scenario.duration_s / INSTANTS as f64 - 0.5 * period {
                over_time.push(distance);
            }
        }
        watch(moment);
    });
    let Some(outcome) = outcome else { return Ok(None) };
    let Outcome { end, dc_max_m, dc_rms_m } = outcome;
    (row.verdict, row.end_s) = match end {
        End::Crashed(t_s) => (Verdict::Crashed, t_s),
        End::Lost(t_s) => (Verdict::Lost, t_s),
        End::NotFinite(t_s) => (Verdict::NonFinite, t_s),
        _ if outcome.is_good() => (Verdict::Good, scenario.duration_s),
        _ if mode == Mode::Hold => (Verdict::Held, scenario.duration_s),
        _ => (Verdict::Off, scenario.duration_s),
    };
    over_time.resize(INSTANTS, LOST_M);
    row.dc_over_time_m = over_time.iter().map(|distance| format!("{distance:.4}")).collect::<Vec<_>>().join(";");
    Ok(Some(Row { mode: format!("{mode:?}").to_lowercase(), dc_max_m, dc_rms_m, ..row }))
}

impl Row {
    /// A row of which nothing has been measured yet.
    pub(super) fn nothing() -> Self {
        Self {
            run: 0,
            verdict: Verdict::Good,
            end_s: 0.0,
            mode: String::new(),
            first_fault: String::new(),
            last_fault: String::new(),
            falls: 0,
            engage_s: 0.0,
            follow_s: 0.0,
            reached_s: None,
            dc_max_m: 0.0,
            dc_rms_m: 0.0,
            start_distance_m: 0.0,
            start_speed: 0.0,
            start_tilt_deg: 0.0,
            start_rod_deg: 0.0,
            payload_mass: 0.0,
            wind: 0.0,
            least_q3: 1.0,
            least_q_b3: 1.0,
            least_tension: f64::INFINITY,
            least_thrust: f64::INFINITY,
            largest_thrust: 0.0,
            largest_torque: 0.0,
            non_finite: 0,
            out_of_limits: 0,
            dc_over_time_m: String::new(),
        }
    }
}
