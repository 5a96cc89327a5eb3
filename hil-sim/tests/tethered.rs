//! The cable and the ground against balances of energy and momentum, against solutions that can be
//! written down, and against the plant on the rod.

use controller::{Command, Matrix3, State, Vector3};
use hil_sim::world::multibody::{Loads, Multibody, rotation};
use hil_sim::world::{Bodies, Cable, Ground, Tethered, Window};
use witness::plant::VehicleParameters;

const G: f64 = 9.81;

fn vehicle() -> VehicleParameters {
    VehicleParameters::default()
}

fn thrust(thrust: f64) -> Command<f64> {
    Command { thrust, torque: Vector3::zeros() }
}

fn at_rest(position: [f64; 3], uav_position: [f64; 3]) -> Bodies {
    Bodies {
        position: position.into(),
        velocity: Vector3::zeros(),
        uav_position: uav_position.into(),
        uav_velocity: Vector3::zeros(),
        attitude: Matrix3::identity(),
        body_rate: Vector3::zeros(),
    }
}

fn fly(body: &mut Tethered, command: Command<f64>, loads: Loads, duration: f64, steps: u32) {
    for _ in 0..steps {
        body.advance(duration / f64::from(steps), &|_| command, &|_, _| loads);
    }
}

fn hooked(hook: [f64; 3]) -> Cable {
    Cable { hook, ..Cable::default() }
}

/// Swinging, spinning, with a pull well above zero.
fn swinging() -> State<f64> {
    let x = [1.0, -2.0, -10.0, 0.3, -0.2, 0.2, -0.1, 0.5, 0.5, -0.4, 0.3, 0.6, -0.5, 0.4, -0.3, 0.7];
    State::from_paper(&x)
}

#[test]
fn taut_and_hung_at_the_centre_of_mass_it_is_the_rod() {
    let command = Command { thrust: 31.0, torque: Vector3::new(0.01, -0.02, 0.005) };
    let loads = Loads { payload_force: Vector3::new(0.3, -0.2, 0.1), ..Loads::none() };
    let mut rod = Multibody::new(vehicle(), &swinging());
    let mut cable =
        Tethered::new(vehicle(), Cable::default(), None, &Bodies::on_rod(&swinging(), vehicle().rod_length));
    for _ in 0..2000 {
        rod.advance(5e-4, |_| command, |_, _| loads);
        cable.advance(5e-4, &|_| command, &|_, _| loads);
    }
    assert!(cable.is_taut());
    let (one, other) = (Bodies::on_rod(&rod.state(), vehicle().rod_length), cable.bodies());
    let apart = [
        (one.position - other.position).amax(),
        (one.velocity - other.velocity).amax(),
        (one.uav_position - other.uav_position).amax(),
        (one.uav_velocity - other.uav_velocity).amax(),
        (one.attitude - other.attitude).amax(),
        (one.body_rate - other.body_rate).amax(),
    ];
    let worst = apart.into_iter().fold(0.0, f64::max);
    println!("rod and cable, one second: {worst:.1e}");
    // Two methods of order 4 whose errors are of order (rate · step)⁴, some 1e-13 a step of half a
    // millisecond, for 2,000 of them.
    assert!(worst < 1e-10, "{worst:e}");
}

/// Flown under constant forces whose work is force times way, with the hook aside and below.
#[test]
fn a_hook_keeps_the_balance_of_energy_to_the_order_of_the_method() {
    let loads = Loads {
        payload_force: Vector3::new(0.5, -1.0, 9.0),
        uav_force: Vector3::new(-3.0, 2.0, -20.0),
        torque: Vector3::zeros(),
    };
    let errors = [100, 200, 400].map(|steps| {
        let bodies = Bodies::on_rod(&swinging(), vehicle().rod_length);
        let mut body = Tethered::new(vehicle(), hooked([0.05, -0.1, 0.2]), None, &bodies);
        // The rod of the start is not the cable's length from the hook: let it become taut first.
        fly(&mut body, thrust(0.0), loads, 0.5, 1000);
        let mut taut = body.is_taut();
        let (energy, before) = (body.energy(), body.bodies());
        for _ in 0..steps {
            fly(&mut body, thrust(0.0), loads, 1.0 / f64::from(steps), 1);
            taut &= body.is_taut();
        }
        assert!(taut, "taut all the while");
        let after = body.bodies();
        let work = loads.payload_force.dot(&(after.position - before.position))
            + loads.uav_force.dot(&(after.uav_position - before.uav_position));
        (body.energy() - energy - work).abs()
    });
    println!("energy less work after 1 s with a hook: {errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 3.5, "{errors:?}");
    }
    assert!(errors[2] < 1e-5, "{errors:?}");
}

/// Momentum, and angular momentum about the origin, N·s and N·m·s.
fn momenta(body: &Tethered) -> [Vector3<f64>; 2] {
    let VehicleParameters { payload_mass, uav_mass, inertia, .. } = vehicle();
    let Bodies { position, velocity, uav_position, uav_velocity, attitude, body_rate } = body.bodies();
    let spin = attitude * Vector3::from(inertia).component_mul(&body_rate);
    [
        velocity * payload_mass + uav_velocity * uav_mass,
        position.cross(&velocity) * payload_mass + uav_position.cross(&uav_velocity) * uav_mass + spin,
    ]
}

/// Both fall and part at w = 2 m/s; the cable becomes taut after 0.25 s.
#[test]
fn becoming_taut_costs_what_an_inelastic_impact_costs() {
    let VehicleParameters { payload_mass, uav_mass, .. } = vehicle();
    let mass = payload_mass * uav_mass / (payload_mass + uav_mass);
    let parting = 2.0;
    for restitution in [0.0, 0.4, 1.0] {
        let cable = Cable { restitution, ..Cable::default() };
        let mut bodies = at_rest([0.0, 0.0, -48.5], [0.0, 0.0, -50.0]);
        bodies.velocity.z = parting;
        let mut body = Tethered::new(vehicle(), cable, None, &bodies);
        let energy = body.energy();
        fly(&mut body, thrust(0.0), Loads::none(), 0.3, 60);
        let lost = energy - body.energy();
        let expected = 0.5 * mass * parting * parting * (1.0 - restitution * restitution);
        // The rounding of energies of 1,500 J, and an instant's way.
        assert!((lost - expected).abs() < 1e-9, "e = {restitution}: {lost} of {expected}");
        let apart = body.bodies().velocity.z - body.bodies().uav_velocity.z;
        assert!((apart + restitution * parting).abs() < 1e-9, "e = {restitution}: {apart}");
        assert_eq!(body.is_taut(), restitution == 0.0);
    }
}

#[test]
fn becoming_taut_at_a_hook_keeps_both_momenta() {
    let weightless = VehicleParameters { gravity: 1e-300, ..vehicle() };
    let mut bodies = at_rest([0.4, 0.2, 1.5], [0.0, 0.0, 0.0]);
    bodies.velocity = Vector3::new(1.0, 0.3, 2.0);
    bodies.attitude = rotation([0.8, 0.0, 0.6, 0.0]);
    bodies.body_rate = Vector3::new(0.3, -0.2, 0.5);
    let mut body = Tethered::new(weightless, hooked([0.1, -0.05, 0.2]), None, &bodies);
    let (energy, before) = (body.energy(), momenta(&body));
    assert!(!body.is_taut());
    let steps = (0..1000).take_while(|_| {
        fly(&mut body, thrust(0.0), Loads::none(), 0.001, 1);
        !body.is_taut()
    });
    assert!(steps.count() < 1000, "taut at last");
    let after = momenta(&body);
    // Runge-Kutta's error in a spin of 0.6 rad/s, and an instant's overshoot of the cable's length,
    // 1e-10 s at 2 m/s.
    assert!((after[0] - before[0]).amax() < 1e-12, "{before:?} {after:?}");
    assert!((after[1] - before[1]).amax() < 1e-8, "{before:?} {after:?}");
    assert!(body.energy() < energy - 0.1, "{} of {energy}", body.energy());
}

/// The stretch under a thrust that begins at once: x = x_s (1 − e^(−ζωt) (cos ω_d t + ζω/ω_d sin
/// ω_d t)), with x_s = T m_L/(M k) the steady one, ω² = k/μ and ζ = c/(2 μ ω).
#[test]
fn an_elastic_cable_has_the_frequency_and_the_decay_of_its_spring() {
    let VehicleParameters { payload_mass, uav_mass, rod_length, .. } = vehicle();
    let (ea, damping, pull) = (5e3, 4.0, 29.43);
    let cable = Cable { ea: Some(ea), damping, ..Cable::default() };
    let (total, stiffness) = (payload_mass + uav_mass, ea / rod_length);
    let mass = payload_mass * uav_mass / total;
    let steady = pull * payload_mass / (total * stiffness);
    let omega = (stiffness / mass).sqrt();
    let decay = damping / (2.0 * mass);
    let damped = (omega * omega - decay * decay).sqrt();
    let errors = [100, 200, 400].map(|steps| {
        // A hair longer than the cable, which is taut then.
        let mut body = Tethered::new(vehicle(), cable, None, &at_rest([0.0, 0.0, 2.0 + 1e-15], [0.0; 3]));
        (1..=steps).fold(0.0_f64, |worst, step| {
            fly(&mut body, thrust(pull), Loads::none(), 0.2 / f64::from(steps), 1);
            let t = 0.2 * f64::from(step) / f64::from(steps);
            let swing = (damped * t).cos() + decay / damped * (damped * t).sin();
            let expected = steady * (1.0 - (-decay * t).exp() * swing);
            let bodies = body.bodies();
            worst.max((bodies.position.z - bodies.uav_position.z - rod_length - expected).abs())
        })
    });
    println!("stretch {steady:.2e} m at {omega:.0} rad/s: off by {errors:?}");
    assert!(errors[2] < 1e-5 * steady, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 3.5, "{errors:?}");
    }
}

/// A payload that falls on the ground from 5 m while the UAV hovers over it.
fn dropped(ground: Ground, seconds: f64, steps: u32) -> (Tethered, f64) {
    let vehicle = VehicleParameters { rod_length: 20.0, ..vehicle() };
    let start = at_rest([0.0, 0.0, -5.0 - ground.payload_height], [0.0, 0.0, -10.0]);
    let mut body = Tethered::new(vehicle, Cable::default(), Some(ground), &start);
    let mut highest = f64::INFINITY;
    let mut bounced = false;
    for _ in 0..steps {
        let down = body.bodies().velocity.z;
        fly(&mut body, thrust(vehicle.uav_mass * G), Loads::none(), seconds / f64::from(steps), 1);
        bounced |= body.touching()[0];
        if bounced && body.bodies().velocity.z >= 0.0 && down < 0.0 {
            highest = highest.min(body.bodies().position.z);
        }
    }
    (body, -(highest + ground.payload_height))
}

#[test]
fn a_payload_bounces_with_the_restitution_of_spring_and_damper() {
    for damping_ratio in [0.05, 0.2, 0.5] {
        let ground = Ground { damping_ratio, sink: 2e-5, ..Ground::default() };
        let (_, height) = dropped(ground, 2.5, 25_000);
        let way = (1.0 - damping_ratio * damping_ratio).sqrt();
        let turn =
            std::f64::consts::PI - (2.0 * damping_ratio * way).atan2(1.0 - 2.0 * damping_ratio * damping_ratio);
        let restitution = (-damping_ratio / way * turn).exp();
        let ratio = (height / 5.0).sqrt();
        println!("damping ratio {damping_ratio}: rebound {ratio:.4} of the speed, {restitution:.4} without gravity");
        // The formula neglects the weight, which takes no more than g times half a swing, π/ω, of
        // the speed that leaves.
        let leaving = restitution * (2.0 * G * 5.0_f64).sqrt();
        let neglected = G * std::f64::consts::PI / (G / ground.sink).sqrt() / (way * leaving);
        assert!((ratio / restitution - 1.0).abs() < neglected, "{ratio} {restitution} {neglected}");
    }
}

#[test]
fn an_undamped_bounce_loses_nothing_to_the_order_of_the_method() {
    let ground = Ground { damping_ratio: 0.0, ..Ground::default() };
    let errors = [2000, 4000, 8000].map(|steps| {
        let (before, _) = dropped(ground, 0.0, 1);
        let (after, _) = dropped(ground, 3.0, steps);
        (after.energy() - before.energy()).abs()
    });
    println!("energy lost in an undamped bounce: {errors:?} J of 25");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 3.0, "{errors:?}");
    }
    assert!(errors[2] < 1e-4, "{errors:?}");
}

/// m v v̇ = −μ m g v²/√(v² + v_0²), so a slide from V takes ∫√(v² + v_0²) dv/(μ g), and all its
/// energy into friction.
#[test]
fn a_slide_is_as_long_as_coulombs_friction_makes_it() {
    let ground = Ground { friction: 0.4, ..Ground::default() };
    let vehicle = VehicleParameters { rod_length: 20.0, ..vehicle() };
    let mut bodies = at_rest([0.0, 0.0, ground.sink - ground.payload_height], [0.0, 0.0, -10.0]);
    let (speed, creep): (f64, f64) = (2.0, 0.01);
    bodies.velocity.x = speed;
    let mut body = Tethered::new(vehicle, Cable::default(), Some(ground), &bodies);
    fly(&mut body, thrust(vehicle.uav_mass * G), Loads::none(), 1.0, 4000);
    let root = speed.hypot(creep);
    let expected = 0.5 * (speed * root + creep * creep * (speed / creep).asinh()) / (0.4 * G);
    let way = body.bodies().position.x;
    println!("slid {way:.5} m of {expected:.5}");
    // After 1 s the creep is through by e^(−0.49/0.0025 s).
    assert!((way - expected).abs() < 1e-6, "{way} {expected}");
    assert!(body.bodies().velocity.amax() < 1e-6);
}

/// On a slope, tan θ: what friction holds creeps down at v_0 tan θ/√(μ² − tan² θ); where it does
/// not hold, energy goes into friction alone. On its box the payload stands that much higher.
#[test]
fn a_slope_holds_what_friction_holds() {
    let slope = [0.3_f64, -0.4];
    let (steep, cos) = (slope[0].hypot(slope[1]), 1.0 / 1.25_f64.sqrt());
    let vehicle = VehicleParameters { rod_length: 50.0, ..vehicle() };
    let slid = |friction: f64, box_height: f64, time: f64| {
        let ground = Ground { friction, slope, box_height, ..Ground::default() };
        let [down, _] = ground.standing(&Vector3::zeros(), &Vector3::zeros());
        let mut body =
            Tethered::new(vehicle, Cable::default(), Some(ground), &at_rest([0.0, 0.0, down], [0.0, 0.0, -10.0]));
        fly(&mut body, thrust(vehicle.uav_mass * G), Loads::none(), time, (time * 4000.0) as u32);
        (ground, body)
    };
    let (ground, body) = slid(0.8, 0.5, 2.0);
    let Bodies { position, velocity, .. } = body.bodies();
    let creep = 0.01 * steep / (0.8_f64 * 0.8 - steep * steep).sqrt();
    println!("creeps at {:.6} of {creep:.6} m/s", velocity.norm());
    assert!((velocity.norm() / creep - 1.0).abs() < 1e-6, "{velocity:?}");
    // Downhill, along the plane.
    let downhill = Vector3::new(slope[0], slope[1], steep * steep) / steep * cos;
    assert!((velocity - downhill * creep).amax() < 1e-8, "{velocity:?}");
    let sunk = ground.payload_depth(&position);
    assert!((sunk - ground.sink * cos).abs() < 1e-8, "{sunk}");
    assert!(
        (position.z + ground.payload_height + 0.5 - slope[0] * position.x - slope[1] * position.y - ground.sink)
            .abs()
            < 1e-6
    );
    // g (sin θ − μ cos θ), less what the start takes of friction.
    let (_, body) = slid(0.1, 0.0, 1.0);
    let speed = body.bodies().velocity.norm();
    let expected = G * cos * (steep - 0.1);
    println!("slides at {speed:.4} of {expected:.4} m/s");
    assert!((speed / expected - 1.0).abs() < 1e-3, "{speed} {expected}");
}

#[test]
fn a_uav_let_go_of_just_above_the_ground_stands_level_on_its_feet() {
    let ground = Ground::default();
    let vehicle = VehicleParameters { rod_length: 20.0, ..vehicle() };
    let mut bodies = at_rest([1.0, 0.0, ground.sink - ground.payload_height], [0.0, 0.0, -0.3]);
    // Ten degrees askew.
    bodies.attitude = rotation([0.087_f64.cos(), 0.087_f64.sin(), 0.0, 0.0]);
    let mut body = Tethered::new(vehicle, Cable::default(), Some(ground), &bodies);
    let mut energy = body.energy();
    for _ in 0..4000 {
        fly(&mut body, thrust(0.0), Loads::none(), 5e-4, 1);
        let now = body.energy();
        assert!(now < energy + 1e-6, "energy from nowhere: {energy} {now}");
        energy = now;
    }
    let end = body.bodies();
    assert_eq!(body.touching(), [true, true]);
    assert!((end.uav_position.z + ground.feet_below - ground.sink).abs() < 1e-5, "{:?}", end.uav_position);
    assert!(end.attitude.m33 > 1.0 - 1e-9 && end.uav_velocity.amax() < 1e-4, "{end:?}");
}

/// Lifted off the ground by a UAV that rises until the cable is taut: every kind of contact in one
/// flight, the errors of order 4.
#[test]
fn a_lift_converges_through_its_contacts() {
    let ground = Ground::default();
    let fly_it = |steps: u32| {
        let start =
            at_rest([0.3, 0.0, ground.sink - ground.payload_height], [0.0, 0.0, ground.sink - ground.feet_below]);
        let mut body = Tethered::new(vehicle(), hooked([0.0, 0.0, 0.1]), Some(ground), &start);
        fly(&mut body, thrust(33.0), Loads::none(), 2.0, steps);
        assert_eq!((body.is_taut(), body.touching()), (true, [false; 2]));
        body.bodies()
    };
    let exact = fly_it(64_000);
    let errors = [1000, 2000, 4000].map(|steps| {
        let end = fly_it(steps);
        (end.position - exact.position).amax().max((end.uav_position - exact.uav_position).amax())
    });
    println!("lift with steps of 2, 1 and 0.5 ms: off by {errors:?} m");
    assert!(errors[2] < 1e-4, "{errors:?}");
    assert!((errors[0] / errors[2]).log2() > 5.0, "{errors:?}");
}

#[test]
fn a_payload_is_dropped_caught_and_picked_up_when_told() {
    let cable = Cable { hooked: Some(Window { at_s: 1.0, for_s: 1.0 }), ..Cable::default() };
    let mut body = Tethered::new(vehicle(), cable, None, &at_rest([0.0, 0.0, 2.0], [0.0; 3]));
    let both = |body: &Tethered| (body.bodies().position.z, body.bodies().uav_position.z);
    let hover = thrust(vehicle().uav_mass * G);
    body.set_time(0.5);
    fly(&mut body, hover, Loads::none(), 0.1, 100);
    assert!((both(&body).0 - 2.0 - 0.5 * G * 0.01).abs() < 1e-12, "it falls while nothing holds it");
    body.set_time(1.0);
    fly(&mut body, hover, Loads::none(), 0.1, 100);
    assert!(!body.is_taut(), "out of reach it is not picked up");

    let cable = Cable { snagged: Some(Window { at_s: 1.0, for_s: 1.0 }), ..Cable::default() };
    let mut body = Tethered::new(vehicle(), cable, None, &at_rest([0.0, 0.0, 2.0], [0.0; 3]));
    body.set_time(1.0);
    fly(&mut body, thrust(100.0), Loads::none(), 1.0, 100);
    assert_eq!(both(&body), (2.0, 0.0), "caught, it and what hangs on it stay");
    let pull = body.rates(&thrust(100.0), &Loads::none()).pull;
    assert!((pull - (100.0 - vehicle().uav_mass * G)).abs() < 1e-12, "{pull}");
    body.set_time(2.0);
    fly(&mut body, thrust(100.0), Loads::none(), 0.1, 100);
    assert!(both(&body).0 < 2.0, "and it comes free");
}
