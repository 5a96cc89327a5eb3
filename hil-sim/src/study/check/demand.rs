//! What a lap asks of the vehicle: each quantity's least and largest value, with their places.

use super::probe::length;
use super::{Excess, Limits, Place, Steady};
use controller::Vehicle;

/// A quantity's least and largest value over the lap, each with its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Least.
    pub min: f64,
    /// Where.
    pub min_at: Place,
    /// Largest.
    pub max: f64,
    /// Where.
    pub max_at: Place,
}

impl Range {
    /// Of the first value.
    pub(super) fn new(value: f64, place: Place) -> Self {
        Self { min: value, min_at: place, max: value, max_at: place }
    }

    /// Takes another value in.
    pub(super) fn take(&mut self, value: f64, place: Place) {
        if value < self.min {
            (self.min, self.min_at) = (value, place);
        }
        if value > self.max {
            (self.max, self.max_at) = (value, place);
        }
    }
}

/// A quantity as it is printed.
pub(super) struct Line<'a> {
    /// Its name.
    pub name: &'static str,
    /// In SI units.
    pub range: &'a Range,
    /// The unit that it is printed in, and how many of them are the SI unit.
    pub unit: (&'static str, f64),
}

/// The one list of quantities: field, name, unit with its number per SI unit, and value.
macro_rules! quantities {
    ($($(#[doc = $doc:expr])+ $field:ident $name:literal ($unit:literal, $per_si:expr)
        = |$vehicle:pat_param, $steady:pat_param| $value:expr;)+) => {
        /// What a lap asks of the vehicle.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Demand {
            $($(#[doc = $doc])+ pub $field: Range,)+
        }

        impl Demand {
            /// At one place.
            pub(super) fn of(vehicle: &Vehicle<f64>, steady: &Steady, place: Place) -> Self {
                $(let $field = {
                    let ($vehicle, $steady) = (vehicle, steady);
                    Range::new($value, place)
                };)+
                Self { $($field,)+ }
            }

            /// Takes another place in.
            pub(super) fn take(&mut self, vehicle: &Vehicle<f64>, steady: &Steady, place: Place) {
                let Self { $($field,)+ } = Self::of(vehicle, steady, place);
                $(self.$field.take($field.min, place);)+
            }

            /// Of two parts.
            pub(super) fn joined(mut self, other: Self) -> Self {
                $(
                    self.$field.take(other.$field.min, other.$field.min_at);
                    self.$field.take(other.$field.max, other.$field.max_at);
                )+
                self
            }

            /// Line by line.
            pub(super) fn lines(&self) -> impl Iterator<Item = Line<'_>> {
                [$(Line { name: $name, range: &self.$field, unit: ($unit, $per_si) },)+].into_iter()
            }
        }
    };
}

/// Degrees per radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

quantities! {
    /// Speed of the payload, m/s.
    speed "speed" ("m/s", 1.0) = |_, s| length(&s.state.velocity);
    /// T, N.
    thrust "thrust" ("N", 1.0) = |_, s| s.command.thrust;
    /// Angle of the rod from straight down, rad.
    rod_angle "rod angle" ("°", DEGREES) = |_, s| s.rod_angle();
    /// Angle of b3 from straight down, rad.
    tilt "tilt" ("°", DEGREES) = |_, s| s.tilt();
    /// |ω|, rad/s.
    body_rate "body rate" ("rad/s", 1.0) = |_, s| length(&s.state.body_rate);
    /// Largest component of τ, N·m.
    torque "torque" ("N·m", 1.0) = |_, s| s.command.torque.amax();
    /// Tension as a part of the payload's weight, −λ/g; 0 in free fall.
    tension "tension/weight" ("", 1.0) = |vehicle, s| -s.lambda / vehicle.params().gravity;
    /// q·e3, 0 with the rod horizontal.
    q3 "q·e3" ("", 1.0) = |_, s| s.state.rod.z;
    /// q·b3, 0 with the thrust across the rod.
    q_b3 "q·b3" ("", 1.0) = |_, s| s.b3_rod;
    /// κ = T/(m_Q L), 1/s².
    kappa "κ" ("1/s²", 1.0) = |_, s| s.kappa;
    /// cos²φ, 0 where yaw is not defined.
    cos_phi_squared "cos²φ" ("", 1.0) = |_, s| s.cos_phi_squared;
}

impl Demand {
    /// The limits that are not kept.
    #[must_use]
    pub fn excesses(&self, limits: &Limits) -> Vec<Excess> {
        let upper = [
            ("thrust", &self.thrust, limits.thrust[1]),
            ("rod angle", &self.rod_angle, limits.rod_angle),
            ("tilt", &self.tilt, limits.tilt),
            ("body rate", &self.body_rate, limits.body_rate),
            ("torque", &self.torque, limits.torque),
        ];
        let lower = [("thrust", &self.thrust, limits.thrust[0]), ("tension", &self.tension, limits.tension)];
        let above = upper
            .into_iter()
            .filter(|(_, range, limit)| range.max > *limit)
            .map(|(quantity, range, limit)| Excess { quantity, value: range.max, limit, place: range.max_at });
        let below = lower
            .into_iter()
            .filter(|(_, range, limit)| range.min < *limit)
            .map(|(quantity, range, limit)| Excess { quantity, value: range.min, limit, place: range.min_at });
        above.chain(below).collect()
    }
}
