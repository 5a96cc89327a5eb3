//! A vehicle with a cable that can go slack, over ground: two bodies, a cable that pulls only, and
//! what the supervisor makes of them from the UAV's own navigation. The plant here shares no
//! equation with the library's model of a taut rod.

use controller::{
    ActuatorLimits, ApproachLimits, Channel, Circle, Command, Curve, EnvelopeParams, Fault, Follow, Follower, Gains,
    Margin, Matrix3, Measured, Mode, ObserverParams, Path, Policy, Request, Sampling, State, Supervisor, Uav,
    Vector3, Vehicle, VehicleParams,
};

type V = Vector3<f64>;

const PERIOD: f64 = 0.002;
const SUBSTEPS: usize = 20;
/// Stiffness and damping of cable (N/m, N·s/m) and ground per kg (1/s², 1/s).
const CABLE: [f64; 2] = [8000.0, 20.0];
const GROUND: [f64; 2] = [4000.0, 100.0];
const FRICTION: f64 = 0.6;

/// What flies, and what it is told to be.
#[derive(Clone, Copy)]
struct Setting {
    payload_mass: f64,
    told_mass: f64,
    uav_mass: f64,
    length: f64,
    told_length: f64,
    /// Of the thrust that is commanded, what acts.
    thrust: f64,
    inertia: [f64; 3],
    /// Force of wind on the UAV along n1, N.
    wind: f64,
}

const PAPER: Setting = Setting {
    payload_mass: 0.5,
    told_mass: 0.5,
    uav_mass: 2.5,
    length: 2.0,
    told_length: 2.0,
    thrust: 1.0,
    inertia: [0.03, 0.03, 0.05],
    wind: 0.0,
};

impl Setting {
    /// With a cable of this length, m, as it is told.
    const fn on(self, length: f64) -> Self {
        Self { length, told_length: length, ..self }
    }
}

struct World {
    setting: Setting,
    load: V,
    load_velocity: V,
    uav: Uav<f64>,
    /// p3 of the ground, m, and how fast each has touched it, m/s.
    ground: f64,
    uav_touch: f64,
    load_touch: f64,
    tension: f64,
}

fn norm(v: &V) -> f64 {
    v.dot(v).sqrt()
}

/// The ground's force on a body of `mass`, and whether it touches.
fn ground(p3: f64, position: &V, velocity: &V, mass: f64) -> (V, bool) {
    let depth = position.z - p3;
    if depth <= 0.0 {
        return (V::zeros(), false);
    }
    let normal = (mass * (GROUND[0] * depth + GROUND[1] * velocity.z)).max(0.0);
    let level = V::new(velocity.x, velocity.y, 0.0);
    let sliding = norm(&level).max(1e-3);
    (V::new(0.0, 0.0, -normal) - level * (FRICTION * normal / sliding), true)
}

impl World {
    /// Hanging at rest from a UAV at `position`, or with the load on the ground `aside` of it.
    fn new(setting: Setting, uav: V, load: V, ground: f64) -> Self {
        let uav = Uav { position: uav, velocity: V::zeros(), attitude: Matrix3::identity(), body_rate: V::zeros() };
        let (uav_touch, load_touch, tension) = (0.0, 0.0, 0.0);
        Self { setting, load, load_velocity: V::zeros(), uav, ground, uav_touch, load_touch, tension }
    }

    fn advance(&mut self, command: &Command<f32>) {
        let Setting { payload_mass, uav_mass, length, thrust, inertia, wind, .. } = self.setting;
        let dt = PERIOD / SUBSTEPS as f64;
        let torque: V = command.torque.map(f64::from);
        let inertia = V::from(inertia);
        for _ in 0..SUBSTEPS {
            let line = self.load - self.uav.position;
            let distance = norm(&line);
            let along = line / distance;
            let parting = (self.load_velocity - self.uav.velocity).dot(&along);
            let stretch = distance - length;
            self.tension = if stretch > 0.0 { (CABLE[0] * stretch + CABLE[1] * parting).max(0.0) } else { 0.0 };
            let gravity = V::new(0.0, 0.0, 9.81);
            let b3: V = self.uav.attitude.column(2).into();
            let (on_load, load_touches) = ground(self.ground, &self.load, &self.load_velocity, payload_mass);
            let (on_uav, uav_touches) = ground(self.ground, &self.uav.position, &self.uav.velocity, uav_mass);
            if load_touches {
                self.load_touch = self.load_touch.max(self.load_velocity.z);
            }
            if uav_touches {
                self.uav_touch = self.uav_touch.max(self.uav.velocity.z);
            }
            let pull = along * self.tension;
            let on_uav = on_uav + pull + V::new(wind, 0.0, 0.0) - b3 * (f64::from(command.thrust) * thrust);
            self.load_velocity += (gravity + (on_load - pull) / payload_mass) * dt;
            self.load += self.load_velocity * dt;
            self.uav.velocity += (gravity + on_uav / uav_mass) * dt;
            self.uav.position += self.uav.velocity * dt;
            if uav_touches {
                // It stands on legs.
                self.uav.body_rate = V::zeros();
                continue;
            }
            let rate = self.uav.body_rate;
            self.uav.body_rate += (torque - rate.cross(&inertia.component_mul(&rate))).component_div(&inertia) * dt;
            let angle = self.uav.body_rate * dt;
            let size = norm(&angle);
            if size > 0.0 {
                let k = angle / size;
                let cross = Matrix3::new(0.0, -k.z, k.y, k.z, 0.0, -k.x, -k.y, k.x, 0.0);
                let turn = Matrix3::identity() + cross * size.sin() + cross * cross * (1.0 - size.cos());
                self.uav.attitude *= turn;
            }
        }
    }
}

/// A flight under the supervisor, which sees load and UAV as motion capture does.
struct Flight<P> {
    world: World,
    supervisor: Supervisor<f32, Follow<f32, P>>,
    /// Whether the load is seen, and whether the UAV has its own navigation.
    sees_load: bool,
    has_navigation: bool,
}

fn flight(setting: Setting, uav: V, load: V, ground: f64) -> Flight<impl Path<f32>> {
    let vehicle = Vehicle::new(VehicleParams {
        payload_mass: setting.told_mass as f32,
        uav_mass: setting.uav_mass as f32,
        rod_length: setting.told_length as f32,
        inertia: setting.inertia.map(|j| j as f32),
        gravity: 9.81,
    })
    .unwrap();
    let path = Circle::new(5.0, -10.0).unwrap().at_speed(1.0).unwrap();
    let hover = vehicle.hover_thrust();
    let limits = ActuatorLimits { min_thrust: 0.05 * hover, max_thrust: 2.0 * hover, max_torque: [0.1 * hover; 3] };
    let follower = Follower::new(vehicle, path, Gains::spread(1.0).unwrap(), Sampling::every(PERIOD as f32))
        .and_then(|follower| follower.with_limits(limits))
        .and_then(|follower| follower.with_observer(ObserverParams::with_bandwidth(4.0)))
        .unwrap();
    let supervisor =
        Supervisor::new(follower, EnvelopeParams::wide(), ApproachLimits::gentle(), Policy::default()).unwrap();
    Flight { world: World::new(setting, uav, load, ground), supervisor, sees_load: true, has_navigation: true }
}

/// Hanging at `height` m above the ground at p3 = 0.
fn hanging(setting: Setting, height: f64) -> Flight<impl Path<f32>> {
    let load = V::new(5.0, 0.0, -height);
    let stretch = setting.payload_mass * 9.81 / CABLE[0];
    let mut flight = flight(setting, load - V::new(0.0, 0.0, setting.length + stretch), load, 0.0);
    let state = flight.state();
    let hover = (setting.payload_mass + setting.uav_mass) * 9.81 / setting.thrust;
    flight.supervisor.take_over(&state, Command::of_thrust(hover as f32)).unwrap();
    flight
}

impl<P: Path<f32>> Flight<P> {
    fn uav(&self) -> Uav<f32> {
        let Uav { position, velocity, attitude, body_rate } = &self.world.uav;
        Uav {
            position: position.map(|x| x as f32),
            velocity: velocity.map(|x| x as f32),
            attitude: attitude.map(|x| x as f32),
            body_rate: body_rate.map(|x| x as f32),
        }
    }

    fn state(&self) -> State<f32> {
        self.uav().with_load(self.world.load.map(|x| x as f32), self.world.load_velocity.map(|x| x as f32))
    }

    fn step(&mut self, request: Request) -> controller::Output<f32> {
        let (uav, state) = (self.uav(), self.state());
        let state = self.sees_load.then_some(&state);
        let uav = self.has_navigation.then_some(&uav);
        let output = self.supervisor.step(Measured { state, uav, specific_force: None }, request);
        assert!(output.command.is_finite());
        self.world.advance(&output.command);
        output
    }
}

#[test]
fn landing_sets_down_the_load_and_then_the_uav_beside_it() {
    let heavy =
        Setting { payload_mass: 10.0, told_mass: 10.0, uav_mass: 25.0, inertia: [1.5, 1.5, 2.5], ..PAPER.on(10.0) };
    for (name, setting) in [
        ("0.5 m", PAPER.on(0.5)),
        ("2 m", PAPER),
        ("5 m", PAPER.on(5.0)),
        ("15 m", PAPER.on(15.0)),
        ("1 kg told 0.5", Setting { payload_mass: 1.0, ..PAPER }),
        ("thrust 85 %", Setting { thrust: 0.85, ..PAPER }),
        ("thrust 115 %", Setting { thrust: 1.15, ..PAPER }),
        ("wind", Setting { wind: 2.0, ..PAPER }),
        ("25 kg with 10", heavy),
    ] {
        let mut flight = hanging(setting, 3.0);
        for _ in 0..3000 {
            flight.step(Request::Hold);
        }
        let mut landed = None;
        for step in 0..60_000 {
            if flight.step(Request::Land).mode == Mode::Off {
                landed = Some(f64::from(step) * PERIOD);
                break;
            }
        }
        let World { uav_touch, load_touch, load, uav, .. } = &flight.world;
        let apart = norm(&(load - uav.position));
        println!("{name}: load {load_touch:.2}, UAV {uav_touch:.2} m/s, {apart:.2} m apart after {landed:?} s");
        assert!(landed.is_some(), "{name}: not landed");
        assert!(*load_touch <= 0.6 && *uav_touch <= 0.6, "{name}: {load_touch} and {uav_touch} m/s");
        assert!(*uav_touch > 0.0, "{name}: rotors off in the air");
    }
}

/// The rod's direction is all that tells of the UAV: it is flown around its load, which stands.
#[test]
fn landing_by_the_rod_alone_brings_the_uav_down_as_slowly() {
    let scaled = |kg: f64, setting: Setting| Setting {
        payload_mass: kg,
        told_mass: kg,
        uav_mass: 5.0 * kg,
        inertia: [0.03, 0.03, 0.05].map(|j| j * kg / 0.5),
        ..setting
    };
    let paper = |height| (height, PAPER);
    for (name, (height, setting)) in [
        ("0.5 m", (3.0, PAPER.on(0.5))),
        ("1 m", (3.0, PAPER.on(1.0))),
        ("2 m", paper(3.0)),
        ("2 m, ground at once", paper(0.02)),
        ("2 m, ground soon", paper(0.3)),
        ("5 m", (3.0, PAPER.on(5.0))),
        ("15 m", (3.0, PAPER.on(15.0))),
        ("0.1 kg", (3.0, scaled(0.1, PAPER))),
        ("10 kg on 10 m", (3.0, scaled(10.0, PAPER.on(10.0)))),
        ("0.1 kg under 2.5", (3.0, Setting { payload_mass: 0.1, told_mass: 0.1, ..PAPER })),
        ("1.5 kg under 2.5", (3.0, Setting { payload_mass: 1.5, told_mass: 1.5, ..PAPER })),
        ("1 kg told 0.5", (3.0, Setting { payload_mass: 1.0, ..PAPER })),
        ("0.35 kg told 0.5", (3.0, Setting { payload_mass: 0.35, ..PAPER })),
        ("thrust 85 %", (3.0, Setting { thrust: 0.85, ..PAPER })),
        ("thrust 115 %", (3.0, Setting { thrust: 1.15, ..PAPER })),
        ("wind", (3.0, Setting { wind: 1.0, ..PAPER })),
    ] {
        let mut flight = hanging(setting, height);
        flight.has_navigation = false;
        for _ in 0..3000 {
            flight.step(Request::Hold);
        }
        let mut landed = None;
        let mut nearest = f64::INFINITY;
        for step in 0..60_000 {
            if flight.step(Request::Land).mode == Mode::Off {
                landed = Some(f64::from(step) * PERIOD);
                break;
            }
            nearest = nearest.min(norm(&(flight.world.load - flight.world.uav.position)));
        }
        let World { uav_touch, load_touch, load, uav, .. } = &flight.world;
        let apart = norm(&(load - uav.position));
        println!(
            "{name}: load {load_touch:.2}, UAV {uav_touch:.2} m/s, {nearest:.2} m apart at least, {apart:.2} m after {landed:?} s"
        );
        assert!(landed.is_some(), "{name}: not landed");
        assert!(*load_touch <= 0.6 && *uav_touch <= 0.6, "{name}: {load_touch} and {uav_touch} m/s");
        assert!(*uav_touch > 0.0, "{name}: rotors off in the air");
        // The cable is taut but for the moment in which the load is set down.
        assert!(nearest > 0.7 * setting.length, "{name}: {nearest} m from its load");
    }
}

#[test]
fn a_load_that_is_not_seen_for_two_seconds_costs_no_height() {
    let mut flight = hanging(PAPER, 10.0);
    for _ in 0..5000 {
        flight.step(Request::Follow);
    }
    assert_eq!(flight.supervisor.mode(), Mode::Follow);
    flight.sees_load = false;
    let height = flight.world.uav.position.z;
    let mut lost = 0.0_f64;
    for step in 0..1000 {
        let output = flight.step(Request::Follow);
        lost = lost.max(flight.world.uav.position.z - height);
        assert_eq!(output.fault, Some(Fault::NoState));
        assert_eq!(output.mode, if step < 50 { Mode::Follow } else { Mode::Hold }, "step {step}");
    }
    println!("{lost:.2} m lost");
    assert!(lost < 1.0, "{lost} m lost");
    flight.sees_load = true;
    for _ in 0..15_000 {
        flight.step(Request::Follow);
    }
    assert_eq!(flight.supervisor.mode(), Mode::Follow);
}

/// For two seconds of following the load is measured elsewhere, at the origin or where it was, or
/// moves as it did. The UAV knows better, since no cable reaches that far, or the load is not where
/// that leads, and holds.
#[test]
fn a_load_that_is_measured_wrong_for_two_seconds_costs_no_height() {
    type Wrong = fn(&State<f32>, &State<f32>) -> State<f32>;
    let at_the_origin: Wrong = |now, _| State { position: Vector3::zeros(), velocity: Vector3::zeros(), ..*now };
    let where_it_was: Wrong = |now, then| State { position: then.position, velocity: then.velocity, ..*now };
    let as_it_did: Wrong = |now, then| State { velocity: then.velocity, ..*now };
    for (name, wrong) in [("at the origin", at_the_origin), ("where it was", where_it_was), ("as it did", as_it_did)]
    {
        let mut flight = hanging(PAPER, 10.0);
        for _ in 0..5000 {
            flight.step(Request::Follow);
        }
        assert_eq!(flight.supervisor.mode(), Mode::Follow);
        let (then, height) = (flight.state(), flight.world.uav.position.z);
        let mut lost = 0.0_f64;
        let mut last = None;
        for step in 0..16_000 {
            let (uav, state) = (flight.uav(), flight.state());
            let state = if step < 1000 { wrong(&state, &then) } else { state };
            let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: None };
            let output = flight.supervisor.step(measured, Request::Follow);
            flight.world.advance(&output.command);
            if step < 1500 {
                lost = lost.max(flight.world.uav.position.z - height);
            }
            if step == 999 {
                assert_eq!((output.mode, output.fault), (Mode::Hold, Some(Fault::Contradiction)), "{name}");
            }
            last = Some(output.mode);
        }
        println!("{name}: {lost:.2} m lost");
        assert!(lost < 1.0, "{name}: {lost} m lost");
        assert_eq!(last, Some(Mode::Follow), "{name}");
    }
}

/// The rod's rate is measured as it was when following began to need it, made square to the rod by
/// whoever builds the state: no bit of it stands still. The law swings the load up on it until the
/// rod is not where that rate leads.
#[test]
fn a_rods_rate_that_stays_as_it_was_is_not_flown_on() {
    let mut flight = hanging(PAPER, 10.0);
    for _ in 0..5000 {
        flight.step(Request::Follow);
    }
    let then = flight.state();
    let (mut lost, mut swing, mut faults) = (0.0_f64, 0.0_f64, 0);
    let mut last = None;
    for step in 0..20_000 {
        let (uav, mut state) = (flight.uav(), flight.state());
        if step < 4000 {
            state.rod_rate = then.rod_rate - state.rod * state.rod.dot(&then.rod_rate);
        }
        let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: None };
        let output = flight.supervisor.step(measured, Request::Follow);
        flight.world.advance(&output.command);
        lost = lost.max(flight.world.uav.position.z - f64::from(then.position.z) + PAPER.length);
        swing = swing.max(norm(&(flight.world.load_velocity - flight.world.uav.velocity)));
        faults += usize::from(output.fault == Some(Fault::Contradiction));
        last = Some(output.mode);
    }
    println!("{lost:.2} m lost, {swing:.2} m/s apart, contradicted for {:.1} s", PERIOD * faults as f64);
    assert!(faults > 0, "not noticed");
    // As fast as a load that has been pulled aside by 20° and let go: √(2 g L (1 − cos 20°)).
    assert!(swing < (2.0 * 9.81 * PAPER.length * (1.0 - 20_f64.to_radians().cos())).sqrt(), "{swing} m/s apart");
    assert!(lost < 1.0, "{lost} m lost");
    assert_eq!(last, Some(Mode::Follow));
}

/// From any of ten moments of a landing on the UAV's own position or velocity stands still, reads
/// zeros, or is missing, for three seconds or for good: each is carried on from the rest, and by an
/// accelerometer.
#[test]
fn a_landing_is_as_slow_on_half_a_navigation() {
    type Wrong = fn(&Uav<f32>, &Uav<f32>) -> Option<Uav<f32>>;
    let kinds: [(&str, f64, Wrong); 7] = [
        ("position stands for 3 s", 3.0, |now, then| Some(Uav { position: then.position, ..*now })),
        ("position stands", f64::INFINITY, |now, then| Some(Uav { position: then.position, ..*now })),
        ("position of zeros for 3 s", 3.0, |now, _| Some(Uav { position: Vector3::zeros(), ..*now })),
        ("position of zeros", f64::INFINITY, |now, _| Some(Uav { position: Vector3::zeros(), ..*now })),
        ("velocity stands", f64::INFINITY, |now, then| Some(Uav { velocity: then.velocity, ..*now })),
        ("velocity of zeros", f64::INFINITY, |now, _| Some(Uav { velocity: Vector3::zeros(), ..*now })),
        ("none for 3 s", 3.0, |_, _| None),
    ];
    for (name, lasts, wrong) in kinds {
        let mut worst = [0.0_f64; 2];
        for begin in 0..10 {
            let begin = 2.0 * f64::from(begin);
            let mut flight = hanging(PAPER, 3.0);
            let mut then = None;
            let mut before = V::zeros();
            let mut is_off = false;
            for step in 0..40_000 {
                let (uav, state) = (flight.uav(), flight.state());
                let World { uav: Uav { velocity, attitude, .. }, .. } = &flight.world;
                let force = attitude.tr_mul(&((velocity - before) / PERIOD - V::new(0.0, 0.0, 9.81)));
                before = *velocity;
                let since = f64::from(step) * PERIOD - begin;
                let told =
                    if (0.0..lasts).contains(&since) { wrong(&uav, then.get_or_insert(uav)) } else { Some(uav) };
                let specific_force = Some(force.map(|f| f as f32));
                let measured = Measured { state: Some(&state), uav: told.as_ref(), specific_force };
                let output = flight.supervisor.step(measured, Request::Land);
                flight.world.advance(&output.command);
                is_off = output.mode == Mode::Off;
                if is_off {
                    break;
                }
            }
            let World { uav_touch, load_touch, .. } = flight.world;
            assert!(is_off, "{name} from {begin} s on: not landed");
            worst = [worst[0].max(load_touch), worst[1].max(uav_touch)];
        }
        println!("{name}: load {:.2}, UAV {:.2} m/s", worst[0], worst[1]);
        assert!(worst[0] <= 0.6 && worst[1] <= 0.6, "{name}: {worst:?} m/s");
    }
}

/// For two or twenty seconds of following attitude or body rate is not measured, or the attitude
/// stands still: each is found from the other, and the UAV holds. An accelerometer that reads zeros changes nothing.
#[test]
fn an_attitude_or_a_body_rate_that_is_lost_costs_no_height() {
    type Wrong = fn(&mut State<f32>, &State<f32>, &mut Vector3<f32>);
    let no_attitude: Wrong = |state, _, _| state.attitude.fill(f32::NAN);
    let no_body_rate: Wrong = |state, _, _| state.body_rate.fill(f32::NAN);
    let no_specific_force: Wrong = |_, _, specific| specific.fill(0.0);
    let old_attitude: Wrong = |state, then, _| state.attitude = then.attitude;
    let (attitude, body_rate) = (Some(Channel::Attitude), Some(Channel::BodyRate));
    for (name, wrong, channel, steps) in [
        ("attitude", no_attitude, attitude, 1000),
        ("attitude for 20 s", no_attitude, attitude, 10_000),
        ("an attitude that stands still for 20 s", old_attitude, attitude, 10_000),
        ("body rate", no_body_rate, body_rate, 1000),
        ("specific force", no_specific_force, None, 1000),
    ] {
        let mut flight = hanging(PAPER, 10.0);
        for _ in 0..5000 {
            flight.step(Request::Follow);
        }
        let (then, height) = (flight.state(), flight.world.uav.position.z);
        let mut lost = 0.0_f64;
        let mut last = None;
        let mut before = flight.world.uav.velocity;
        for step in 0..steps + 15_000 {
            let (mut uav, mut state) = (flight.uav(), flight.state());
            let acceleration = (flight.world.uav.velocity - before) / PERIOD;
            before = flight.world.uav.velocity;
            let specific = flight.world.uav.attitude.transpose() * (acceleration - V::new(0.0, 0.0, 9.81));
            let mut specific: Vector3<f32> = specific.map(|a| a as f32);
            if step < steps {
                wrong(&mut state, &then, &mut specific);
                (uav.attitude, uav.body_rate) = (state.attitude, state.body_rate);
            }
            let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: Some(specific) };
            let output = flight.supervisor.step(measured, Request::Follow);
            flight.world.advance(&output.command);
            lost = lost.max(flight.world.uav.position.z - height);
            if step == steps - 1 {
                let mode = if channel.is_some() { Mode::Hold } else { Mode::Follow };
                assert_eq!((output.mode, output.fault), (mode, channel.map(Fault::State)), "{name}");
            }
            last = Some(output.mode);
        }
        println!("{name}: {lost:.2} m lost");
        assert!(lost < 1.0, "{name}: {lost} m lost");
        assert_eq!(last, Some(Mode::Follow), "{name}");
    }
}

/// For two seconds of following the UAV's own position jumps, alone or with the load's. Alone it
/// is not believed; with the load's it is, since then it is their origin that has moved.
#[test]
fn a_jump_of_position_does_not_end_the_following() {
    for (name, jump, of_load) in [("UAV", 20.0, false), ("both", 0.5, true)] {
        let mut flight = hanging(PAPER, 10.0);
        for _ in 0..5000 {
            flight.step(Request::Follow);
        }
        for step in 0..2000 {
            let (mut uav, mut state) = (flight.uav(), flight.state());
            if step < 1000 {
                uav.position.x += jump;
                state.position.x += if of_load { jump } else { 0.0 };
            }
            let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: None };
            let output = flight.supervisor.step(measured, Request::Follow);
            flight.world.advance(&output.command);
            assert_eq!((output.mode, output.fault), (Mode::Follow, None), "{name}, step {step}");
        }
    }
}

/// In hold the UAV's own position, or the load's with it, jumps for three seconds by 10 m. The
/// vehicle stays where it is.
#[test]
fn a_jump_of_position_does_not_move_the_hold() {
    for of_load in [false, true] {
        let mut flight = hanging(PAPER, 10.0);
        for _ in 0..1000 {
            flight.step(Request::Hold);
        }
        let place = flight.world.uav.position;
        let mut moved = 0.0_f64;
        for step in 0..5000 {
            let (mut uav, mut state) = (flight.uav(), flight.state());
            if step < 1500 {
                uav.position.z += 10.0;
                state.position.z += if of_load { 10.0 } else { 0.0 };
            }
            let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: None };
            let output = flight.supervisor.step(measured, Request::Hold);
            flight.world.advance(&output.command);
            assert_eq!(output.mode, Mode::Hold);
            moved = moved.max(norm(&(flight.world.uav.position - place)));
        }
        println!("with the load's {of_load}: {moved:.3} m");
        assert!(moved < 0.3, "with the load's {of_load}: {moved} m");
    }
}

/// Positions and velocities of 8 cm and 12 cm/s of noise contradict nothing, and are no jumps.
#[test]
fn noise_does_not_move_the_hold() {
    let mut flight = hanging(PAPER, 10.0);
    let place = flight.world.uav.position;
    let mut seed = 1_u32;
    let mut moved = 0.0_f64;
    for _ in 0..10_000 {
        let (mut uav, mut state) = (flight.uav(), flight.state());
        let mut uniform = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        let mut noise = |deviation: f32| Vector3::from_fn(|_, _| deviation * 3.0_f32.sqrt() * uniform());
        for (position, velocity) in
            [(&mut uav.position, &mut uav.velocity), (&mut state.position, &mut state.velocity)]
        {
            *position += noise(0.08);
            *velocity += noise(0.12);
        }
        let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: None };
        let output = flight.supervisor.step(measured, Request::Hold);
        flight.world.advance(&output.command);
        assert_eq!((output.mode, output.fault), (Mode::Hold, None));
        moved = moved.max(norm(&(flight.world.uav.position - place)));
    }
    println!("{moved:.3} m");
    assert!(moved < 0.3, "{moved} m");
}

/// Beside its load on a slack cable, a vehicle without navigation of its own does not know where it
/// is: it stays on the ground and says what is wrong; with navigation it takes off.
#[test]
fn a_take_off_without_navigation_is_refused_in_words() {
    let mut flight = flight(PAPER, V::new(0.0, 0.0, -0.15), V::new(0.8, 0.0, 0.0), 0.0);
    flight.has_navigation = false;
    for request in [Request::Idle, Request::Hold, Request::Follow] {
        for _ in 0..1000 {
            let output = flight.step(request);
            assert_eq!(output.mode, Mode::Idle, "{request:?}");
            let fault = (request != Request::Idle).then_some(Fault::Margin(Margin::RodAngle));
            assert_eq!(output.fault, fault, "{request:?}");
        }
    }
    flight.has_navigation = true;
    assert_eq!(flight.step(Request::Hold).mode, Mode::TakeOff);
}

/// A cable that is told too long seems slack: it holds, and says why. Told a little too short or
/// too long it flies.
#[test]
fn a_cable_of_another_length_than_told_is_flown_or_refused_in_words() {
    for (share, flies) in [(0.9, true), (1.08, true), (1.15, false)] {
        let mut flight = hanging(Setting { told_length: share * PAPER.length, ..PAPER }, 10.0);
        let mut last = None;
        for _ in 0..15_000 {
            last = Some(flight.step(Request::Follow));
        }
        let output = last.expect("it flew");
        let (mode, fault) = if flies { (Mode::Follow, None) } else { (Mode::Hold, Some(Fault::Slack)) };
        assert_eq!((output.mode, output.fault), (mode, fault), "told {share} of its length");
    }
}

#[test]
fn landing_is_as_slow_as_told_whatever_the_altitude() {
    let mut flight = hanging(PAPER, 3.0);
    flight.world.ground = 20_000.0;
    flight.world.load.z -= 10_000.0;
    flight.world.uav.position.z -= 10_000.0;
    for _ in 0..20_000 {
        flight.step(Request::Land);
    }
    let sinking = flight.world.uav.velocity.z;
    // Half an ulp of 10 km, 0.5 mm, in each of the position's samples.
    assert!((sinking - 0.4).abs() < 0.02, "{sinking} m/s");
}

#[test]
fn a_flight_goes_from_ground_to_ground() {
    for (name, setting) in [
        ("as told", PAPER),
        ("0.75 kg told 0.5", Setting { payload_mass: 0.75, ..PAPER }),
        ("0.25 kg told 0.5", Setting { payload_mass: 0.25, ..PAPER }),
        ("thrust 85 %", Setting { thrust: 0.85, ..PAPER }),
        ("thrust 115 %", Setting { thrust: 1.15, ..PAPER }),
        ("wind", Setting { wind: 2.0, ..PAPER }),
        ("rope 5 m", PAPER.on(5.0)),
    ] {
        let mut flight = flight(setting, V::new(0.7, 0.0, 0.0), V::zeros(), 0.0);
        let mut mode = Mode::Off;
        let (mut jerk, mut modes) = (0.0_f64, Vec::new());
        let mut fly = |flight: &mut Flight<_>, request, until: &dyn Fn(Mode, usize) -> bool| {
            for step in 0..100_000 {
                let output = flight.step(request);
                if output.mode != mode {
                    mode = output.mode;
                    modes.push(mode);
                }
                jerk = jerk.max(flight.world.tension);
                if until(mode, step) {
                    return;
                }
            }
            panic!("{name}: {request:?} ended in {mode:?} after {modes:?}, {:?}", flight.world.uav);
        };
        fly(&mut flight, Request::Idle, &|mode, step| mode == Mode::Idle && step > 500);
        fly(&mut flight, Request::Hold, &|mode, _| mode == Mode::Hold);
        let height = -flight.world.load.z;
        fly(&mut flight, Request::Follow, &|mode, _| mode == Mode::Follow);
        fly(&mut flight, Request::Follow, &|_, step| step > 5000);
        let World { load, .. } = &flight.world;
        let off = (load.x.hypot(load.y) - 5.0).hypot(load.z + 10.0);
        fly(&mut flight, Request::Land, &|mode, _| mode == Mode::Off);
        let World { uav_touch, load_touch, .. } = &flight.world;
        println!(
            "{name}: {height:.2} m up, tension at most {jerk:.1} N, {:.1} mm off, touching at {load_touch:.2}, {uav_touch:.2}",
            off * 1e3
        );
        assert_eq!(modes, [Mode::Idle, Mode::TakeOff, Mode::Hold, Mode::Join, Mode::Follow, Mode::Land, Mode::Off]);
        assert!(height > 0.5, "{name}: the load is at {height} m");
        // The cable becomes taut at no more than the rising speed, 0.4 m/s, which its stiffness
        // turns into w √(k μ); and the load weighs twice as much in no manoeuvre.
        let reduced = setting.payload_mass * setting.uav_mass / (setting.payload_mass + setting.uav_mass);
        let impact = 0.4 * (CABLE[0] * reduced).sqrt();
        assert!(jerk < impact + 2.0 * setting.payload_mass * 9.81, "{name}: a jerk of {jerk} N");
        assert!(off < 0.05, "{name}: {off} m");
        assert!(*load_touch <= 0.6 && *uav_touch <= 0.6, "{name}: {load_touch} and {uav_touch} m/s");
    }
}
