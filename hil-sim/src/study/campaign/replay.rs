//! One flight of a campaign again, with its full log.

use super::file::Campaign;
use super::fly::{Row, describe, fly_run};
use crate::describe::input::Invalid;
use crate::fly::flight::Control;
use crate::fly::pilot::Telemetry;
use crate::world::Seed;
use controller::Disturbance;

const COLUMNS: [&str; 37] = [
    "t_s",
    "mode",
    "fault",
    "p1",
    "p2",
    "p3",
    "v1",
    "v2",
    "v3",
    "q1",
    "q2",
    "q3",
    "dq1",
    "dq2",
    "dq3",
    "b3_1",
    "b3_2",
    "b3_3",
    "omega1",
    "omega2",
    "omega3",
    "d_c",
    "thrust",
    "torque1",
    "torque2",
    "torque3",
    "margin_q3",
    "margin_q_b3",
    "margin_lambda",
    "margin_kappa",
    "margin_path_det",
    "d1",
    "d2",
    "d3",
    "delta1",
    "delta2",
    "delta3",
];

/// Flies the flight that `seed` stands for; returns its row and a CSV log with a line every period: the true state in N (omega in body
/// axes), the command, and what the controller took it from; `None` if it was interrupted. d_C and margins are empty where they were not taken.
///
/// # Errors
/// As [`fly_run`].
pub fn replay(campaign: &Campaign, seed: Seed, control: Control<'_>) -> Result<Option<(Row, Vec<u8>)>, Invalid> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Plain strings into memory: neither step can fail.
    let _ = writer.write_record(COLUMNS);
    let row = fly_run(campaign, seed, control, &mut |moment| {
        let (state, Some(decision)) = (moment.state, moment.decision) else { return };
        let mut line = Vec::with_capacity(COLUMNS.len());
        line.push(format!("{:.6}", moment.t_s));
        line.push(format!("{:?}", decision.mode).to_lowercase());
        line.push(decision.fault.map(describe).unwrap_or_default());
        let b3 = state.attitude.column(2);
        let groups = [&state.position, &state.velocity, &state.rod, &state.rod_rate, &b3.into(), &state.body_rate];
        line.extend(groups.into_iter().flat_map(|group| group.iter().map(f64::to_string)));
        line.push(moment.distance_m.map(|distance| distance.to_string()).unwrap_or_default());
        line.push(decision.command.thrust.to_string());
        line.extend(decision.command.torque.iter().map(f64::to_string));
        let margins =
            decision.telemetry.map(|Telemetry { margins: m, .. }| [m.q3, m.q_b3, m.lambda, m.kappa, m.path_det]);
        line.extend(margins.map_or([const { String::new() }; 5], |margins| margins.map(|margin| margin.to_string())));
        let found = decision.disturbance.unwrap_or_else(Disturbance::none);
        line.extend(found.payload.iter().chain(found.rod.iter()).map(f64::to_string));
        let _ = writer.write_record(&line);
    })?;
    Ok(row.map(|row| (row, writer.into_inner().unwrap_or_default())))
}
