//! An autopilot with a link's other end: what is sent to it, and what it says.

use autopilot::{Answer, Autopilot, Boot, Next, Server, Setting, Settings};
use controller::{Request, State, Vector3};
use link::dialect::*;
use link::{Decoder, Encoder, MavMessage, state_frame};
use rig::{Parameter, parameter};

/// At rest, 1 m outside the default circle.
pub fn start() -> State<f32> {
    State::at_rest(Vector3::new(6.0, 0.0, -10.0))
}

/// The `sequence`-th state, every 2 ms; no two in a row are the same, as no measurements are.
pub fn frame_of(state: &State<f32>, sequence: u32) -> LOAD_STATE_DATA {
    let mut frame = state_frame(state);
    frame.velocity[0] += 1e-6 * (sequence % 7) as f32;
    LOAD_STATE_DATA { time_usec: 2_000 * u64::from(sequence) + 1, sequence, ..frame }
}

pub fn frame(sequence: u32) -> LOAD_STATE_DATA {
    frame_of(&start(), sequence)
}

/// Not armed, in a drive.
pub fn driven(simulate: f32) -> Autopilot {
    let mut autopilot = Autopilot::new(Boot::default());
    autopilot.settings_mut().unwrap().set(Setting::DRIVE, simulate).unwrap();
    autopilot
}

/// Sets one of the controller's parameters.
pub fn set(autopilot: &mut Autopilot, parameter: Parameter, value: f32) {
    autopilot.settings_mut().unwrap().rig_mut().set(parameter, value).unwrap();
}

/// Armed to take over in flight and follow the path.
pub fn armed(simulate: f32) -> Autopilot {
    let mut autopilot = driven(simulate);
    arm_in_flight(&mut autopilot);
    autopilot
}

pub fn arm_in_flight(autopilot: &mut Autopilot) {
    autopilot.request(Request::Follow);
    arm(autopilot);
}

/// Armed, with the good state that it takes to be.
pub fn arm(autopilot: &mut Autopilot) {
    see(autopilot);
    autopilot.arm().unwrap();
}

/// Sees a good state.
pub fn see(autopilot: &mut Autopilot) {
    autopilot.receive(&frame(0));
    autopilot.tick();
}

/// A state, and the step on it.
pub fn fly(autopilot: &mut Autopilot, sequence: u32) -> Answer {
    autopilot.receive(&frame(sequence));
    autopilot.tick()
}

/// Finite, and what four rotors of `settings` can give.
pub fn is_flyable(answer: &Answer, settings: &Settings) -> bool {
    let command = &answer.command;
    let get = |parameter| settings.rig().get(parameter);
    // A float's rounding more.
    let most = 4.0 * get(parameter!("ROT_KT")) * get(parameter!("ROT_W_MAX")).powi(2) * 1.000_01;
    let torques = [parameter!("LIM_TAU_1"), parameter!("LIM_TAU_2"), parameter!("LIM_TAU_3")];
    let telemetry = answer.telemetry.as_ref().is_none_or(|t| {
        let scalars =
            [t.q3, t.q_b3, t.specific_force, t.kappa, t.path_det, t.reach, t.cos_phi_squared, t.payload_mass];
        let vectors = [&t.integral, &t.payload_force, &t.uav_force, &t.uav_torque];
        scalars.iter().chain(&t.xi).chain(&t.nu).chain(vectors.into_iter().flatten()).all(|number| number.is_finite())
    });
    telemetry
        && (0.0..=most).contains(&command.thrust)
        && command.torque.iter().zip(torques).all(|(axis, most)| axis.abs() <= get(most))
        && answer.outputs.iter().chain(&command.rotor).all(|duty| (0.0..=1.0).contains(duty))
        && command.zeta.iter().chain([&command.u_zeta]).all(|number| number.is_finite())
}

/// Both ends, joined by bytes.
pub struct Station {
    pub autopilot: Autopilot,
    server: Server,
    decoder: Decoder,
    encoder: Encoder,
    /// What its clock says.
    pub time_ns: u64,
}

impl Station {
    pub fn new(autopilot: Autopilot) -> Self {
        let (decoder, encoder) = (Decoder::new(), Encoder::new(link::STATION));
        Self { autopilot, server: Server::new(), decoder, encoder, time_ns: 0 }
    }

    pub fn encode(&mut self, message: &MavMessage) -> Vec<u8> {
        self.encoder.frame(message).bytes().to_vec()
    }

    /// Bytes as they come; the replies, and the answers of lockstep's steps.
    pub fn hear(&mut self, bytes: &[u8]) -> (Vec<MavMessage>, Vec<Answer>) {
        let (mut replies, mut answers) = (Vec::new(), Vec::new());
        let Self { autopilot, server, decoder, time_ns, .. } = self;
        for &byte in bytes {
            decoder.push(byte, |received| {
                if let Next::Step(frame) =
                    server.handle(received, *time_ns, autopilot, &mut |message| replies.push(message))
                {
                    answers.push(autopilot.lockstep(&frame));
                }
            });
        }
        (replies, answers)
    }

    /// What it replies to a message.
    pub fn say(&mut self, message: &MavMessage) -> Vec<MavMessage> {
        let bytes = self.encode(message);
        self.hear(&bytes).0
    }

    /// A command's result, and what was said about it.
    pub fn command(&mut self, command: MavCmd, param1: f32, param2: f32) -> (u8, Vec<String>) {
        let command = command as u16;
        let request =
            MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { param1, param2, command, ..COMMAND_LONG_DATA::DEFAULT });
        let replies = self.say(&request);
        let result = replies.iter().find_map(|reply| match reply {
            MavMessage::COMMAND_ACK(ack) if ack.command == command => Some(ack.result),
            _ => None,
        });
        (result.expect("every command is acknowledged"), texts(&replies))
    }

    /// Asks for a mode.
    pub fn ask(&mut self, mode: LoadMode) -> (u8, Vec<String>) {
        let custom = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u32 as f32;
        self.command(MavCmd::MAV_CMD_DO_SET_MODE, custom, mode as u32 as f32)
    }

    /// What it says unasked.
    pub fn news(&mut self) -> Vec<String> {
        texts(&self.messages())
    }

    /// The messages that come unasked.
    pub fn messages(&mut self) -> Vec<MavMessage> {
        let Self { autopilot, server, time_ns, .. } = self;
        let time_ns = *time_ns;
        std::iter::from_fn(|| server.news(time_ns, autopilot).or_else(|| server.listed(autopilot))).collect()
    }
}

/// The texts among messages.
pub fn texts(messages: &[MavMessage]) -> Vec<String> {
    let texts = messages.iter().filter_map(|message| match message {
        MavMessage::STATUSTEXT(text) => Some(link::text_of(&*text.text).to_owned()),
        _ => None,
    });
    texts.collect()
}
