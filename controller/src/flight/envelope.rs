//! The envelope that the law is flown within: how near its singularities it may come.

use model::{OutOfRange, Real, Vehicle};

use crate::law::margins::{Margin, Margins};
use crate::ranges::{
    BandRange, ENVELOPE_PATH, ENVELOPE_REACH, ENVELOPE_ROD_ANGLE, ENVELOPE_ROLL, ENVELOPE_TENSION, ENVELOPE_THRUST,
    ENVELOPE_THRUST_ANGLE,
};

/// Where a margin begins to count, and where it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band<T> {
    /// Crossing it is reported.
    pub warning: T,
    /// Crossing it ends the law's flight.
    pub limit: T,
}

impl<T: Real> Band<T> {
    fn default(range: &BandRange) -> Self {
        Self { warning: range.warning.default(), limit: range.limit.default() }
    }
}

/// The envelope in physical terms. Angles and their warnings below their limits, the others above.
///
/// ```
/// use controller::{Band, Envelope, EnvelopeParams, Vehicle, VehicleParams};
///
/// // The rod to 45°, with a warning from 35°.
/// let degrees = core::f32::consts::PI / 180.0;
/// let rod_angle = Band { warning: 35.0 * degrees, limit: 45.0 * degrees };
/// let params = EnvelopeParams { rod_angle, ..EnvelopeParams::wide() };
/// assert!(Envelope::new(&Vehicle::new(VehicleParams::paper())?, &params).is_ok());
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvelopeParams<T> {
    /// Rod from the vertical, rad.
    pub rod_angle: Band<T>,
    /// Thrust axis from the rod, rad.
    pub thrust_angle: Band<T>,
    /// Roll φ of the yaw's chart, rad.
    pub roll: Band<T>,
    /// Tension of the rod, a share of the payload's weight.
    pub tension: Band<T>,
    /// Thrust, a share of the hover thrust.
    pub thrust: Band<T>,
    /// The determinant of the path's 3×3 system, a share of its value on the path.
    pub path: Band<T>,
    /// What is left of the path's reach, a share.
    pub reach: Band<T>,
}

impl<T: Real> EnvelopeParams<T> {
    /// Angles to 70° (warning at 55°), tension and thrust down to a tenth of their values at hover
    /// (a quarter), path to a tenth, reach to a twentieth (a fifth each).
    #[must_use]
    pub fn wide() -> Self {
        Self {
            rod_angle: Band::default(&ENVELOPE_ROD_ANGLE),
            thrust_angle: Band::default(&ENVELOPE_THRUST_ANGLE),
            roll: Band::default(&ENVELOPE_ROLL),
            tension: Band::default(&ENVELOPE_TENSION),
            thrust: Band::default(&ENVELOPE_THRUST),
            path: Band::default(&ENVELOPE_PATH),
            reach: Band::default(&ENVELOPE_REACH),
        }
    }
}

/// How a flight stands in its envelope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// No margin counts.
    Inside,
    /// This margin is past its warning.
    Warning(Margin),
    /// This margin is past its limit.
    Beyond(Margin),
}

/// How much of the way from a margin's limit to its warning is left: `per_band` · value − `offset`,
/// 1 at the warning and 0 at the limit.
#[derive(Clone, Copy, Debug)]
struct Threshold<T> {
    per_band: T,
    offset: T,
}

impl<T: Real> Threshold<T> {
    fn new(warning: T, limit: T) -> Self {
        // Where warning and limit coincide, a band of almost no width.
        let per_band = T::one() / (warning - limit).max(T::lit(1e-6));
        Self { per_band, offset: per_band * limit }
    }

    /// Of an angle; `margin` turns it into the number in [`Margins`].
    fn of_angle(band: &Band<T>, range: &BandRange, margin: impl Fn(T) -> T) -> Result<Self, OutOfRange<T>> {
        range.limit.check(band.limit)?;
        OutOfRange::within(range.warning.field, band.warning, T::lit(range.warning.min), band.limit)?;
        Ok(Self::new(margin(band.warning), margin(band.limit)))
    }

    /// Of a share; the whole is `unit`.
    fn of_share(band: &Band<T>, range: &BandRange, unit: T) -> Result<Self, OutOfRange<T>> {
        range.limit.check(band.limit)?;
        OutOfRange::within(range.warning.field, band.warning, band.limit, T::lit(range.warning.max))?;
        Ok(Self::new(band.warning * unit, band.limit * unit))
    }
}

fn cosine<T: Real>(angle: T) -> T {
    let (_, cosine) = angle.sin_cos();
    cosine
}

/// An envelope whose parameters are in range.
#[derive(Clone, Copy, Debug)]
pub struct Envelope<T> {
    /// In the order of [`Margin::ALL`].
    thresholds: [Threshold<T>; 7],
}

impl<T: Real> Envelope<T> {
    /// Checks every parameter.
    ///
    /// # Errors
    /// [`OutOfRange`] names the first that is out of its [range](crate::ranges).
    pub fn new(vehicle: &Vehicle<T>, params: &EnvelopeParams<T>) -> Result<Self, OutOfRange<T>> {
        let hover_kappa = vehicle.hover_thrust() * vehicle.kappa_per_thrust();
        let (one, gravity) = (T::one(), vehicle.params().gravity);
        let squared = |angle| cosine(angle) * cosine(angle);
        let mut thresholds = [Threshold::new(one, one); 7];
        for (threshold, margin) in thresholds.iter_mut().zip(Margin::ALL) {
            *threshold = match margin {
                Margin::RodAngle => Threshold::of_angle(&params.rod_angle, &ENVELOPE_ROD_ANGLE, cosine),
                Margin::ThrustAngle => Threshold::of_angle(&params.thrust_angle, &ENVELOPE_THRUST_ANGLE, cosine),
                Margin::Tension => Threshold::of_share(&params.tension, &ENVELOPE_TENSION, gravity),
                Margin::Thrust => Threshold::of_share(&params.thrust, &ENVELOPE_THRUST, hover_kappa),
                Margin::Path => Threshold::of_share(&params.path, &ENVELOPE_PATH, one),
                Margin::Reach => Threshold::of_share(&params.reach, &ENVELOPE_REACH, one),
                Margin::Yaw => Threshold::of_angle(&params.roll, &ENVELOPE_ROLL, squared),
            }?;
        }
        Ok(Self { thresholds })
    }

    /// How `margins` stand by the least of them, with the determinant of the path's system as a
    /// share of `path_det`, its value on the path.
    #[inline]
    pub fn assess(&self, margins: &Margins<T>, path_det: T) -> Standing {
        let (mut least, mut margin) = (T::one(), Margin::RodAngle);
        let values = margins.values(path_det);
        for ((value, threshold), of) in values.into_iter().zip(&self.thresholds).zip(Margin::ALL) {
            let share = value * threshold.per_band - threshold.offset;
            if share < least {
                (least, margin) = (share, of);
            }
        }
        if least >= T::one() {
            Standing::Inside
        } else if least >= T::zero() {
            Standing::Warning(margin)
        } else {
            Standing::Beyond(margin)
        }
    }
}

#[cfg(test)]
mod tests {
    use model::VehicleParams;

    use super::*;

    #[test]
    fn each_margin_is_reported_by_its_own_name() {
        let vehicle = Vehicle::new(VehicleParams::<f64>::paper()).unwrap();
        let envelope = Envelope::new(&vehicle, &EnvelopeParams::wide()).unwrap();
        let kappa = vehicle.hover_thrust() * vehicle.kappa_per_thrust();
        let hover =
            Margins { q3: 1.0, q_b3: 1.0, lambda: -9.81, kappa, path_det: 2.0, reach: 1.0, cos_phi_squared: 1.0 };
        assert_eq!(envelope.assess(&hover, 2.0), Standing::Inside);
        for (margin, singular) in [
            (Margin::RodAngle, Margins { q3: 0.0, ..hover }),
            (Margin::ThrustAngle, Margins { q_b3: 0.0, ..hover }),
            (Margin::Tension, Margins { lambda: 0.0, ..hover }),
            (Margin::Thrust, Margins { kappa: 0.0, ..hover }),
            (Margin::Path, Margins { path_det: 0.0, ..hover }),
            (Margin::Reach, Margins { reach: 0.0, ..hover }),
            (Margin::Yaw, Margins { cos_phi_squared: 0.0, ..hover }),
        ] {
            assert_eq!(envelope.assess(&singular, 2.0), Standing::Beyond(margin));
        }
        // A fifth of the payload's weight: below a quarter, above a tenth.
        let light = Margins { lambda: -0.2 * 9.81, ..hover };
        assert_eq!(envelope.assess(&light, 2.0), Standing::Warning(Margin::Tension));
    }
}
