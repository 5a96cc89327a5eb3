//! Whatever bits come in, finite and bounded commands go out, and nothing stays.
//!
//! `TOTALITY_STEPS` sets the number of steps; 300,000 by default.

use controller::{
    ActuatorLimits, ApproachLimits, Band, Circle, Command, Curve, EnvelopeParams, Follow, Follower, Gains, Lost,
    Matrix3, Measured, ObserverParams, Policy, Request, Sampling, State, Supervisor, Uav, Vector3, Vehicle,
    VehicleParams,
};

use crate::flight::{LIMITS, PERIOD, assert_bounded, follower, gains, supervise, vehicle};

/// A small generator of bits: xorshift.
struct Bits(u64);

impl Bits {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Any f32 there is: half of them any bits, half of them the odd ones and whole numbers.
    fn raw(&mut self) -> f32 {
        const ODD: [u32; 12] = [
            0,
            1,
            0x8000_0000,
            0x8000_0001,
            0x0080_0000,
            0x7F7F_FFFF,
            0xFF7F_FFFF,
            0x7F80_0000,
            0xFF80_0000,
            0x7FC0_0000,
            0x3F80_0000,
            0xBF80_0000,
        ];
        let bits = self.next();
        if bits & 1 == 0 {
            f32::from_bits((bits >> 32) as u32)
        } else {
            f32::from_bits(ODD[(bits >> 8) as usize % ODD.len()])
        }
    }

    /// Between −1 and 1.
    fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    }

    /// Of any size up to `most`, the small ones as likely as the large.
    fn sized(&mut self, most: f32) -> f32 {
        let size = 10.0_f32.powf(-8.0 * self.unit().abs());
        self.unit().signum() * most * size
    }

    fn vector(&mut self, most: f32) -> Vector3<f32> {
        Vector3::new(self.sized(most), self.sized(most), self.sized(most))
    }

    fn direction(&mut self) -> Vector3<f32> {
        let v = Vector3::new(self.unit(), self.unit(), self.unit());
        v / v.dot(&v).sqrt().max(1e-3)
    }

    /// A state that passes for one: any direction of the rod, any attitude, any size of the rest.
    fn state(&mut self) -> State<f32> {
        let b3 = self.direction();
        let b1 = self.direction();
        let b1 = b1 - b3 * b3.dot(&b1);
        let b1 = b1 / b1.dot(&b1).sqrt().max(1e-6);
        let rod = if self.next() & 3 == 0 { Vector3::z() } else { self.direction() };
        let rates = self.sized(100.0).abs();
        State {
            position: self.vector(1e5),
            velocity: self.vector(1e3),
            rod,
            rod_rate: self.vector(rates.min(57.0)),
            attitude: Matrix3::from_columns(&[b1, b3.cross(&b1), b3]),
            body_rate: self.vector(57.0),
        }
    }

    /// The same with some of its numbers replaced by any bits.
    fn spoilt(&mut self) -> State<f32> {
        let mut state = self.state();
        for _ in 0..self.next() % 4 {
            let bits = self.raw();
            let place = (self.next() >> 16) as usize;
            match place % 6 {
                0 => state.position[place / 6 % 3] = bits,
                1 => state.velocity[place / 6 % 3] = bits,
                2 => state.rod[place / 6 % 3] = bits,
                3 => state.rod_rate[place / 6 % 3] = bits,
                4 => state.attitude[place / 6 % 9] = bits,
                _ => state.body_rate[place / 6 % 3] = bits,
            }
        }
        state
    }

    /// Any bits throughout.
    fn noise(&mut self) -> State<f32> {
        let mut vector = || Vector3::new(self.raw(), self.raw(), self.raw());
        State {
            position: vector(),
            velocity: vector(),
            rod: vector(),
            rod_rate: vector(),
            attitude: Matrix3::from_columns(&[vector(), vector(), vector()]),
            body_rate: vector(),
        }
    }

    /// Follow as often as all others.
    fn request(&mut self) -> Request {
        match self.next() >> 60 {
            0 => Request::Off,
            1 => Request::Idle,
            2..4 => Request::Hold,
            4 => Request::Land,
            _ => Request::Follow,
        }
    }
}

fn steps() -> usize {
    std::env::var("TOTALITY_STEPS").map_or(300_000, |steps| steps.parse().expect("a number of steps"))
}

#[test]
fn every_bit_pattern_of_the_state_is_answered_and_leaves_no_trace() {
    let mut bits = Bits(0x9E37_79B9_7F4A_7C15);
    let policies = [Policy::default(), Policy { lost: Lost::Cut, coast: 0.004, calm: 0.0, ..Policy::default() }];
    let samplings = [
        Sampling::every(PERIOD as f32),
        Sampling { latency: 0.01, rotor_lag: 0.05, ..Sampling::every(PERIOD as f32) },
        Sampling { look_ahead: false, ..Sampling::every(0.02) },
    ];
    let steps = steps();
    let mut done = 0;
    let mut flown = [0_usize; 8];
    while done < steps {
        let sampling = samplings[bits.next() as usize % samplings.len()];
        let policy = policies[bits.next() as usize % policies.len()];
        let integral = [[0.0; 3], [100.0, 100.0, 10.0]][bits.next() as usize % 2];
        let make = || supervise(follower(1.0, 4.0, sampling, integral), policy);
        let mut law = make();
        let mut request = bits.request();
        let near: State<f32> = State::at_rest(Vector3::new(5.5, 0.2, -10.0));
        let applied = Command { thrust: 29.43, torque: Vector3::zeros() };
        for _ in 0..1000 {
            let roll = bits.next() >> 56;
            if roll < 8 {
                request = bits.request();
            } else if roll < 10 {
                let applied = Command { thrust: bits.raw(), torque: Vector3::repeat(bits.raw()) };
                let state = bits.spoilt();
                let expected = if state.check().is_err() { false } else { applied.is_finite() };
                assert_eq!(law.take_over(&state, applied).is_ok(), expected);
            } else if roll < 12 {
                let _ = law.start(&bits.spoilt(), [bits.raw(), bits.raw(), bits.raw(), bits.raw()]);
            } else if roll < 20 {
                law.take_over(&near, applied).unwrap();
            } else if roll < 28 {
                request = Request::Follow;
                law.start(&near, [0.0; 4]).unwrap();
            }
            let state = match bits.next() >> 61 {
                0 => Some(bits.noise()),
                1 => Some(bits.spoilt()),
                2 => Some(bits.state()),
                3 => None,
                // A good one, so that the modes of flight are reached and left from.
                _ => Some(State { velocity: bits.vector(0.5), body_rate: bits.vector(0.5), ..near }),
            };
            let uav = match bits.next() >> 61 {
                0 => Some(Uav::of(&bits.noise(), &vehicle())),
                1 => Some(Uav::of(&bits.spoilt(), &vehicle())),
                2 => Some(Uav::of(&near, &vehicle())),
                _ => None,
            };
            let specific_force = (bits.next() >> 62 == 0).then(|| Vector3::new(bits.raw(), bits.raw(), bits.raw()));
            let measured = Measured { state: state.as_ref(), uav: uav.as_ref(), specific_force };
            let output = law.step(measured, request);
            assert_bounded(&output);
            assert!(law.disturbance().payload.iter().all(|d| d.is_finite()), "{:?}", law.disturbance());
            flown[output.mode as usize] += 1;
            done += 1;
        }
        // The next good samples are flown as by a controller that has seen nothing else.
        let mut fresh = make();
        law.take_over(&near, applied).unwrap();
        fresh.take_over(&near, applied).unwrap();
        for request in [Request::Hold, Request::Follow, Request::Follow, Request::Follow, Request::Land] {
            assert_eq!(law.step(Some(&near), request), fresh.step(Some(&near), request));
        }
    }
    println!("{done} steps, by mode {flown:?}");
    assert!(flown.iter().all(|&flown| flown > done / 1000), "a mode was hardly tried: {flown:?}");
}

/// All parameters of a controller, good ones.
#[derive(Clone, Copy, Debug)]
struct Setup {
    vehicle: VehicleParams<f32>,
    circle: [f32; 3],
    gains: Gains<f32>,
    sampling: Sampling<f32>,
    limits: ActuatorLimits<f32>,
    observer: ObserverParams<f32>,
    envelope: EnvelopeParams<f32>,
    approach: ApproachLimits<f32>,
    policy: Policy<f32>,
}

impl Setup {
    fn good() -> Self {
        Self {
            vehicle: VehicleParams::paper(),
            circle: [5.0, -10.0, 1.0],
            gains: gains([0.0; 3]),
            sampling: Sampling { latency: 0.01, rotor_lag: 0.05, ..Sampling::every(PERIOD as f32) },
            limits: LIMITS,
            observer: ObserverParams::with_bandwidth(4.0),
            envelope: EnvelopeParams::wide(),
            approach: ApproachLimits::gentle(),
            policy: Policy::default(),
        }
    }

    /// Every number in it, each with the name its error has.
    fn numbers(&mut self) -> Vec<(&'static str, &mut f32)> {
        let Self { vehicle, circle, gains, sampling, limits, observer, envelope, approach, policy } = self;
        let [j1, j2, j3] = &mut vehicle.inertia;
        let [radius, p3, speed] = circle;
        let [t1, t2, t3] = &mut limits.max_torque;
        let mut numbers = vec![
            ("payload_mass", &mut vehicle.payload_mass),
            ("uav_mass", &mut vehicle.uav_mass),
            ("rod_length", &mut vehicle.rod_length),
            ("inertia[0]", j1),
            ("inertia[1]", j2),
            ("inertia[2]", j3),
            ("gravity", &mut vehicle.gravity),
            ("radius", radius),
            ("p3", p3),
            ("speed", speed),
            ("period", &mut sampling.period),
            ("latency", &mut sampling.latency),
            ("rotor_lag", &mut sampling.rotor_lag),
            ("min_thrust", &mut limits.min_thrust),
            ("max_thrust", &mut limits.max_thrust),
            ("max_torque[0]", t1),
            ("max_torque[1]", t2),
            ("max_torque[2]", t3),
            ("payload_bandwidth", &mut observer.payload_bandwidth),
            ("rod_bandwidth", &mut observer.rod_bandwidth),
            ("torque_bandwidth", &mut observer.torque_bandwidth),
            ("payload_bound", &mut observer.payload_bound),
            ("rod_bound", &mut observer.rod_bound),
            ("torque_lever", &mut observer.torque_lever),
            ("speed", &mut approach.speed),
            ("acceleration", &mut approach.acceleration),
            ("tilt", &mut approach.tilt),
            ("rod_angle", &mut approach.rod_angle),
            ("min_thrust", &mut approach.min_thrust),
            ("max_thrust", &mut approach.max_thrust),
            ("coast", &mut policy.coast),
            ("calm", &mut policy.calm),
            ("descent", &mut policy.descent),
            ("rise", &mut policy.rise),
            ("clear", &mut policy.clear),
            ("aside", &mut policy.aside),
            ("payload_lost", &mut policy.payload_lost),
        ];
        if let Lost::Sink(share) = &mut policy.lost {
            numbers.push(("lost", share));
        }
        let EnvelopeParams { rod_angle, thrust_angle, roll, tension, thrust, path, reach } = envelope;
        let bands = [
            ("rod_angle", rod_angle),
            ("thrust_angle", thrust_angle),
            ("roll", roll),
            ("tension", tension),
            ("thrust", thrust),
            ("path", path),
            ("reach", reach),
        ];
        for (name, Band { warning, limit }) in bands {
            numbers.extend([(name, warning), (name, limit)]);
        }
        for k in [&mut gains.k1[..], &mut gains.k2[..], &mut gains.k3[..], &mut gains.k4[..], &mut gains.integral[..]]
        {
            numbers.extend(k.iter_mut().map(|k| ("gain", k)));
        }
        numbers
    }

    /// The controller of these parameters, or the first error's text.
    fn make(&self) -> Result<Supervisor<f32, Follow<f32, impl controller::Path<f32> + use<>>>, String> {
        let text = |error: &dyn std::fmt::Display| error.to_string();
        let vehicle = Vehicle::new(self.vehicle).map_err(|e| text(&e))?;
        let [radius, p3, speed] = self.circle;
        let path = Circle::new(radius, p3).and_then(|circle| circle.at_speed(speed)).map_err(|e| text(&e))?;
        let follower = Follower::new(vehicle, path, self.gains, self.sampling).map_err(|e| text(&e))?;
        let follower = follower.with_limits(self.limits).map_err(|e| text(&e))?;
        let follower = follower.with_observer(self.observer).map_err(|e| text(&e))?;
        Supervisor::new(follower, self.envelope, self.approach, self.policy).map_err(|e| text(&e))
    }
}

#[test]
fn every_parameter_is_refused_by_name_when_it_is_no_number() {
    let count = Setup::good().numbers().len();
    assert!(Setup::good().make().is_ok());
    for i in 0..count {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut setup = Setup::good();
            let mut numbers = setup.numbers();
            let (name, number) = &mut numbers[i];
            let name = *name;
            **number = value;
            drop(numbers);
            match setup.make() {
                Err(text) => assert!(text.contains(name), "{name} = {value}: {text}"),
                Ok(_) => panic!("{name} = {value} accepted"),
            }
        }
    }
}

#[test]
fn parameters_of_any_bits_are_refused_or_answered_with() {
    let mut bits = Bits(0xD1B5_4A32_D192_ED03);
    let (mut refused, mut accepted) = (0, 0);
    for _ in 0..steps() / 30 {
        let mut setup = Setup::good();
        let mut numbers = setup.numbers();
        for _ in 0..1 + bits.next() % 3 {
            let i = (bits.next() >> 8) as usize % numbers.len();
            let raw = bits.raw();
            let scaled = *numbers[i].1 * 10.0_f32.powf(2.0 * bits.unit());
            *numbers[i].1 = if bits.next() & 1 << 9 == 0 { raw } else { scaled };
        }
        drop(numbers);
        let Ok(mut law) = setup.make() else {
            refused += 1;
            continue;
        };
        accepted += 1;
        law.take_over(&State::at_rest(Vector3::new(5.0, 0.0, -10.0)), Command::of_thrust(29.43)).unwrap();
        for _ in 0..20 {
            let state = if bits.next() & 3 == 0 { bits.spoilt() } else { bits.state() };
            let Command { thrust, torque } = law.step(Some(&state), bits.request()).command;
            let limits = &setup.limits;
            let within = thrust >= limits.min_thrust && thrust <= limits.max_thrust;
            let within = within && torque.iter().zip(limits.max_torque).all(|(torque, most)| torque.abs() <= most);
            assert!(within || (thrust == 0.0 && torque == Vector3::zeros()), "{thrust} {torque} of {setup:?}");
        }
    }
    println!("{refused} refused, {accepted} accepted");
    assert!(refused > 100 && accepted > 100, "{refused} {accepted}");
}
