//! A file of a ground station, and the same file sent up: `hil-sim route` makes of it the route, the
//! end and the fence that the flight program flies, and refuses what that refuses.
//!
//! The items are written here in three ways, as a plan of QGroundControl, as its file of waypoints
//! and as the messages that it sends of both, so that nothing of the reader's is on the other side.

use autopilot::Settings;
use controller::{Knot, Run, Table};
use hil_sim::describe::mission::{self, Defaults, Local, LocalEdge};
use hil_sim::describe::path::RouteSpec;
use hil_sim::describe::scenario::{Law, Scenario};
use link::MavMessage;
use link::dialect::*;
use serde_json::{Value, json};

use crate::mission::{KEPT, Lossy, station, upload};
use crate::station::Station;

const HOME: [f64; 3] = [53.527, -113.529, 668.0];
const RELATIVE: u8 = 3;
const AMSL: u8 = 0;

const WAYPOINT: u16 = 16;
const LOITER_UNLIMITED: u16 = 17;
const LOITER_TIME: u16 = 19;
const RETURN: u16 = 20;
const LAND: u16 = 21;
const TAKE_OFF: u16 = 22;
const SPLINE: u16 = 82;
const DELAY: u16 = 93;
const JUMP: u16 = 177;
const SPEED: u16 = 178;
const TRIGGER: u16 = 206;

/// An item as a pilot draws it. A jump's first parameter is the item's index here.
#[derive(Clone, Copy)]
struct Drawn {
    command: u16,
    frame: u8,
    params: [f64; 4],
    /// Latitude and longitude, degrees, and height, m.
    place: [f64; 3],
}

fn at(command: u16, params: [f64; 4], [north, east, up]: [f64; 3]) -> Drawn {
    // Some metres, to whole steps: the plan says what it says.
    let degrees = |metres: f64, per: f64| (metres / per * 1e7).round() / 1e7;
    let place = [HOME[0] + degrees(north, 111_297.0), HOME[1] + degrees(east, 66_300.0), up];
    Drawn { command, frame: RELATIVE, params, place }
}

/// Above the sea.
fn amsl(item: Drawn) -> Drawn {
    let [latitude, longitude, up] = item.place;
    Drawn { frame: AMSL, place: [latitude, longitude, up + HOME[2]], ..item }
}

fn waypoint(place: [f64; 3]) -> Drawn {
    at(WAYPOINT, [0.0, 0.0, 0.0, f64::NAN], place)
}

/// What has no place.
fn order(command: u16, param1: f64, param2: f64) -> Drawn {
    Drawn { command, frame: 2, params: [param1, param2, -1.0, 0.0], place: [0.0; 3] }
}

/// A mission, its polygons and its circles, each to stay in or to keep out of; in degrees and m.
#[derive(Clone, Default)]
struct Case {
    items: Vec<Drawn>,
    polygons: Vec<(bool, Vec<[f64; 2]>)>,
    circles: Vec<(bool, [f64; 2], f64)>,
}

impl Case {
    fn of(items: impl IntoIterator<Item = Drawn>) -> Self {
        Self { items: items.into_iter().collect(), ..Self::default() }
    }

    fn plan(&self) -> String {
        let number = |number: f64| if number.is_nan() { Value::Null } else { json!(number) };
        let item = |(index, item): (usize, &Drawn)| {
            let mut params = item.params.to_vec();
            params.extend(item.place);
            if item.command == JUMP {
                params[0] += 1.0;
            }
            let params: Vec<Value> = params.into_iter().map(number).collect();
            json!({ "type": "SimpleItem", "command": item.command, "frame": item.frame, "doJumpId": index + 1,
                "autoContinue": true, "params": params })
        };
        let items: Vec<Value> = self.items.iter().enumerate().map(item).collect();
        let polygons: Vec<Value> = self
            .polygons
            .iter()
            .map(|(inside, corners)| json!({ "polygon": corners, "inclusion": inside, "version": 1 }))
            .collect();
        let circles: Vec<Value> = self
            .circles
            .iter()
            .map(|(inside, center, radius)| {
                json!({ "circle": { "center": center, "radius": radius }, "inclusion": inside, "version": 1 })
            })
            .collect();
        json!({ "fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
            "mission": { "version": 2, "plannedHomePosition": HOME, "cruiseSpeed": 15, "hoverSpeed": 5, "items": items },
            "geoFence": { "version": 2, "polygons": polygons, "circles": circles },
            "rallyPoints": { "version": 2, "points": [] } })
        .to_string()
    }

    fn waypoints(&self) -> String {
        let [latitude, longitude, altitude] = HOME;
        let mut text = format!("QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t{latitude}\t{longitude}\t{altitude}\t1\n");
        for (index, item) in self.items.iter().enumerate() {
            let Drawn { command, frame, params: [p1, p2, p3, p4], place: [latitude, longitude, up] } = item;
            let p1 = if *command == JUMP { p1 + 1.0 } else { *p1 };
            let index = index + 1;
            text += &format!(
                "{index}\t0\t{frame}\t{command}\t{p1}\t{p2}\t{p3}\t{p4}\t{latitude}\t{longitude}\t{up}\t1\n"
            );
        }
        text
    }

    /// As a station sends them.
    fn messages(&self) -> [Vec<MISSION_ITEM_INT_DATA>; 2] {
        let steps = |degrees: f64| (degrees * 1e7).round() as i32;
        let mission = self.items.iter().map(|item| {
            let [param1, param2, param3, param4] = item.params.map(|param| param as f32);
            let [latitude, longitude, z] = item.place;
            let (command, frame) = (item.command, item.frame);
            let (x, y, z) = (steps(latitude), steps(longitude), z as f32);
            let base = MISSION_ITEM_INT_DATA::DEFAULT;
            MISSION_ITEM_INT_DATA { command, frame, param1, param2, param3, param4, x, y, z, ..base }
        });
        let fence = |command: u16, param1: f64, [latitude, longitude]: [f64; 2]| MISSION_ITEM_INT_DATA {
            command,
            param1: param1 as f32,
            x: steps(latitude),
            y: steps(longitude),
            ..MISSION_ITEM_INT_DATA::DEFAULT
        };
        let corners = self.polygons.iter().flat_map(|(inside, corners)| {
            let command = if *inside { 5001 } else { 5002 };
            corners.iter().map(move |&corner| fence(command, corners.len() as f64, corner))
        });
        let circles = self.circles.iter().map(|&(inside, center, radius)| {
            let command = if inside { 5003 } else { 5004 };
            fence(command, radius, center)
        });
        [mission.collect(), corners.chain(circles).collect()]
    }
}

/// Sends all up to a vehicle that knows its home, and says what it says of the mission.
fn sent(case: &Case) -> (Station, u8, Vec<String>) {
    let mut station = station();
    let [latitude, longitude] = [HOME[0], HOME[1]].map(|degrees| (degrees * 1e7).round() as i32);
    station.say(&MavMessage::SET_GPS_GLOBAL_ORIGIN(SET_GPS_GLOBAL_ORIGIN_DATA {
        latitude,
        longitude,
        altitude: (HOME[2] * 1e3) as i32,
        ..SET_GPS_GLOBAL_ORIGIN_DATA::DEFAULT
    }));
    let [mission, fence] = case.messages();
    if !fence.is_empty() {
        let kind = MavMissionType::MAV_MISSION_TYPE_FENCE;
        assert_eq!(upload(&mut station, &fence, kind, &mut Lossy::none()), (KEPT as u8, vec![]));
    }
    let kind = MavMissionType::MAV_MISSION_TYPE_MISSION;
    let (result, said) = upload(&mut station, &mission, kind, &mut Lossy::none());
    (station, result, said)
}

/// What `hil-sim route` writes of a file, read as `run` and `check` read it.
fn routed(text: &str) -> Result<(Local, RouteSpec, Scenario), String> {
    let read = mission::read("file", text).map_err(|error| error.to_string())?;
    let local = read.local(None, None, &Defaults::default()).map_err(|error| error.to_string())?;
    let written = mission::toml(&local, "file", 10.0);
    let scenario = Scenario::parse("route.toml", &written).map_err(|error| format!("{error}\n{written}"))?;
    let Law::Follow { path, .. } = &scenario.controller.law else { panic!("it follows") };
    let route = path.route().expect("a route").clone();
    Ok((local, route, scenario))
}

/// By how much two places may differ, m: half of the scenario's last digit, 0.1 mm, and a step of the
/// f32 in which the flight program lays, 0.03 mm within 256 to 512 m.
const OFF: f64 = 0.5e-4 + 0.03e-3;
/// And yaws, rad, and speeds, m/s: the scenario has 0.1 mrad and 0.1 mm/s, and what follows from the
/// direction of knots 0.2 m apart, or their bend, turns by 2 OFF in that.
const TURN: f64 = 0.5e-4 + 2.0 * OFF / 0.2;

/// Checks one number against another.
fn close(what: &str, found: f64, wanted: f32, most: f64) {
    let off = (found - f64::from(wanted)).abs();
    let is_same = found.is_infinite() && f64::from(wanted) == found;
    assert!(is_same || off <= most, "{what}: {found} where {wanted} is flown");
}

fn compare(what: &str, case: &Case, text: &str) {
    let (station, result, said) = sent(case);
    assert_eq!(result, KEPT as u8, "{what}: {said:?}");
    let flown = station.autopilot.mission();
    let (local, route, scenario) = routed(text).unwrap_or_else(|error| panic!("{what}: {error}"));

    let (found, wanted) = (route.table(), flown.table().expect("it is laid"));
    assert_eq!(found.runs().len(), wanted.runs().len(), "{what}");
    for (found, wanted) in found.runs().iter().zip(wanted.runs()) {
        let Run { first, knots, is_closed, dwell } = *wanted;
        assert_eq!((found.first, found.knots, found.is_closed), (first, knots, is_closed), "{what}");
        close(what, found.dwell, dwell, OFF);
    }
    let count: usize = wanted.runs().iter().map(|run| run.knots).sum();
    assert_eq!(found.knots().len(), count, "{what}");
    for (index, (found, wanted)) in found.knots().iter().zip(wanted.knots()).enumerate() {
        let what = format!("{what}, knot {index}");
        let Knot { point, speed, yaw, .. } = *wanted;
        found.point.iter().zip(point).for_each(|(found, wanted)| close(&what, *found, wanted, OFF));
        found.speed.iter().zip(speed).for_each(|(found, wanted)| close(&what, *found, wanted, TURN));
        close(&what, found.yaw, yaw, TURN);
    }
    let course = flown.course();
    assert_eq!(
        (route.end(), route.lands(), route.is_closed()),
        (course.end, course.lands, course.is_closed),
        "{what}"
    );

    let settings = Settings::default();
    let regions: Vec<_> = flown.regions(&settings).collect();
    assert_eq!(local.regions.len(), regions.len(), "{what}");
    for ((is_inside, edge), wanted) in local.regions.iter().zip(&regions) {
        assert_eq!(*is_inside, wanted.is_inside, "{what}");
        match (edge, &wanted.edge) {
            (LocalEdge::Polygon(found), controller::FenceEdge::Polygon(wanted)) => {
                assert_eq!(found.len(), wanted.len(), "{what}");
                let pairs = found.as_flattened().iter().zip(wanted.as_flattened());
                pairs.for_each(|(found, wanted)| close(what, *found, *wanted, OFF));
            }
            (LocalEdge::Circle(center, radius), controller::FenceEdge::Circle(place, size)) => {
                center.iter().zip(place).for_each(|(found, wanted)| close(what, *found, *wanted, OFF));
                close(what, *radius, *size, OFF);
            }
            other => panic!("{what}: {other:?}"),
        }
    }
    let fenced = scenario.fence.map_or(0, |fence| fence.inside.len() + fence.outside.len());
    assert_eq!(fenced, regions.len(), "{what}");
}

#[test]
fn a_file_is_the_route_that_is_flown_when_it_is_sent() {
    let near = [[0.0, 0.0, 10.0], [40.0, 0.0, 10.0], [40.0, 30.0, 12.0], [0.0, 30.0, 15.0]];
    let take_off = at(TAKE_OFF, [0.0, 0.0, 0.0, f64::NAN], near[0]);
    let with = |item: Drawn, index: usize, value: f64| {
        let mut params = item.params;
        params[index] = value;
        Drawn { params, ..item }
    };
    let line = near.map(waypoint);
    let round = |last: Drawn| [line[0], line[1], line[2], line[3], last];
    let corner = |[n, e]: [f64; 2]| {
        let Drawn { place: [latitude, longitude, _], .. } = waypoint([n, e, 0.0]);
        [latitude, longitude]
    };
    let cases = [
        ("corners", Case::of(line)),
        ("radius", Case::of([line[0], with(line[1], 1, 7.5), with(line[2], 1, 0.5), line[3]])),
        ("above the sea", Case::of(line.map(amsl))),
        ("return", Case::of([take_off, line[1], line[2], order(RETURN, 0.0, 0.0)])),
        ("land", Case::of([take_off, line[1], line[2], at(LAND, [0.0; 4], [5.0, 60.0, 0.0])])),
        ("land above the sea", Case::of([take_off, line[1], line[2], amsl(at(LAND, [0.0; 4], [250.0, 60.0, 0.0]))])),
        ("land here", Case::of([take_off, line[1], line[2], Drawn { frame: RELATIVE, ..order(LAND, 0.0, 0.0) }])),
        ("jump without end", Case::of(round(order(JUMP, 0.0, -1.0)))),
        ("jump twice", Case::of(round(order(JUMP, 0.0, 2.0)))),
        ("jump no times", Case::of([line[0], order(JUMP, 0.0, 0.0), line[1], line[2]])),
        ("jump with rests", Case::of([with(line[0], 0, 2.0), line[1], line[2], order(JUMP, 0.0, -1.0)])),
        ("jump behind a speed", Case::of([order(SPEED, 1.0, 3.0), line[0], line[1], line[2], order(JUMP, 1.0, 1.0)])),
        (
            "speeds",
            Case::of([
                line[0],
                order(SPEED, 1.0, 3.5),
                line[1],
                order(SPEED, 1.0, -1.0),
                line[2],
                order(SPEED, 1.0, -2.0),
                line[3],
            ]),
        ),
        (
            "rests",
            Case::of([
                with(line[0], 0, 1.5),
                at(LOITER_TIME, [4.0, 0.0, 0.0, 1.0], near[1]),
                order(DELAY, 2.0, -1.0),
                at(LOITER_UNLIMITED, [0.0, 0.0, 0.0, 45.0], near[2]),
                line[3],
                order(DELAY, 3.0, -1.0),
            ]),
        ),
        ("some headings", Case::of([take_off, with(line[1], 3, 90.0), line[2], with(line[3], 3, -120.0)])),
        (
            "all headings",
            Case::of([10.0, 90.0, 200.0, 360.0].into_iter().zip(line).map(|(yaw, item)| with(item, 3, yaw))),
        ),
        ("no headings", Case::of(line.map(|item| with(item, 3, 0.0)))),
        (
            "smooth",
            Case::of([line[0], at(SPLINE, [0.0; 4], near[1]), at(SPLINE, [2.0, 0.0, 0.0, 0.0], near[2]), line[3]]),
        ),
        ("a survey", Case::of([take_off, order(TRIGGER, 25.0, 0.0), line[1], line[2], order(TRIGGER, 0.0, 0.0)])),
    ];
    for (what, case) in &cases {
        compare(&format!("{what}, plan"), case, &case.plan());
        compare(&format!("{what}, waypoints"), case, &case.waypoints());
    }
    let fenced = Case {
        polygons: vec![
            (true, [[-50.0, -50.0], [90.0, -50.0], [90.0, 80.0], [-50.0, 80.0]].map(corner).to_vec()),
            (false, [[10.0, 8.0], [25.0, 8.0], [18.0, 22.0]].map(corner).to_vec()),
        ],
        circles: vec![(true, corner([10.0, 10.0]), 150.0), (false, corner([70.0, 40.0]), 12.5)],
        ..Case::of(line)
    };
    compare("fences", &fenced, &fenced.plan());
}

#[test]
fn a_file_is_refused_as_it_is_when_it_is_sent() {
    let line = [[0.0, 0.0, 10.0], [40.0, 0.0, 10.0], [40.0, 30.0, 12.0]].map(waypoint);
    let with = |at: usize, item: Drawn| {
        let mut items = line.to_vec();
        items.insert(at, item);
        Case::of(items)
    };
    let changed = |index: usize, value: f64| {
        let mut params = line[1].params;
        params[index] = value;
        with(1, Drawn { params, ..line[1] })
    };
    let cases = [
        changed(0, -1.0),
        changed(1, 2000.0),
        with(1, order(201, 0.0, 0.0)),
        with(3, at(18, [2.0, 0.0, 5.0, 0.0], [40.0, 40.0, 12.0])),
        with(1, Drawn { frame: 7, ..line[1] }),
        with(1, order(RETURN, 0.0, 0.0)),
        with(3, order(JUMP, 1.0, 3.0)),
        with(3, order(SPEED, 1.0, 200.0)),
        with(3, order(DELAY, -1.0, 0.0)),
        with(3, waypoint([39.0, 0.2, 12.0])),
        with(3, waypoint([40.0, 30.0, 2e5])),
        with(3, waypoint([2e5, 0.0, 12.0])),
        with(2, waypoint([20.0, 0.0, 10.0])),
        Case::of([line[0]]),
    ];
    for case in cases {
        let (_, result, said) = sent(&case);
        assert_ne!(result, KEPT as u8);
        let [said] = &said[..] else { panic!("{said:?}") };
        // Files, and stations' lists, count from 1: the home is 0.
        let wanted = match said.strip_prefix("item ").and_then(|text| text.split_once(": ")) {
            Some((number, text)) => format!("item {}: {text}", number.parse::<u32>().unwrap() + 1),
            None => said.clone(),
        };
        for text in [case.plan(), case.waypoints()] {
            let error = routed(&text).err().unwrap_or_else(|| panic!("{said}: {text}"));
            assert!(error.starts_with(&wanted), "{error}, where {wanted} is said of what is sent");
        }
    }
}

/// What a vehicle refuses by parameters of its own is a word here, not an end.
#[test]
fn a_fence_that_a_vehicle_would_refuse_is_told() {
    let items = [[0.0, 0.0, 10.0], [40.0, 0.0, 10.0], [40.0, 30.0, 12.0]].map(waypoint);
    let Drawn { place: [latitude, longitude, _], .. } = items[1];
    let case = Case { circles: vec![(false, [latitude, longitude], 3.0)], ..Case::of(items) };
    let (_, _, said) = sent(&case);
    assert_eq!(said, ["item 1: the load too near the fence"]);
    let (local, ..) = routed(&case.plan()).unwrap();
    let word = "item 2: the load too near the fence: a vehicle refuses the mission with FNC_MARGIN 1 and VEH_ROD 2";
    assert!(local.notes.iter().any(|note| note == word), "{:?}", local.notes);
}
