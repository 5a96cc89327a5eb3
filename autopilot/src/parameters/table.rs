//! The table: what each parameter is called, means and may be.

use super::Entry;

macro_rules! parameters {
    ($($(#[doc = $doc:literal])+ $variant:ident $name:literal = $default:expr, $min:expr, $max:expr;)*) => {
        /// A parameter, as an index into the table.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        pub enum Parameter {
            $($(#[doc = $doc])+ $variant,)*
        }

        /// All parameters, in the order of [`Parameter`].
        pub(super) const TABLE: &[Entry] = &[$(Entry { name: $name, default: $default, min: $min, max: $max },)*];
    };
}

/// Gains are limited only by what a float holds: the law itself refuses those that make no stable loop.
const GAIN: f32 = 1e9;

// The gains' defaults are the poles −1, −2, … of each chain, spread as they should be in flight.
parameters! {
    /// Fingerprint of the link's dialect. Read-only.
    Dialect "LINK_DIALECT" = link::FINGERPRINT as f32, link::FINGERPRINT as f32, link::FINGERPRINT as f32;
    /// What drives the control step: 0 the timer, with the rotors on; 1 state frames (lockstep), 2 the timer, both with the rotors off.
    Simulate "SYS_SIM" = 0.0, 0.0, 2.0;
    /// Steps between two telemetry frames; 0 for none.
    TelemetryEvery "TLM_EVERY" = 50.0, 0.0, 1e6;
    /// Control period, s.
    Period "CTL_PERIOD" = 0.002, 5e-4, 0.2;
    /// Known time from the state's sample to its command's start, s.
    Latency "CTL_LATENCY" = 0.0, 0.0, 0.5;
    /// Known time constant of the rotors, s.
    RotorLag "CTL_LAG" = 0.0, 0.0, 0.5;
    /// 1: evaluate the law for the middle of the coming hold; 0: at the sample.
    LookAhead "CTL_AHEAD" = 1.0, 0.0, 1.0;
    /// The law: 0 path following, 1 trajectory tracking.
    Law "CTL_LAW" = 0.0, 0.0, 1.0;

    /// Payload mass, kg.
    PayloadMass "VEH_M_LOAD" = 0.5, 1e-3, 1e3;
    /// UAV mass without the payload, kg.
    UavMass "VEH_M_UAV" = 2.5, 1e-2, 1e3;
    /// Rod length, m.
    RodLength "VEH_ROD" = 2.0, 0.05, 100.0;
    /// Moment of inertia about b1, kg·m².
    Inertia1 "VEH_J1" = 0.03, 1e-6, 1e3;
    /// Moment of inertia about b2, kg·m².
    Inertia2 "VEH_J2" = 0.03, 1e-6, 1e3;
    /// Moment of inertia about b3, kg·m².
    Inertia3 "VEH_J3" = 0.05, 1e-6, 1e3;
    /// Gravity, m/s².
    Gravity "VEH_G" = 9.81, 0.1, 30.0;

    /// The curve: 0 circle, 1 ellipse, 2 bent, 3 superellipse, 4 tilted, 5 Fourier, each as in the controller.
    PathKind "PATH_KIND" = 0.0, 0.0, 5.0;
    /// Speed along the curve, m/s; negative flies it the other way.
    PathSpeed "PATH_SPEED" = 1.0, -50.0, 50.0;
    /// Largest centripetal acceleration, m/s²: slower where the curve bends. 0: the same speed everywhere.
    PathAcceleration "PATH_ACC" = 0.0, 0.0, 100.0;
    /// Yaw along the path: 0 fixed, 1 along the tangent, 2 towards a vertical line.
    PathYawKind "PATH_YAW_KIND" = 0.0, 0.0, 2.0;
    /// Fixed yaw, rad.
    PathYaw "PATH_YAW" = 0.0, -10.0, 10.0;
    /// p1 of the line that the nose points to, m.
    PathYawX "PATH_YAW_X" = 0.0, -1e5, 1e5;
    /// Its p2, m.
    PathYawY "PATH_YAW_Y" = 0.0, -1e5, 1e5;
    /// Circle, of the path or of the tracking law's reference: radius, m.
    PathRadius "PATH_RADIUS" = 5.0, 0.01, 1e5;
    /// Circle: p3, m (negative is above the origin).
    PathP3 "PATH_P3" = -10.0, -1e5, 1e5;
    /// Ellipse, bent, superellipse, tilted: half axis a, m.
    PathA "PATH_A" = 5.0, 0.01, 1e5;
    /// Half axis b, m.
    PathB "PATH_B" = 4.0, 0.01, 1e5;
    /// Ellipse, bent, superellipse: height c0, m.
    PathC0 "PATH_C0" = -10.0, -1e5, 1e5;
    /// Ellipse, superellipse: slope c1.
    PathC1 "PATH_C1" = 0.0, -100.0, 100.0;
    /// Superellipse: half its exponent.
    PathHalfExponent "PATH_EXP2" = 2.0, 1.0, 255.0;
    /// Tilted, Fourier: centre, n1, m.
    PathCenter1 "PATH_CTR_1" = 0.0, -1e5, 1e5;
    /// n2.
    PathCenter2 "PATH_CTR_2" = 0.0, -1e5, 1e5;
    /// n3.
    PathCenter3 "PATH_CTR_3" = -10.0, -1e5, 1e5;
    /// Tilted: the normal; Fourier: the direction that its normals are counted from; of any length. n1.
    PathNormal1 "PATH_NRM_1" = 0.0, -1e5, 1e5;
    /// n2.
    PathNormal2 "PATH_NRM_2" = 0.0, -1e5, 1e5;
    /// n3.
    PathNormal3 "PATH_NRM_3" = 1.0, -1e5, 1e5;
    /// Tilted: direction of the half axis a, of any length. n1.
    PathMajor1 "PATH_MAJ_1" = 1.0, -1e5, 1e5;
    /// n2.
    PathMajor2 "PATH_MAJ_2" = 0.0, -1e5, 1e5;
    /// n3.
    PathMajor3 "PATH_MAJ_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 1 along n1, m.
    Cos11 "FOU_C1_1" = 5.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 1 along n2, m.
    Cos12 "FOU_C1_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 1 along n3, m.
    Cos13 "FOU_C1_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 2 along n1, m.
    Cos21 "FOU_C2_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 2 along n2, m.
    Cos22 "FOU_C2_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 2 along n3, m.
    Cos23 "FOU_C2_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 3 along n1, m.
    Cos31 "FOU_C3_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 3 along n2, m.
    Cos32 "FOU_C3_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 3 along n3, m.
    Cos33 "FOU_C3_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 4 along n1, m.
    Cos41 "FOU_C4_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 4 along n2, m.
    Cos42 "FOU_C4_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 4 along n3, m.
    Cos43 "FOU_C4_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 5 along n1, m.
    Cos51 "FOU_C5_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 5 along n2, m.
    Cos52 "FOU_C5_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 5 along n3, m.
    Cos53 "FOU_C5_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 6 along n1, m.
    Cos61 "FOU_C6_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 6 along n2, m.
    Cos62 "FOU_C6_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 6 along n3, m.
    Cos63 "FOU_C6_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 7 along n1, m.
    Cos71 "FOU_C7_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 7 along n2, m.
    Cos72 "FOU_C7_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 7 along n3, m.
    Cos73 "FOU_C7_3" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 8 along n1, m.
    Cos81 "FOU_C8_1" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 8 along n2, m.
    Cos82 "FOU_C8_2" = 0.0, -1e5, 1e5;
    /// Fourier: cosine of harmonic 8 along n3, m.
    Cos83 "FOU_C8_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 1 along n1, m.
    Sin11 "FOU_S1_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 1 along n2, m.
    Sin12 "FOU_S1_2" = 5.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 1 along n3, m.
    Sin13 "FOU_S1_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 2 along n1, m.
    Sin21 "FOU_S2_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 2 along n2, m.
    Sin22 "FOU_S2_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 2 along n3, m.
    Sin23 "FOU_S2_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 3 along n1, m.
    Sin31 "FOU_S3_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 3 along n2, m.
    Sin32 "FOU_S3_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 3 along n3, m.
    Sin33 "FOU_S3_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 4 along n1, m.
    Sin41 "FOU_S4_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 4 along n2, m.
    Sin42 "FOU_S4_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 4 along n3, m.
    Sin43 "FOU_S4_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 5 along n1, m.
    Sin51 "FOU_S5_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 5 along n2, m.
    Sin52 "FOU_S5_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 5 along n3, m.
    Sin53 "FOU_S5_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 6 along n1, m.
    Sin61 "FOU_S6_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 6 along n2, m.
    Sin62 "FOU_S6_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 6 along n3, m.
    Sin63 "FOU_S6_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 7 along n1, m.
    Sin71 "FOU_S7_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 7 along n2, m.
    Sin72 "FOU_S7_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 7 along n3, m.
    Sin73 "FOU_S7_3" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 8 along n1, m.
    Sin81 "FOU_S8_1" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 8 along n2, m.
    Sin82 "FOU_S8_2" = 0.0, -1e5, 1e5;
    /// Fourier: sine of harmonic 8 along n3, m.
    Sin83 "FOU_S8_3" = 0.0, -1e5, 1e5;
    /// Tracking law's circle: angular rate, rad/s.
    ReferenceRate "REF_RATE" = 1.0, -50.0, 50.0;

    /// Following: gain of h1, or tracking: of the error of p1.
    K1D0 "K1_0" = 720.0, -GAIN, GAIN;
    /// Of its derivative.
    K1D1 "K1_1" = 1764.0, -GAIN, GAIN;
    /// Of order 2.
    K1D2 "K1_2" = 1624.0, -GAIN, GAIN;
    /// Of order 3.
    K1D3 "K1_3" = 735.0, -GAIN, GAIN;
    /// Of order 4.
    K1D4 "K1_4" = 175.0, -GAIN, GAIN;
    /// Of order 5.
    K1D5 "K1_5" = 21.0, -GAIN, GAIN;
    /// Following: gain of h2, or tracking: of the error of p2.
    K2D0 "K2_0" = 720.0, -GAIN, GAIN;
    /// Of its derivative.
    K2D1 "K2_1" = 1764.0, -GAIN, GAIN;
    /// Of order 2.
    K2D2 "K2_2" = 1624.0, -GAIN, GAIN;
    /// Of order 3.
    K2D3 "K2_3" = 735.0, -GAIN, GAIN;
    /// Of order 4.
    K2D4 "K2_4" = 175.0, -GAIN, GAIN;
    /// Of order 5.
    K2D5 "K2_5" = 21.0, -GAIN, GAIN;
    /// Following: gain of h3, or tracking: of the error of p3.
    K3D0 "K3_0" = 120.0, -GAIN, GAIN;
    /// Of its derivative.
    K3D1 "K3_1" = 274.0, -GAIN, GAIN;
    /// Of order 2.
    K3D2 "K3_2" = 225.0, -GAIN, GAIN;
    /// Of order 3.
    K3D3 "K3_3" = 85.0, -GAIN, GAIN;
    /// Of order 4.
    K3D4 "K3_4" = 15.0, -GAIN, GAIN;
    /// Of order 5; tracking only.
    K3D5 "K3_5" = 0.0, -GAIN, GAIN;
    /// Gain of the yaw error.
    K4D0 "K4_0" = 6.0, -GAIN, GAIN;
    /// Of its derivative.
    K4D1 "K4_1" = 5.0, -GAIN, GAIN;
    /// Integral gain of h1; following only.
    KI1 "KI_1" = 0.0, 0.0, GAIN;
    /// Of h2.
    KI2 "KI_2" = 0.0, 0.0, GAIN;
    /// Of h3.
    KI3 "KI_3" = 0.0, 0.0, GAIN;

    /// Bandwidth of the observer of the force on the payload, rad/s; 0 is off, here and below.
    ObserverPayload "OBS_W_LOAD" = 4.0, 0.0, 100.0;
    /// Of the rod's acceleration beyond the model's, rad/s.
    ObserverRod "OBS_W_ROD" = 4.0, 0.0, 100.0;
    /// Of the torque on the UAV, rad/s.
    ObserverTorque "OBS_W_TAU" = 4.0, 0.0, 100.0;
    /// Largest force on the payload that it may find, as an acceleration, m/s².
    ObserverPayloadBound "OBS_MAX_LOAD" = 15.0, 0.0, 1e3;
    /// Largest acceleration of the rod, 1/s².
    ObserverRodBound "OBS_MAX_ROD" = 10.0, 0.0, 1e3;
    /// Largest torque, N·m.
    ObserverTorqueBound "OBS_MAX_TAU" = 1.0, 0.0, 1e3;

    /// Envelope, a warning and a limit each: angle of the rod from the vertical, rad.
    RodAngleWarning "ENV_ROD_WARN" = 0.96, 0.0, 1.5;
    /// Beyond it the law is left for hold, rad; so with each limit below.
    RodAngleLimit "ENV_ROD_LIM" = 1.22, 0.05, 1.5;
    /// Angle of the thrust axis from the rod, rad.
    ThrustAngleWarning "ENV_AXIS_WARN" = 0.96, 0.0, 1.5;
    /// Its limit.
    ThrustAngleLimit "ENV_AXIS_LIM" = 1.22, 0.05, 1.5;
    /// Roll of the yaw's chart, rad.
    RollWarning "ENV_ROLL_WARN" = 0.96, 0.0, 1.5;
    /// Its limit.
    RollLimit "ENV_ROLL_LIM" = 1.22, 0.05, 1.5;
    /// Tension of the rod, N, up to the payload's weight.
    TensionWarning "ENV_TENS_WARN" = 1.2, 0.0, 1e4;
    /// Its limit.
    TensionLimit "ENV_TENS_LIM" = 0.5, 0.0, 1e4;
    /// Thrust, N, up to hover's.
    ThrustWarning "ENV_T_WARN" = 7.4, 0.0, 1e4;
    /// Its limit.
    ThrustLimit "ENV_T_LIM" = 2.9, 0.0, 1e4;
    /// Determinant of the path's system, as a share of its value on the path.
    PathWarning "ENV_PATH_WARN" = 0.2, 0.0, 1.0;
    /// Its limit.
    PathLimit "ENV_PATH_LIM" = 0.1, 0.0, 1.0;
    /// What is left of the path's reach, as a share.
    ReachWarning "ENV_REACH_WARN" = 0.2, 0.0, 1.0;
    /// Its limit.
    ReachLimit "ENV_REACH_LIM" = 0.05, 0.0, 1.0;

    /// Joining the path: speed of the slide, m/s.
    ApproachSpeed "APP_SPEED" = 3.0, 0.01, 100.0;
    /// Its acceleration, m/s².
    ApproachAcceleration "APP_ACC" = 1.5, 0.01, 100.0;
    /// Tilt of the thrust, rad.
    ApproachTilt "APP_TILT" = 0.35, 0.01, 1.2;
    /// Angle of the rod from the vertical, rad.
    ApproachRodAngle "APP_ROD" = 0.35, 0.01, 1.2;
    /// Least thrust, N, below hover's.
    ApproachThrustMin "APP_T_MIN" = 20.6, 0.0, 1e4;
    /// Largest thrust, N, above hover's.
    ApproachThrustMax "APP_T_MAX" = 38.3, 0.1, 1e4;

    /// How long the last command goes on without a good state, s. The tracking law has no such time.
    Coast "POL_COAST" = 0.1, 0.0, 10.0;
    /// Then: thrust as a share of hover's, without torque, until a good state; negative: rotors cut, until disarmed.
    Sink "POL_SINK" = 0.9, -1.0, 1.0;
    /// 1: go back to the path by itself, from hold; 0: once it is asked for again.
    Resume "POL_RESUME" = 1.0, 0.0, 1.0;
    /// How long the vehicle must have been calm before it does, s.
    Calm "POL_CALM" = 1.0, 0.0, 100.0;
    /// Speed of a landing, m/s.
    Descent "POL_DESCENT" = 0.5, 0.01, 10.0;
    /// Share of the payload's mass below which it counts as lost; negative: never.
    PayloadLost "POL_LOAD_LOST" = 0.3, -1.0, 0.95;

    /// Least thrust that the law may ask for in flight, N. Roll and pitch may need more or less of it.
    ThrustMin "LIM_T_MIN" = 0.0, 0.0, 1e4;
    /// Largest thrust, N; likewise.
    ThrustMax "LIM_T_MAX" = 60.0, 0.1, 1e4;
    /// Largest torque about b1, N·m.
    TorqueMax1 "LIM_TAU_1" = 3.0, 0.0, 1e3;
    /// About b2.
    TorqueMax2 "LIM_TAU_2" = 3.0, 0.0, 1e3;
    /// About b3.
    TorqueMax3 "LIM_TAU_3" = 1.0, 0.0, 1e3;

    /// Rotor's distance from the axes b1 and b2 (X configuration), m.
    RotorArm "ROT_ARM" = 0.25, 0.01, 10.0;
    /// Rotor's thrust over its speed squared, N/(rad/s)².
    RotorThrust "ROT_KT" = 2e-5, 1e-10, 1.0;
    /// Rotor's drag torque over its speed squared, N·m/(rad/s)².
    RotorTorque "ROT_KQ" = 4e-7, 1e-12, 1.0;
    /// Speed of an armed rotor at least, rad/s.
    RotorSpeedMin "ROT_W_MIN" = 100.0, 0.0, 1e5;
    /// Rotor's speed at full command, rad/s; at most 0.9 of it may be the least.
    RotorSpeedMax "ROT_W_MAX" = 1100.0, 1.0, 1e5;
}
