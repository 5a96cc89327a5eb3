//! Any bytes are a flight: parameters, then steps of a request and a state each. What goes out is
//! to be finite and within the limits, and what came in is to leave no trace.
#![no_main]

use controller::{
    ActuatorLimits, ApproachLimits, Circle, Command, EnvelopeParams, Curve, Follow, Follower, Gains, Lost, Matrix3, ObserverParams,
    Path, Policy, Request, RotorParams, Rotors, Sampling, State, Supervisor, Vector3, Vehicle, VehicleParams,
};
use libfuzzer_sys::fuzz_target;

const LIMITS: ActuatorLimits<f32> = ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] };

/// Reads numbers off the input until it ends; a state's numbers are offsets from a good one where
/// the selector says so.
struct Input<'a>(&'a [u8]);

impl Input<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    fn raw(&mut self) -> Option<f32> {
        let (bits, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(f32::from_le_bytes(*bits))
    }

    fn vector(&mut self) -> Option<Vector3<f32>> {
        Some(Vector3::new(self.raw()?, self.raw()?, self.raw()?))
    }

    fn state(&mut self) -> Option<State<f32>> {
        let mut state = near();
        let parts = self.byte()?;
        let has = |part: u8| parts & (1 << part) != 0;
        if has(0) {
            state.position = self.vector()?;
        }
        if has(1) {
            state.velocity = self.vector()?;
        }
        if has(2) {
            state.rod = self.vector()?;
        }
        if has(3) {
            state.rod_rate = self.vector()?;
        }
        if has(4) {
            state.attitude = Matrix3::from_columns(&[self.vector()?, self.vector()?, self.vector()?]);
        }
        if has(5) {
            state.body_rate = self.vector()?;
        }
        if has(6) {
            // Brought to unit length, so that the law sees it.
            let length = state.rod.dot(&state.rod).sqrt();
            state.rod /= length;
        }
        Some(state)
    }
}

fn near() -> State<f32> {
    State::at_rest(Vector3::new(5.5, 0.2, -10.0))
}

fn supervisor(choice: u8) -> Supervisor<f32, Follow<f32, impl Path<f32>>> {
    let vehicle = Vehicle::new(VehicleParams::paper()).unwrap();
    let integral = if choice & 1 == 0 { [0.0; 3] } else { [108.0, 108.0, 12.0] };
    let gains = Gains { integral, ..Gains::spread(1.0).unwrap() };
    let late = if choice & 2 == 0 { 0.0 } else { 0.01 };
    let sampling = Sampling { latency: late, rotor_lag: 5.0 * late, ..Sampling::every(0.002) };
    let path = Circle::new(5.0, -10.0).unwrap().at_speed(1.0).unwrap();
    let bandwidth = if choice & 4 == 0 { 4.0 } else { 0.0 };
    let follower = Follower::new(vehicle, path, gains, sampling).unwrap();
    let follower = follower.with_limits(LIMITS).unwrap();
    let follower = follower.with_observer(ObserverParams::with_bandwidth(bandwidth)).unwrap();
    let lost = if choice & 8 == 0 { Lost::Sink(0.9) } else { Lost::Cut };
    let policy = Policy { lost, calm: if choice & 16 == 0 { 1.0 } else { 0.0 }, ..Policy::default() };
    Supervisor::new(follower, EnvelopeParams::wide(), ApproachLimits::gentle(), policy).unwrap()
}

fn check(command: &Command<f32>) {
    let Command { thrust, torque } = command;
    let within = (LIMITS.min_thrust..=LIMITS.max_thrust).contains(thrust)
        && torque.iter().zip(LIMITS.max_torque).all(|(torque, most)| torque.abs() <= most);
    assert!(within || *command == Command::zero(), "{command:?}");
}

/// `None` at the input's end.
fn fly(input: &mut Input<'_>, law: &mut Supervisor<f32, Follow<f32, impl Path<f32>>>, rotors: &Rotors<f32, 4>) -> Option<()> {
    let mut request = Request::Follow;
    loop {
        let choice = input.byte()?;
        match choice >> 4 {
            0 => request = Request::Off,
            1 => request = Request::Idle,
            2 => request = Request::Hold,
            3 => request = Request::Land,
            4 => request = Request::Follow,
            // What is refused changes nothing.
            5 => _ = law.take_over(&input.state()?, Command { thrust: input.raw()?, torque: input.vector()? }),
            6 => _ = law.start(&input.state()?, [input.raw()?, input.raw()?, input.raw()?, input.raw()?]),
            7 => law.take_over(&near(), Command::of_thrust(29.43)).unwrap(),
            8 => {
                let found = rotors.allocate(&Command { thrust: input.raw()?, torque: input.vector()? });
                assert!(
                    found.applied.is_finite() && found.speeds.iter().all(|speed| speed.is_finite() && *speed >= 0.0)
                );
            }
            _ => {}
        }
        let state = if choice & 8 == 0 { Some(input.state()?) } else { None };
        // The same state for a while: modes take their time.
        for _ in 0..1 << (choice & 7) {
            check(&law.step(state.as_ref(), request).command);
        }
    }
}

fuzz_target!(|data: &[u8]| {
    let mut input = Input(data);
    let Some(choice) = input.byte() else { return };
    let mut law = supervisor(choice);
    let rotors = Rotors::quad_x(RotorParams::typical(29.43, 4), 0.25).unwrap();
    fly(&mut input, &mut law, &rotors);
    let mut fresh = supervisor(choice);
    let applied = Command::of_thrust(29.43);
    law.take_over(&near(), applied).unwrap();
    fresh.take_over(&near(), applied).unwrap();
    for request in [Request::Hold, Request::Follow, Request::Follow, Request::Land] {
        assert_eq!(law.step(Some(&near()), request), fresh.step(Some(&near()), request));
    }
});
