//! Missions as MAVLink has them, QGroundControl's plans and files of waypoints: read into the items
//! that a ground station sends of them, and these as the flight program reads them.

use autopilot::{Course, DEGREES, Fence, ITEMS, Item, Kind, METRES, Plan, Refusal, Setting, Settings};
use controller::{FenceEdge, Knot, Route, RouteTable, Run, Waypoint};
use link::dialect::{MavCmd, MavFrame, MavMissionResult};
use serde_json::Value;

use super::{Defaults, Home, Local, LocalEdge, MissionError, NO_HOME, NO_TERRAIN, placed};

/// Frames of heights above the ground, which no vehicle takes.
const TERRAIN: [u8; 2] = [10, 11];
/// Corners and circles of a fence, at most.
const CORNERS: usize = 4096;
/// Knots of a route, at most.
const MOST_KNOTS: usize = 4_000_000;

/// A mission and its fence as they are sent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Items {
    /// The home, where the file says it.
    pub home: Option<Home>,
    /// In the order flown.
    pub mission: Vec<Item>,
    /// What the file calls each of those.
    numbers: Vec<u64>,
    /// One after the other.
    pub fence: Vec<Item>,
    /// What the file calls each of those.
    shapes: Vec<String>,
    /// What is not sent.
    notes: Vec<String>,
}

/// An item's numbers as files have them.
struct Line {
    command: u64,
    frame: u64,
    params: [f64; 7],
}

impl Items {
    /// Takes the next item in, which the file calls `number`.
    fn take(&mut self, number: u64, line: &Line) -> Result<(), MissionError> {
        let item = line.item().map_err(|error| MissionError(format!("item {number}: {error}")))?;
        self.mission.push(item);
        self.numbers.push(number);
        Ok(())
    }

    fn take_fence(&mut self, command: MavCmd, param1: f64, [latitude, longitude]: [f64; 2], name: String) -> Done {
        let frame = MavFrame::MAV_FRAME_GLOBAL as u64;
        let params = [param1, 0.0, 0.0, 0.0, latitude, longitude, 0.0];
        let item = Line { command: command as u64, frame, params }.item();
        self.fence.push(item.map_err(|error| MissionError(format!("{name}: {error}")))?);
        self.shapes.push(name);
        Ok(())
    }

    /// Has jumps lead to items by their order, as they are sent, instead of by what the file calls
    /// them.
    fn resolve_jumps(&mut self, names: &[u64]) -> Done {
        for (item, number) in self.mission.iter_mut().zip(&self.numbers) {
            if item.command == MavCmd::MAV_CMD_DO_JUMP as u16 {
                let [to, ..] = &mut item.params;
                let found = names.iter().position(|&name| name as f32 == *to);
                let found =
                    found.ok_or_else(|| MissionError(format!("item {number}: jumps to {to}, which is none")))?;
                *to = found as f32;
            }
        }
        Ok(())
    }

    /// The mission in N, as [`Mission::local`](super::Mission::local).
    pub(super) fn local(&self, home: Option<Home>, terrain: Option<f64>, defaults: &Defaults) -> Read<Local> {
        let home = home.or(self.home).map(placed).transpose()?;
        let mut notes = self.notes.clone();
        let mission = self.about_sea(terrain, &mut notes)?;
        let mut settings = Settings::default();
        for (setting, value) in
            [(Setting::MISSION_SPEED, defaults.speed), (Setting::MISSION_CORNER, defaults.corner_m)]
        {
            settings.set(setting, value as f32).map_err(MissionError::new)?;
        }
        let mut waypoints =
            vec![Waypoint { point: [0.0; 3], corner: None, speed: 0.0, yaw: None, stop: None }; mission.len() + 1];
        let mut numbers = vec![0; waypoints.len()];
        let named = |refusal: Refusal| self.named(&refusal);
        let plan = Plan::read(&mission, home.as_ref(), &settings, &mut waypoints, &mut numbers).map_err(named)?;
        let mut fence = Box::new(Fence::<CORNERS>::new());
        fence.lay(&self.fence, home.as_ref()).map_err(named)?;
        let (table, marks) = laid(&plan).map_err(named)?;
        let mut route = Route::new(table).map_err(MissionError::new)?;

        // What depends on the vehicle is said, and not refused here.
        for (what, count) in [("mission", mission.len()), ("fence", self.fence.len())] {
            if count > ITEMS {
                notes.push(format!("{what}: {count} items: a vehicle takes at most {ITEMS}"));
            }
        }
        if let Err(refusal) = fence.allows(&mut route, &marks, &settings) {
            let margin = settings.get(Setting::FENCE_MARGIN);
            let rod = settings.rig().get(rig::parameter!("VEH_ROD"));
            let why = self.named(&refusal);
            notes.push(format!("{why}: a vehicle refuses the mission with FNC_MARGIN {margin} and VEH_ROD {rod}"));
        }
        notes.extend(self.mission.iter().zip(&self.numbers).filter(|(item, _)| item.is_for_camera()).map(
            |(item, number)| format!("item {number}: command {} does not move the load: passed over", item.command),
        ));
        let mut course = *plan.course();
        if defaults.is_closed && !course.is_closed {
            if course != Course::default() {
                return Err(MissionError("--closed, but the mission says itself how it ends".to_owned()));
            }
            course.is_closed = true;
        }
        let waypoints = plan.waypoints().iter().map(in_f64).collect();
        let regions = fence.regions(&settings).map(|region| (region.is_inside, edge(&region.edge))).collect();
        Ok(Local { home, waypoints, course, regions, notes })
    }

    /// The mission with heights above the terrain counted from the sea.
    fn about_sea(&self, terrain: Option<f64>, notes: &mut Vec<String>) -> Read<Vec<Item>> {
        let mut mission = self.mission.clone();
        for (item, number) in mission.iter_mut().zip(&self.numbers).filter(|(item, _)| TERRAIN.contains(&item.frame))
        {
            let ground = terrain.ok_or_else(|| MissionError(format!("item {number}: {NO_TERRAIN}")))?;
            item.frame = MavFrame::MAV_FRAME_GLOBAL as u8;
            item.z = (f64::from(item.z) + ground) as f32;
            notes.push(format!("item {number}: its height is above the terrain: a vehicle refuses the mission"));
        }
        Ok(mission)
    }

    /// A refusal by what the file calls the item, and what could be done.
    fn named(&self, refusal: &Refusal) -> MissionError {
        let of = match refusal.item {
            Some((Kind::Mission, index)) => {
                format!("item {}: ", self.numbers.get(usize::from(index)).copied().unwrap_or_default())
            }
            Some((Kind::Fence, index)) => {
                format!("{}: ", self.shapes.get(usize::from(index)).map_or("fence", String::as_str))
            }
            None => String::new(),
        };
        let text = &refusal.text;
        MissionError(match refusal.result {
            MavMissionResult::MAV_MISSION_ERROR => format!("{of}{NO_HOME}"),
            MavMissionResult::MAV_MISSION_UNSUPPORTED => {
                let known = Item::COMMANDS.map(|command| command.to_string()).join(", ");
                format!("{of}{text}: {known} are, and a camera's are passed over")
            }
            MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME => {
                let known = Item::FRAMES.map(|frame| frame.to_string()).join(", ");
                format!("{of}{text}: {known} are")
            }
            _ => format!("{of}{text}"),
        })
    }
}

type Read<T> = Result<T, MissionError>;
type Done = Read<()>;
type Table = RouteTable<Vec<Knot<f32>>, Vec<Run<f32>>>;

/// The route's table, and where it passes its items.
fn laid(plan: &Plan<'_>) -> Result<(Table, Vec<autopilot::Mark>), Refusal> {
    let mut runs = vec![Run::default(); plan.waypoints().len() + 1];
    let mut most = 32 * runs.len() + 256;
    loop {
        let (mut knots, mut marks) = (vec![Knot::default(); most], Vec::new());
        match plan.build(&mut knots, &mut runs, |mark| marks.push(mark)) {
            Ok(built) => {
                knots.truncate(built.knots);
                runs.truncate(built.runs);
                return Ok((RouteTable { knots, runs }, marks));
            }
            Err(Refusal { result: MavMissionResult::MAV_MISSION_NO_SPACE, .. }) if most < MOST_KNOTS => most *= 4,
            Err(refusal) => return Err(refusal),
        }
    }
}

fn in_f64(&Waypoint { point, corner, speed, yaw, stop }: &Waypoint<f32>) -> Waypoint<f64> {
    Waypoint {
        point: point.map(f64::from),
        corner: corner.map(f64::from),
        speed: speed.into(),
        yaw: yaw.map(f64::from),
        stop: stop.map(f64::from),
    }
}

fn edge(edge: &FenceEdge<'_, f32>) -> LocalEdge {
    match *edge {
        FenceEdge::Polygon(corners) => {
            LocalEdge::Polygon(corners.iter().map(|corner| corner.map(f64::from)).collect())
        }
        FenceEdge::Circle(center, radius) => LocalEdge::Circle(center.map(f64::from), radius.into()),
    }
}

impl Line {
    /// As it is sent: places in whole steps, and none by the largest number.
    fn item(&self) -> Result<Item, String> {
        let Self { command, frame, params: [p1, p2, p3, p4, x, y, z] } = *self;
        let command = u16::try_from(command).map_err(|_| format!("{command} is no MAV_CMD"))?;
        let frame = u8::try_from(frame).map_err(|_| format!("{frame} is no MAV_FRAME"))?;
        let step = if frame == MavFrame::MAV_FRAME_LOCAL_NED as u8 { METRES } else { DEGREES };
        let steps = |name: &str, value: f64| match (value / step).round() {
            none if none.is_nan() => Ok(i32::MAX),
            steps if steps.abs() < f64::from(i32::MAX) => Ok(steps as i32),
            _ => Err(format!("{name} {value} is outside ±{:.0}", f64::from(i32::MAX) * step)),
        };
        let [x, y] = if step == METRES {
            [steps("x", x)?, steps("y", y)?]
        } else {
            [steps("latitude", x)?, steps("longitude", y)?]
        };
        let params = [p1, p2, p3, p4].map(|param| param as f32);
        Ok(Item { command, frame, current: 0, autocontinue: 1, params, x, y, z: z as f32 })
    }
}

/// A file of waypoints, `QGC WPL 110`: twelve fields a line. Its first is the home, which is not
/// sent.
pub fn waypoints(text: &str) -> Read<Items> {
    let mut items = Items::default();
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
        let whole = |name: &str, value: f64| {
            let is_whole = value.fract() == 0.0 && (0.0..=f64::from(u16::MAX)).contains(&value);
            if is_whole { Ok(value as u64) } else { Err(error(format!("{name} {value} is not whole, 0 to 65535"))) }
        };
        let params = [p1, p2, p3, p4, latitude, longitude, altitude];
        let line = Line { command: whole("command", command)?, frame: whole("frame", frame)?, params };
        let index = whole("index", index)?;
        if index == 0 && line.command == MavCmd::MAV_CMD_NAV_WAYPOINT as u64 && line.frame == 0 {
            if (latitude, longitude) != (0.0, 0.0) {
                items.home = Some(Home { latitude, longitude, altitude });
            }
            continue;
        }
        items.take(index, &line)?;
    }
    let names = items.numbers.clone();
    items.resolve_jumps(&names)?;
    Ok(items)
}

/// A plan of QGroundControl.
pub fn plan(value: &Value) -> Read<Items> {
    let mission = table(value, "", "mission")?.ok_or_else(|| MissionError("the plan has no mission".to_owned()))?;
    let mut items = Items::default();
    if let Some(home) = list(mission, "mission", "plannedHomePosition")? {
        let home: [f64; 3] = numbers(home, "mission: plannedHomePosition")?;
        let [latitude, longitude, altitude] = home;
        // One that is not known stands there as null.
        items.home = home.iter().all(|number| number.is_finite()).then_some(Home { latitude, longitude, altitude });
    }
    let mut names = Vec::new();
    let given = list(mission, "mission", "items")?;
    take_items(&mut items, &mut names, given.ok_or_else(|| MissionError("mission: it has no items".to_owned()))?)?;
    items.resolve_jumps(&names)?;
    if let Some(fence) = table(value, "", "geoFence")? {
        fences(fence, &mut items)?;
    }
    // Stations reckon the time with it, and send it to no vehicle.
    if let Some(speed) = mission.get("hoverSpeed").and_then(Value::as_f64) {
        items
            .notes
            .push(format!("hoverSpeed {speed} m/s is not sent: a DO_CHANGE_SPEED, or MIS_SPEED, sets a speed"));
    }
    let rally = value.get("rallyPoints").and_then(|rally| rally.get("points")).and_then(Value::as_array);
    if rally.is_some_and(|points| !points.is_empty()) {
        items.notes.push("rally points: passed over; a vehicle refuses them".to_owned());
    }
    Ok(items)
}

/// Takes items in, with the `names` that jumps have for them.
fn take_items(items: &mut Items, names: &mut Vec<u64>, given: &[Value]) -> Done {
    for item in given {
        // Stations count the home as 0.
        let number = items.mission.len() as u64 + 1;
        let at = format!("item {number}");
        match item.get("type").and_then(Value::as_str) {
            Some("SimpleItem") => {
                let (command, frame) = (whole(item, &at, "command")?, whole(item, &at, "frame")?);
                let params = numbers(list(item, &at, "params")?.unwrap_or_default(), &format!("{at}: params"))?;
                names.push(if item.get("doJumpId").is_some() { whole(item, &at, "doJumpId")? } else { number });
                items.take(number, &Line { command, frame, params })?;
            }
            Some("ComplexItem") => {
                // A survey holds the items that it is flown by.
                let style = table(item, &at, "TransectStyleComplexItem")?.unwrap_or(item);
                let kind = item.get("complexItemType").and_then(Value::as_str).unwrap_or("a complex item");
                let inner = list(style, &at, "Items")?;
                let inner = inner.ok_or_else(|| MissionError(format!("{at}: {kind} holds no items to fly by")))?;
                take_items(items, names, inner)?;
            }
            _ => return Err(wrong(&at, "type", item, "SimpleItem or ComplexItem")),
        }
    }
    Ok(())
}

fn fences(fence: &Value, items: &mut Items) -> Done {
    let shapes = |name: &str| Ok(list(fence, "geoFence", name)?.unwrap_or_default().iter().zip(1..));
    let command = |shape: &Value, at: &str, inside: MavCmd, outside: MavCmd| match shape.get("inclusion") {
        None | Some(Value::Bool(true)) => Ok(inside),
        Some(Value::Bool(false)) => Ok(outside),
        Some(_) => Err(wrong(at, "inclusion", shape, "true or false")),
    };
    for (shape, number) in shapes("polygons")? {
        let at = format!("geoFence polygon {number}");
        let (inside, outside) =
            (MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, MavCmd::MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION);
        let command = command(shape, &at, inside, outside)?;
        let corners = list(shape, &at, "polygon")?.unwrap_or_default();
        if corners.len() < 3 {
            return Err(MissionError(format!("{at}: {} corners where a polygon has at least 3", corners.len())));
        }
        for (corner, index) in corners.iter().zip(1..) {
            let place = numbers(corner.as_array().map_or(&[][..], Vec::as_slice), &format!("{at}: corner {index}"))?;
            items.take_fence(command, corners.len() as f64, place, at.clone())?;
        }
    }
    for (shape, number) in shapes("circles")? {
        let at = format!("geoFence circle {number}");
        let (inside, outside) =
            (MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION);
        let command = command(shape, &at, inside, outside)?;
        let circle = table(shape, &at, "circle")?.unwrap_or(&Value::Null);
        let center = numbers(list(circle, &at, "center")?.unwrap_or_default(), &format!("{at}: center"))?;
        let radius = circle.get("radius").and_then(Value::as_f64);
        let radius = radius.ok_or_else(|| wrong(&at, "radius", circle, "a number"))?;
        items.take_fence(command, radius, center, at)?;
    }
    Ok(())
}

/// That the field `name` of what stands `at` is not what is `wanted`.
fn wrong(at: &str, name: &str, of: &Value, wanted: &str) -> MissionError {
    let colon = if at.is_empty() { "" } else { ": " };
    let is = of.get(name).map_or("is missing".to_owned(), |value| {
        let mut shown: String = value.to_string().chars().take(40).collect();
        if shown.len() < value.to_string().len() {
            shown.push('…');
        }
        format!("is {shown}")
    });
    MissionError(format!("{at}{colon}{name} {is}: {wanted} is wanted"))
}

/// A table that may be left out.
fn table<'a>(of: &'a Value, at: &str, name: &str) -> Read<Option<&'a Value>> {
    match of.get(name) {
        None | Some(Value::Null) => Ok(None),
        Some(table @ Value::Object(_)) => Ok(Some(table)),
        Some(_) => Err(wrong(at, name, of, "an object")),
    }
}

/// A list that may be left out.
fn list<'a>(of: &'a Value, at: &str, name: &str) -> Read<Option<&'a [Value]>> {
    match of.get(name) {
        None | Some(Value::Null) => Ok(None),
        Some(Value::Array(list)) => Ok(Some(list)),
        Some(_) => Err(wrong(at, name, of, "a list")),
    }
}

fn whole(of: &Value, at: &str, name: &str) -> Read<u64> {
    of.get(name).and_then(Value::as_u64).ok_or_else(|| wrong(at, name, of, "a whole number"))
}

/// So many numbers; null is one that is not given.
fn numbers<const N: usize>(list: &[Value], at: &str) -> Read<[f64; N]> {
    let number = |value: &Value| if value.is_null() { Some(f64::NAN) } else { value.as_f64() };
    let numbers: Option<Vec<f64>> = list.iter().map(number).collect();
    let numbers = numbers.and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| MissionError(format!("{at}: {N} numbers are wanted")))
}
