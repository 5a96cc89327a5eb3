//! The header's structures, field by field. A test compares every size and offset with C's.

use crate::pointer::Sized32;

/// Why a call was refused: `slung_error`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungError {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// The status.
    pub status: i32,
    /// The field's or parameter's name, ended by a zero.
    pub field: [u8; Self::FIELD_BYTES],
    /// What it was given.
    pub value: f32,
    /// The least that it takes.
    pub min: f32,
    /// The largest.
    pub max: f32,
    /// Of a route, from 0; negative: none.
    pub waypoint: i32,
}

impl SlungError {
    /// Bytes of a field's name, with the zero that ends it.
    pub const FIELD_BYTES: usize = 32;
}

// SAFETY: the first field is a u32; so with those below.
unsafe impl Sized32 for SlungError {}

/// An entry of the table of parameters: `slung_parameter`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungParameter {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// Its value where it is not set.
    pub default_value: f32,
    /// The least value.
    pub min: f32,
    /// The largest value.
    pub max: f32,
    /// Ended by a zero.
    pub name: [u8; 20],
    /// SI, ended by a zero.
    pub unit: [u8; 20],
    /// What it means, ended by a zero, cut where it is longer.
    pub text: [u8; 160],
}

// SAFETY: as above.
unsafe impl Sized32 for SlungParameter {}

/// The UAV as its navigation reports it: `slung_uav`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungUav {
    /// m.
    pub position_world_m: [f32; 3],
    /// m/s.
    pub velocity_world_m_s: [f32; 3],
    /// w, x, y, z, from body to world.
    pub quaternion_body_to_world: [f32; 4],
    /// rad/s.
    pub body_rate_rad_s: [f32; 3],
}

/// The state that the law is stepped on: `slung_state`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungState {
    /// Of the payload, in N, m.
    pub payload_position_ned_m: [f32; 3],
    /// m/s.
    pub payload_velocity_ned_m_s: [f32; 3],
    /// Unit vector from UAV to payload, in N.
    pub rod_ned: [f32; 3],
    /// 1/s.
    pub rod_rate_ned_1_s: [f32; 3],
    /// Row by row, B to N.
    pub attitude_frd_to_ned: [f32; 9],
    /// rad/s.
    pub body_rate_frd_rad_s: [f32; 3],
}

/// Thrust and torque: `slung_wrench`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungWrench {
    /// Along −b3, N.
    pub thrust_n: f32,
    /// About b1, b2, b3, N·m.
    pub torque_frd_n_m: [f32; 3],
}

/// How far a route is flown: `slung_progress`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungProgress {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// From stop to stop, counted from 0.
    pub run: u32,
    /// How many there are.
    pub runs: u32,
    /// 1 while the payload rests at a stop.
    pub rests: u32,
    /// 1 once it has rested at the last for as long as it is to.
    pub is_over: u32,
    /// What the prescribed speed is multiplied by.
    pub speed_factor: f32,
    /// The route's point nearest to the payload, in N, m.
    pub nearest_ned_m: [f32; 3],
}

// SAFETY: as above.
unsafe impl Sized32 for SlungProgress {}

/// A step's answer: `slung_output`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungOutput {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// `slung_mode`.
    pub mode: u32,
    /// `slung_fault`.
    pub fault: u32,
    /// `slung_warning`.
    pub warning: u32,
    /// 1 if limits or rotors gave less than the law asked for.
    pub limited: u32,
    /// N.
    pub thrust_n: f32,
    /// N·m.
    pub torque_frd_n_m: [f32; 3],
    /// rad/s².
    pub angular_acceleration_frd_rad_s2: [f32; 3],
    /// rad/s.
    pub body_rate_setpoint_frd_rad_s: [f32; 3],
    /// Share of the rotors' largest.
    pub thrust_normalized: f32,
    /// Shares of the rotors' largest.
    pub torque_normalized_frd: [f32; 3],
    /// Speeds as shares of the largest.
    pub rotor: [f32; 4],
}

// SAFETY: as above.
unsafe impl Sized32 for SlungOutput {}

/// Where a command came from: `slung_telemetry`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungTelemetry {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// 1 if the law flew, and the numbers up to the margins are its own.
    pub law_flew: u32,
    /// The outputs and their derivatives.
    pub xi: [f32; 20],
    /// ν.
    pub nu: [f32; 4],
    /// m/s⁶.
    pub u_zeta_m_s6: f32,
    /// ζ, m/s²⁺ᵏ.
    pub zeta: [f32; 4],
    /// q·e3.
    pub margin_rod: f32,
    /// q·b3.
    pub margin_thrust_axis: f32,
    /// λ, m/s².
    pub margin_lambda_m_s2: f32,
    /// κ, 1/s².
    pub margin_kappa_1_s2: f32,
    /// The path's determinant.
    pub margin_path: f32,
    /// What is left of the path's reach.
    pub margin_reach: f32,
    /// N.
    pub payload_force_ned_n: [f32; 3],
    /// N.
    pub uav_force_ned_n: [f32; 3],
    /// N·m.
    pub torque_frd_n_m: [f32; 3],
    /// kg.
    pub implied_payload_mass_kg: f32,
}

// SAFETY: as above.
unsafe impl Sized32 for SlungTelemetry {}

/// A point of a route: `slung_waypoint`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungWaypoint {
    /// In N, m.
    pub point_ned_m: [f32; 3],
    /// Where a corner's blend begins, m; 0: the curve passes smoothly through the point.
    pub corner_m: f32,
    /// m/s.
    pub speed_m_s: f32,
    /// Not a number: along the route.
    pub yaw_rad: f32,
    /// How long it rests here, s; negative: it passes.
    pub stop_s: f32,
}

/// How a route is sped up and slowed down: `slung_pace`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungPace {
    /// Along the route and across it, m/s².
    pub acceleration_m_s2: f32,
    /// Speed over distance near a stop, 1/s.
    pub stop_rate_1_s: f32,
    /// s.
    pub rise_s: f32,
}

/// Where things sit, and drag: `slung_mounting`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungMounting {
    /// From the centre of mass, m.
    pub hook_frd_m: [f32; 3],
    /// From the centre of mass, m.
    pub imu_frd_m: [f32; 3],
    /// Linear and quadratic.
    pub uav_drag: [f32; 2],
    /// Linear and quadratic.
    pub payload_drag: [f32; 2],
}

/// What an estimator has found: `slung_estimate`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungEstimate {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// `slung_validity`.
    pub validity: u32,
    /// 1 while the cable pulls.
    pub taut: u32,
    /// N.
    pub tension_n: f32,
    /// Of the rod's direction, rad.
    pub rod_deviation_rad: f32,
    /// Of its rate, 1/s.
    pub rate_deviation_1_s: f32,
    /// The law's state.
    pub state: SlungState,
    /// The step's UAV as it goes beside it, in the step's axes; not a number where none was given.
    pub uav: SlungUav,
}

// SAFETY: as above.
unsafe impl Sized32 for SlungEstimate {}

impl SlungEstimate {
    /// Bytes of the first version, which ended with the state.
    pub const FIRST: u32 = core::mem::offset_of!(Self, uav) as u32;
}

/// What a navigation filter is told: `slung_navigation_settings`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungNavigationSettings {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// From the centre of mass, m.
    pub imu_frd_m: [f32; 3],
    /// From the centre of mass, m.
    pub antenna_frd_m: [f32; 3],
    /// From n1 toward n2, rad.
    pub declination_rad: f32,
    /// m/s²/√Hz.
    pub accelerometer_m_s2_rthz: f32,
    /// rad/s/√Hz.
    pub gyro_rad_s_rthz: f32,
    /// m/s²/√s.
    pub accelerometer_walk_m_s2_rts: f32,
    /// rad/s/√s.
    pub gyro_walk_rad_s_rts: f32,
    /// Horizontal and down, m.
    pub fix_position_m: [f32; 2],
    /// Horizontal and down, m/s.
    pub fix_velocity_m_s: [f32; 2],
    /// rad.
    pub heading_rad: f32,
    /// m.
    pub barometer_m: f32,
    /// s.
    pub barometer_time_s: f32,
    /// m.
    pub start_position_m: f32,
    /// m/s.
    pub start_velocity_m_s: f32,
    /// rad.
    pub start_tilt_rad: f32,
    /// rad.
    pub start_heading_rad: f32,
    /// rad/s.
    pub start_gyro_rad_s: f32,
    /// m/s².
    pub start_accelerometer_m_s2: f32,
}

// SAFETY: as above.
unsafe impl Sized32 for SlungNavigationSettings {}

/// A fix of a receiver or of motion capture: `slung_fix`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungFix {
    /// Three times not a number: not measured.
    pub position_world_m: [f32; 3],
    /// Likewise.
    pub velocity_world_m_s: [f32; 3],
    /// Horizontal and vertical.
    pub position_deviation_m: [f32; 2],
    /// Horizontal and vertical.
    pub velocity_deviation_m_s: [f32; 2],
    /// s.
    pub age_s: f32,
}

/// What navigation has found: `slung_navigated`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SlungNavigated {
    /// Bytes of this structure as the caller knows it.
    pub struct_size: u32,
    /// 1 while the IMU has been silent for more than 50 periods.
    pub blind: u32,
    /// How often the filter has started anew from a fix.
    pub resets: u32,
    /// Since the last fix that was taken, s.
    pub fix_age_s: f32,
    /// Horizontal, both axes together, m.
    pub position_deviation_m: f32,
    /// m/s.
    pub velocity_deviation_m_s: f32,
    /// Of the attitude's tilt, rad.
    pub tilt_deviation_rad: f32,
    /// Found, in the body axes of the call.
    pub gyro_bias_body_rad_s: [f32; 3],
    /// Likewise.
    pub accelerometer_bias_body_m_s2: [f32; 3],
    /// The period's mean less its bias.
    pub specific_force_body_m_s2: [f32; 3],
    /// The UAV at the period's end.
    pub uav: SlungUav,
}

// SAFETY: as above.
unsafe impl Sized32 for SlungNavigated {}
