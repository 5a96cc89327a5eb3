//! Payload and UAV as two free bodies, on a [`Cable`] that may be slack, over [`Ground`] on which
//! both may stand.
//!
//! With S the cable's pull, u the unit vector along it from the hook at r_h (body axes) to the
//! payload, and F_L, F_Q, τ_d all other forces and torques, the ground's among them:
//!
//! ```text
//! m_L v̇   = m_L g e3 + F_L − S u
//! m_Q v̇_Q = m_Q g e3 + F_Q − T b3 + S u
//! J ω̇     = J ω × ω + τ + τ_d + r_h × (S Rᵀu),   Ṙ = R ω^
//! ```
//!
//! S is zero while the cable is slack, a function of length and rate where it is elastic, and where
//! it is taut and does not stretch what keeps u·(v̇ − v̇_h) + |ḋ|²/l = 0, d from the hook (which
//! moves at v_h) to the payload, l its length. That is linear in S:
//!
//! ```text
//! S = μ (u·(v̇⁰ − v̇⁰_h) + |ḋ|²/l),   1/μ = 1/m_L + 1/m_Q + (r_h × Rᵀu)·J⁻¹(r_h × Rᵀu)
//! (⁰: at S = 0)
//! ```
//!
//! A step ends where the cable becomes slack or taut, or a point comes to the ground or leaves it,
//! and the next begins there, so that the Runge-Kutta method is of its order in spite of them.
//! After each, length and rate of a taut cable are put back along u, by an impulse as that of a
//! cable that becomes taut.

use controller::{Command, Matrix3, State, Vector3};

use super::body::{Bodies, Rates};
use super::cable::Cable;
use super::ground::Ground;
use super::integrate::rk4_step;
use super::multibody::{Loads, quaternion, quaternion_rate, rotation, square, vector};
use witness::plant::VehicleParameters;

/// UAV position and velocity, payload position and velocity, attitude quaternion, body rate.
const COORDINATES: usize = 19;

type Coordinates = [f64; COORDINATES];

/// Points that can touch the ground: the payload and four feet.
const POINTS: usize = 5;

/// What a step may not pass over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Contacts {
    /// The cable is taut.
    taut: bool,
    /// Points in the ground, the payload first.
    touching: [bool; POINTS],
}

/// Two bodies on a cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tethered {
    vehicle: VehicleParameters,
    cable: Cable,
    ground: Option<Ground>,
    x: Coordinates,
    contacts: Contacts,
    /// The cable holds the payload.
    hooked: bool,
    /// The payload is held where it is.
    snagged: bool,
}

/// The cable's geometry.
struct Line {
    /// l, m.
    length: f64,
    /// l̇, m/s.
    rate: f64,
    /// u in N.
    along: Vector3<f64>,
    /// r_h × Rᵀu in body axes, m.
    lever: Vector3<f64>,
    /// |ḋ|²/l, m/s².
    turning: f64,
    /// μ, kg.
    mass: f64,
}

/// Closer than this, s, two instants are one: far below any step, far above the rounding of what a
/// step covers.
const INSTANT: f64 = 1e-10;
/// Changes of contact that are looked for in one step; those that come after are flown over.
const CHANGES: usize = 12;
/// Ends that part slower than this, m/s, do not bounce.
const SETTLING: f64 = 0.01;
/// A taut cable is slack at a pull below minus this, N: rounding does not make it slack in free
/// fall.
const SLACK: f64 = 1e-6;
/// Accuracy asks for so many steps in a radian of the fastest motion there is; stability would be
/// content with one.
const STEPS_PER_RADIAN: f64 = 3.0;

impl Tethered {
    /// `vehicle` at `bodies`; the cable is taut where they are its length apart and part or stay
    /// so.
    #[must_use]
    pub fn new(vehicle: VehicleParameters, cable: Cable, ground: Option<Ground>, bodies: &Bodies) -> Self {
        let mut x = [0.0; COORDINATES];
        x[..3].copy_from_slice(bodies.uav_position.as_slice());
        x[3..6].copy_from_slice(bodies.uav_velocity.as_slice());
        x[6..9].copy_from_slice(bodies.position.as_slice());
        x[9..12].copy_from_slice(bodies.velocity.as_slice());
        x[12..16].copy_from_slice(&quaternion(&bodies.attitude));
        x[16..].copy_from_slice(bodies.body_rate.as_slice());
        let contacts = Contacts { taut: false, touching: [false; POINTS] };
        let hooked = cable.hooked.is_none();
        let mut new = Self { vehicle, cable, ground, x, contacts, hooked, snagged: false };
        // A start on the rod is to within rounding.
        let line = new.line(&new.x);
        new.contacts.taut = hooked && line.length >= vehicle.rod_length * (1.0 - 1e-12) && line.rate > -SETTLING;
        new.contacts.touching = new.depths(&new.x).map(|depth| depth > 0.0);
        new.settle();
        new
    }

    /// The vehicle that moves.
    #[must_use]
    pub fn vehicle(&self) -> &VehicleParameters {
        &self.vehicle
    }

    /// Another payload mass, kg, from now on, all velocities kept.
    pub fn set_payload_mass(&mut self, mass: f64) {
        self.vehicle.payload_mass = mass;
    }

    /// What the cable's windows say of `t_s`.
    pub fn set_time(&mut self, t_s: f64) {
        let hooks = self.cable.hooked.is_none_or(|window| window.contains(t_s));
        // A payload out of reach is not picked up.
        self.hooked = hooks && (self.hooked || self.line(&self.x).length <= self.vehicle.rod_length);
        if !self.hooked {
            self.contacts.taut = false;
        }
        let snagged = self.cable.snagged.is_some_and(|window| window.contains(t_s));
        if snagged && !self.snagged {
            self.x[9..12].fill(0.0);
            self.snagged = true;
            self.settle();
        }
        self.snagged = snagged;
    }

    /// Where the bodies are.
    #[must_use]
    pub fn bodies(&self) -> Bodies {
        let x = &self.x;
        Bodies {
            position: vector(x, 6),
            velocity: vector(x, 9),
            uav_position: vector(x, 0),
            uav_velocity: vector(x, 3),
            attitude: attitude(x),
            body_rate: vector(x, 16),
        }
    }

    /// The state as the law takes it.
    #[must_use]
    pub fn state(&self) -> State<f64> {
        self.bodies().state()
    }

    /// Whether the cable is taut.
    #[must_use]
    pub fn is_taut(&self) -> bool {
        self.contacts.taut
    }

    /// Whether the payload, and whether a foot of the UAV, is on the ground.
    #[must_use]
    pub fn touching(&self) -> [bool; 2] {
        let [payload, feet @ ..] = self.contacts.touching;
        [payload, feet.contains(&true)]
    }

    /// Kinetic energy, and that of gravity, cable and ground, J; the latter is zero with both
    /// bodies at height zero.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let VehicleParameters { payload_mass, uav_mass, inertia, gravity, rod_length } = self.vehicle;
        let x = &self.x;
        let speed = |first: usize| square(&vector(x, first));
        let spin: f64 = inertia.iter().zip(&x[16..]).map(|(j, o)| j * o * o).sum();
        let moving = 0.5 * (payload_mass * speed(9) + uav_mass * speed(3) + spin);
        let stretch = if self.contacts.taut { self.line(x).length - rod_length } else { 0.0 };
        let cable = self.cable.ea.map_or(0.0, |ea| 0.5 * ea / rod_length * stretch * stretch);
        let ground = self.ground.map_or(0.0, |ground| {
            let [payload, feet @ ..] = self.depths(x);
            feet.into_iter().map(|depth| ground.energy(0.25 * uav_mass, gravity, depth)).sum::<f64>()
                + ground.energy(payload_mass, gravity, payload)
        });
        moving + cable + ground - (x[8] * payload_mass + x[2] * uav_mass) * gravity
    }

    /// Whether every coordinate is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.x.iter().all(|coordinate| coordinate.is_finite())
    }

    /// Accelerations and the cable's pull now, under `command` and `loads`.
    #[must_use]
    pub fn rates(&self, command: &Command<f64>, loads: &Loads) -> Rates {
        self.rates_at(&self.x, command, loads)
    }

    /// The longest step, s, in which cable and ground are resolved.
    #[must_use]
    pub fn largest_step(&self) -> f64 {
        let VehicleParameters { payload_mass, uav_mass, inertia, gravity, rod_length } = self.vehicle;
        let per_inertia = inertia.into_iter().map(f64::recip).fold(0.0, f64::max);
        let cable = self.cable.ea.map_or(0.0, |ea| {
            let hook = square(&Vector3::from(self.cable.hook));
            let per_mass = 1.0 / payload_mass + 1.0 / uav_mass + hook * per_inertia;
            (ea / rod_length * per_mass).sqrt().max(self.cable.damping * per_mass)
        });
        let ground = self.ground.map_or(0.0, |ground| {
            let lever = ground.feet_below.hypot(ground.feet_apart);
            // A foot bears a quarter of the UAV, and of what turns it.
            let feet = ground.rate(uav_mass, gravity, 0.25 * per_inertia, lever);
            feet.max(ground.rate(payload_mass, gravity, 0.0, 0.0))
        });
        1.0 / (STEPS_PER_RADIAN * cable).max(ground)
    }

    /// Moves on by `step` seconds; `command` gives thrust and torque at a time since its start, and
    /// `loads` what the velocities of payload and UAV bring with them.
    pub fn advance(
        &mut self,
        step: f64,
        command: &impl Fn(f64) -> Command<f64>,
        loads: &impl Fn(&Vector3<f64>, &Vector3<f64>) -> Loads,
    ) {
        let mut done = 0.0;
        for _ in 0..CHANGES {
            let left = step - done;
            let fly = |span: f64| {
                let x = self.flown(done, span, command, loads);
                (x, self.contacts_at(&x, &command(done + span), loads))
            };
            let (mut x, mut contacts) = fly(left);
            if contacts == self.contacts {
                self.x = x;
                self.settle();
                return;
            }
            let (mut before, mut after) = (0.0, left);
            while after - before > INSTANT {
                let middle = 0.5 * (before + after);
                let (there, then) = fly(middle);
                if then == self.contacts {
                    before = middle;
                } else {
                    (after, x, contacts) = (middle, there, then);
                }
            }
            self.x = x;
            self.enter(contacts);
            done += after;
            if done >= step {
                return;
            }
        }
        let x = self.flown(done, step - done, command, loads);
        let contacts = self.contacts_at(&x, &command(step), loads);
        self.x = x;
        self.enter(contacts);
    }

    /// The coordinates `span` seconds after `done`, in the contacts that there are.
    fn flown(
        &self,
        done: f64,
        span: f64,
        command: &impl Fn(f64) -> Command<f64>,
        loads: &impl Fn(&Vector3<f64>, &Vector3<f64>) -> Loads,
    ) -> Coordinates {
        let derivative = |t: f64, x: &Coordinates| {
            let rates = self.rates_at(x, &command(t), &loads(&vector(x, 9), &vector(x, 3)));
            let mut rate = [0.0; COORDINATES];
            rate[..3].copy_from_slice(&x[3..6]);
            rate[3..6].copy_from_slice(rates.uav.as_slice());
            rate[6..9].copy_from_slice(&x[9..12]);
            rate[9..12].copy_from_slice(rates.payload.as_slice());
            rate[12..16].copy_from_slice(&quaternion_rate([x[12], x[13], x[14], x[15]], &vector(x, 16)));
            rate[16..].copy_from_slice(rates.body.as_slice());
            rate
        };
        let mut x = rk4_step(derivative, done, &self.x, span);
        let norm = x[12..16].iter().map(|part| part * part).sum::<f64>().sqrt();
        x[12..16].iter_mut().for_each(|part| *part /= norm);
        x
    }

    /// The contacts at `x`, coming from those that there are.
    fn contacts_at(
        &self,
        x: &Coordinates,
        command: &Command<f64>,
        loads: &impl Fn(&Vector3<f64>, &Vector3<f64>) -> Loads,
    ) -> Contacts {
        let line = self.line(x);
        let stretched = line.length > self.vehicle.rod_length;
        let taut = match (self.contacts.taut, self.cable.ea) {
            _ if !self.hooked => false,
            (_, Some(_)) => stretched,
            (false, None) => stretched && line.rate > 0.0,
            (true, None) => {
                let loads = loads(&vector(x, 9), &vector(x, 3));
                self.rates_at(x, command, &loads).pull > -SLACK
            }
        };
        Contacts { taut, touching: self.depths(x).map(|depth| depth > 0.0) }
    }

    /// Goes on in these contacts, through the impact of a cable that has become taut.
    fn enter(&mut self, contacts: Contacts) {
        let parting = self.line(&self.x).rate;
        let jerked = contacts.taut && !self.contacts.taut && self.cable.ea.is_none();
        let restitution = self.cable.restitution;
        self.contacts = contacts;
        if jerked && restitution > 0.0 && parting > SETTLING {
            self.impulse((1.0 + restitution) * parting);
            self.contacts.taut = false;
        } else {
            self.settle();
        }
    }

    /// Puts a taut cable that does not stretch back to its length, and takes its ends' parting or
    /// closing.
    fn settle(&mut self) {
        if !self.contacts.taut || self.cable.ea.is_some() {
            return;
        }
        let line = self.line(&self.x);
        let excess = line.along * (line.length - self.vehicle.rod_length);
        let [per_payload, per_uav] = self.per_mass();
        let (payload, uav) = (per_payload / (per_payload + per_uav), per_uav / (per_payload + per_uav));
        for axis in 0..3 {
            self.x[axis] += uav * excess[axis];
            self.x[6 + axis] -= payload * excess[axis];
        }
        self.impulse(self.line(&self.x).rate);
    }

    /// An impulse along the cable that changes the rate of its length by −`change`, m/s.
    fn impulse(&mut self, change: f64) {
        let line = self.line(&self.x);
        let impulse = change * line.mass;
        let [per_payload, per_uav] = self.per_mass();
        let turn = line.lever.component_div(&Vector3::from(self.vehicle.inertia)) * impulse;
        for axis in 0..3 {
            self.x[3 + axis] += per_uav * impulse * line.along[axis];
            self.x[9 + axis] -= per_payload * impulse * line.along[axis];
            self.x[16 + axis] += turn[axis];
        }
    }

    /// 1/m_L and 1/m_Q; a payload that is held does not give way.
    fn per_mass(&self) -> [f64; 2] {
        let payload = if self.snagged { 0.0 } else { 1.0 / self.vehicle.payload_mass };
        [payload, 1.0 / self.vehicle.uav_mass]
    }

    fn line(&self, x: &Coordinates) -> Line {
        let attitude = attitude(x);
        let hook = Vector3::from(self.cable.hook);
        let d = vector(x, 6) - vector(x, 0) - attitude * hook;
        let d_rate = vector(x, 9) - vector(x, 3) - attitude * vector(x, 16).cross(&hook);
        let length = square(&d).sqrt();
        // Of a payload at the hook, any direction will do.
        let along = if length > 0.0 { d / length } else { Vector3::z() };
        let lever = hook.cross(&attitude.tr_mul(&along));
        let [per_payload, per_uav] = self.per_mass();
        let turned = lever.component_div(&Vector3::from(self.vehicle.inertia));
        Line {
            length,
            rate: along.dot(&d_rate),
            along,
            lever,
            turning: if length > 0.0 { square(&d_rate) / length } else { 0.0 },
            mass: 1.0 / (per_payload + per_uav + lever.dot(&turned)),
        }
    }

    /// How deep each point is in the ground, m.
    fn depths(&self, x: &Coordinates) -> [f64; POINTS] {
        let Some(ground) = self.ground else { return [f64::NEG_INFINITY; POINTS] };
        let attitude = attitude(x);
        let [a, b, c, d] = ground.feet().map(|foot| ground.depth(&(vector(x, 0) + attitude * foot)));
        [ground.payload_depth(&vector(x, 6)), a, b, c, d]
    }

    fn rates_at(&self, x: &Coordinates, command: &Command<f64>, loads: &Loads) -> Rates {
        let VehicleParameters { payload_mass, uav_mass, inertia, gravity, rod_length } = self.vehicle;
        let (attitude, omega, inertia) = (attitude(x), vector(x, 16), Vector3::from(inertia));
        let b3: Vector3<f64> = attitude.column(2).into();
        let mut on_payload = loads.payload_force;
        let mut on_uav = loads.uav_force - b3 * command.thrust;
        let mut torque = command.torque + loads.torque + inertia.component_mul(&omega).cross(&omega);
        if let Some(ground) = &self.ground {
            let [payload, feet @ ..] = self.depths(x);
            on_payload += ground.reaction(payload_mass, gravity, payload, &vector(x, 9));
            for (foot, depth) in ground.feet().into_iter().zip(feet) {
                let velocity = vector(x, 3) + attitude * omega.cross(&foot);
                let reaction = ground.reaction(0.25 * uav_mass, gravity, depth, &velocity);
                on_uav += reaction;
                torque += foot.cross(&attitude.tr_mul(&reaction));
            }
        }
        let weight = Vector3::new(0.0, 0.0, gravity);
        let held = if self.snagged { 0.0 } else { 1.0 };
        let mut payload = (on_payload / payload_mass + weight) * held;
        let mut uav = on_uav / uav_mass + weight;
        let mut body = torque.component_div(&inertia);
        let mut pull = 0.0;
        if self.contacts.taut {
            let line = self.line(x);
            pull = match self.cable.ea {
                Some(ea) => (ea / rod_length * (line.length - rod_length) + self.cable.damping * line.rate).max(0.0),
                None => {
                    let hook = Vector3::from(self.cable.hook);
                    let hung = uav + attitude * (body.cross(&hook) + omega.cross(&omega.cross(&hook)));
                    line.mass * (line.along.dot(&(payload - hung)) + line.turning)
                }
            };
            payload -= line.along * (held * pull / payload_mass);
            uav += line.along * (pull / uav_mass);
            body += line.lever.component_div(&inertia) * pull;
        }
        Rates { payload, uav, body, pull }
    }
}

fn attitude(x: &Coordinates) -> Matrix3<f64> {
    rotation([x[12], x[13], x[14], x[15]])
}
