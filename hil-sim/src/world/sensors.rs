//! What the sensors make of the state, channel by channel, and what goes wrong with them.
//!
//! Each control period a channel's reading comes about in this order: the true value, at a sample
//! time that jitters uniformly over `jitter_s` before now (linear between two samples); plus
//! `bias`; plus white noise, normal, independent per sample and axis; rounded to multiples of
//! `quantum`; then frozen at the last reading, dropped out (zeros, as from a driver with an empty
//! message), or NaN, in the windows given.
//!
//! Vectors are read in their own axes and units. A rod is read with the errors of a rotation vector
//! (rad, in N) and attitude likewise (rad, in body axes); both stay on their manifolds to second
//! order, then exactly, except for `quantum`, which acts on the components read. The rod's rate is
//! read orthogonal to the rod read.
//!
//! The UAV's own position and velocity, and its accelerometer, are channels likewise. They are
//! given to the controller beside the state where `uav` and `accelerometer` say so.

pub mod gnss;
pub mod imu;
pub mod instruments;
pub mod mocap;
pub mod simple;

use controller::{Matrix3, State, Uav, Vector3};
use estimator::Motion;
use serde::Deserialize;

use super::check;
use crate::describe::input::{Invalid, all_within, join};
use crate::world::random::Stream;

/// A span of time.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Its start, s.
    pub at_s: f64,
    /// Its length, s.
    pub for_s: f64,
}

impl Window {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "at_s", self.at_s, 0.0, 1e5)?;
        check(at, "for_s", self.for_s, 0.0, 1e5)
    }

    /// Whether `t_s` lies in it.
    #[must_use]
    pub fn contains(&self, t_s: f64) -> bool {
        (self.at_s..self.at_s + self.for_s).contains(&t_s)
    }
}

/// What the controller is given at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Whether it comes to the controller.
    pub comes: bool,
    /// Load, rod and UAV.
    pub state: State<f64>,
    /// Whether the load is seen; to an estimator it is not where the cable is slack.
    pub sees_load: bool,
    /// The UAV as its own navigation has it, where it does.
    pub uav: Option<Uav<f64>>,
    /// Specific force of the UAV's centre of mass in body axes, m/s², where it is measured.
    pub specific_force: Option<Vector3<f64>>,
    /// What the rest was found from, for who finds it himself; of a flight on an estimate.
    pub aboard: Option<Aboard>,
}

/// What is aboard in place of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aboard {
    /// Of the instruments in this period.
    pub readings: instruments::Readings,
    /// What navigation makes of them.
    pub motion: Motion<f32>,
}

impl From<State<f64>> for Reading {
    /// The state and nothing else.
    fn from(state: State<f64>) -> Self {
        Self { comes: true, state, sees_load: true, uav: None, specific_force: None, aboard: None }
    }
}

/// The errors of one channel, in its unit.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Channel {
    /// Standard deviation per sample and axis, 0 to 100.
    pub noise: f64,
    /// Constant error, each axis within ±100.
    pub bias: [f64; 3],
    /// Step of the reading, 0 (none) to 100.
    pub quantum: f64,
    /// Largest age of a reading, s, 0 to one control period.
    pub jitter_s: f64,
    /// When the reading stands still.
    pub freeze: Option<Window>,
    /// When the sensor is silent, and its driver gives zeros.
    pub drop_out: Option<Window>,
    /// When the driver gives NaN.
    pub nan: Option<Window>,
}

/// All channels.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Sensors {
    /// Of the payload in N, m.
    pub position: Channel,
    /// Of the payload in N, m/s.
    pub velocity: Channel,
    /// Direction of the rod; errors in rad.
    pub rod: Channel,
    /// Rate of the rod's direction in N, 1/s.
    pub rod_rate: Channel,
    /// Attitude; errors in rad.
    pub attitude: Channel,
    /// In body axes, rad/s.
    pub body_rate: Channel,
    /// Whether the controller is given the UAV's own position and velocity; with a cable or ground
    /// if left out.
    pub uav: Option<bool>,
    /// Of the UAV in N, m.
    pub uav_position: Channel,
    /// Of the UAV in N, m/s.
    pub uav_velocity: Channel,
    /// Whether it is given the specific force; likewise.
    pub accelerometer: Option<bool>,
    /// In body axes, m/s².
    pub specific_force: Channel,
    /// Accelerometer and gyro, for an estimator; those of a vehicle in flight if left out.
    pub imu: Option<imu::Imu>,
    /// Satellite receiver, for an estimator, as what follows.
    pub gnss: Option<gnss::Gnss>,
    /// Height by pressure.
    pub barometer: Option<simple::Barometer>,
    /// Direction of the earth's field.
    pub magnetometer: Option<simple::Magnetometer>,
    /// Speeds of the rotors.
    pub esc: Option<simple::Esc>,
    /// Motion capture.
    pub mocap: Option<mocap::Mocap>,
}

/// How many of the channels are of the state.
const OF_STATE: usize = 6;

/// What a channel reads instead of what is there.
#[derive(Clone, Copy)]
enum Fault {
    Nan,
    Silent,
    Frozen,
}

impl Channel {
    fn check(&self, at: &str, period: f64) -> Result<(), Invalid> {
        check(at, "noise", self.noise, 0.0, 100.0)?;
        all_within(&join(at, "bias"), self.bias, 100.0)?;
        check(at, "quantum", self.quantum, 0.0, 100.0)?;
        check(at, "jitter_s", self.jitter_s, 0.0, period)?;
        for (name, window) in [("freeze", &self.freeze), ("drop_out", &self.drop_out), ("nan", &self.nan)] {
            if let Some(window) = window {
                window.check(&join(at, name))?;
            }
        }
        Ok(())
    }

    fn is_off(&self) -> bool {
        *self == Self::default()
    }

    /// Whether nothing but bias and noise comes between a value and its reading.
    fn is_plain(&self) -> bool {
        let Self { noise, bias, .. } = *self;
        *self == Self { noise, bias, ..Self::default() }
    }

    /// The error of this sample, in the channel's unit, with `normals` drawn where there is noise.
    #[inline]
    fn error(&self, normals: impl FnOnce() -> Vector3<f64>) -> Vector3<f64> {
        let bias = Vector3::from(self.bias);
        if self.noise > 0.0 { bias + normals() * self.noise } else { bias }
    }

    fn round(&self, value: Vector3<f64>) -> Vector3<f64> {
        let Self { quantum, .. } = *self;
        if quantum > 0.0 { value.map(|x| libm::rint(x / quantum) * quantum) } else { value }
    }

    /// How far back, as a share of the last period, the sample was taken, if not now.
    fn age(&self, period: f64, stream: &mut Stream) -> Option<f64> {
        (self.jitter_s > 0.0).then(|| stream.uniform(0.0, self.jitter_s / period))
    }

    /// What of its faults the channel has at `t_s`.
    #[inline]
    fn fault(&self, t_s: f64) -> Option<Fault> {
        let now = |window: &Option<Window>| window.is_some_and(|window| window.contains(t_s));
        if now(&self.nan) {
            Some(Fault::Nan)
        } else if now(&self.drop_out) {
            Some(Fault::Silent)
        } else {
            now(&self.freeze).then_some(Fault::Frozen)
        }
    }

    /// What is read of `value` with a `fault`, where `last` was read.
    #[inline]
    fn reading(&self, fault: Option<Fault>, value: Vector3<f64>, last: &Vector3<f64>) -> Vector3<f64> {
        match fault {
            None => self.round(value),
            Some(Fault::Nan) => Vector3::repeat(f64::NAN),
            Some(Fault::Silent) => Vector3::zeros(),
            Some(Fault::Frozen) => *last,
        }
    }
}

impl Sensors {
    /// The channels by name: those of the state first.
    #[must_use]
    pub fn channels(&self) -> [(&'static str, &Channel); 9] {
        [
            ("position", &self.position),
            ("velocity", &self.velocity),
            ("rod", &self.rod),
            ("rod_rate", &self.rod_rate),
            ("attitude", &self.attitude),
            ("body_rate", &self.body_rate),
            ("uav_position", &self.uav_position),
            ("uav_velocity", &self.uav_velocity),
            ("specific_force", &self.specific_force),
        ]
    }

    /// Checks every range; `at` is the table's name, `period` the control period in s.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str, period: f64) -> Result<(), Invalid> {
        self.channels().into_iter().try_for_each(|(name, channel)| channel.check(&join(at, name), period))?;
        self.imu.map_or(Ok(()), |imu| imu.check(&join(at, "imu")))?;
        self.gnss.map_or(Ok(()), |gnss| gnss.check(&join(at, "gnss")))?;
        self.barometer.map_or(Ok(()), |barometer| barometer.check(&join(at, "barometer")))?;
        self.magnetometer.map_or(Ok(()), |magnetometer| magnetometer.check(&join(at, "magnetometer")))?;
        self.esc.map_or(Ok(()), |esc| esc.check(&join(at, "esc")))?;
        self.mocap.map_or(Ok(()), |mocap| mocap.check(&join(at, "mocap")))
    }

    /// The same standard deviations as the paper's extension was measured with: 2 cm, 3 cm/s, 5
    /// mrad, 20 mrad/s and 10 mrad/s.
    #[must_use]
    pub fn noisy() -> Self {
        let noise = |noise| Channel { noise, ..Channel::default() };
        Self {
            position: noise(0.02),
            velocity: noise(0.03),
            rod: noise(0.005),
            rod_rate: noise(0.02),
            attitude: noise(0.005),
            body_rate: noise(0.01),
            ..Self::default()
        }
    }
}

/// Sensors at work.
#[derive(Clone, Debug)]
pub struct SensorModel {
    sensors: Sensors,
    period: f64,
    stream: Stream,
    /// The state at the last sample, and what was read then.
    before: State<f64>,
    last: State<f64>,
    perfect: bool,
    /// Whether all channels of the state are plain: then nothing is asked of them, or of the past.
    plain: bool,
    /// How many of them are noisy.
    noisy: usize,
    /// Of the UAV's own position, velocity and specific force.
    own: [Memory; 3],
}

/// A channel's value at the last sample, and what was read then.
#[derive(Clone, Copy, Debug, Default)]
struct Memory {
    before: Option<Vector3<f64>>,
    last: Vector3<f64>,
}

impl Memory {
    fn read(&mut self, channel: &Channel, now: &Vector3<f64>, sample: &mut Sample<'_>) -> Vector3<f64> {
        let read = sample.vector(channel, now, &self.before.unwrap_or(*now), &self.last);
        *self = Self { before: Some(*now), last: read };
        read
    }
}

impl SensorModel {
    /// `sensors` sampled every `period` s, from a flight that starts at `state`.
    #[must_use]
    pub fn new(sensors: Sensors, period: f64, state: &State<f64>, stream: Stream) -> Self {
        let of_state = sensors.channels().into_iter().take(OF_STATE).map(|(_, channel)| channel);
        let all = |is: fn(&Channel) -> bool| of_state.clone().all(is);
        let (perfect, plain) = (all(Channel::is_off), all(Channel::is_plain));
        let noisy = of_state.filter(|channel| channel.noise > 0.0).count();
        let own = [Memory::default(); 3];
        Self { sensors, period, stream, before: *state, last: *state, perfect, plain, noisy, own }
    }

    /// What is read of `state` at `t_s`, into `read`.
    #[inline]
    pub fn read(&mut self, t_s: f64, state: &State<f64>, read: &mut State<f64>) {
        if self.perfect {
            *read = *state;
        } else if self.plain {
            self.read_plain(state, read);
        } else {
            *read = self.read_wronged(t_s, state);
        }
    }

    /// With bias and noise alone.
    fn read_plain(&mut self, state: &State<f64>, read: &mut State<f64>) {
        let Self { sensors, stream, noisy, .. } = self;
        // All at once, which costs less than channel by channel.
        let mut drawn = [[0.0; 3]; OF_STATE];
        stream.fill(&mut drawn[..*noisy]);
        let mut drawn = drawn.iter();
        let mut error = |channel: &Channel| channel.error(|| drawn.next().copied().unwrap_or_default().into());
        let turned = state.rod + error(&sensors.rod).cross(&state.rod);
        let rod = turned * (1.0 / turned.dot(&turned).sqrt());
        read.rod = rod;
        read.attitude = orthonormal(&turn(&state.attitude, &error(&sensors.attitude)));
        read.position = state.position + error(&sensors.position);
        read.velocity = state.velocity + error(&sensors.velocity);
        let rate = state.rod_rate + error(&sensors.rod_rate);
        read.rod_rate = rate - rod * rod.dot(&rate);
        read.body_rate = state.body_rate + error(&sensors.body_rate);
    }

    /// With all that can go wrong.
    fn read_wronged(&mut self, t_s: f64, state: &State<f64>) -> State<f64> {
        let Self { sensors, period, stream, before, last, .. } = self;
        let mut sample = Sample { t_s, period: *period, stream };
        let rod = {
            let channel = &sensors.rod;
            let aged = sample.aged(channel, &state.rod, &before.rod);
            let turned = aged + channel.error(|| sample.stream.normals()).cross(&aged);
            let unit = turned / turned.dot(&turned).sqrt();
            channel.reading(channel.fault(t_s), unit, &last.rod)
        };
        let attitude = {
            let channel = &sensors.attitude;
            let aged = match channel.age(sample.period, sample.stream) {
                Some(age) => state.attitude + (before.attitude - state.attitude) * age,
                None => state.attitude,
            };
            let turned = orthonormal(&turn(&aged, &channel.error(|| sample.stream.normals())));
            let fault = channel.fault(t_s);
            let column = |i| channel.reading(fault, turned.column(i).into(), &last.attitude.column(i).into());
            Matrix3::from_columns(&[column(0), column(1), column(2)])
        };
        let position = sample.vector(&sensors.position, &state.position, &before.position, &last.position);
        let velocity = sample.vector(&sensors.velocity, &state.velocity, &before.velocity, &last.velocity);
        let rate = sample.vector(&sensors.rod_rate, &state.rod_rate, &before.rod_rate, &last.rod_rate);
        let rod_rate = rate - rod * rod.dot(&rate);
        let body_rate = sample.vector(&sensors.body_rate, &state.body_rate, &before.body_rate, &last.body_rate);
        self.before = *state;
        self.last = State { position, velocity, rod, rod_rate, attitude, body_rate };
        self.last
    }

    /// What the UAV's own navigation makes of its `position` and `velocity`, with attitude and body
    /// rate as they were `read`.
    pub fn read_uav(&mut self, t_s: f64, [position, velocity]: [&Vector3<f64>; 2], read: &State<f64>) -> Uav<f64> {
        let Self { sensors, period, stream, own: [of_position, of_velocity, _], .. } = self;
        let mut sample = Sample { t_s, period: *period, stream };
        Uav {
            position: of_position.read(&sensors.uav_position, position, &mut sample),
            velocity: of_velocity.read(&sensors.uav_velocity, velocity, &mut sample),
            attitude: read.attitude,
            body_rate: read.body_rate,
        }
    }

    /// What the accelerometer makes of the specific `force`.
    pub fn read_force(&mut self, t_s: f64, force: &Vector3<f64>) -> Vector3<f64> {
        let Self { sensors, period, stream, own: [.., memory], .. } = self;
        memory.read(&sensors.specific_force, force, &mut Sample { t_s, period: *period, stream })
    }
}

/// One sample of all channels.
struct Sample<'a> {
    t_s: f64,
    period: f64,
    stream: &'a mut Stream,
}

impl Sample<'_> {
    /// The value of a channel at its sample time.
    #[inline]
    fn aged(&mut self, channel: &Channel, now: &Vector3<f64>, before: &Vector3<f64>) -> Vector3<f64> {
        match channel.age(self.period, self.stream) {
            Some(age) => now + (before - now) * age,
            None => *now,
        }
    }

    /// What a channel reads of `now`, which was `before` at the sample before, when it read `last`.
    #[inline]
    fn vector(
        &mut self,
        channel: &Channel,
        now: &Vector3<f64>,
        before: &Vector3<f64>,
        last: &Vector3<f64>,
    ) -> Vector3<f64> {
        let value = self.aged(channel, now, before) + channel.error(|| self.stream.normals());
        channel.reading(channel.fault(self.t_s), value, last)
    }
}

/// R (1 + v^): orthonormal to |v|².
#[inline]
fn turn(r: &Matrix3<f64>, v: &Vector3<f64>) -> Matrix3<f64> {
    let b1 = Vector3::new(r.m11, r.m21, r.m31);
    let b2 = Vector3::new(r.m12, r.m22, r.m32);
    let b3 = Vector3::new(r.m13, r.m23, r.m33);
    Matrix3::from_columns(&[b1 + b2 * v.z - b3 * v.y, b2 + b3 * v.x - b1 * v.z, b3 + b1 * v.y - b2 * v.x])
}

/// The columns made orthonormal, the first two alike (Gram and Schmidt prefer one), the third their
/// product.
#[inline]
fn orthonormal(r: &Matrix3<f64>) -> Matrix3<f64> {
    let of_length = |v: Vector3<f64>, length: f64| v * (length / v.dot(&v).sqrt());
    let (c1, c2) = (of_length(r.column(0).into(), 1.0), of_length(r.column(1).into(), 1.0));
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (sum, difference) = (of_length(c1 + c2, half), of_length(c1 - c2, half));
    let (c1, c2) = (sum + difference, sum - difference);
    Matrix3::from_columns(&[c1, c2, c1.cross(&c2)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::random::Purpose;

    fn reading(model: &mut SensorModel, t_s: f64, state: &State<f64>) -> State<f64> {
        let mut read = *state;
        model.read(t_s, state, &mut read);
        read
    }

    fn state() -> State<f64> {
        let mut state = State::at_rest(Vector3::new(1.0, 2.0, -10.0));
        state.velocity = Vector3::new(0.5, -0.25, 0.125);
        state
    }

    fn model(sensors: Sensors) -> SensorModel {
        SensorModel::new(sensors, 0.002, &state(), Stream::new(5, 0, Purpose::Sensor))
    }

    #[test]
    fn without_errors_the_state_is_read() {
        assert_eq!(reading(&mut model(Sensors::default()), 0.0, &state()), state());
    }

    #[test]
    fn noise_has_its_deviation_and_keeps_the_manifolds() {
        let mut model = model(Sensors::noisy());
        let truth = state();
        let count = 20_000;
        let mut squares = [0.0; 6];
        for i in 0..count {
            let read = reading(&mut model, 0.002 * f64::from(i), &truth);
            assert!((read.rod.dot(&read.rod) - 1.0).abs() < 1e-15 * 10.0);
            assert!((read.attitude * read.attitude.transpose() - Matrix3::identity()).amax() < 1e-14);
            assert!(read.rod.dot(&read.rod_rate).abs() < 1e-15);
            let differences = [
                read.position.x - truth.position.x,
                read.velocity.y - truth.velocity.y,
                read.rod.x - truth.rod.x,
                read.rod_rate.y - truth.rod_rate.y,
                read.attitude.m32,
                read.body_rate.z,
            ];
            for (square, difference) in squares.iter_mut().zip(differences) {
                *square += difference * difference / f64::from(count);
            }
        }
        for (square, deviation) in squares.iter().zip([0.02, 0.03, 0.005, 0.02, 0.005, 0.01]) {
            // Five standard errors of a deviation from 20,000 values: 5/√40000.
            assert!((square.sqrt() / deviation - 1.0).abs() < 0.025, "{square} {deviation}");
        }
    }

    #[test]
    fn faults_act_in_their_windows() {
        let window = Some(Window { at_s: 1.0, for_s: 1.0 });
        let channel = |f: fn(&mut Channel, Option<Window>)| {
            let mut channel = Channel { noise: 0.1, ..Channel::default() };
            f(&mut channel, window);
            Sensors { position: channel, ..Sensors::default() }
        };
        let mut frozen = model(channel(|c, w| c.freeze = w));
        let first = reading(&mut frozen, 0.9, &state()).position;
        assert_eq!(reading(&mut frozen, 1.0, &state()).position, first);
        assert_eq!(reading(&mut frozen, 1.9, &state()).position, first);
        assert_ne!(reading(&mut frozen, 2.0, &state()).position, first);
        let mut dropped = model(channel(|c, w| c.drop_out = w));
        assert_eq!(reading(&mut dropped, 1.5, &state()).position, Vector3::zeros());
        let mut nan = model(channel(|c, w| c.nan = w));
        assert!(
            reading(&mut nan, 1.5, &state()).position.x.is_nan()
                && reading(&mut nan, 2.5, &state()).position.x.is_finite()
        );
    }

    #[test]
    fn readings_are_multiples_of_the_quantum_with_their_bias() {
        let channel = Channel { quantum: 0.25, bias: [0.3, 0.0, 0.0], ..Channel::default() };
        let read = reading(&mut model(Sensors { velocity: channel, ..Sensors::default() }), 0.0, &state());
        assert_eq!(read.velocity, Vector3::new(0.75, -0.25, 0.0));
        let channel = Channel { jitter_s: 0.002, ..Channel::default() };
        let mut jittering = model(Sensors { position: channel, ..Sensors::default() });
        let mut later = state();
        later.position.x += 1.0;
        let x = reading(&mut jittering, 0.0, &later).position.x;
        assert!(x > 1.0 && x < 2.0, "between the two samples: {x}");
    }
}
