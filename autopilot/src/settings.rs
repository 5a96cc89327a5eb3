//! All parameters by the names that MAVLink's parameter protocol gives them: the program's own, then the controller's.

use rig::{Entry, Parameter, Parameters, Refused, Tabled as _};

const OWN: [Entry<f64>; 3] = [
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
];
static TABLE: [Entry; OWN.len()] = rig::narrowed(&OWN);

/// One of the program's own parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting(usize);

impl Setting {
    /// `SYS_SIM`: what drives the control step, a [`Drive`](crate::Drive).
    pub const DRIVE: Self = Self(rig::index_of(&OWN, "SYS_SIM"));
    /// `TLM_EVERY`: steps between two telemetry frames.
    pub const TELEMETRY_EVERY: Self = Self(rig::index_of(&OWN, "TLM_EVERY"));
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
