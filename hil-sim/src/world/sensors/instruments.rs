//! What an autopilot has on board: instruments, rather than channels of the law's state.

use controller::{State, Vector3};

use super::Sensors;
use super::gnss::{FixReading, GnssModel};
use super::imu::{Imu, ImuModel, ImuReading};
use super::mocap::{MocapModel, PoseReading};
use super::simple::{BarometerModel, Esc, MagnetometerModel};
use crate::world::random::{Purpose, Stream};
use crate::world::{Seed, World};

/// What comes from the instruments in a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readings {
    /// Every period.
    pub imu: ImuReading,
    /// When one comes.
    pub fix: Option<FixReading>,
    /// Height, m, up.
    pub height: Option<f64>,
    /// Field in body axes, of its strength.
    pub field: Option<Vector3<f64>>,
    /// Thrust by the rotors' speeds, N.
    pub thrust: Option<f64>,
    /// When a frame comes.
    pub pose: Option<PoseReading>,
}

/// Instruments at work, each on a stream of its own.
#[derive(Clone, Debug)]
pub struct InstrumentModel {
    imu: ImuModel,
    gnss: Option<GnssModel>,
    barometer: Option<(f64, BarometerModel)>,
    magnetometer: Option<(f64, MagnetometerModel)>,
    esc: Option<(Esc, Stream)>,
    mocap: Option<MocapModel>,
    period: f64,
}

impl InstrumentModel {
    /// The instruments among `sensors`, read every `period` s. An IMU is always there.
    #[must_use]
    pub fn new(sensors: &Sensors, period: f64, seed: Seed) -> Self {
        let stream = |purpose| seed.stream(purpose);
        Self {
            imu: ImuModel::new(sensors.imu.unwrap_or_else(Imu::in_flight), stream(Purpose::Imu)),
            gnss: sensors.gnss.map(|gnss| GnssModel::new(gnss, stream(Purpose::Gnss))),
            barometer: sensors.barometer.map(|b| (0.0, BarometerModel::new(b, stream(Purpose::Barometer)))),
            magnetometer: sensors
                .magnetometer
                .map(|m| (0.0, MagnetometerModel::new(m, stream(Purpose::Magnetometer)))),
            esc: sensors.esc.map(|esc| (esc, stream(Purpose::Esc))),
            mocap: sensors.mocap.map(|mocap| MocapModel::new(mocap, stream(Purpose::Mocap))),
            period,
        }
    }

    /// What comes at the end of a period of flight in `world`.
    pub fn read(&mut self, world: &World) -> Readings {
        let (t_s, body) = (world.time_s(), world.body());
        let (state, place, velocity): (State<f64>, _, _) = (body.state(), body.uav_position(), body.uav_velocity());
        let vehicle = body.vehicle();
        let given = world.rotor_thrust();
        let hover = (vehicle.uav_mass + vehicle.payload_mass) * vehicle.gravity;
        let is_due = |next_s: &mut f64, rate_hz: f64| {
            let is_due = t_s > *next_s - 1e-9;
            if is_due {
                *next_s += 1.0 / rate_hz;
            }
            is_due
        };
        Readings {
            imu: self.imu.read(&state, &velocity, vehicle.gravity, given / hover, self.period),
            fix: self.gnss.as_mut().and_then(|gnss| gnss.read(t_s, &state, &place, &velocity)),
            height: self
                .barometer
                .as_mut()
                .and_then(|(next_s, barometer)| is_due(next_s, barometer.rate_hz()).then(|| barometer.read(&place))),
            field: self.magnetometer.as_mut().and_then(|(next_s, magnetometer)| {
                is_due(next_s, magnetometer.rate_hz()).then(|| magnetometer.read(&state.attitude))
            }),
            thrust: self.esc.as_mut().map(|(esc, stream)| esc.read(given, stream)),
            pose: self.mocap.as_mut().and_then(|mocap| mocap.read(t_s, &state, &place)),
        }
    }
}
