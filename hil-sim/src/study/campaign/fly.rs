//! A campaign's flight, and the row of the table it leaves.

use controller::{Command, Fault, Mode, Request};
use rig::parameter;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

use super::file::{ApproachFields, Campaign, Drawn};
use crate::describe::input::Invalid;
use crate::describe::parameters::without_path;
use crate::describe::scenario::{ControllerSpec, Scenario};
use crate::fly::fault::describe;
use crate::fly::flight::{Control, End, LOST_M, Moment};
use crate::fly::judge::{GOOD_M, Outcome, judge};
use crate::fly::pilot::{Decision, Pilot};
use crate::world::Seed;

/// The controller of a campaign: `spec`'s under its supervisor in f32, joining its path within
/// these limits.
///
/// # Errors
/// [`Invalid`] if rounding to f32 takes a parameter out of range, or the approach's limits are.
pub fn pilot(spec: &ControllerSpec, approach: &ApproachFields) -> Result<Pilot<f32>, Invalid> {
    let spec = ControllerSpec { supervised: true, ..spec.clone() };
    let mut parameters = without_path(&spec).map_err(|error| Invalid::new("controller", error))?;
    let ApproachFields { speed, acceleration, tilt_deg, rod_deg } = *approach;
    for (name, parameter, value) in [
        ("speed", parameter!("APP_SPEED"), speed),
        ("acceleration", parameter!("APP_ACC"), acceleration),
        ("tilt_deg", parameter!("APP_TILT"), tilt_deg.map(f64::to_radians)),
        ("rod_deg", parameter!("APP_ROD"), rod_deg.map(f64::to_radians)),
    ] {
        if let Some(value) = value {
            let refused = |refused| Invalid::refused(format!("approach.{name}"), refused);
            parameters.set(parameter, value).map_err(refused)?;
        }
    }
    Pilot::of(&spec, &parameters)
}

/// What became of a flight.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// d_C below 25 cm throughout the last quarter; of a flight that was to land: on the ground,
    /// rotors off, the payload within 50 cm of its place.
    Good,
    /// Not that, and in hold at the end.
    Held,
    /// Not that, and in another mode at the end.
    Off,
    /// A body came to the ground that was not to, or too hard.
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
    /// How often the vehicle fell back to another mode than engage or follow, asked to follow.
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
    /// Fastest touch of the UAV on the ground, m/s; empty if there was none.
    pub uav_touchdown_m_s: Option<f64>,
    /// Fastest touch of the payload on the ground, m/s; empty if there was none.
    pub load_touchdown_m_s: Option<f64>,
    /// Level distance of the payload from its place when landing was asked for, m; empty if it was
    /// not.
    pub load_place_m: Option<f64>,
    /// d_C at sixteen instants, evenly over the flight, m, separated by semicolons.
    pub dc_over_time_m: String,
}

/// A payload nearer to its place than this was set down in it, m.
const IN_PLACE_M: f64 = 0.5;

/// Instants at which a row has d_C.
pub const INSTANTS: usize = 16;

/// Flies one flight of a campaign; `watch`, if there is one, sees every period with its telemetry.
/// `None` if it was interrupted.
///
/// # Errors
/// [`Invalid`] if the drawn scenario is not valid or cannot be set up.
pub fn fly_run(
    campaign: &Campaign,
    seed: Seed,
    control: Control<'_>,
    watch: Option<&mut dyn FnMut(&Moment<'_>)>,
) -> Result<Option<Row>, Invalid> {
    let drawn = campaign.draw(seed)?;
    let pilot = pilot(&drawn.scenario.controller, &campaign.approach)?;
    Ok(match watch {
        Some(watch) => fly_drawn(&drawn, pilot, campaign.ground_p3, seed, control, watch),
        None => fly_drawn(&drawn, pilot.without_telemetry(), campaign.ground_p3, seed, control, &mut |_| {}),
    })
}

/// Flies a flight that has been drawn, with everything else random from `seed`; `None` if it was
/// interrupted.
pub(super) fn fly_drawn(
    drawn: &Drawn,
    mut pilot: Pilot<f32>,
    ground_p3: Option<f64>,
    seed: Seed,
    control: Control<'_>,
    watch: &mut dyn FnMut(&Moment<'_>),
) -> Option<Row> {
    let mut tally = Tally::new(drawn, seed);
    let Drawn { scenario, start } = drawn;
    let outcome = judge(scenario, start.state, seed, ground_p3, control, &mut pilot, &mut |moment| {
        if let Some(decision) = moment.decision {
            tally.take(moment, decision);
            watch(moment);
        }
    });
    Some(tally.row(outcome?))
}

/// A row in the making.
struct Tally<'a> {
    scenario: &'a Scenario,
    /// The limits as the controller has them, rounded to f32.
    thrust_range: RangeInclusive<f64>,
    max_torque: [f64; 3],
    period: f64,
    row: Row,
    over_time: Vec<f64>,
    mode: Mode,
    fault: Option<Fault>,
}

impl<'a> Tally<'a> {
    fn new(Drawn { scenario, start }: &'a Drawn, seed: Seed) -> Self {
        let controller = &scenario.controller;
        let limits = controller.limits.cast::<f32>();
        let row = Row {
            run: seed.run,
            start_distance_m: controller.law.distance(start.state.position.into()),
            start_speed: start.state.velocity.dot(&start.state.velocity).sqrt(),
            start_tilt_deg: start.tilt_deg,
            start_rod_deg: start.rod_deg,
            payload_mass: scenario.vehicle.payload_mass,
            wind: scenario.environment.air.map_or(0.0, |air| air.wind.iter().map(|w| w * w).sum::<f64>().sqrt()),
            ..Row::nothing()
        };
        Self {
            scenario,
            thrust_range: f64::from(limits.min_thrust)..=f64::from(limits.max_thrust),
            max_torque: limits.max_torque.map(f64::from),
            period: 1.0 / controller.rate_hz,
            row,
            over_time: Vec::with_capacity(INSTANTS),
            mode: Mode::Off,
            fault: None,
        }
    }

    /// Takes a control period in.
    fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        self.take_mode(moment.request, decision);
        let row = &mut self.row;
        if let Some(margins) = &decision.margins {
            lower(&mut row.least_q3, margins.q3);
            lower(&mut row.least_q_b3, margins.q_b3);
            lower(&mut row.least_tension, -margins.lambda * self.scenario.controller.vehicle.payload_mass);
        }
        self.take_command(&decision.command);
        if let Some(distance) = moment.distance_m {
            self.take_distance(moment.t_s, distance);
        }
    }

    fn take_mode(&mut self, request: Request, decision: &Decision) {
        let row = &mut self.row;
        if let Some(now) = decision.fault
            && self.fault != Some(now)
        {
            self.fault = Some(now);
            row.last_fault = describe(now);
            if row.first_fault.is_empty() {
                row.first_fault.clone_from(&row.last_fault);
            }
        }
        let flies = |mode| matches!(mode, Mode::Join | Mode::Follow);
        let falls = flies(self.mode) && !flies(decision.mode) && request == Request::Follow;
        row.falls += u32::from(falls);
        self.mode = decision.mode;
        match self.mode {
            Mode::Join => row.engage_s += self.period,
            Mode::Follow => row.follow_s += self.period,
            _ => {}
        }
    }

    fn take_command(&mut self, command: &Command<f64>) {
        let row = &mut self.row;
        let torque = command.torque.abs();
        let within = self.thrust_range.contains(&command.thrust)
            && torque.iter().zip(self.max_torque).all(|(torque, limit)| *torque <= limit);
        if !within {
            let finite = command.thrust.is_finite() && torque.iter().all(|torque| torque.is_finite());
            row.non_finite += u32::from(!finite);
            // Off is no command.
            row.out_of_limits += u32::from(self.mode != Mode::Off);
        }
        lower(&mut row.least_thrust, command.thrust);
        raise(&mut row.largest_thrust, command.thrust);
        torque.iter().for_each(|torque| raise(&mut row.largest_torque, *torque));
    }

    fn take_distance(&mut self, t_s: f64, distance: f64) {
        if distance < GOOD_M {
            self.row.reached_s.get_or_insert(t_s);
        } else {
            self.row.reached_s = None;
        }
        let due_s = self.over_time.len() as f64 * self.scenario.duration_s / INSTANTS as f64;
        if t_s >= due_s - 0.5 * self.period {
            self.over_time.push(distance);
        }
    }

    /// The row of a flight that ended so.
    fn row(mut self, outcome: Outcome) -> Row {
        let (verdict, end_s) = self.verdict(&outcome);
        self.over_time.resize(INSTANTS, LOST_M);
        let dc_over_time: Vec<String> = self.over_time.iter().map(|distance| format!("{distance:.4}")).collect();
        let Outcome { dc_max_m, dc_rms_m, touchdown, .. } = outcome;
        Row {
            verdict,
            end_s,
            mode: format!("{:?}", self.mode).to_lowercase(),
            dc_max_m,
            dc_rms_m,
            uav_touchdown_m_s: touchdown.uav_m_s,
            load_touchdown_m_s: touchdown.load_m_s,
            load_place_m: touchdown.load_place_m,
            dc_over_time_m: dc_over_time.join(";"),
            ..self.row
        }
    }

    /// What became of the flight, and when, s.
    fn verdict(&self, outcome: &Outcome) -> (Verdict, f64) {
        let scenario = self.scenario;
        let is_in_place = outcome.touchdown.load_place_m.is_some_and(|distance| distance <= IN_PLACE_M);
        match outcome.end {
            End::Crashed(t_s) => (Verdict::Crashed, t_s),
            End::Lost(t_s) => (Verdict::Lost, t_s),
            End::NotFinite(t_s) => (Verdict::NonFinite, t_s),
            End::Landed(t_s) => (if is_in_place { Verdict::Good } else { Verdict::Off }, t_s),
            _ if outcome.is_good() && !scenario.lands() => (Verdict::Good, scenario.duration_s),
            _ if self.mode == Mode::Hold => (Verdict::Held, scenario.duration_s),
            _ => (Verdict::Off, scenario.duration_s),
        }
    }
}

/// The lower of the two; a NaN is none.
#[inline]
fn lower(least: &mut f64, value: f64) {
    if value < *least {
        *least = value;
    }
}

/// The higher of the two; a NaN is none.
#[inline]
fn raise(largest: &mut f64, value: f64) {
    if value > *largest {
        *largest = value;
    }
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
            uav_touchdown_m_s: None,
            load_touchdown_m_s: None,
            load_place_m: None,
            dc_over_time_m: String::new(),
        }
    }
}
