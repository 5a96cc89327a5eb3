//! The law's distances from where it is singular, and the envelope it is flown within.

use model::{OutOfRange, Real, Vehicle};

/// The numbers the law divides by, as signed distances from zero: the paper's singularities, the path's and the yaw's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margins<T> {
    /// q·e3, cos α cos β: 1 hanging straight down, 0 with the rod horizontal.
    pub q3: T,
    /// q·b3: 1 with the thrust along the rod, 0 across it.
    pub q_b3: T,
    /// Payload's specific force along the rod, m/s²: −g hanging at rest, 0 in free fall (a slack cable).
    pub lambda: T,
    /// T/(m_Q L), 1/s²: 0 without thrust.
    pub kappa: T,
    /// (∇h1 × ∇h2)·ρ, in the units of h1 and h2 per m²; 1 for trajectory tracking. Negative where ρ is the opposite of (3).
    pub path_det: T,
    /// What is left of the reach of a path with a nearest point; 1 for the others.
    pub reach: T,
    /// cos²φ: 0 where yaw is not defined.
    pub cos_phi_squared: T,
}

impl<T: Real> Margins<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Margins<U> {
        Margins {
            q3: self.q3.cast(),
            q_b3: self.q_b3.cast(),
            lambda: self.lambda.cast(),
            kappa: self.kappa.cast(),
            path_det: self.path_det.cast(),
            reach: self.reach.cast(),
            cos_phi_squared: self.cos_phi_squared.cast(),
        }
    }
}

/// Which margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Margin {
    /// The rod's angle from the vertical (α, β → π/2).
    RodAngle,
    /// The angle between thrust axis and rod (b3 ⊥ q).
    ThrustAngle,
    /// The tension of the rod (free fall).
    Tension,
    /// The thrust (T → 0).
    Thrust,
    /// The regularity of the path's functions (∇h1 ∥ ∇h2, or one of them zero).
    Path,
    /// The reach of a path with a nearest point.
    Reach,
    /// The yaw's chart (φ → π/2).
    Yaw,
}

/// Where a margin begins to count, and where it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band<T> {
    /// Crossing it is reported.
    pub warning: T,
    /// Crossing it ends the law's flight.
    pub limit: T,
}

/// The envelope in physical terms. Angles and their warnings below their limits, the others above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvelopeParams<T> {
    /// Rod from the vertical, rad.
    pub rod_angle: Band<T>,
    /// Thrust axis from the rod, rad.
    pub thrust_angle: Band<T>,
    /// Roll φ of the yaw's chart, rad.
    pub roll: Band<T>,
    /// Tension of the rod as the law knows the payload, N.
    pub tension: Band<T>,
    /// Thrust, N.
    pub thrust: Band<T>,
    /// The determinant of the path's 3×3 system, as a share of its value on the path.
    pub path: Band<T>,
    /// What is left of the path's reach, as a share.
    pub reach: Band<T>,
}

impl<T: Real> EnvelopeParams<T> {
    /// Angles to 70° (warning at 55°), tension and thrust down to a tenth of their values at hover (a quarter), path to a tenth, reach to a
    /// twentieth (a fifth each).
    pub fn wide(vehicle: &Vehicle<T>) -> Self {
        let angle = Band { warning: T::lit(0.96), limit: T::lit(1.22) };
        let share = |of: T| Band { warning: of * T::lit(0.25), limit: of * T::lit(0.1) };
        let params = vehicle.params();
        Self {
            rod_angle: angle,
            thrust_angle: angle,
            roll: angle,
            tension: share(params.payload_mass * params.gravity),
            thrust: share(vehicle.hover_thrust()),
            path: Band { warning: T::lit(0.2), limit: T::lit(0.1) },
            reach: Band { warning: T::lit(0.2), limit: T::lit(0.05) },
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

/// The margins in the order of [`Margins`].
const MARGINS: [Margin; 7] = [
    Margin::RodAngle,
    Margin::ThrustAngle,
    Margin::Tension,
    Margin::Thrust,
    Margin::Path,
    Margin::Reach,
    Margin::Yaw,
];

/// What of the way from a margin's limit to its warning is left: `per_band` · value − `offset`, 1 at the warning and 0 at the limit.
#[derive(Clone, Copy, Debug)]
struct Threshold<T> {
    per_band: T,
    offset: T,
}

impl<T: Real> Threshold<T> {
    fn new(warning: T, limit: T) -> Self {
        // Without a band between the two, a warning is hardly ever due.
        let per_band = T::one() / (warning - limit).max(T::lit(1e-6));
        Self { per_band, offset: per_band * limit }
    }
}

/// An envelope whose parameters are in range.
#[derive(Clone, Copy, Debug)]
pub struct Envelope<T> {
    thresholds: [Threshold<T>; 7],
}

impl<T: Real> Envelope<T> {
    /// Checks every parameter; an error names the first that is out of range.
    pub fn new(vehicle: &Vehicle<T>, params: &EnvelopeParams<T>) -> Result<Self, OutOfRange<T>> {
        let cosines = |field, band: &Band<T>| {
            OutOfRange::check(field, band.limit, 0.05, 1.5)?;
            OutOfRange::within(field, band.warning, T::zero(), band.limit)?;
            let (_, warning) = band.warning.sin_cos();
            let (_, limit) = band.limit.sin_cos();
            Ok((warning, limit))
        };
        let least = |field, band: &Band<T>, largest: T, unit: T| {
            OutOfRange::within(field, band.limit, T::zero(), largest)?;
            OutOfRange::within(field, band.warning, band.limit, largest)?;
            Ok(Threshold::new(band.warning * unit, band.limit * unit))
        };
        let one = T::one();
        let payload = vehicle.params().payload_mass;
        let weight = payload * vehicle.params().gravity;
        let rod = cosines("rod_angle", &params.rod_angle)?;
        let thrust = cosines("thrust_angle", &params.thrust_angle)?;
        let roll = cosines("roll", &params.roll)?;
        Ok(Self {
            thresholds: [
                Threshold::new(rod.0, rod.1),
                Threshold::new(thrust.0, thrust.1),
                least("tension", &params.tension, weight, one / payload)?,
                least("thrust", &params.thrust, vehicle.hover_thrust(), vehicle.kappa_per_thrust())?,
                least("path", &params.path, one, one)?,
                least("reach", &params.reach, one, one)?,
                Threshold::new(roll.0 * roll.0, roll.1 * roll.1),
            ],
        })
    }

    /// How `margins` stand by the least of them, with the determinant of the path's system as a share of `path_det`, its value on the path.
    #[inline(never)]
    pub fn assess(&self, margins: &Margins<T>, path_det: T) -> Standing {
        let values = [
            margins.q3,
            margins.q_b3,
            -margins.lambda,
            margins.kappa,
            margins.path_det / path_det,
            margins.reach,
            margins.cos_phi_squared,
        ];
        let (mut least, mut margin) = (T::one(), Margin::RodAngle);
        for ((value, threshold), of) in values.into_iter().zip(&self.thresholds).zip(MARGINS) {
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
