//! Modes, faults and telemetry as the link has them: numbers for programs, words for the pilot.

use core::fmt::Write;

use controller::{Channel, Fault, Margin, Mode, State};
use estimator::Validity;
use link::dialect::{LOAD_TELEMETRY_DATA, LoadFault, LoadMode};

use rig::{LawNumbers, Rig};

use crate::control::{Absence, Notice};
use crate::estimate::Unseen;
use crate::failsafe::Loss;
use crate::mission::Flown;

/// As long as a STATUSTEXT can be.
pub type Text = heapless::String<50>;

pub fn mode(mode: Mode) -> LoadMode {
    match mode {
        Mode::Off => LoadMode::LOAD_MODE_OFF,
        Mode::Idle => LoadMode::LOAD_MODE_IDLE,
        Mode::TakeOff => LoadMode::LOAD_MODE_TAKEOFF,
        Mode::Join => LoadMode::LOAD_MODE_ENGAGE,
        Mode::Follow => LoadMode::LOAD_MODE_FOLLOW,
        Mode::Hold => LoadMode::LOAD_MODE_HOLD,
        Mode::Land => LoadMode::LOAD_MODE_LAND,
        Mode::Fault => LoadMode::LOAD_MODE_FAULT,
        // One that the link has no number for yet flies, but neither joins nor follows.
        _ => LoadMode::LOAD_MODE_HOLD,
    }
}

pub fn margin(margin: Margin) -> LoadFault {
    match margin {
        Margin::RodAngle => LoadFault::LOAD_FAULT_ROD_ANGLE,
        Margin::ThrustAngle => LoadFault::LOAD_FAULT_THRUST_ANGLE,
        Margin::Tension => LoadFault::LOAD_FAULT_TENSION,
        Margin::Thrust => LoadFault::LOAD_FAULT_THRUST,
        Margin::Path => LoadFault::LOAD_FAULT_PATH,
        Margin::Reach => LoadFault::LOAD_FAULT_REACH,
        Margin::Yaw => LoadFault::LOAD_FAULT_YAW,
        _ => LoadFault::LOAD_FAULT_LAW,
    }
}

/// The bit of a fault that stands. A state's, missing or bad, has its bit where it is found, step
/// by step.
pub fn fault(fault: Fault) -> LoadFault {
    match fault {
        Fault::Margin(which) => margin(which),
        Fault::NotFinite => LoadFault::LOAD_FAULT_LAW,
        Fault::NoPath => LoadFault::LOAD_FAULT_NO_PATH,
        Fault::Slack => LoadFault::LOAD_FAULT_TENSION,
        Fault::Caught => LoadFault::LOAD_FAULT_CAUGHT,
        Fault::PayloadLost => LoadFault::LOAD_FAULT_PAYLOAD_LOST,
        Fault::Contradiction => LoadFault::LOAD_FAULT_BAD_STATE,
        _ => LoadFault::empty(),
    }
}

/// What to tell the pilot: the mode, and what keeps it from another. A state's fault that is over
/// is told of where it has led to hold alone.
pub fn text(mode: Mode, fault: Option<Fault>, waits_for: Option<Margin>, absence: Option<Absence>) -> Text {
    let name = match mode {
        Mode::Off => "off",
        Mode::Idle => "idle",
        Mode::TakeOff => "taking off",
        Mode::Join => "joining the path",
        Mode::Follow => "on the path",
        Mode::Hold => "hold",
        Mode::Land => "landing",
        Mode::Fault => "fault",
        _ => "flying",
    };
    let fault = match (fault, absence) {
        (Some(Fault::State(_) | Fault::NoState), None) if mode == Mode::Idle => "",
        (Some(Fault::NoState), Some(Absence::Stale)) => "stale states",
        (Some(Fault::NoState), Some(Absence::Frozen)) => "frozen states",
        (Some(Fault::NoState), Some(Absence::Unseen(unseen))) => unseen_text(unseen),
        (Some(Fault::NoState), _) => "no state",
        (Some(Fault::State(channel)), _) => match channel {
            Channel::Position => "bad position",
            Channel::Velocity => "bad velocity",
            Channel::Rod => "bad rod",
            Channel::RodRate => "bad rod rate",
            Channel::Attitude => "bad attitude",
            Channel::BodyRate => "bad body rate",
            _ => "bad state",
        },
        (Some(Fault::Margin(margin)), _) => margin_text(margin),
        (Some(Fault::NotFinite), _) => "law's answer not finite",
        (Some(Fault::NoPath), _) => "no point of the path found",
        (Some(Fault::Slack), _) => "cable slack, or shorter than VEH_ROD",
        (Some(Fault::PayloadLost), _) => "payload lost",
        (Some(Fault::Contradiction), _) => "load, rod and UAV disagree",
        (Some(Fault::Caught), _) => "UAV hangs from a caught load",
        (Some(_), _) => "another fault",
        (None, _) => "",
    };
    let mut text = Text::new();
    // The longest of each fits.
    let _ = match (fault, waits_for) {
        ("", None) => text.push_str(name).map_err(|_| core::fmt::Error),
        ("", Some(margin)) => write!(text, "{name}: {}, no follow", margin_text(margin)),
        _ => write!(text, "{name}: {fault}"),
    };
    text
}

/// Why it does not know its state.
pub fn unseen_text(unseen: Unseen) -> &'static str {
    match unseen {
        Unseen::Navigation => "no navigation of the UAV",
        Unseen::Imu => "no HIGHRES_IMU",
        Unseen::Fix => "no fix (EST_FIX_T)",
        Unseen::Heading => "no heading",
        Unseen::Rod(Validity::Slack) => "cable slack",
        Unseen::Rod(Validity::Inconsistent) => "thrust disagrees (EST_NOISE)",
        Unseen::Rod(_) => "rod not known yet",
    }
}

fn margin_text(margin: Margin) -> &'static str {
    match margin {
        Margin::RodAngle => "rod too far from vertical",
        Margin::ThrustAngle => "thrust too far from rod",
        Margin::Tension => "rod nearly slack",
        Margin::Thrust => "thrust too small",
        Margin::Path => "path nearly singular",
        Margin::Reach => "out of the path's reach",
        Margin::Yaw => "roll too large for a yaw",
        _ => "outside its envelope",
    }
}

/// What has happened, with the setting that says what is done.
pub fn notice(notice: Notice) -> &'static str {
    match notice {
        Notice::Nothing => "",
        Notice::Killed => "rotors stopped by the kill switch",
        Notice::Blind => "rotors stopped: no state for FS_BLIND_T",
        Notice::Fence => "too near the fence: FNC_ACT",
        Notice::Drifts => "no fix: position drifts",
        Notice::Fixed => "fixes come again",
        Notice::Lost(Loss::Station) => "ground station lost: FS_GCS_ACT",
        Notice::Lost(Loss::Stick) => "stick or radio lost: FS_RC_ACT",
        Notice::Lost(Loss::Battery) => "battery below FS_BAT_PCT: FS_BAT_ACT",
    }
}

/// Where the last command of `rig`, made on `state`, came from, with the `integral` as it was
/// before.
pub fn telemetry(
    sequence: u32,
    rig: &Rig<f32, Flown>,
    state: &State<f32>,
    integral: [f32; 3],
) -> LOAD_TELEMETRY_DATA {
    let rig::Telemetry { law, payload_force, uav_force, torque, payload_mass } = rig.telemetry(state);
    let mut telemetry = LOAD_TELEMETRY_DATA {
        sequence,
        integral: integral.map(number),
        payload_force,
        uav_force,
        uav_torque: torque,
        payload_mass: number(payload_mass),
        warning: rig.output().warning.map_or(LoadFault::empty(), margin),
        ..LOAD_TELEMETRY_DATA::DEFAULT
    };
    if let Some(LawNumbers { xi, nu, margins, .. }) = law {
        telemetry.xi = xi.map(number);
        telemetry.nu = nu.map(number);
        telemetry.q3 = margins.q3;
        telemetry.q_b3 = margins.q_b3;
        telemetry.specific_force = margins.lambda;
        telemetry.kappa = margins.kappa;
        telemetry.path_det = margins.path_det;
        telemetry.reach = margins.reach;
        telemetry.cos_phi_squared = margins.cos_phi_squared;
    }
    telemetry
}

/// A number that is not finite is sent as zero.
pub fn number(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}

/// As much of it as fits.
pub fn cut(what: impl core::fmt::Display) -> Text {
    let mut text = Text::new();
    let _ = write!(Cut(&mut text), "{what}");
    text
}

/// Writes as much as fits.
struct Cut<'a>(&'a mut Text);

impl Write for Cut<'_> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        for character in text.chars() {
            self.0.push(character).map_err(|_| core::fmt::Error)?;
        }
        Ok(())
    }
}
