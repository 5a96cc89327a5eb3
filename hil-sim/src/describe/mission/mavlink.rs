//! Missions as MAVLink has them: QGroundControl's plans, and files of waypoints.

use serde_json::Value;

use super::{Edge, Height, Home, Item, Mission, MissionError, Region, Spot};

/// An item of MAVLink's mission protocol.
struct Command {
    command: u64,
    frame: u64,
    params: [f64; 7],
}

// MAV_CMD.
const WAYPOINT: u64 = 16;
const LOITER_UNLIMITED: u64 = 17;
const LOITER_TIME: u64 = 19;
const RETURN_TO_LAUNCH: u64 = 20;
const LAND: u64 = 21;
const TAKE_OFF: u64 = 22;
const SPLINE_WAYPOINT: u64 = 82;
const DELAY: u64 = 93;
/// The last of the commands that move the vehicle.
const LAST_NAVIGATION: u64 = 95;
const JUMP: u64 = 177;
const CHANGE_SPEED: u64 = 178;

/// Takes a mission's items in, one after the other.
#[derive(Default)]
struct Reader {
    mission: Mission,
    /// As of the last change of speed.
    speed: Option<f64>,
}

impl Reader {
    fn take(&mut self, number: usize, command: &Command) -> Result<(), MissionError> {
        let Command { command, frame, params: [first, second, _, heading, x, y, z] } = *command;
        let error = |message: String| Err(MissionError(format!("item {number}: {message}")));
        let mut item = match command {
            WAYPOINT | LOITER_UNLIMITED | LOITER_TIME | LAND | TAKE_OFF | SPLINE_WAYPOINT => {
                let height = match frame {
                    0 | 5 => Height::Amsl(z),
                    3 | 6 => Height::Relative(z),
                    1 => Height::Relative(-z),
                    10 | 11 => Height::Terrain(z),
                    other => return error(format!("MAV_FRAME {other} is not known: 0, 1, 3, 5, 6, 10 and 11 are")),
                };
                if !z.is_finite() && command != LAND {
                    return error("it has no height".to_owned());
                }
                let is_placed = x.is_finite() && y.is_finite() && (x, y) != (0.0, 0.0);
                let spot = match (is_placed, frame, self.mission.items.is_empty()) {
                    (_, 1, _) => Spot::Local([x, y]),
                    (true, ..) => Spot::Earth([x, y]),
                    (false, _, true) => Spot::Home,
                    (false, _, false) => Spot::Same,
                };
                Item::at(spot, height)
            }
            RETURN_TO_LAUNCH => Item::at(Spot::Home, Height::Same),
            DELAY => Item { stop: Some(first.max(0.0)), ..Item::at(Spot::Same, Height::Same) },
            CHANGE_SPEED => {
                if second > 0.0 {
                    self.speed = Some(second);
                    if let Some(last) = self.mission.items.last_mut() {
                        last.speed = Some(second);
                    }
                }
                return Ok(());
            }
            JUMP => return error("DO_JUMP: a route has no jumps; laps are told by `end`".to_owned()),
            other if other <= LAST_NAVIGATION => {
                return error(format!(
                    "MAV_CMD {other} moves the vehicle in a way that no route can: 16, 17, 19, 20, 21, 22, 82 and 93 can be"
                ));
            }
            other => {
                self.mission
                    .notes
                    .push(format!("item {number}: MAV_CMD {other} does not move the payload: passed over"));
                return Ok(());
            }
        };
        match command {
            WAYPOINT | SPLINE_WAYPOINT if first > 0.0 => item.stop = Some(first),
            LOITER_TIME => item.stop = Some(first.max(0.0)),
            LOITER_UNLIMITED => item.stop = Some(f64::INFINITY),
            // The vehicle comes down by itself: the route ends above.
            LAND => {
                item.height = Height::Same;
                self.mission.notes.push(format!("item {number}: the route ends above the place to land"));
            }
            _ => {}
        }
        item.is_smooth = command == SPLINE_WAYPOINT;
        // Of take-off and landing it is the vehicle's, not the route's.
        let has_heading = matches!(command, WAYPOINT | LOITER_TIME | LOITER_UNLIMITED | SPLINE_WAYPOINT);
        item.heading = Some(heading).filter(|heading| has_heading && heading.is_finite() && *heading != 0.0);
        item.speed = self.speed;
        self.mission.items.push(item);
        Ok(())
    }
}

/// A file of waypoints, `QGC WPL 110`: twelve fields a line. Its first is the home.
pub fn waypoints(text: &str) -> Result<Mission, MissionError> {
    let mut reader = Reader::default();
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let header = lines.next().map_or("", |(_, line)| line.trim());
    if header != "QGC WPL 110" {
        return Err(MissionError(format!("\"{header}\" where QGC WPL 110 is known")));
    }
    for (number, line) in lines {
        let error = |message: String| MissionError(format!("line {}: {message}", number + 1));
        let fields: Vec<f64> = line
            .split_whitespace()
            .map(|field| field.parse().map_err(|_| error(format!("\"{field}\" is no number"))))
            .collect::<Result<_, _>>()?;
        let count = fields.len();
        let fields: [f64; 12] =
            fields.try_into().map_err(|_| error(format!("{count} fields where a waypoint has 12")))?;
        let [index, _, frame, command, p1, p2, p3, p4, latitude, longitude, altitude, _] = fields;
        let params = [p1, p2, p3, p4, latitude, longitude, altitude];
        let command = Command { command: command as u64, frame: frame as u64, params };
        if index == 0.0 && command.command == WAYPOINT && command.frame == 0 {
            if (latitude, longitude) != (0.0, 0.0) {
                reader.mission.home = Some(Home { latitude, longitude, altitude });
            }
            continue;
        }
        reader.take(index as usize, &command)?;
    }
    Ok(reader.mission)
}

/// A plan of QGroundControl.
pub fn plan(value: &Value) -> Result<Mission, MissionError> {
    let mission = value.get("mission").ok_or_else(|| MissionError("the plan has no mission".to_owned()))?;
    let mut reader = Reader::default();
    if let Some([latitude, longitude, altitude]) = numbers(mission.get("plannedHomePosition")) {
        reader.mission.home = Some(Home { latitude, longitude, altitude });
    }
    reader.mission.speed = mission.get("hoverSpeed").and_then(Value::as_f64).filter(|speed| *speed > 0.0);
    take_items(&mut reader, mission.get("items"), &mut 0)?;
    fences(value.get("geoFence"), &mut reader.mission)?;
    Ok(reader.mission)
}

fn take_items(reader: &mut Reader, items: Option<&Value>, number: &mut usize) -> Result<(), MissionError> {
    for item in items.and_then(Value::as_array).into_iter().flatten() {
        let error = |number: usize, message: &str| MissionError(format!("item {number}: {message}"));
        match item.get("type").and_then(Value::as_str) {
            Some("SimpleItem") => {
                *number += 1;
                let whole = |name: &str| item.get(name).and_then(Value::as_u64);
                let (Some(command), Some(frame)) = (whole("command"), whole("frame")) else {
                    return Err(error(*number, "it has no command or no frame"));
                };
                let mut params = [f64::NAN; 7];
                let given =
                    item.get("params").and_then(Value::as_array).ok_or_else(|| error(*number, "no params"))?;
                if given.len() != params.len() {
                    return Err(error(*number, &format!("{} params where an item has 7", given.len())));
                }
                for (param, given) in params.iter_mut().zip(given) {
                    // null is a number that is not given.
                    *param = given.as_f64().unwrap_or(f64::NAN);
                }
                reader.take(*number, &Command { command, frame, params })?;
            }
            Some("ComplexItem") => {
                // A survey holds the items that it is flown by.
                let inner = item.get("TransectStyleComplexItem").and_then(|style| style.get("Items"));
                let inner = inner.or_else(|| item.get("Items"));
                let kind = item.get("complexItemType").and_then(Value::as_str).unwrap_or("a complex item");
                if inner.is_none() {
                    return Err(error(*number + 1, &format!("{kind} holds no items to fly by")));
                }
                take_items(reader, inner, number)?;
            }
            other => {
                return Err(error(*number + 1, &format!("its type is {other:?}: SimpleItem or ComplexItem")));
            }
        }
    }
    Ok(())
}

fn fences(fence: Option<&Value>, mission: &mut Mission) -> Result<(), MissionError> {
    let list = |name: &str| fence.and_then(|fence| fence.get(name)).and_then(Value::as_array).into_iter().flatten();
    let is_inside = |shape: &Value| shape.get("inclusion").and_then(Value::as_bool).unwrap_or(true);
    let unclear = || MissionError("geoFence: a shape that is no polygon of corners and no circle".to_owned());
    for shape in list("polygons") {
        let corners = shape.get("polygon").and_then(Value::as_array).ok_or_else(unclear)?;
        let corner = |corner: &Value| numbers(Some(corner)).map(Spot::Earth).ok_or_else(unclear);
        let edge = Edge::Polygon(corners.iter().map(corner).collect::<Result<_, _>>()?);
        mission.regions.push(Region { is_inside: is_inside(shape), edge });
    }
    for shape in list("circles") {
        let circle = shape.get("circle").ok_or_else(unclear)?;
        let center = numbers(circle.get("center")).map(Spot::Earth).ok_or_else(unclear)?;
        let radius = circle.get("radius").and_then(Value::as_f64).ok_or_else(unclear)?;
        mission.regions.push(Region { is_inside: is_inside(shape), edge: Edge::Circle(center, radius) });
    }
    Ok(())
}

fn numbers<const N: usize>(value: Option<&Value>) -> Option<[f64; N]> {
    let numbers: Vec<f64> = value?.as_array()?.iter().map(Value::as_f64).collect::<Option<_>>()?;
    numbers.try_into().ok()
}
