//! A flight from the ground to the ground over a line: idle with a slack cable, take-off, hold, the
//! path, landing, rotors off.

use controller::{Command, Matrix3, Measured, Mode, Request, State, Uav, Vector3};
use hil_sim::describe::parameters::parameters;
use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::pilot::Decision;
use hil_sim::world::{Bodies, Seed, World};
use rig::Rig;

/// The paper's vehicle beside its load, both on the ground, in 2 m/s of wind with drag.
const SCENARIO: &str = r#"
duration_s = 100.0
path = { kind = "circle", radius = 2.0, p3 = -4.0, speed = 0.8 }
cable = {}
ground = {}
initial = { position = [2.6, 0.2, 0.0], uav_position = [2.0, 0.0, 0.0], standing = true }
environment.air = { wind = [2.0, 0.0, 0.0], payload_drag_area = 0.01, uav_drag_area = 0.03 }
controller = { law = "follow", rate_hz = 250.0, observer = { payload = 6.0, rod = 6.0, torque = 6.0 } }
"#;

/// Both bodies come down no faster than this, m/s.
pub const TOUCHDOWN: f64 = 0.6;

pub fn scenario() -> Scenario {
    Scenario::parse("mission", SCENARIO).expect("a scenario")
}

/// What is asked for from when on, s.
const REQUESTS: [(f64, Request); 4] =
    [(0.0, Request::Idle), (1.0, Request::Hold), (13.0, Request::Follow), (48.0, Request::Land)];

/// Whether the load is seen: a while of the flight it is not.
fn sees_load(t_s: f64) -> bool {
    !(28.0..29.0).contains(&t_s)
}

/// How a mission went.
#[derive(Debug, PartialEq)]
pub struct Flown {
    /// Thrust, torque and mode of every command, by their bits.
    pub commands: Vec<[u32; 5]>,
    pub modes: Vec<Mode>,
    /// The fastest touch of load and UAV, m/s.
    pub touchdown: [f64; 2],
    /// The largest distance from the path while it was followed, m.
    pub off_path: f64,
    pub ended_s: f64,
}

/// Flies it by whatever answers what is measured.
pub fn fly(mut answer: impl FnMut(&Measured<'_, f64>, Request, f64) -> Decision) -> Flown {
    let scenario = scenario();
    let mut world = scenario.begin(&State::at_rest(Vector3::zeros()), Command::zero(), Seed::default());
    let mut flown = Flown { commands: vec![], modes: vec![], touchdown: [0.0; 2], off_path: 0.0, ended_s: 0.0 };
    let period = 1.0 / scenario.controller.rate_hz;
    let mut stood = world.body().touching();
    let mut followed = 0;
    for step in 0..scenario.steps() {
        let t_s = step as f64 * period;
        let request = REQUESTS.iter().rfind(|(at_s, _)| *at_s <= t_s).map_or(Request::Idle, |(_, request)| *request);
        let Bodies { uav_position: position, uav_velocity: velocity, attitude, body_rate, .. } =
            world.body().bodies();
        let state = world.body().state();
        let measured = Measured {
            state: sees_load(t_s).then_some(&state),
            uav: Some(&Uav { position, velocity, attitude, body_rate }),
            specific_force: Some(specific_force(&world, &attitude)),
        };
        let Decision { command, mode, .. } = answer(&measured, request, t_s);
        let [t1, t2, t3] = command.torque.into();
        let bits = [command.thrust, t1, t2, t3].map(|number| (number as f32).to_bits());
        flown.commands.push([bits[0], bits[1], bits[2], bits[3], mode as u32]);
        if flown.modes.last() != Some(&mode) {
            flown.modes.push(mode);
        }
        // Half a lap after it was joined.
        followed = if mode == Mode::Follow { followed + 1 } else { 0 };
        if followed > 1000 {
            flown.off_path = flown.off_path.max(scenario.controller.law.distance(state.position.into()));
        }
        let falling = [state.velocity.z, velocity.z];
        world.advance(&command);
        let stands = world.body().touching();
        for body in 0..2 {
            if stands[body] && !stood[body] && t_s > 1.0 {
                flown.touchdown[body] = flown.touchdown[body].max(falling[body]);
            }
        }
        stood = stands;
        flown.ended_s = t_s;
        if request == Request::Land && mode == Mode::Off {
            break;
        }
    }
    assert_eq!(world.body().touching(), [true; 2], "rotors off in the air");
    flown
}

fn specific_force(world: &World, attitude: &Matrix3<f64>) -> Vector3<f64> {
    let mut acceleration = world.rates().uav;
    acceleration.z -= world.body().vehicle().gravity;
    attitude.tr_mul(&acceleration)
}

/// With the controller in this program: the same numbers in the same arithmetic, without a line.
pub fn fly_here() -> Flown {
    let parameters = parameters(&scenario().controller).expect("a controller").cast::<f32>();
    let mut rig = Rig::new(&parameters).expect("a controller");
    fly(|measured, request, _| {
        let (state, uav) = (measured.state.map(State::cast), measured.uav.map(Uav::cast));
        let specific_force = measured.specific_force.map(|force| force.map(|x| x as f32));
        let output = rig.step(Measured { state: state.as_ref(), uav: uav.as_ref(), specific_force }, request, 0.0);
        Decision {
            command: output.command.cast(),
            body_rate: None,
            zeta: [0.0; 4],
            mode: output.mode,
            fault: output.fault,
            margins: None,
            telemetry: None,
        }
    })
}

/// That it went as it should.
pub fn check(flown: &Flown) {
    let Flown { modes, touchdown: [load, uav], off_path, ended_s, .. } = flown;
    println!("load {load:.2}, UAV {uav:.2} m/s, {:.1} mm off the path, down after {ended_s:.1} s", off_path * 1e3);
    use Mode::{Follow, Hold, Idle, Join, Land, Off, TakeOff};
    // A while without the load: hold, and back.
    assert_eq!(*modes, [Idle, TakeOff, Hold, Join, Follow, Hold, Join, Follow, Land, Off]);
    assert!((0.0..=TOUCHDOWN).contains(load) && *load > 0.0, "{load} m/s");
    assert!((0.0..=TOUCHDOWN).contains(uav) && *uav > 0.0, "{uav} m/s");
    assert!(*off_path < 0.02, "{off_path} m");
}
