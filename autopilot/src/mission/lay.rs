//! From a mission's items to waypoints, and how it ends.

use controller::{End, Waypoint};
use link::Home;
use link::dialect::MavMissionResult;

use super::item::{
    CHANGE_SPEED, DEGREES, DELAY, Item, JUMP, Kind, LAND, LOITER_TIME, LOITER_UNLIMITED, METRES, RETURN_TO_LAUNCH,
    Refusal, SPLINE_WAYPOINT, TAKE_OFF, WAYPOINT,
};
use super::{Pace, STOPS};

/// Points nearer than this are one, m: no leg is shorter.
const SAME: f32 = controller::SHORTEST_LEG as f32;
/// The smallest corner, m.
const LEAST_CORNER: f32 = 0.02;
/// The slowest leg, m/s.
const LEAST_SPEED: f32 = 0.05;

/// A mission's waypoints, each with the number of its last item.
#[derive(Clone, Debug)]
pub struct Waypoints {
    pub all: heapless::Vec<Waypoint<f32>, STOPS>,
    pub items: heapless::Vec<u16, STOPS>,
}

/// How a mission is closed and ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    pub is_closed: bool,
    pub end: End,
    /// Lands at its end.
    pub lands: bool,
}

impl Waypoints {
    pub const fn new() -> Self {
        Self { all: heapless::Vec::new(), items: heapless::Vec::new() }
    }

    /// Makes them of `items` about `home`, at the usual `pace`.
    pub fn lay(&mut self, items: &[Item], home: Option<&Home>, pace: &Pace) -> Result<Course, Refusal> {
        self.all.clear();
        self.items.clear();
        let mut course = Course::default();
        let mut speed = pace.speed;
        let mut last = [0.0; 3];
        let mut is_over = false;
        for (number, item) in items.iter().enumerate() {
            if is_over {
                return Err(Refusal::invalid(format_args!("item {number}: behind the mission's end")));
            }
            item.check(Kind::Mission, number)?;
            let [first, second, _, heading] = item.params;
            match item.command {
                WAYPOINT | SPLINE_WAYPOINT | LOITER_UNLIMITED | LOITER_TIME | TAKE_OFF => {
                    last = place(item, Kind::Mission, number, home, last)?;
                    let stop = match item.command {
                        LOITER_UNLIMITED => Some(f32::INFINITY),
                        LOITER_TIME => Some(first),
                        WAYPOINT | SPLINE_WAYPOINT if first > 0.0 => Some(first),
                        _ => None,
                    };
                    let corner = if item.command == WAYPOINT && second > 0.0 { second } else { pace.corner };
                    let has_heading = item.command != TAKE_OFF && heading.is_finite() && heading != 0.0;
                    self.add(
                        number,
                        Waypoint {
                            point: last,
                            corner: (item.command != SPLINE_WAYPOINT).then_some(corner.max(LEAST_CORNER)),
                            speed,
                            yaw: has_heading.then(|| heading.to_radians()),
                            stop,
                        },
                    )?;
                }
                LAND | RETURN_TO_LAUNCH => {
                    // It comes down by itself: the route ends above.
                    if item.command == RETURN_TO_LAUNCH {
                        (last[0], last[1]) = (0.0, 0.0);
                    } else if item.is_local() || item.is_placed() {
                        let [n1, n2, _] = place(&Item { z: 0.0, ..*item }, Kind::Mission, number, home, last)?;
                        (last[0], last[1]) = (n1, n2);
                    }
                    self.add(number, passing(last, speed, pace))?;
                    (course.lands, is_over) = (true, true);
                }
                DELAY => self.add(number, Waypoint { stop: Some(first), ..passing(last, speed, pace) })?,
                CHANGE_SPEED => {
                    if second > 0.0 {
                        speed = second.max(LEAST_SPEED);
                    } else if second <= -2.0 {
                        speed = pace.speed;
                    }
                    if let Some(before) = self.all.last_mut() {
                        before.speed = speed;
                    }
                }
                JUMP => {
                    let begins = self.items.first().is_some_and(|&first_item| first <= f32::from(first_item));
                    if !begins {
                        return Err(Refusal::invalid(format_args!("item {number}: jumps only to the first one")));
                    }
                    course.end = End::Again(if second < 0.0 { u32::MAX } else { second as u32 });
                    is_over = true;
                }
                // Refused above.
                _ => {}
            }
        }
        if matches!(course.end, End::Again(_)) {
            let stops = self.all.iter().any(|waypoint| waypoint.stop.is_some());
            let begin = self.all.first().map_or([0.0; 3], |waypoint| waypoint.point);
            if !stops && course.end == End::Again(u32::MAX) && self.all.len() > 2 {
                if near(&begin, &last) {
                    self.all.pop();
                    self.items.pop();
                }
                (course.is_closed, course.end) = (true, End::Stay);
            } else {
                self.add(items.len().saturating_sub(1), passing(begin, speed, pace))?;
            }
        }
        Ok(course)
    }

    /// Another waypoint; what is done at the same place is done at one.
    fn add(&mut self, number: usize, waypoint: Waypoint<f32>) -> Result<(), Refusal> {
        if let Some(before) = self.all.last_mut().filter(|before| near(&before.point, &waypoint.point)) {
            let stops = [before.stop, waypoint.stop];
            before.stop = stops.into_iter().flatten().reduce(|one, other| one + other);
            before.speed = waypoint.speed;
            before.yaw = waypoint.yaw.or(before.yaw);
            if let Some(item) = self.items.last_mut() {
                *item = number as u16;
            }
            return Ok(());
        }
        let full = |_| Refusal::no_space(format_args!("too many waypoints"));
        self.all.push(waypoint).map_err(|_| full(0))?;
        self.items.push(number as u16).map_err(full)
    }
}

fn passing(point: [f32; 3], speed: f32, pace: &Pace) -> Waypoint<f32> {
    Waypoint { point, corner: Some(pace.corner), speed, yaw: None, stop: None }
}

fn near(a: &[f32; 3], b: &[f32; 3]) -> bool {
    let square = a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
    square < SAME * SAME
}

/// In N, m. An item that says no place on the earth is where the `last` one is.
pub(super) fn place(
    item: &Item,
    kind: Kind,
    number: usize,
    home: Option<&Home>,
    last: [f32; 3],
) -> Result<[f32; 3], Refusal> {
    if item.is_local() {
        return Ok([local(item.x), local(item.y), item.z]);
    }
    let no_home = || {
        let text = format_args!("{} {number}: on the earth, but no home is set", kind.item());
        Refusal::new(MavMissionResult::MAV_MISSION_ERROR, text)
    };
    let up = if item.is_above_sea() {
        let home = home.ok_or_else(no_home)?;
        (f64::from(item.z) - home.altitude) as f32
    } else {
        item.z
    };
    if !item.is_placed() {
        return Ok([last[0], last[1], -up]);
    }
    let [n1, n2] = on_earth(item, home.ok_or_else(no_home)?, up);
    if !(n1.abs() <= FURTHEST && n2.abs() <= FURTHEST) {
        return Err(Refusal::invalid(format_args!("{} {number}: more than 100 km from home", kind.item())));
    }
    Ok([n1, n2, -up])
}

/// From home, m.
const FURTHEST: f32 = 1e5;

fn local(steps: i32) -> f32 {
    (f64::from(steps) * METRES) as f32
}

/// n1 and n2 of an item's latitude and longitude, m, `up` above home.
fn on_earth(item: &Item, home: &Home, up: f32) -> [f32; 2] {
    let place = [item.x, item.y].map(|steps| f64::from(steps) * DEGREES);
    home.local(place, home.altitude + f64::from(up)).map(|number| number as f32)
}
