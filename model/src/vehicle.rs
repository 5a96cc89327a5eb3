//! The slung-load vehicle's parameters: checked once, then trusted.

use nalgebra::Vector3;

use crate::error::OutOfRange;
use crate::range::{GRAVITY, INERTIA, PAYLOAD_MASS, ROD_LENGTH, UAV_MASS};
use crate::scalar::Real;

/// What the law has to know of the vehicle, SI units.
///
/// ```
/// use model::{Vehicle, VehicleParams};
///
/// let mine = VehicleParams {
///     payload_mass: 1.2_f32,
///     uav_mass: 3.4,
///     rod_length: 3.0,
///     inertia: [0.05, 0.05, 0.08],
///     gravity: 9.81,
/// };
/// assert!(Vehicle::new(mine).is_ok());
///
/// // A number that can't be is refused by name.
/// let error = Vehicle::new(VehicleParams { rod_length: -3.0, ..mine }).unwrap_err();
/// assert_eq!(error.field, "rod_length");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleParams<T> {
    /// Payload mass m_L, kg.
    pub payload_mass: T,
    /// UAV mass m_Q without the payload, kg.
    pub uav_mass: T,
    /// Length L of the rod, which is the taut cable taken for rigid and massless, from the UAV's
    /// centre of mass to the payload, m.
    pub rod_length: T,
    /// Principal moments of inertia J of the UAV in body axes, kg·m².
    pub inertia: [T; 3],
    /// Gravity g along +n3 (down), m/s².
    pub gravity: T,
}

impl<T: Real> VehicleParams<T> {
    /// The paper's vehicle, its Table I, with g = 9.81 m/s²: for its figures and for examples.
    /// Yours is another.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            payload_mass: PAYLOAD_MASS.default(),
            uav_mass: UAV_MASS.default(),
            rod_length: ROD_LENGTH.default(),
            inertia: INERTIA.map(|range| range.default()),
            gravity: GRAVITY.default(),
        }
    }
}

impl<T: Real> VehicleParams<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> VehicleParams<U> {
        VehicleParams {
            payload_mass: self.payload_mass.cast(),
            uav_mass: self.uav_mass.cast(),
            rod_length: self.rod_length.cast(),
            inertia: self.inertia.map(T::cast),
            gravity: self.gravity.cast(),
        }
    }
}

/// A vehicle whose parameters are in range, with the constants the law derives from them.
///
/// ```
/// use model::{Vehicle, VehicleParams};
///
/// let vehicle = Vehicle::new(VehicleParams::<f32>::paper())?;
/// assert!((vehicle.hover_thrust() - 3.0 * 9.81).abs() < 1e-5);
/// # Ok::<(), model::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vehicle<T> {
    params: VehicleParams<T>,
    /// m_Q L, kg·m: thrust is κ m_Q L.
    thrust_per_kappa: T,
    /// 1/(m_Q L).
    kappa_per_thrust: T,
    /// c = M/(m_Q L), 1/m.
    coupling: T,
    /// 1/M, 1/kg.
    per_total_mass: T,
    /// 1/c.
    inverse_coupling: T,
    /// M, kg.
    total_mass: T,
    /// M g, N.
    hover_thrust: T,
    /// J, kg·m².
    inertia: Vector3<T>,
    /// J⁻¹.
    inverse_inertia: Vector3<T>,
}

impl<T: Real> Vehicle<T> {
    /// Checks every parameter.
    ///
    /// # Errors
    /// [`OutOfRange`] names the first that is out of its [range](crate::ranges).
    pub fn new(params: VehicleParams<T>) -> Result<Self, OutOfRange<T>> {
        PAYLOAD_MASS.check(params.payload_mass)?;
        UAV_MASS.check(params.uav_mass)?;
        ROD_LENGTH.check(params.rod_length)?;
        for (range, &moment) in INERTIA.iter().zip(&params.inertia) {
            range.check(moment)?;
        }
        GRAVITY.check(params.gravity)?;

        let arm = params.uav_mass * params.rod_length;
        let total = params.uav_mass + params.payload_mass;
        Ok(Self {
            params,
            thrust_per_kappa: arm,
            kappa_per_thrust: T::one() / arm,
            coupling: total / arm,
            per_total_mass: T::one() / total,
            inverse_coupling: arm / total,
            total_mass: total,
            hover_thrust: total * params.gravity,
            inertia: Vector3::from(params.inertia),
            inverse_inertia: Vector3::from(params.inertia.map(|j| T::one() / j)),
        })
    }

    /// Takes all mass for `share` of what it is `told`, on the same UAV: what M stands in moves,
    /// [`params`](Self::params) stay. Along the rod a thrust of 1/`share` of what was told looks
    /// the same.
    #[inline(always)]
    pub fn weigh(&mut self, told: &Self, share: T) {
        let inverse = T::one() / share;
        self.coupling = told.coupling * share;
        self.per_total_mass = told.per_total_mass * inverse;
        self.inverse_coupling = told.inverse_coupling * inverse;
        self.total_mass = told.total_mass * share;
        self.hover_thrust = told.hover_thrust * share;
    }

    /// The parameters it was made from.
    pub fn params(&self) -> &VehicleParams<T> {
        &self.params
    }

    /// M = m_Q + m_L, kg.
    pub fn total_mass(&self) -> T {
        self.total_mass
    }

    /// The thrust that balances gravity at rest, M g, N.
    pub fn hover_thrust(&self) -> T {
        self.hover_thrust
    }

    /// m_Q L, kg·m: thrust is κ m_Q L.
    #[inline(always)]
    pub fn thrust_per_kappa(&self) -> T {
        self.thrust_per_kappa
    }

    /// 1/(m_Q L), 1/(kg·m).
    #[inline(always)]
    pub fn kappa_per_thrust(&self) -> T {
        self.kappa_per_thrust
    }

    /// c = M/(m_Q L), 1/m.
    #[inline(always)]
    pub fn coupling(&self) -> T {
        self.coupling
    }

    /// 1/c, m.
    #[inline(always)]
    pub fn inverse_coupling(&self) -> T {
        self.inverse_coupling
    }

    /// 1/M, 1/kg.
    #[inline(always)]
    pub fn per_total_mass(&self) -> T {
        self.per_total_mass
    }

    /// J, principal moments in body axes, kg·m².
    #[inline(always)]
    pub fn inertia(&self) -> &Vector3<T> {
        &self.inertia
    }

    /// J⁻¹, 1/(kg·m²).
    #[inline(always)]
    pub fn inverse_inertia(&self) -> &Vector3<T> {
        &self.inverse_inertia
    }
}
