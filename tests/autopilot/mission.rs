//! Missions by MAVLink's protocol: what is sent up is kept to the bit, whatever the line loses;
//! what makes no route is refused in words; and what is kept is flown.

use autopilot::{Autopilot, Boot, Item, Kind, Memory, Setting};
use controller::{Command, Mode, State, Vector3};
use hil_sim::world::multibody::{Loads, Multibody};
use hil_sim::world::random::{Purpose, Stream};
use link::MavMessage;
use link::dialect::*;
use rig::{ROUTE, parameter};
use witness::plant::VehicleParameters;

use crate::station::{Station, frame_of, set, texts};

pub const ACCEPTED: u8 = MavResult::MAV_RESULT_ACCEPTED as u8;
pub const NOT_NOW: u8 = MavResult::MAV_RESULT_TEMPORARILY_REJECTED as u8;
pub const KEPT: MavMissionResult = MavMissionResult::MAV_MISSION_ACCEPTED;
const LOCAL: u8 = MavFrame::MAV_FRAME_LOCAL_NED as u8;
pub const RELATIVE: u8 = MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT as u8;
pub const PERIOD_S: f64 = 0.002;

/// An autopilot that is to fly missions, not armed.
pub fn station() -> Station {
    let memory = Box::leak(Box::new(Memory::<4096>::new()));
    let mut autopilot = Autopilot::new(Boot::default()).with_memory(memory);
    autopilot.settings_mut().unwrap().set(Setting::DRIVE, 2.0).unwrap();
    set(&mut autopilot, parameter!("PATH_KIND"), f32::from(ROUTE));
    Station::new(autopilot)
}

pub fn item(command: MavCmd, place: [f32; 3]) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA {
        command: command as u16,
        frame: LOCAL,
        autocontinue: 1,
        param4: f32::NAN,
        x: (place[0] * 1e4) as i32,
        y: (place[1] * 1e4) as i32,
        z: place[2],
        ..MISSION_ITEM_INT_DATA::DEFAULT
    }
}

pub fn waypoint(place: [f32; 3]) -> MISSION_ITEM_INT_DATA {
    item(MavCmd::MAV_CMD_NAV_WAYPOINT, place)
}

pub fn rest(place: [f32; 3], seconds: f32) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA { param1: seconds, ..waypoint(place) }
}

fn action(command: MavCmd, param1: f32, param2: f32) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA { param1, param2, ..item(command, [0.0; 3]) }
}

/// A line that loses a share of the frames either way.
pub struct Lossy {
    share: f64,
    random: Stream,
}

impl Lossy {
    pub fn none() -> Self {
        Self { share: 0.0, random: Stream::new(1, 0, Purpose::Draw) }
    }

    fn loses(&mut self) -> bool {
        self.random.unit() < self.share
    }
}

/// Uploads as stations do: the count again, and the last item again, where no answer comes for half
/// a second. The outcome, and what was said.
pub fn upload(
    station: &mut Station,
    items: &[MISSION_ITEM_INT_DATA],
    kind: MavMissionType,
    line: &mut Lossy,
) -> (u8, Vec<String>) {
    let mission_type = kind as u8;
    let count = MISSION_COUNT_DATA { count: items.len() as u16, mission_type, ..MISSION_COUNT_DATA::DEFAULT };
    let mut question = MavMessage::MISSION_COUNT(count);
    let (mut said, mut waits) = (Vec::new(), u32::MAX);
    for _ in 0..20_000 {
        // Every 10 ms.
        station.time_ns += 10_000_000;
        waits = waits.saturating_add(1);
        let mut heard = if waits > 50 && !std::mem::replace(&mut waits, 0).eq(&u32::MAX) && !line.loses() {
            station.say(&question)
        } else {
            Vec::new()
        };
        loop {
            heard.extend(station.messages());
            let messages = std::mem::take(&mut heard);
            if messages.is_empty() {
                break;
            }
            said.extend(texts(&messages));
            for message in messages {
                match message {
                    _ if line.loses() => {}
                    MavMessage::MISSION_ACK(ack) => {
                        assert_eq!(ack.mission_type, mission_type);
                        return (ack.mavtype, said);
                    }
                    MavMessage::MISSION_REQUEST_INT(request) => {
                        assert_eq!((request.target_system, request.target_component), link::STATION);
                        let seq = request.seq;
                        let item = items[usize::from(seq)].clone();
                        question = MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA { seq, mission_type, ..item });
                        waits = 0;
                        if !line.loses() {
                            heard.extend(station.say(&question));
                        }
                    }
                    _ => {}
                }
            }
        }
    }
    panic!("no end of an upload")
}

/// Sends a mission over a good line, which is kept.
pub fn send(station: &mut Station, items: &[MISSION_ITEM_INT_DATA]) {
    let (result, said) = upload(station, items, MavMissionType::MAV_MISSION_TYPE_MISSION, &mut Lossy::none());
    assert_eq!((result, said), (KEPT as u8, vec![]));
}

/// Reads it back, asking again for what is lost.
fn download(station: &mut Station, kind: MavMissionType, line: &mut Lossy) -> Vec<MISSION_ITEM_INT_DATA> {
    let mission_type = kind as u8;
    let ask = |station: &mut Station, question: MavMessage, line: &mut Lossy| loop {
        let lost = line.loses();
        let replies = if lost { vec![] } else { station.say(&question) };
        if let Some(reply) = replies.into_iter().next().filter(|_| !line.loses()) {
            return reply;
        }
    };
    let list = MISSION_REQUEST_LIST_DATA { mission_type, ..MISSION_REQUEST_LIST_DATA::DEFAULT };
    let MavMessage::MISSION_COUNT(count) = ask(station, MavMessage::MISSION_REQUEST_LIST(list), line) else {
        panic!("no count")
    };
    let item = |seq| {
        let request = MISSION_REQUEST_INT_DATA { seq, mission_type, ..MISSION_REQUEST_INT_DATA::DEFAULT };
        match ask(station, MavMessage::MISSION_REQUEST_INT(request), line) {
            MavMessage::MISSION_ITEM_INT(item) => item,
            other => panic!("{other:?}"),
        }
    };
    (0..count.count).map(item).collect()
}

type Bits = (u16, [u8; 3], [u32; 5], [i32; 2]);

/// All bits but those of whom it is for, and its number.
fn bits_of(items: &[MISSION_ITEM_INT_DATA]) -> Vec<Bits> {
    let bits = |item: &MISSION_ITEM_INT_DATA| {
        let floats = [item.param1, item.param2, item.param3, item.param4, item.z].map(f32::to_bits);
        (item.command, [item.frame, item.current, item.autocontinue], floats, [item.x, item.y])
    };
    items.iter().map(bits).collect()
}

/// What the autopilot keeps, as [`bits_of`] has it.
fn kept(station: &Station) -> Vec<Bits> {
    let items = station.autopilot.mission().items(Kind::Mission).iter();
    let bits = |item: &Item| {
        let [a, b, c, d] = item.params.map(f32::to_bits);
        (
            item.command,
            [item.frame, item.current, item.autocontinue],
            [a, b, c, d, item.z.to_bits()],
            [item.x, item.y],
        )
    };
    items.map(bits).collect()
}

#[test]
fn what_is_sent_up_is_kept_to_the_bit_whatever_the_line_loses() {
    for seed in 0..20 {
        let mut line = Lossy { share: 0.05 + 0.01 * seed as f64, random: Stream::new(seed, 0, Purpose::Draw) };
        let mut random = Stream::new(seed, 1, Purpose::Draw);
        let items: Vec<_> = (0..100)
            .map(|number| {
                let place = [10.0 * number as f32, 20.0 * random.unit() as f32, -10.0 - random.unit() as f32];
                let seconds = if number % 10 == 9 { 1.5 } else { 0.0 };
                let current = u8::from(number == 0);
                MISSION_ITEM_INT_DATA { current, param2: random.unit() as f32, ..rest(place, seconds) }
            })
            .collect();
        let mut station = station();
        let kind = MavMissionType::MAV_MISSION_TYPE_MISSION;
        let (result, said) = upload(&mut station, &items, kind, &mut line);
        assert_eq!((result, said), (KEPT as u8, vec![]), "{seed}");
        let back = download(&mut station, kind, &mut line);
        assert_eq!(bits_of(&back), bits_of(&items), "{seed}");
        assert_eq!(station.autopilot.mission().items(Kind::Mission).len(), 100);
    }
}

#[test]
fn an_upload_that_ends_halfway_changes_nothing() {
    let mut station = station();
    let old = [waypoint([0.0, 0.0, -10.0]), waypoint([20.0, 0.0, -10.0])];
    send(&mut station, &old);
    let count = MISSION_COUNT_DATA { count: 3, ..MISSION_COUNT_DATA::DEFAULT };
    let asked = station.say(&MavMessage::MISSION_COUNT(count));
    assert!(matches!(&asked[..], [MavMessage::MISSION_REQUEST_INT(request)] if request.seq == 0), "{asked:?}");
    // It is asked for again, and at last given up.
    let mut asked = 0;
    let ended = loop {
        station.time_ns += 100_000_000;
        let mut ended = None;
        for message in station.messages() {
            match message {
                MavMessage::MISSION_REQUEST_INT(request) => asked += u32::from(request.seq == 0),
                MavMessage::MISSION_ACK(ack) => ended = Some(ack.mavtype),
                _ => {}
            }
        }
        if let Some(ended) = ended {
            break ended;
        }
    };
    assert_eq!((asked, ended), (20, MavMissionResult::MAV_MISSION_OPERATION_CANCELLED as u8));
    assert_eq!(kept(&station), bits_of(&old));
    // An item that was not asked for is none.
    assert_eq!(station.say(&MavMessage::MISSION_ITEM_INT(waypoint([1.0; 3]))), []);
}

#[test]
fn what_makes_no_route_is_refused_by_item_and_in_words() {
    use MavCmd::*;
    use MavMissionResult as R;
    let line = [[0.0, 0.0, -10.0], [20.0, 0.0, -10.0], [40.0, 0.0, -10.0]].map(waypoint);
    let with = |at: usize, item: MISSION_ITEM_INT_DATA| {
        let mut items = line.to_vec();
        items.insert(at, item);
        items
    };
    let frame = |frame: u8| MISSION_ITEM_INT_DATA { frame, ..waypoint([10.0, 0.0, -10.0]) };
    let earth = |x, y| MISSION_ITEM_INT_DATA { x, y, ..frame(RELATIVE) };
    let command = |command: u16| MISSION_ITEM_INT_DATA { command, ..waypoint([10.0, 0.0, -10.0]) };
    let cases = [
        (with(1, command(201)), R::MAV_MISSION_UNSUPPORTED, "item 1: command 201 not supported"),
        (with(2, command(18)), R::MAV_MISSION_UNSUPPORTED, "item 2: command 18 not supported"),
        (with(1, frame(10)), R::MAV_MISSION_UNSUPPORTED_FRAME, "item 1: frame 10 not supported"),
        (with(1, frame(7)), R::MAV_MISSION_UNSUPPORTED_FRAME, "item 1: frame 7 not supported"),
        (with(1, rest([9.0, 0.0, -10.0], -1.0)), R::MAV_MISSION_INVALID_PARAM1, "item 1: rest -1 not in 0 to 100000"),
        (with(1, earth(910_000_000, 1)), R::MAV_MISSION_INVALID_PARAM5_X, "item 1: latitude 91.0 not in -90 to 90"),
        (
            with(1, earth(1, -1_810_000_000)),
            R::MAV_MISSION_INVALID_PARAM6_Y,
            "item 1: longitude -181.0 not in -180 to 180",
        ),
        (
            with(1, waypoint([9.0, 0.0, f32::NAN])),
            R::MAV_MISSION_INVALID_PARAM7,
            "item 1: height NaN not in -1e5 to 1e5",
        ),
        (with(2, waypoint([10.0, 0.1, -10.0])), R::MAV_MISSION_INVALID, "item 1: turns over 150 deg, needs a rest"),
        (
            with(1, action(MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0)),
            R::MAV_MISSION_INVALID,
            "item 2: behind the jump or landing that ends it",
        ),
        (with(3, action(MAV_CMD_DO_JUMP, 1.0, 3.0)), R::MAV_MISSION_INVALID, "item 3: jumps only to the first one"),
        (line[..1].to_vec(), R::MAV_MISSION_INVALID, "a mission needs at least two places"),
    ];
    for (items, result, words) in cases {
        let mut station = station();
        send(&mut station, &line);
        let answer = upload(&mut station, &items, MavMissionType::MAV_MISSION_TYPE_MISSION, &mut Lossy::none());
        assert_eq!(answer, (result as u8, vec![words.to_owned()]), "{words}");
        assert_eq!(kept(&station), bits_of(&line), "{words}");
    }
    // Too many, rally points, partial lists.
    let mut station = station();
    let count = |count, mission_type| {
        MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, mission_type, ..MISSION_COUNT_DATA::DEFAULT })
    };
    for (question, result, words) in [
        (count(129, 0), R::MAV_MISSION_NO_SPACE, "mission: 129 items, at most 128"),
        (count(2, 2), R::MAV_MISSION_UNSUPPORTED, "mission: routes and fences alone"),
        (
            MavMessage::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA::DEFAULT),
            R::MAV_MISSION_UNSUPPORTED,
            "mission: no partial lists",
        ),
    ] {
        let replies = station.say(&question);
        assert_eq!(texts(&replies), [words]);
        assert!(matches!(replies.last(), Some(MavMessage::MISSION_ACK(ack)) if ack.mavtype == result as u8));
    }
    // A board without memory has no missions.
    let mut bare = Station::new(Autopilot::new(Boot::default()));
    let replies = bare.say(&count(2, 0));
    assert_eq!(texts(&replies), ["this board has no memory for missions"]);
}

/// A vehicle under an autopilot, by its states.
pub struct Flight {
    pub station: Station,
    pub body: Multibody,
    sequence: u32,
    /// What was said, and the items that were reached.
    pub said: Vec<String>,
    pub reached: Vec<u16>,
    states: Vec<u8>,
}

impl Flight {
    pub fn at(station: Station, place: [f64; 3]) -> Self {
        let state = State::at_rest(Vector3::from(place));
        let body = Multibody::new(VehicleParameters::default(), &state);
        Self { station, body, sequence: 0, said: vec![], reached: vec![], states: vec![] }
    }

    pub fn step(&mut self) {
        self.sequence += 1;
        self.station.time_ns += 2_000_000;
        self.station.autopilot.receive(&frame_of(&self.body.state().cast(), self.sequence));
        let command = self.station.autopilot.tick().command;
        let command =
            Command { thrust: f64::from(command.thrust), torque: Vector3::from(command.torque).map(f64::from) };
        if self.station.autopilot.is_armed() {
            self.body.advance(PERIOD_S, |_| command, |_, _| Loads::none());
        }
        for message in self.station.messages() {
            self.said.extend(texts(std::slice::from_ref(&message)));
            match message {
                MavMessage::MISSION_ITEM_REACHED(item) => self.reached.push(item.seq),
                MavMessage::MISSION_CURRENT(current) if self.states.last() != Some(&current.mission_state) => {
                    self.states.push(current.mission_state);
                }
                _ => {}
            }
        }
    }

    pub fn fly(&mut self, seconds: f64) {
        for _ in 0..(seconds / PERIOD_S) as u32 {
            self.step();
        }
    }

    pub fn fly_until(&mut self, what: &str, mut is_so: impl FnMut(&Self) -> bool) {
        for _ in 0..300_000 {
            self.step();
            if is_so(self) {
                return;
            }
        }
        panic!("never {what}: {:?} {:?}", self.said, self.reached)
    }

    pub fn place(&self) -> Vector3<f64> {
        self.body.state().position
    }

    pub fn command(&mut self, command: MavCmd, param1: f32, param2: f32) -> (u8, Vec<String>) {
        self.station.command(command, param1, param2)
    }

    /// Takes the vehicle over in flight, to hold.
    pub fn arm(&mut self) {
        self.station.ask(LoadMode::LOAD_MODE_HOLD);
        self.step();
        assert_eq!(self.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0), (ACCEPTED, vec![]));
        self.fly(1.0);
        assert_eq!(self.station.autopilot.mode(), Mode::Hold);
    }
}

#[test]
fn a_mission_is_flown_with_rests_pauses_holds_and_speeds() {
    let mut station = station();
    let corners = [[0.0, 0.0, -10.0], [15.0, 0.0, -10.0], [15.0, 15.0, -12.0], [0.0, 15.0, -12.0]];
    send(
        &mut station,
        &[
            waypoint(corners[0]),
            rest(corners[1], 1.0),
            action(MavCmd::MAV_CMD_DO_CHANGE_SPEED, 1.0, 3.0),
            waypoint(corners[2]),
            rest(corners[3], 0.0),
        ],
    );
    let mut flight = Flight::at(station, [0.5, -0.5, -10.0]);
    assert_eq!(flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0).0, NOT_NOW);
    flight.arm();
    assert_eq!(flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0), (ACCEPTED, vec![]));
    flight.fly_until("the second item", |flight| flight.reached == [0, 1]);
    let at = flight.place() - Vector3::from(corners[1].map(f64::from));
    // At rest is 10 mm/s: the stop's rate of 0.5/s leaves 20 mm.
    assert!(at.norm() < 0.021, "{at}");
    // On the way to the third it pauses, goes on slower, holds, and goes on where it was.
    flight.fly_until("under way", |flight| flight.place().y > 5.0);
    assert_eq!(flight.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, 0.0, 0.0), (ACCEPTED, vec![]));
    flight.fly(12.0);
    assert!(flight.body.state().velocity.norm() < 1e-3, "{}", flight.body.state().velocity);
    let paused = flight.place();
    assert_eq!(flight.states.last(), Some(&(MissionState::MISSION_STATE_PAUSED as u8)));
    assert_eq!(
        flight.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, 1.0, 4.0),
        (NOT_NOW, vec!["speed: above that of the route's leg".to_owned()])
    );
    assert_eq!(flight.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, 1.0, 0.5).0, ACCEPTED);
    // -1 changes nothing.
    assert_eq!(flight.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, 1.0, -1.0).0, ACCEPTED);
    for speed in [0.0, -0.5, f32::NAN] {
        assert_eq!(flight.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, 1.0, speed).0, NOT_NOW, "{speed}");
    }
    assert_eq!(flight.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, 1.0, 0.0), (ACCEPTED, vec![]));
    flight.fly(8.0);
    let speed = flight.body.state().velocity.norm();
    assert!((0.1..0.5).contains(&speed) && flight.place().y > paused.y, "{speed}");
    flight.station.ask(LoadMode::LOAD_MODE_HOLD);
    flight.fly(5.0);
    let held = flight.place();
    assert_eq!(flight.station.autopilot.mode(), Mode::Hold);
    assert_eq!(flight.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, 1.0, -2.0).0, ACCEPTED);
    flight.station.ask(LoadMode::LOAD_MODE_FOLLOW);
    flight.fly(2.0);
    assert!((flight.place() - held).norm() < 3.0);
    flight.fly_until("the end", |flight| flight.states.last() == Some(&(MissionState::MISSION_STATE_COMPLETE as u8)));
    assert_eq!(flight.reached, [0, 1, 3, 4]);
    flight.fly(10.0);
    let at = flight.place() - Vector3::from(corners[3].map(f64::from));
    assert!(at.norm() < 1e-3, "{at}");
    assert_eq!(flight.station.autopilot.mode(), Mode::Follow);
    // Denied while it flies; and the memory is there again after it.
    let denied = upload(
        &mut flight.station,
        &[waypoint([0.0; 3]), waypoint([9.0; 3])],
        MavMissionType::MAV_MISSION_TYPE_MISSION,
        &mut Lossy::none(),
    );
    assert_eq!(denied.0, MavMissionResult::MAV_MISSION_DENIED as u8);
    for _ in 0..3 {
        flight.station.autopilot.disarm();
        flight.arm();
    }
}

#[test]
fn a_mission_begins_at_its_beginning_and_loops_as_often_as_it_says() {
    // Its end is nearer than its beginning.
    let corners = [[0.0, 0.0, -10.0], [8.0, 0.0, -10.0], [8.0, 8.0, -10.0], [0.0, 8.0, -10.0], [0.0, 0.8, -10.0]];
    let mut items: Vec<_> = corners.map(waypoint).to_vec();
    items.push(action(MavCmd::MAV_CMD_DO_JUMP, 0.0, 1.0));
    let mut station = station();
    send(&mut station, &items);
    let mut flight = Flight::at(station, [0.0, 1.0, -10.0]);
    flight.arm();
    flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0);
    flight.fly_until("the end", |flight| flight.states.last() == Some(&(MissionState::MISSION_STATE_COMPLETE as u8)));
    // Where it does not rest, the way back is the next round's.
    assert_eq!(flight.reached, [0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 5]);
    assert!(flight.place().xy().norm() < 0.021, "{}", flight.place());
}

#[test]
fn a_mission_waits_lands_and_goes_to_another_item_when_told() {
    let mut station = station();
    send(
        &mut station,
        &[
            waypoint([0.0, 0.0, -30.0]),
            item(MavCmd::MAV_CMD_NAV_LOITER_UNLIM, [10.0, 0.0, -30.0]),
            rest([10.0, 10.0, -30.0], 0.5),
            action(MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0),
        ],
    );
    let mut flight = Flight::at(station, [0.0, 0.0, -30.0]);
    flight.arm();
    flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0);
    flight.fly_until("the second item", |flight| flight.reached == [0, 1]);
    flight.fly(10.0);
    assert_eq!(flight.reached, [0, 1]);
    assert_eq!(
        flight.command(MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT, 3.0, 0.0),
        (NOT_NOW, vec!["mission: hold first, then another item".to_owned()])
    );
    flight.command(MavCmd::MAV_CMD_DO_PAUSE_CONTINUE, 1.0, 0.0);
    flight.fly_until("landing", |flight| flight.station.autopilot.mode() == Mode::Land);
    assert_eq!(flight.reached, [0, 1, 2, 3]);
    assert!(flight.place().xy().norm() < 0.05, "{}", flight.place());
    // Back to the second leg from there.
    flight.station.ask(LoadMode::LOAD_MODE_HOLD);
    flight.fly(5.0);
    let current = flight.station.say(&MavMessage::MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA {
        seq: 2,
        ..MISSION_SET_CURRENT_DATA::DEFAULT
    }));
    assert!(matches!(&current[..], [MavMessage::MISSION_CURRENT(current)] if current.seq == 2), "{current:?}");
    flight.reached.clear();
    flight.station.ask(LoadMode::LOAD_MODE_FOLLOW);
    flight.fly_until("landing", |flight| flight.station.autopilot.mode() == Mode::Land);
    assert_eq!(flight.reached, [2, 3]);
}

#[test]
fn a_mission_begins_where_it_is_told_to_and_the_next_one_at_its_first_item() {
    let mut station = station();
    let places = [[0.0, 0.0, -10.0], [8.0, 0.0, -10.0], [8.0, 8.0, -10.0], [0.0, 8.0, -10.0]];
    send(&mut station, &places.map(|place| rest(place, 0.1)));
    let current = |flight: &mut Flight, seq: Option<u16>| {
        let told = match seq {
            Some(seq) => flight.station.say(&MavMessage::MISSION_SET_CURRENT(MISSION_SET_CURRENT_DATA {
                seq,
                ..MISSION_SET_CURRENT_DATA::DEFAULT
            })),
            None => flight.station.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
                command: MavCmd::MAV_CMD_REQUEST_MESSAGE as u16,
                param1: 42.0,
                ..COMMAND_LONG_DATA::DEFAULT
            })),
        };
        let seqs: Vec<_> = told
            .into_iter()
            .filter_map(|message| match message {
                MavMessage::MISSION_CURRENT(current) => Some(current.seq),
                _ => None,
            })
            .collect();
        assert_eq!(seqs.len(), 1);
        seqs[0]
    };
    let set = MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT;
    let no_item = (NOT_NOW, vec!["mission: no such item".to_owned()]);
    let mut flight = Flight::at(station, [8.0, 8.0, -10.0]);
    assert_eq!(current(&mut flight, Some(3)), 3);
    // -1 is the current one; what is no number is none.
    for (number, answer) in
        [(-1.0, (ACCEPTED, vec![])), (f32::NAN, no_item.clone()), (-2.0, no_item.clone()), (1e6, no_item)]
    {
        assert_eq!(flight.command(set, number, 0.0), answer, "{number}");
        assert_eq!(current(&mut flight, None), 3, "{number}");
    }
    // It is flown from there, once.
    flight.arm();
    assert_eq!(current(&mut flight, None), 3);
    flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0);
    flight.fly_until("the end", |flight| flight.states.last() == Some(&(MissionState::MISSION_STATE_COMPLETE as u8)));
    assert_eq!(flight.reached, [3]);
    flight.station.autopilot.disarm();
    assert_eq!(current(&mut flight, None), 0);
    flight.reached.clear();
    flight.arm();
    flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0);
    flight.fly_until("the second item", |flight| flight.reached == [0, 1]);
}

#[test]
fn places_on_the_earth_are_those_of_the_importer() {
    // Edmonton, Quito, Ushuaia, and near the date line; to 5 km away.
    for (seed, (lat, lon, alt)) in
        [(53.527, -113.529, 668.0), (-0.1807, -78.4678, 2850.0), (-54.8, -68.3, 10.0), (65.0, 179.99, 0.0)]
            .into_iter()
            .enumerate()
    {
        let mut random = Stream::new(seed as u64, 0, Purpose::Draw);
        let home = link::Home { latitude: lat, longitude: lon, altitude: alt };
        for _ in 0..200 {
            let mut spread = || random.unit() * 2.0 - 1.0;
            let (place, up) = ([lat + 0.04 * spread(), lon + 0.06 * spread()], 500.0 * spread());
            let [north, east] = home.local(place, alt + up);
            let enu = map_3d::geodetic2enu(
                place[0].to_radians(),
                place[1].to_radians(),
                alt + up,
                lat.to_radians(),
                lon.to_radians(),
                alt,
                map_3d::Ellipsoid::WGS84,
            );
            let off = (north - enu.1).hypot(east - enu.0);
            assert!(off < 1e-6, "{off}");
        }
    }
    // Without a home it is kept, and not flown; with one it is, at the same places as local items.
    let mut station = station();
    let earth = |x, y, z| MISSION_ITEM_INT_DATA { frame: RELATIVE, x, y, z, ..waypoint([0.0; 3]) };
    let items = [earth(535_270_000, -1_135_290_000, 10.0), earth(535_280_000, -1_135_290_000, 12.0)];
    let (result, said) = upload(&mut station, &items, MavMissionType::MAV_MISSION_TYPE_MISSION, &mut Lossy::none());
    assert_eq!((result, said), (KEPT as u8, vec!["item 0: on the earth, but no home is set".to_owned()]));
    let mut flight = Flight::at(station, [0.0, 0.0, -10.0]);
    flight.step();
    let refused = flight.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(refused.1, ["item 0: on the earth, but no home is set"]);
    let home = SET_GPS_GLOBAL_ORIGIN_DATA {
        latitude: 535_270_000,
        longitude: -1_135_290_000,
        altitude: 668_000,
        ..SET_GPS_GLOBAL_ORIGIN_DATA::DEFAULT
    };
    let told = flight.station.say(&MavMessage::SET_GPS_GLOBAL_ORIGIN(home));
    assert!(
        matches!(&told[..], [MavMessage::GPS_GLOBAL_ORIGIN(origin), MavMessage::HOME_POSITION(home)]
            if origin.latitude == 535_270_000 && home.altitude == 668_000),
        "{told:?}"
    );
    flight.arm();
    flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0);
    flight.fly_until("the end", |flight| flight.states.last() == Some(&(MissionState::MISSION_STATE_COMPLETE as u8)));
    flight.fly(10.0);
    // A thousandth of a degree of the meridian, 680 m above the sea.
    let at = flight.place() - Vector3::new(111.308, 0.0, -12.0);
    assert!(at.norm() < 0.01, "{at}");
}

pub fn fence(command: MavCmd, param1: f32, [n1, n2]: [f32; 2]) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA { param1, ..item(command, [n1, n2, 0.0]) }
}

pub fn polygon(command: MavCmd, corners: &[[f32; 2]]) -> Vec<MISSION_ITEM_INT_DATA> {
    corners.iter().map(|&corner| fence(command, corners.len() as f32, corner)).collect()
}

#[test]
fn a_fence_is_kept_before_a_flight_and_in_it() {
    use MavCmd::*;
    let kind = MavMissionType::MAV_MISSION_TYPE_FENCE;
    let square = polygon(MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, &[[-5., -5.], [30., -5.], [30., 5.], [-5., 5.]]);
    let mut items = square.clone();
    items.push(fence(MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, 1.0, [20.0, 3.5]));
    let mut station = station();
    assert_eq!(upload(&mut station, &items, kind, &mut Lossy::none()), (KEPT as u8, vec![]));
    assert_eq!(bits_of(&download(&mut station, kind, &mut Lossy::none())), bits_of(&items));
    // 31 m is outside, and so is 29.5 m, with a metre's margin; a leg to (24, 4) goes into the
    // keep-out.
    let route = |last: [f32; 3]| [waypoint([0.0, 0.0, -10.0]), waypoint([10.0, 0.0, -10.0]), waypoint(last)];
    for (last, what) in [
        ([29.5, 0.0, -10.0], Some("item 2: the load too near the fence")),
        ([29.5, 4.5, -10.0], Some("item 2: the load too near the fence")),
        ([24.0, 4.0, -10.0], Some("item 2: the load too near the fence")),
        ([25.0, 0.0, -10.0], None),
    ] {
        let (result, said) =
            upload(&mut station, &route(last), MavMissionType::MAV_MISSION_TYPE_MISSION, &mut Lossy::none());
        let expected = what.map(str::to_owned).into_iter().collect::<Vec<_>>();
        assert_eq!(said, expected, "{last:?}");
        assert_eq!(result == KEPT as u8, what.is_none());
    }
    // Under a ceiling the UAV, 2 m above the load, comes first.
    station.autopilot.settings_mut().unwrap().set(Setting::FENCE_HIGH, 12.5).unwrap();
    let route = route([25.0, 0.0, -10.0]);
    let answer = upload(&mut station, &route, MavMissionType::MAV_MISSION_TYPE_MISSION, &mut Lossy::none());
    assert_eq!(answer.1, ["item 1: the UAV too near the fence"]);
    station.autopilot.settings_mut().unwrap().set(Setting::FENCE_HIGH, 100.0).unwrap();
    // A fence through the route that is kept is refused in turn; and so are halves of polygons.
    let across = [fence(MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, 1.0, [15.0, 0.0])];
    let answer = upload(&mut station, &across, kind, &mut Lossy::none());
    assert_eq!(
        answer,
        (MavMissionResult::MAV_MISSION_INVALID as u8, vec!["item 2: the load too near the fence".to_owned()])
    );
    let answer = upload(&mut station, &square[..3], kind, &mut Lossy::none());
    assert_eq!(
        answer,
        (MavMissionResult::MAV_MISSION_INVALID as u8, vec!["fence item 0: not 4 corners in a row".to_owned()])
    );
    // Blown aside it holds before the fence is reached.
    let mut flight = Flight::at(station, [0.0, 0.0, -10.0]);
    flight.arm();
    flight.command(MAV_CMD_MISSION_START, 0.0, 0.0);
    flight.fly_until("under way", |flight| flight.place().x > 5.0);
    assert_eq!(flight.station.autopilot.mode(), Mode::Follow);
    let moved = State { position: flight.place() + Vector3::new(0.0, 4.6, 0.0), ..flight.body.state() };
    flight.body = Multibody::new(VehicleParameters::default(), &moved);
    flight.fly(0.1);
    assert!(flight.said.contains(&"too near the fence: FNC_ACT".to_owned()), "{:?}", flight.said);
    assert_eq!(flight.station.autopilot.mode(), Mode::Hold);
}

#[test]
fn the_way_to_a_route_keeps_the_fence_or_is_refused() {
    use MavCmd::*;
    // The route begins at (10, 0, -10), behind a keep-out of 2 m about (5, 0).
    let start = |at: [f64; 3]| {
        let mut station = station();
        let fence = [fence(MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, 2.0, [5.0, 0.0])];
        let route = [waypoint([10.0, 0.0, -10.0]), waypoint([20.0, 0.0, -10.0])];
        for (items, kind) in [
            (&fence[..], MavMissionType::MAV_MISSION_TYPE_FENCE),
            (&route[..], MavMissionType::MAV_MISSION_TYPE_MISSION),
        ] {
            assert_eq!(upload(&mut station, items, kind, &mut Lossy::none()), (KEPT as u8, vec![]));
        }
        let mut flight = Flight::at(station, at);
        flight.arm();
        let answer = flight.command(MAV_CMD_MISSION_START, 0.0, 0.0);
        flight.fly(1.0);
        (answer, flight.station.autopilot.mode())
    };
    let refused = (NOT_NOW, vec!["way to the route: the load too near the fence".to_owned()]);
    for aside in [0.0, 2.9, -5.5] {
        let (answer, mode) = start([0.0, aside, -10.0]);
        assert_eq!(answer, refused, "{aside}");
        assert!(!matches!(mode, Mode::Join | Mode::Follow), "{aside}: {mode:?}");
    }
    // From (0, 8) the straight way passes (5, 0) at 5 sin 38.66 deg = 3.12 m, and 3 m are kept.
    for at in [[0.0, 8.0, -10.0], [10.0, 5.0, -12.0]] {
        let (answer, mode) = start(at);
        assert_eq!(answer, (ACCEPTED, vec![]), "{at:?}");
        assert!(matches!(mode, Mode::Join | Mode::Follow), "{at:?}: {mode:?}");
    }
}

/// A point's distance from a polygon's edge or a circle's, on the right side, by sampling the edge:
/// not as the flight program finds it.
fn distance(corners: &[[f32; 2]], circle: Option<([f32; 2], f32)>, is_inside: bool, p: Vector3<f64>) -> f64 {
    let (within, away) = match circle {
        Some((center, radius)) => {
            let r = (p.x - f64::from(center[0])).hypot(p.y - f64::from(center[1]));
            (r < f64::from(radius), (r - f64::from(radius)).abs())
        }
        None => {
            let (mut winding, mut away) = (0.0, f64::INFINITY);
            for (index, a) in corners.iter().enumerate() {
                let b = corners[(index + 1) % corners.len()];
                let [a, b] = [*a, b].map(|c| [f64::from(c[0]) - p.x, f64::from(c[1]) - p.y]);
                winding += (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
                for step in 0..=200 {
                    let share = f64::from(step) / 200.0;
                    away = away.min((a[0] + (b[0] - a[0]) * share).hypot(a[1] + (b[1] - a[1]) * share));
                }
            }
            (f64::abs(winding) > 3.0, away)
        }
    };
    if within == is_inside { away } else { -away }
}

#[test]
fn random_missions_stay_within_random_fences_or_are_refused_by_their_leg() {
    let kinds = [MavMissionType::MAV_MISSION_TYPE_FENCE, MavMissionType::MAV_MISSION_TYPE_MISSION];
    let count = std::env::var("FENCED_MISSIONS").map_or(200, |text| text.parse().expect("a number of missions"));
    let (mut kept, mut flown, mut nearest) = (0, 0, f64::INFINITY);
    let mut station = station();
    for seed in 0..count {
        let mut random = Stream::new(seed, 2, Purpose::Draw);
        let mut number = |low: f64, high: f64| random.uniform(low, high) as f32;
        let corners: Vec<_> = (0..7)
            .map(|corner| {
                let (angle, radius) = (corner as f32 * 0.897 + number(-0.3, 0.3), number(15.0, 40.0));
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let circle = ([number(-20.0, 20.0), number(-20.0, 20.0)], number(1.0, 6.0));
        let mut items = polygon(MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, &corners);
        items.push(fence(MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, circle.1, circle.0));
        let route: Vec<_> =
            (0..4).map(|_| rest([number(-15.0, 15.0), number(-15.0, 15.0), number(-30.0, -20.0)], 0.1)).collect();
        station.say(&MavMessage::MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA {
            mission_type: 255,
            ..MISSION_CLEAR_ALL_DATA::DEFAULT
        }));
        assert_eq!(upload(&mut station, &items, kinds[0], &mut Lossy::none()).0, KEPT as u8);
        let (result, said) = upload(&mut station, &route, kinds[1], &mut Lossy::none());
        let nearness = |p| distance(&corners, None, true, p).min(distance(&[], Some(circle), false, p));
        if result != KEPT as u8 {
            assert!(said.len() == 1 && said[0].starts_with("item "), "{seed}: {said:?}");
            continue;
        }
        kept += 1;
        // The legs are straight; the UAV and the cable lean by the acceleration, at most 1 m/s² and
        // its overshoot of 10 %.
        let legs = route.windows(2).flat_map(|leg| {
            let [a, b] = [&leg[0], &leg[1]]
                .map(|item| Vector3::new(f64::from(item.x) * 1e-4, f64::from(item.y) * 1e-4, f64::from(item.z)));
            (0..=100).map(move |step| a + (b - a) * (f64::from(step) / 100.0))
        });
        nearest = legs.map(nearness).fold(nearest, f64::min);
        if seed % (count / 10).max(1) != 0 {
            continue;
        }
        flown += 1;
        let begin = [f64::from(route[0].x) * 1e-4, f64::from(route[0].y) * 1e-4, f64::from(route[0].z)];
        let mut flight = Flight::at(std::mem::replace(&mut station, self::station()), begin);
        flight.arm();
        flight.command(MavCmd::MAV_CMD_MISSION_START, 0.0, 0.0);
        let mut closest = f64::INFINITY;
        flight.fly_until("the end", |flight| {
            let state = flight.body.state();
            for share in [0.0, 0.5, 1.0] {
                closest = closest.min(nearness(state.position - state.rod * (2.0 * share)));
            }
            flight.states.last() == Some(&(MissionState::MISSION_STATE_COMPLETE as u8))
        });
        // The margin, but for what the law leaves and the sampled edges hide.
        assert!(closest > 0.98, "{seed}: {closest}");
        assert!(flight.said.iter().all(|text| !text.contains("fence")), "{:?}", flight.said);
    }
    println!("{count} missions, {kept} kept, {flown} flown, nearest {nearest:.3} m");
    assert!(kept > count / 20 && flown > 0);
    assert!(nearest > 0.999, "{nearest}");
}
