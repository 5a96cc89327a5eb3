//! All parameters by the names that MAVLink's parameter protocol gives them: the program's own,
//! then the controller's.

use rig::{Entry, Parameter, Parameters, Refused, Tabled as _};

use crate::estimate::params;

const ACTIONS: &[&str] = &["nothing", "hold", "land"];
const CHANNEL: (f64, f64) = (0.0, 18.0);
const BUTTON: (f64, f64) = (0.0, 32.0);

const PROGRAM: &[Entry<f64>] = &[
    Entry::real(
        "LINK_DIALECT",
        "dialect",
        "",
        link::FINGERPRINT as f64,
        (link::FINGERPRINT as f64, link::FINGERPRINT as f64),
        "Fingerprint of the link's dialect. Read-only.",
    ),
    Entry::choice(
        "SYS_SIM",
        "drive",
        &["timer, rotors on", "state frames (lockstep), rotors off", "timer, rotors off"],
        0,
        "What drives the control step.",
    ),
    Entry::whole("TLM_EVERY", "every", 50.0, (0.0, 1e6), "Steps between two telemetry frames; 0 for none."),
    Entry::real(
        "ARM_THRUST",
        "share",
        "",
        1.6,
        (1.0, 10.0),
        "Share of the hover thrust that limits and rotors must give, for arming.",
    ),
    Entry::real(
        "FS_GCS_T",
        "timeout",
        "s",
        5.0,
        (0.0, 600.0),
        "A ground station that was heard and is silent for so long is lost; 0: never.",
    ),
    Entry::choice("FS_GCS_ACT", "action", ACTIONS, 1, "What to do when the ground station is lost."),
    Entry::real(
        "FS_RC_T",
        "timeout",
        "s",
        1.0,
        (0.0, 600.0),
        "A stick or radio that was heard and is silent for so long is lost; 0: never.",
    ),
    Entry::choice("FS_RC_ACT", "action", ACTIONS, 1, "What to do when the stick or radio is lost."),
    Entry::whole("FS_BAT_PCT", "least", 15.0, (0.0, 100.0), "The battery is low below this many percent; 0: never."),
    Entry::choice("FS_BAT_ACT", "action", ACTIONS, 2, "What to do when the battery is low."),
    Entry::real(
        "FS_BLIND_T",
        "timeout",
        "s",
        20.0,
        (1.0, 600.0),
        "In fault, or idle without a state, the rotors stop after so long.",
    ),
    Entry::whole(
        "RC_MODE_CH",
        "channel",
        0.0,
        CHANNEL,
        "Channel of the mode switch: land below 1300 us, follow above 1700 us, hold between; 0: none.",
    ),
    Entry::whole("RC_KILL_CH", "channel", 0.0, CHANNEL, "Channel that stops the rotors above 1700 us; 0: none."),
    Entry::whole("RC_BTN_HOLD", "button", 0.0, BUTTON, "Joystick's button for hold; 0: none, here and below."),
    Entry::whole("RC_BTN_FOLLOW", "button", 0.0, BUTTON, "Joystick's button for follow."),
    Entry::whole("RC_BTN_LAND", "button", 0.0, BUTTON, "Joystick's button for land."),
    Entry::whole("RC_BTN_KILL", "button", 0.0, BUTTON, "Joystick's button that stops the rotors."),
    Entry::real("MIS_SPEED", "speed", "m/s", 2.0, (0.05, 100.0), "Missions: speed where no item says one."),
    Entry::real(
        "MIS_CORNER",
        "corner",
        "m",
        2.0,
        (0.02, 1e3),
        "Missions: how far from a waypoint its corner's blend begins, where the item says nothing.",
    ),
    Entry::real(
        "MIS_ACC",
        "acceleration",
        "m/s^2",
        1.0,
        (0.05, 20.0),
        "Missions: bound of the load's acceleration along the route and across it.",
    ),
    Entry::real(
        "FNC_MARGIN",
        "margin",
        "m",
        1.0,
        (0.0, 100.0),
        "What a mission's load, UAV and cable keep from the fence; in flight half of it.",
    ),
    Entry::real(
        "FNC_UP_MIN",
        "low",
        "m",
        -1e5,
        (-1e5, 1e5),
        "Fence: least height above home of what is to be stayed in.",
    ),
    Entry::real(
        "FNC_UP_MAX",
        "high",
        "m",
        1e5,
        (-1e5, 1e5),
        "Fence: largest height above home of what is to be stayed in.",
    ),
    Entry::choice("FNC_ACT", "action", ACTIONS, 1, "What to do when the fence is not kept in flight."),
];
/// The program's own, one group behind the other.
const GROUPS: &[&[Entry<f64>]] = &[PROGRAM, params::ENTRIES];
const OWN: [Entry<f64>; PROGRAM.len() + params::ENTRIES.len()] = rig::concatenated(GROUPS);
static TABLE: [Entry; OWN.len()] = rig::narrowed(&OWN);

/// One of the program's own parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting(usize);

impl Setting {
    /// `SYS_SIM`: what drives the control step, a [`Drive`](crate::Drive).
    pub const DRIVE: Self = Self::named("SYS_SIM");
    /// `TLM_EVERY`: steps between two telemetry frames.
    pub const TELEMETRY_EVERY: Self = Self::named("TLM_EVERY");
    /// `ARM_THRUST`: the share of the hover thrust that must be there for arming.
    pub const ARMING_THRUST: Self = Self::named("ARM_THRUST");
    /// `FS_GCS_T`: after how long a ground station is lost, s.
    pub const STATION_TIMEOUT: Self = Self::named("FS_GCS_T");
    /// `FS_GCS_ACT`: what is done then.
    pub const STATION_ACTION: Self = Self::named("FS_GCS_ACT");
    /// `FS_RC_T`: after how long a stick or radio is lost, s.
    pub const STICK_TIMEOUT: Self = Self::named("FS_RC_T");
    /// `FS_RC_ACT`: what is done then.
    pub const STICK_ACTION: Self = Self::named("FS_RC_ACT");
    /// `FS_BAT_PCT`: below what a battery is low, %.
    pub const BATTERY_LEAST: Self = Self::named("FS_BAT_PCT");
    /// `FS_BAT_ACT`: what is done then.
    pub const BATTERY_ACTION: Self = Self::named("FS_BAT_ACT");
    /// `FS_BLIND_T`: after how long without a state the rotors stop, s.
    pub const BLIND_TIMEOUT: Self = Self::named("FS_BLIND_T");
    /// `RC_MODE_CH`: the radio channel of the mode switch.
    pub const MODE_CHANNEL: Self = Self::named("RC_MODE_CH");
    /// `RC_KILL_CH`: the radio channel that stops the rotors.
    pub const KILL_CHANNEL: Self = Self::named("RC_KILL_CH");
    /// `RC_BTN_HOLD`: the joystick's button for hold.
    pub const HOLD_BUTTON: Self = Self::named("RC_BTN_HOLD");
    /// `RC_BTN_FOLLOW`: for follow.
    pub const FOLLOW_BUTTON: Self = Self::named("RC_BTN_FOLLOW");
    /// `RC_BTN_LAND`: for land.
    pub const LAND_BUTTON: Self = Self::named("RC_BTN_LAND");
    /// `RC_BTN_KILL`: that stops the rotors.
    pub const KILL_BUTTON: Self = Self::named("RC_BTN_KILL");
    /// `MIS_SPEED`: a mission's speed where no item says one, m/s.
    pub const MISSION_SPEED: Self = Self::named("MIS_SPEED");
    /// `MIS_CORNER`: likewise its corners, m.
    pub const MISSION_CORNER: Self = Self::named("MIS_CORNER");
    /// `MIS_ACC`: the bound of the load's acceleration, m/s².
    pub const MISSION_ACCELERATION: Self = Self::named("MIS_ACC");
    /// `FNC_MARGIN`: what is kept from the fence, m.
    pub const FENCE_MARGIN: Self = Self::named("FNC_MARGIN");
    /// `FNC_UP_MIN`: the least height of what is to be stayed in, m.
    pub const FENCE_LOW: Self = Self::named("FNC_UP_MIN");
    /// `FNC_UP_MAX`: its largest height, m.
    pub const FENCE_HIGH: Self = Self::named("FNC_UP_MAX");
    /// `FNC_ACT`: what is done where the fence is not kept.
    pub const FENCE_ACTION: Self = Self::named("FNC_ACT");
}

impl Setting {
    /// The one of this name; for the compiler.
    pub(crate) const fn named(name: &str) -> Self {
        Self(rig::index_of(&OWN, name))
    }

    /// Its place among all parameters.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}

/// A value for each parameter, within its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    own: [f32; OWN.len()],
    /// The controller's.
    rig: Parameters<f32>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { own: TABLE.each_ref().map(|entry| entry.default), rig: Parameters::default() }
    }
}

impl Settings {
    /// How many there are.
    pub const COUNT: usize = OWN.len() + rig::COUNT;

    /// The controller's parameters.
    #[must_use]
    pub fn rig(&self) -> &Parameters<f32> {
        &self.rig
    }

    /// The controller's parameters, to be changed.
    pub fn rig_mut(&mut self) -> &mut Parameters<f32> {
        &mut self.rig
    }

    /// The value of one of the program's own.
    #[must_use]
    pub fn get(&self, setting: Setting) -> f32 {
        self.own.get(setting.0).copied().unwrap_or_default()
    }

    /// Sets one of the program's own.
    ///
    /// # Errors
    /// [`Refused`], and the value is then what it was.
    pub fn set(&mut self, setting: Setting, value: f32) -> Result<(), Refused<f32>> {
        let entry = TABLE.get(setting.0).ok_or(Refused::Unknown)?;
        *self.own.get_mut(setting.0).ok_or(Refused::Unknown)? = entry.accept(value)?;
        Ok(())
    }

    /// Sets the value of a name. Returns its index.
    ///
    /// # Errors
    /// [`Refused`], and the value is then what it was.
    pub fn set_by_name(&mut self, name: &str, value: f32) -> Result<usize, Refused<f32>> {
        let index = Self::index(name).ok_or(Refused::Unknown)?;
        self.set_at(index, value)?;
        Ok(index)
    }

    /// Sets the value at an index.
    ///
    /// # Errors
    /// [`Refused`], and the value is then what it was.
    pub fn set_at(&mut self, index: usize, value: f32) -> Result<(), Refused<f32>> {
        match Parameter::at(index.wrapping_sub(OWN.len())) {
            Some(parameter) => self.rig.set(parameter, value),
            None => self.set(Setting(index), value),
        }
    }

    /// Where the parameter of that name stands.
    #[must_use]
    pub fn index(name: &str) -> Option<usize> {
        entries().position(|entry| entry.name.as_str() == name)
    }

    /// The entry and value at an index.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<(&'static Entry, f32)> {
        TABLE.get(index).zip(self.own.get(index).copied()).or_else(|| self.rig.at(index.checked_sub(OWN.len())?))
    }

    /// All entries with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Entry, f32)> + '_ {
        TABLE.iter().zip(self.own).chain(self.rig.iter())
    }
}

impl From<Parameters<f32>> for Settings {
    /// The controller's parameters, with the program's own at their defaults.
    fn from(rig: Parameters<f32>) -> Self {
        Self { rig, ..Self::default() }
    }
}

/// All entries, in order.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    TABLE.iter().chain(f32::table())
}
