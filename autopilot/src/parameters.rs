//! The parameters, by the names that MAVLink's parameter protocol gives them. All are floats.

/// A parameter's name and what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// At most 16 characters.
    pub name: &'static str,
    /// Value after a reset.
    pub default: f32,
    /// Least allowed value.
    pub min: f32,
    /// Largest allowed value.
    pub max: f32,
}

/// Why a parameter was not set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// There is none of that name.
    Unknown,
    /// The value is outside the parameter's range, or no number.
    OutOfRange,
}

macro_rules! parameters {
    ($($(#[doc = $doc:literal])+ $variant:ident $name:literal = $default:expr, $min:expr, $max:expr;)*) => {
        /// A parameter, as an index into the table.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        pub enum Parameter {
            $($(#[doc = $doc])+ $variant,)*
        }

        /// All parameters, in the order of [`Parameter`].
        const TABLE: &[Entry] = &[$(Entry { name: $name, default: $default, min: $min, max: $max },)*];
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

    /// Least thrust that is commanded in flight, N.
    ThrustMin "LIM_T_MIN" = 0.0, 0.0, 1e4;
    /// Largest thrust, N.
    ThrustMax "LIM_T_MAX" = 100.0, 0.1, 1e4;
    /// Largest torque about each axis, N·m.
    TorqueMax "LIM_TAU" = 10.0, 1e-3, 1e3;
    /// How long the last command is held when states stop coming or can't be used, s.
    HoldTime "HOLD_TIME" = 0.1, 0.0, 10.0;
    /// The safe command after that: this thrust, N, without torque. The default lets Table I's vehicle sink slowly.
    SafeThrust "SAFE_THRUST" = 28.0, 0.0, 1e4;

    /// Rotor's distance from the axes b1 and b2 (X configuration), m.
    RotorArm "ROT_ARM" = 0.25, 0.01, 10.0;
    /// Rotor's drag torque over its thrust, m.
    RotorDrag "ROT_DRAG" = 0.05, 1e-4, 1.0;
    /// Rotor's thrust at full command, N.
    RotorThrust "ROT_F_MAX" = 25.0, 0.1, 1e4;
}

/// The table's values.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters([f32; TABLE.len()]);

impl Default for Parameters {
    fn default() -> Self {
        Self(core::array::from_fn(|index| TABLE.get(index).map_or(0.0, |entry| entry.default)))
    }
}

impl Parameters {
    /// How many there are.
    pub const COUNT: usize = TABLE.len();

    /// A value.
    #[must_use]
    pub fn get(&self, parameter: Parameter) -> f32 {
        self.0.get(parameter as usize).copied().unwrap_or_default()
    }

    /// Sets a value in code, where its range is known to hold: a value outside is moved to the range's end.
    pub fn set(&mut self, parameter: Parameter, value: f32) {
        if let (Some(slot), Some(entry)) = (self.0.get_mut(parameter as usize), TABLE.get(parameter as usize)) {
            *slot = if value >= entry.min { value.min(entry.max) } else { entry.min };
        }
    }

    /// Sets a value by name. Returns its index.
    ///
    /// # Errors
    /// [`Refused`]; the value is then what it was.
    pub fn set_by_name(&mut self, name: &str, value: f32) -> Result<usize, Refused> {
        let index = Self::index(name).ok_or(Refused::Unknown)?;
        let entry = TABLE.get(index).ok_or(Refused::Unknown)?;
        if !(value >= entry.min && value <= entry.max) {
            return Err(Refused::OutOfRange);
        }
        *self.0.get_mut(index).ok_or(Refused::Unknown)? = value;
        Ok(index)
    }

    /// Where the parameter of that name stands.
    #[must_use]
    pub fn index(name: &str) -> Option<usize> {
        TABLE.iter().position(|entry| entry.name == name)
    }

    /// The entry and value at an index.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<(&'static Entry, f32)> {
        Some((TABLE.get(index)?, *self.0.get(index)?))
    }

    /// All entries with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Entry, f32)> + '_ {
        TABLE.iter().zip(self.0)
    }

    /// A run of consecutive parameters from `first` on, as the gains of one output are.
    #[must_use]
    pub(crate) fn run<const N: usize>(&self, first: Parameter) -> [f32; N] {
        core::array::from_fn(|offset| self.0.get(first as usize + offset).copied().unwrap_or_default())
    }

    /// Sets a run of consecutive parameters from `first` on.
    ///
    /// # Errors
    /// [`Refused::OutOfRange`] at the first value outside its range.
    pub fn set_run(&mut self, first: Parameter, values: &[f32]) -> Result<(), Refused> {
        for (offset, &value) in values.iter().enumerate() {
            let entry = TABLE.get(first as usize + offset).ok_or(Refused::Unknown)?;
            self.set_by_name(entry.name, value)?;
        }
        Ok(())
    }
}

const _: () = {
    let mut index = 0;
    while index < TABLE.len() {
        #[allow(clippy::indexing_slicing)]
        let entry = &TABLE[index];
        assert!(entry.name.len() <= 16, "a MAVLink parameter's name has at most 16 characters");
        assert!(entry.min <= entry.default && entry.default <= entry.max);
        index += 1;
    }
};
