//! Every quantity of a log: its topic, its columns' names and units, what it is, and where it comes
//! from.

use super::record::Record;
use crate::fly::fault::describe;
use crate::fly::sample::Contact;
use controller::{Matrix3, Vector3};

/// Numbers of a record, padded with zeros to the longest quantity.
type Numbers = Option<[f64; 4]>;

/// A quantity of one or more columns.
pub struct Quantity {
    /// The topic of logs that have topics.
    pub topic: &'static str,
    /// Name and unit of each column; "1" is the unit of a pure number.
    pub columns: &'static [(&'static str, &'static str)],
    /// What it is, for people.
    pub about: &'static str,
    /// Taken from a record.
    pub values: fn(&Record) -> Numbers,
}

/// A quantity that is a word.
pub struct Word {
    /// As of a [`Quantity`].
    pub topic: &'static str,
    /// The column's name.
    pub name: &'static str,
    /// What it is, for people.
    pub about: &'static str,
    /// Taken from a record.
    pub value: fn(&Record) -> Option<String>,
}

/// The words, in order.
pub const WORDS: &[Word] = &[
    Word {
        topic: "supervisor",
        name: "mode",
        about: "What the supervisor has the vehicle do",
        value: |r| r.decision.map(|decision| format!("{:?}", decision.mode).to_lowercase()),
    },
    Word {
        topic: "supervisor",
        name: "fault",
        about: "Why the vehicle does not do what was asked; empty if it does",
        value: |r| r.decision.map(|decision| decision.fault.map(describe).unwrap_or_default()),
    },
    Word {
        topic: "status",
        name: "cable",
        about: "Whether the cable pulls: taut or slack",
        value: |r| r.contact.map(|contact| if contact.is_taut { "taut" } else { "slack" }.to_owned()),
    },
    Word {
        topic: "status",
        name: "ground",
        about: "Who is on the ground: load, UAV, both; empty if nobody is",
        value: |r| {
            let word = |contact: Contact| match contact.touching {
                [false, false] => "",
                [true, false] => "load",
                [false, true] => "UAV",
                [true, true] => "both",
            };
            r.contact.map(|contact| word(contact).to_owned())
        },
    },
    Word {
        topic: "status",
        name: "estimate",
        about: "What the estimate of the rod is worth: valid, converging, inconsistent, blind or slack",
        value: |r| r.seen.map(|seen| format!("{:?}", seen.validity).to_lowercase()),
    },
];

/// The numbers, in order.
pub const QUANTITIES: &[Quantity] = &[
    Quantity {
        topic: "load",
        columns: &[("p1", "m"), ("p2", "m"), ("p3", "m")],
        about: "Position p of the payload in N, n3 down",
        values: |r| vector(&r.state.position),
    },
    Quantity {
        topic: "load",
        columns: &[("v1", "m/s"), ("v2", "m/s"), ("v3", "m/s")],
        about: "Velocity v of the payload in N",
        values: |r| vector(&r.state.velocity),
    },
    Quantity {
        topic: "load",
        columns: &[("d_c", "m")],
        about: "Distance of the payload from the curve to be flown",
        values: |r| r.distance_m.and_then(number),
    },
    Quantity {
        topic: "uav",
        columns: &[("uav_p1", "m"), ("uav_p2", "m"), ("uav_p3", "m")],
        about: "Position of the UAV in N, n3 down",
        values: |r| vector(&r.uav_position),
    },
    Quantity {
        topic: "uav",
        columns: &[("uav_v1", "m/s"), ("uav_v2", "m/s"), ("uav_v3", "m/s")],
        about: "Velocity of the UAV in N",
        values: |r| vector(&r.uav_velocity),
    },
    Quantity {
        topic: "uav",
        columns: &[("att_w", "1"), ("att_x", "1"), ("att_y", "1"), ("att_z", "1")],
        about: "Attitude R, body to N, as Hamilton's unit quaternion",
        values: |r| quaternion(&r.state.attitude),
    },
    Quantity {
        topic: "uav",
        columns: &[("omega1", "rad/s"), ("omega2", "rad/s"), ("omega3", "rad/s")],
        about: "Angular velocity ω in body axes",
        values: |r| vector(&r.state.body_rate),
    },
    Quantity {
        topic: "uav",
        columns: &[("f1", "m/s^2"), ("f2", "m/s^2"), ("f3", "m/s^2")],
        about: "The accelerometer's specific force in body axes, mean of a control period",
        values: |r| r.seen.and_then(|seen| vector(&seen.specific_force)),
    },
    Quantity {
        topic: "angles",
        columns: &[("alpha", "rad"), ("beta", "rad")],
        about: "The paper's angles of the rod",
        values: |r| paper(r, [3, 4, 4]),
    },
    Quantity {
        topic: "angles",
        columns: &[("phi", "rad"), ("theta", "rad"), ("psi", "rad")],
        about: "The paper's angles of the UAV",
        values: |r| paper(r, [5, 6, 7]),
    },
    Quantity {
        topic: "command",
        columns: &[("thrust", "N")],
        about: "Thrust T commanded for the coming hold",
        values: |r| r.decision.and_then(|decision| number(decision.command.thrust)),
    },
    Quantity {
        topic: "command",
        columns: &[("torque1", "N m"), ("torque2", "N m"), ("torque3", "N m")],
        about: "Torque τ in body axes commanded for the coming hold",
        values: |r| r.decision.and_then(|decision| vector(&decision.command.torque)),
    },
    Quantity {
        topic: "logged",
        columns: &[("logged_thrust", "N")],
        about: "Thrust that the replayed log has",
        values: |r| r.logged.and_then(|command| number(command.thrust)),
    },
    Quantity {
        topic: "logged",
        columns: &[("logged_torque1", "N m"), ("logged_torque2", "N m"), ("logged_torque3", "N m")],
        about: "Torque in body axes that the replayed log has",
        values: |r| r.logged.and_then(|command| vector(&command.torque)),
    },
    Quantity {
        topic: "estimate",
        columns: &[("est_p1", "m"), ("est_p2", "m"), ("est_p3", "m")],
        about: "Position of the payload in N as estimated",
        values: |r| r.seen.and_then(|seen| vector(&seen.position)),
    },
    Quantity {
        topic: "estimate",
        columns: &[("est_q1", "1"), ("est_q2", "1"), ("est_q3", "1")],
        about: "Rod q as estimated, from the UAV to the payload in N",
        values: |r| r.seen.and_then(|seen| vector(&seen.rod)),
    },
    Quantity {
        topic: "estimate",
        columns: &[("rod_sigma", "rad")],
        about: "Standard deviation of the estimated rod, both axes together",
        values: |r| r.seen.and_then(|seen| number(seen.rod_deviation)),
    },
    Quantity {
        topic: "estimate",
        columns: &[("position_sigma", "m")],
        about: "Standard deviation of the navigation's level position, both axes together",
        values: |r| r.seen.and_then(|seen| seen.position_deviation).and_then(number),
    },
    Quantity {
        topic: "law",
        columns: &[("zeta1", "m/s^2"), ("zeta2", "m/s^3"), ("zeta3", "m/s^4"), ("zeta4", "m/s^5")],
        about: "State ζ of the compensator at the sample",
        values: |r| r.decision.map(|decision| decision.zeta),
    },
    Quantity {
        topic: "law",
        columns: &[("speed_error", "m/s")],
        about: "Speed along the path less the wanted speed (h3)",
        values: |r| r.errors.and_then(|[speed, _]| number(speed)),
    },
    Quantity {
        topic: "law",
        columns: &[("yaw_error", "rad")],
        about: "Yaw less the wanted yaw (h4)",
        values: |r| r.errors.and_then(|[_, yaw]| number(yaw)),
    },
    Quantity {
        topic: "law",
        columns: &[("integral1", "h1 s"), ("integral2", "h2 s"), ("integral3", "m")],
        about: "Integrals of the outputs h1, h2, h3",
        values: |r| r.law().and_then(|law| array(law.integral)),
    },
    Quantity {
        topic: "law",
        columns: &[("nu1", "h1/s^6"), ("nu2", "h2/s^6"), ("nu3", "m/s^6"), ("nu4", "rad/s^2")],
        about: "Wanted highest derivatives ν of the outputs",
        values: |r| r.law().map(|law| law.nu),
    },
    Quantity {
        topic: "margins",
        columns: &[("q3", "1"), ("q_b3", "1")],
        about: "q·e3 (rod against the vertical) and q·b3 (thrust against the rod); 0 is singular",
        values: |r| r.margins().map(|margins| [margins.q3, margins.q_b3, 0.0, 0.0]),
    },
    Quantity {
        topic: "margins",
        columns: &[("lambda", "m/s^2")],
        about: "Specific force on the payload along the rod; −g hanging at rest, 0 in free fall",
        values: |r| r.margins().and_then(|margins| number(margins.lambda)),
    },
    Quantity {
        topic: "margins",
        columns: &[("kappa", "1/s^2")],
        about: "T/(m_Q L); 0 without thrust",
        values: |r| r.margins().and_then(|margins| number(margins.kappa)),
    },
    Quantity {
        topic: "margins",
        columns: &[("path_det", "h1 h2/m^2"), ("reach", "1"), ("cos_phi_squared", "1")],
        about: "Regularity of the path's functions, what is left of its reach, and cos²φ; 0 is singular",
        values: |r| r.margins().and_then(|m| array([m.path_det, m.reach, m.cos_phi_squared])),
    },
    Quantity {
        topic: "observers",
        columns: &[("payload_force1", "N"), ("payload_force2", "N"), ("payload_force3", "N")],
        about: "Disturbing force found on the payload, in N",
        values: |r| r.law().and_then(|law| array(law.observed.payload_force)),
    },
    Quantity {
        topic: "observers",
        columns: &[("uav_force1", "N"), ("uav_force2", "N"), ("uav_force3", "N")],
        about: "Disturbing force found on the UAV across the rod, in N",
        values: |r| r.law().and_then(|law| array(law.observed.uav_force)),
    },
    Quantity {
        topic: "observers",
        columns: &[("disturbing_torque1", "N m"), ("disturbing_torque2", "N m"), ("disturbing_torque3", "N m")],
        about: "Disturbing torque found on the UAV, in body axes",
        values: |r| r.law().and_then(|law| array(law.observed.torque)),
    },
    Quantity {
        topic: "observers",
        columns: &[("implied_payload_mass", "kg")],
        about: "Payload's mass that would explain the force along the rod in still air",
        values: |r| r.law().and_then(|law| number(law.observed.payload_mass)),
    },
];

fn vector(v: &Vector3<f64>) -> Numbers {
    array((*v).into())
}

fn array([a, b, c]: [f64; 3]) -> Numbers {
    Some([a, b, c, 0.0])
}

fn number(value: f64) -> Numbers {
    Some([value, 0.0, 0.0, 0.0])
}

/// These of the paper's coordinates.
fn paper(record: &Record, places: [usize; 3]) -> Numbers {
    let x = record.state.to_paper();
    array(places.map(|place| x[place]))
}

/// (w, x, y, z) of a rotation.
fn quaternion(rotation: &Matrix3<f64>) -> Numbers {
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(*rotation);
    let q = nalgebra::UnitQuaternion::from_rotation_matrix(&rotation);
    Some([q.w, q.i, q.j, q.k])
}
