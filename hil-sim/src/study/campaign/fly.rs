//! A campaign's flight, and the row of the table it leaves.

use controller::{Mode, Request};
use rig::parameter;
use serde::{Deserialize, Serialize};

use super::file::{ApproachFields, Campaign, Drawn};
use crate::describe::input::Invalid;
use crate::describe::parameters::without_path;
use crate::describe::scenario::ControllerSpec;
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
    Drawn { scenario, start }: &Drawn,
    mut pilot: Pilot<f32>,
    ground_p3: Option<f64>,
    seed: Seed,
    control: Control<'_>,
    watch: &mut dyn FnMut(&Moment<'_>),
) -> Option<Row> {
    let controller = &scenario.controller;

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
    let outcome = judge(scenario, start.state, seed, ground_p3, control, &mut pilot, &mut |moment| {
        let Some(decision) = moment.decision else { return };
        let Decision { command, margins, .. } = decision;
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
        row.falls += u32::from(flying && !flies && moment.request == Request::Follow);
        flying = flies;
        match mode {
            Mode::Join => row.engage_s += period,
            Mode::Follow => row.follow_s += period,
            _ => {}
        }
        if let Some(margins) = margins {
            lower(&mut row.least_q3, margins.q3);
            lower(&mut row.least_q_b3, margins.q_b3);
            lower(&mut row.least_tension, -margins.lambda * controller.vehicle.payload_mass);
        }
        let torque = command.torque.abs();
        let within = thrust_range.contains(&command.thrust)
            && torque.iter().zip(max_torque).all(|(torque, limit)| *torque <= limit);
        if !within {
            let finite = command.thrust.is_finite() && torque.iter().all(|torque| torque.is_finite());
            row.non_finite += u32::from(!finite);
            // Off is no command.
            row.out_of_limits += u32::from(mode != Mode::Off);
        }
        lower(&mut row.least_thrust, command.thrust);
        raise(&mut row.largest_thrust, command.thrust);
        torque.iter().for_each(|torque| raise(&mut row.largest_torque, *torque));
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
    let outcome = outcome?;
    let Outcome { end, dc_max_m, dc_rms_m, touchdown } = outcome;
    let is_to_land = scenario.lands();
    let is_in_place = touchdown.load_place_m.is_some_and(|distance| distance <= IN_PLACE_M);
    (row.verdict, row.end_s) = match end {
        End::Crashed(t_s) => (Verdict::Crashed, t_s),
        End::Lost(t_s) => (Verdict::Lost, t_s),
        End::NotFinite(t_s) => (Verdict::NonFinite, t_s),
        End::Landed(t_s) => (if is_in_place { Verdict::Good } else { Verdict::Off }, t_s),
        _ if outcome.is_good() && !is_to_land => (Verdict::Good, scenario.duration_s),
        _ if mode == Mode::Hold => (Verdict::Held, scenario.duration_s),
        _ => (Verdict::Off, scenario.duration_s),
    };
    over_time.resize(INSTANTS, LOST_M);
    row.dc_over_time_m = over_time.iter().map(|distance| format!("{distance:.4}")).collect::<Vec<_>>().join(";");
    Some(Row {
        mode: format!("{mode:?}").to_lowercase(),
        dc_max_m,
        dc_rms_m,
        uav_touchdown_m_s: touchdown.uav_m_s,
        load_touchdown_m_s: touchdown.load_m_s,
        load_place_m: touchdown.load_place_m,
        ..row
    })
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
