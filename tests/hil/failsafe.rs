//! The failsafes on a board, by its own clock: the ground station is lost, then the stick, the
//! battery runs low, and the pilot stops the rotors, all in one flight.

use std::io::ErrorKind;
use std::time::{Duration, Instant};

use controller::{State, Vector3};
use hil_sim::hil::Wire;
use link::dialect::*;
use link::{Decoder, Encoder, MavMessage, state_frame};

/// Until something is said, at most.
const PATIENCE: Duration = Duration::from_secs(20);
const STATE_EVERY: Duration = Duration::from_millis(10);

/// A ground station, a joystick and a navigation at one end of a line.
struct Station {
    wire: Box<dyn Wire>,
    encoder: Encoder,
    decoder: Decoder,
    begun: Instant,
    /// States sent, and when the last was.
    sequence: u32,
    sent: Option<Instant>,
    /// What is said again with every tenth of them.
    alive: Vec<MavMessage>,
    /// What was heard and not asked for yet.
    heard: Vec<MavMessage>,
}

impl Station {
    fn over(mut wire: Box<dyn Wire>) -> Self {
        wire.set_patience(Duration::from_millis(2)).expect("a patience");
        let (encoder, decoder) = (Encoder::new(link::STATION), Decoder::new());
        Self {
            wire,
            encoder,
            decoder,
            begun: Instant::now(),
            sequence: 0,
            sent: None,
            alive: Vec::new(),
            heard: Vec::new(),
        }
    }

    fn say(&mut self, message: &MavMessage) {
        let frame = self.encoder.frame(message);
        self.wire.write_all(frame.bytes()).expect("it listens");
    }

    fn set(&mut self, name: &str, value: f32) {
        self.say(&MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: value,
            target_system: 1,
            target_component: 1,
            param_id: link::name(name),
            param_type: MavParamType::MAV_PARAM_TYPE_REAL32 as u8,
        }));
        self.until(name, |message| match message {
            MavMessage::PARAM_VALUE(now) if now.param_id == link::name(name) => {
                assert_eq!(now.param_value, value);
                Some(())
            }
            _ => None,
        });
    }

    fn command(&mut self, command: MavCmd, param1: f32, param2: f32) {
        self.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            command: command as u16,
            param1,
            param2,
            target_system: 1,
            target_component: 1,
            ..COMMAND_LONG_DATA::DEFAULT
        }));
    }

    fn ask(&mut self, mode: LoadMode) {
        self.command(MavCmd::MAV_CMD_DO_SET_MODE, 1.0, f32::from(mode as u8));
    }

    /// At rest in the air, 1 m outside the path, every 10 ms.
    fn see(&mut self) {
        if self.sent.is_some_and(|sent| sent.elapsed() < STATE_EVERY) {
            return;
        }
        self.sent = Some(Instant::now());
        self.sequence += 1;
        let mut frame = state_frame(&State::at_rest(Vector3::new(6.0, 0.0, -10.0)));
        // No two in a row are the same, as no measurements are.
        frame.velocity[0] += 1e-6 * (self.sequence % 7) as f32;
        let time_usec = self.begun.elapsed().as_micros() as u64 + 1;
        self.say(&MavMessage::LOAD_STATE(LOAD_STATE_DATA { time_usec, sequence: self.sequence, ..frame }));
        if self.sequence.is_multiple_of(10) {
            self.alive.clone().iter().for_each(|message| self.say(message));
        }
    }

    /// What `is_it` makes of the first message that it knows, from those not asked for yet on.
    fn until<R>(&mut self, what: &str, is_it: impl Fn(&MavMessage) -> Option<R>) -> R {
        let (begun, mut passed, mut others, first) = (Instant::now(), Vec::new(), 0, self.sequence);
        while begun.elapsed() < PATIENCE {
            while !self.heard.is_empty() {
                let message = self.heard.remove(0);
                if let Some(found) = is_it(&message) {
                    return found;
                }
                if let MavMessage::STATUSTEXT(said) = &message {
                    passed.push(said.text.to_str().unwrap_or_default().to_owned());
                } else {
                    others += 1;
                }
            }
            self.see();
            let mut bytes = [0; 4096];
            match self.wire.read(&mut bytes) {
                Ok(count) => {
                    for &byte in &bytes[..count] {
                        self.decoder
                            .push(byte, |received| self.heard.extend(received.ok().map(|(message, _)| message)));
                    }
                }
                Err(error) => assert!(matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut), "{error}"),
            }
        }
        let states = self.sequence - first;
        panic!("{what} never came, but {passed:?} and {others} other messages, in {states} states");
    }

    /// Follows, with station and stick alive as they are in `alive`, which fall silent when it has
    /// joined.
    fn join(&mut self, alive: &[MavMessage]) {
        self.alive = alive.to_vec();
        self.alive.clone().iter().for_each(|message| self.say(message));
        self.ask(LoadMode::LOAD_MODE_FOLLOW);
        self.hears("joining the path");
        // Once more: what a busy host was late with may have been lost before.
        std::mem::take(&mut self.alive).iter().for_each(|message| self.say(message));
    }

    /// Waits for a status text that begins so.
    fn hears(&mut self, text: &str) {
        self.until(text, |message| match message {
            MavMessage::STATUSTEXT(said) => said.text.to_str().unwrap_or_default().starts_with(text).then_some(()),
            _ => None,
        });
    }
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA { mavtype: MavType::MAV_TYPE_GCS as u8, ..HEARTBEAT_DATA::DEFAULT })
}

fn joystick(buttons: u16) -> MavMessage {
    MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { target: 1, buttons, ..MANUAL_CONTROL_DATA::DEFAULT })
}

/// Flies through all of them.
pub fn fly(wire: Box<dyn Wire>) {
    let mut station = Station::over(wire);
    // By the timer, with rotors that do not turn; a busy host may send late.
    for (name, value) in
        [("SYS_SIM", 2.0), ("POL_COAST", 2.0), ("FS_GCS_T", 0.8), ("FS_RC_T", 0.4), ("RC_BTN_KILL", 16.0)]
    {
        station.set(name, value);
    }
    station.ask(LoadMode::LOAD_MODE_HOLD);
    station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    station.hears("hold");

    station.join(&[heartbeat()]);
    station.hears("ground station lost: FS_GCS_ACT");
    station.hears("hold");

    station.join(&[heartbeat(), joystick(0)]);
    station.hears("stick or radio lost: FS_RC_ACT");
    station.hears("hold");

    station.say(&heartbeat());
    station.say(&joystick(0));
    let battery = BATTERY_STATUS_DATA { battery_remaining: 10, ..BATTERY_STATUS_DATA::DEFAULT };
    station.say(&MavMessage::BATTERY_STATUS(battery));
    station.hears("battery below FS_BAT_PCT: FS_BAT_ACT");
    station.hears("landing");

    station.say(&joystick(1 << 15));
    station.hears("rotors stopped by the kill switch");
    let is_armed = station.until("a heartbeat", |message| match message {
        MavMessage::HEARTBEAT(heartbeat) => {
            Some(heartbeat.base_mode & MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED as u8 != 0)
        }
        _ => None,
    });
    assert!(!is_armed, "armed after the kill switch");
}
