//! The cable between hook and payload, which pulls and does not push, and what becomes of its ends.
//!
//! With d from the hook to the payload, l = |d| and L the cable's length (`vehicle.rod_length`):
//!
//! ```text
//! slack         l < L           no force
//! inextensible  l = L, l̇ = 0    the tension that keeps it so, as long as that is not negative
//! elastic       l > L           max(0, k (l − L) + c l̇),   k = EA/L
//! ```
//!
//! An inextensible cable that becomes taut while its ends part at w takes that from them by an
//! impulse along itself, j = (1 + e) w μ, of which ½ μ w² (1 − e²) is lost (Newton's restitution e;
//! μ is what the two ends together weigh along the cable, m_Q m_L/(m_Q + m_L) with the hook at the
//! centre of mass). Stiffness of real cables: EA is about 5 kN for 3 mm of polyamide and 100 kN for
//! aramid or polyethylene; k of the cable is that over its length.

use serde::Deserialize;

use super::check;
use super::sensors::Window;
use crate::describe::input::{Invalid, all_within, join};

/// A cable, in place of the massless rigid rod that a scenario without one has.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Cable {
    /// r_h, where it hangs, in body axes from the UAV's centre of mass, m, each within ±10.
    pub hook: [f64; 3],
    /// EA, the force that would double its length, N, 1 to 10⁸; inextensible if left out.
    pub ea: Option<f64>,
    /// c of an elastic cable, N·s/m, 0 to 10⁵.
    pub damping: f64,
    /// e of an inextensible one that becomes taut, 0 to 1.
    pub restitution: f64,
    /// When it holds the payload: picked up at its start, from when the payload is in reach, and
    /// dropped at its end. Always if left out.
    pub hooked: Option<Window>,
    /// When the payload is caught by something that does not move, and stays where it then is.
    pub snagged: Option<Window>,
}

impl Cable {
    /// Checks every range; `at` is the table's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        all_within(&join(at, "hook"), self.hook, 10.0)?;
        check(at, "ea", self.ea.unwrap_or(1.0), 1.0, 1e8)?;
        check(at, "damping", self.damping, 0.0, 1e5)?;
        check(at, "restitution", self.restitution, 0.0, 1.0)?;
        for (name, window) in [("hooked", &self.hooked), ("snagged", &self.snagged)] {
            if let Some(window) = window {
                window.check(&join(at, name))?;
            }
        }
        Ok(())
    }
}
