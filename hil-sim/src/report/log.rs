//! The CSV file of a flight: one line a logged sample, SI units and radians, empty where there is no command, or no telemetry.

use crate::fly::batch::Outcome;

const COLUMNS: [&str; 50] = [
    "t_s",
    "p1",
    "p2",
    "p3",
    "alpha",
    "beta",
    "phi",
    "theta",
    "psi",
    "v1",
    "v2",
    "v3",
    "alpha_dot",
    "beta_dot",
    "omega1",
    "omega2",
    "omega3",
    "d_c",
    "thrust",
    "torque1",
    "torque2",
    "torque3",
    "zeta1",
    "zeta2",
    "zeta3",
    "zeta4",
    "integral1",
    "integral2",
    "integral3",
    "nu1",
    "nu2",
    "nu3",
    "nu4",
    "q3",
    "q_b3",
    "lambda",
    "kappa",
    "path_det",
    "reach",
    "cos_phi_squared",
    "payload_force1",
    "payload_force2",
    "payload_force3",
    "uav_force1",
    "uav_force2",
    "uav_force3",
    "disturbing_torque1",
    "disturbing_torque2",
    "disturbing_torque3",
    "implied_payload_mass",
];

/// The log as CSV.
pub fn csv(outcome: &Outcome) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for sample in &outcome.flight.log {
        let mut line = Vec::with_capacity(COLUMNS.len());
        line.push(sample.t_s);
        line.extend(sample.x);
        line.push(sample.distance_m);
        if let Some(decision) = &sample.decision {
            line.push(decision.command.thrust);
            line.extend(&decision.command.torque);
            line.extend(decision.zeta);
        }
        if let Some(telemetry) = sample.decision.and_then(|decision| decision.telemetry) {
            let margins = &telemetry.margins;
            line.extend(telemetry.integral);
            line.extend(telemetry.nu);
            line.extend([margins.q3, margins.q_b3, margins.lambda, margins.kappa, margins.path_det]);
            line.extend([margins.reach, margins.cos_phi_squared]);
            let observed = &telemetry.observed;
            line.extend([observed.payload_force, observed.uav_force, observed.torque].concat());
            line.push(observed.payload_mass);
        }
        let filled = line.iter().map(f64::to_string);
        let empty = std::iter::repeat_n(String::new(), COLUMNS.len() - line.len());
        writer.write_record(filled.chain(empty))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}
