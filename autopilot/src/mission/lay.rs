//! From a mission's items to waypoints in N, and how it ends: what the flight program flies of what
//! a ground station sends, and what a simulator flies of the same file.

use controller::{Built, End, Knot, Passage, RouteError, RoutePace, Run, Waypoint, build_route_passing};
use link::Home;
use link::dialect::MavMissionResult;

use super::item::{
    CHANGE_SPEED, DEGREES, DELAY, Item, JUMP, Kind, LAND, LOITER_TIME, LOITER_UNLIMITED, METRES, RETURN_TO_LAUNCH,
    Refusal, SPLINE_WAYPOINT, TAKE_OFF, WAYPOINT,
};
use crate::settings::{Setting, Settings};

/// Points nearer than this are one, m: no leg is shorter.
const SAME: f32 = controller::SHORTEST_LEG as f32;
/// The smallest corner, m.
const LEAST_CORNER: f32 = 0.02;
/// The slowest leg, m/s.
const LEAST_SPEED: f32 = 0.05;

/// How a mission is closed and ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// The last waypoint leads back to the first.
    pub is_closed: bool,
    /// What is flown after the last waypoint.
    pub end: End,
    /// Lands at its end.
    pub lands: bool,
}

/// Where the route passes a waypoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// The last item that is done there.
    pub item: u16,
    /// Where that is.
    pub at: Passage,
    /// Speed of the leg that leads there, m/s.
    pub speed: f32,
}

/// The numbers that items leave out.
#[derive(Clone, Copy, Debug)]
struct Pace {
    speed: f32,
    corner: f32,
    acceleration: f32,
}

impl Pace {
    fn of(settings: &Settings) -> Self {
        Self {
            speed: settings.get(Setting::MISSION_SPEED),
            corner: settings.get(Setting::MISSION_CORNER),
            acceleration: settings.get(Setting::MISSION_ACCELERATION),
        }
    }
}

/// What a mission's items come to: waypoints in N, in lent memory, and how it ends.
#[derive(Debug)]
pub struct Plan<'a> {
    all: &'a mut [Waypoint<f32>],
    /// The number of each waypoint's last item.
    items: &'a mut [u16],
    count: usize,
    course: Course,
    pace: Pace,
}

impl<'a> Plan<'a> {
    /// Reads `items` about `home`; what they leave out is the `MIS_*` of `settings`. `all` and
    /// `numbers` have room for a waypoint an item and one more.
    ///
    /// # Errors
    /// [`Refusal`] of the first item that no route can have; with MAV_MISSION_ERROR where only the
    /// home is missing.
    pub fn read(
        items: &[Item],
        home: Option<&Home>,
        settings: &Settings,
        all: &'a mut [Waypoint<f32>],
        numbers: &'a mut [u16],
    ) -> Result<Self, Refusal> {
        let pace = Pace::of(settings);
        let mut plan = Self { all, items: numbers, count: 0, course: Course::default(), pace };
        let mut reader = Reader { home, speed: pace.speed, last: [0.0; 3], is_over: false };
        for (number, item) in items.iter().enumerate() {
            reader.take(number, item, &mut plan).map_err(|refusal| refusal.at(Kind::Mission, number))?;
        }
        plan.loop_back(items.len().saturating_sub(1), &reader)?;
        Ok(plan)
    }

    /// In N.
    #[must_use]
    pub fn waypoints(&self) -> &[Waypoint<f32>] {
        self.all.get(..self.count).unwrap_or_default()
    }

    /// How it ends.
    #[must_use]
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// Writes the route's table, telling where it passes each item, in the order flown.
    ///
    /// # Errors
    /// [`Refusal`] by the item that makes no route of the others; with MAV_MISSION_NO_SPACE if the
    /// table is too short.
    pub fn build(
        &self,
        knots: &mut [Knot<f32>],
        runs: &mut [Run<f32>],
        mut passes: impl FnMut(Mark),
    ) -> Result<Built, Refusal> {
        let number = |waypoint: usize| self.items.get(waypoint).copied().unwrap_or_default();
        let all = self.waypoints();
        let route_pace = RoutePace { acceleration: self.pace.acceleration, ..RoutePace::default() };
        let (mut speed, mut last) = (self.pace.speed, None);
        let built = build_route_passing(all, self.course.is_closed, &route_pace, knots, runs, |waypoint, at| {
            // A stop is where the run before ends; of its beginning the next one is told again.
            let item = number(waypoint);
            if last.replace(item) != Some(item) {
                passes(Mark { item, at, speed });
            }
            speed = all.get(waypoint).map_or(speed, |waypoint| waypoint.speed);
        });
        built.map_err(|error| match error {
            RouteError::Knots | RouteError::Runs => {
                Refusal::no_space(format_args!("the route is too long for this board"))
            }
            RouteError::TooFew => Refusal::invalid(format_args!("a mission needs at least two places")),
            RouteError::SharpTurn(at) => Refusal::invalid(format_args!("turns over 150 deg, needs a rest"))
                .at(Kind::Mission, number(at).into()),
            RouteError::ShortLeg(at) => {
                Refusal::invalid(format_args!("next one too near")).at(Kind::Mission, number(at).into())
            }
            RouteError::Waypoint(at, error) => {
                Refusal::invalid(format_args!("{error}")).at(Kind::Mission, number(at).into())
            }
            error => Refusal::invalid(format_args!("{error}")),
        })
    }

    /// The way back to the first waypoint, where the mission is flown again.
    fn loop_back(&mut self, number: usize, reader: &Reader<'_>) -> Result<(), Refusal> {
        let End::Again(times) = self.course.end else { return Ok(()) };
        let stops = self.waypoints().iter().any(|waypoint| waypoint.stop.is_some());
        let begin = self.waypoints().first().map_or([0.0; 3], |waypoint| waypoint.point);
        if stops || times < u32::MAX || self.count <= 2 {
            return self.add(number, self.passing(begin, reader.speed));
        }
        if near(&begin, &reader.last) {
            self.count = self.count.saturating_sub(1);
        }
        (self.course.is_closed, self.course.end) = (true, End::Stay);
        Ok(())
    }

    /// A waypoint of which an item says nothing but the place.
    fn passing(&self, point: [f32; 3], speed: f32) -> Waypoint<f32> {
        Waypoint { point, corner: Some(self.pace.corner), speed, yaw: None, stop: None }
    }

    fn last_mut(&mut self) -> Option<&mut Waypoint<f32>> {
        self.all.get_mut(self.count.checked_sub(1)?)
    }

    /// Another waypoint; what is done at the same place is done at one.
    fn add(&mut self, number: usize, waypoint: Waypoint<f32>) -> Result<(), Refusal> {
        let is_same = self.last_mut().is_some_and(|before| near(&before.point, &waypoint.point));
        if !is_same {
            self.count = self.count.saturating_add(1);
        }
        let full = || Refusal::no_space(format_args!("too many waypoints"));
        let at = self.count.saturating_sub(1);
        let (Some(kept), Some(item)) = (self.all.get_mut(at), self.items.get_mut(at)) else { return Err(full()) };
        *item = number as u16;
        if is_same {
            kept.stop = [kept.stop, waypoint.stop].into_iter().flatten().reduce(|one, other| one + other);
            kept.speed = waypoint.speed;
            kept.yaw = waypoint.yaw.or(kept.yaw);
        } else {
            *kept = waypoint;
        }
        Ok(())
    }
}

/// What the items before one leave it with.
struct Reader<'a> {
    home: Option<&'a Home>,
    speed: f32,
    last: [f32; 3],
    is_over: bool,
}

impl Reader<'_> {
    /// Takes the next item in.
    fn take(&mut self, number: usize, item: &Item, plan: &mut Plan<'_>) -> Result<(), Refusal> {
        item.check(Kind::Mission)?;
        if item.is_for_camera() {
            return Ok(());
        }
        if self.is_over {
            return Err(Refusal::invalid(format_args!("behind the jump or landing that ends it")));
        }
        let [first, second, _, heading] = item.params;
        match item.command {
            WAYPOINT | SPLINE_WAYPOINT | LOITER_UNLIMITED | LOITER_TIME | TAKE_OFF => {
                self.last = place(item, self.home, self.last)?;
                let stop = match item.command {
                    LOITER_UNLIMITED => Some(f32::INFINITY),
                    LOITER_TIME => Some(first),
                    WAYPOINT | SPLINE_WAYPOINT if first > 0.0 => Some(first),
                    _ => None,
                };
                let corner = if item.command == WAYPOINT && second > 0.0 { second } else { plan.pace.corner };
                // That of a take-off is the vehicle's; a timed loiter's says how a circle is left.
                let has_heading = matches!(item.command, WAYPOINT | SPLINE_WAYPOINT | LOITER_UNLIMITED)
                    && heading.is_finite()
                    && heading != 0.0;
                plan.add(
                    number,
                    Waypoint {
                        point: self.last,
                        corner: (item.command != SPLINE_WAYPOINT).then_some(corner.max(LEAST_CORNER)),
                        speed: self.speed,
                        yaw: has_heading.then(|| heading.to_radians()),
                        stop,
                    },
                )?;
            }
            LAND | RETURN_TO_LAUNCH => {
                // It comes down by itself: the route ends above.
                let [n1, n2, n3] = self.last;
                let [n1, n2] = match item.command {
                    RETURN_TO_LAUNCH => [0.0; 2],
                    _ => spot(item, -n3, self.home, [n1, n2])?,
                };
                self.last = [n1, n2, n3];
                plan.add(number, plan.passing(self.last, self.speed))?;
                (plan.course.lands, self.is_over) = (true, true);
            }
            DELAY => plan.add(number, Waypoint { stop: Some(first), ..plan.passing(self.last, self.speed) })?,
            CHANGE_SPEED => {
                if second > 0.0 {
                    self.speed = second.max(LEAST_SPEED);
                } else if second <= -2.0 {
                    self.speed = plan.pace.speed;
                }
                if let Some(before) = plan.last_mut() {
                    before.speed = self.speed;
                }
            }
            // Back no times: on.
            JUMP if second == 0.0 => {}
            JUMP => {
                let begins = plan.items.first().is_some_and(|&first_item| first <= f32::from(first_item));
                if plan.count == 0 || !begins {
                    return Err(Refusal::invalid(format_args!("jumps only to the first one")));
                }
                plan.course.end = End::Again(if second < 0.0 { u32::MAX } else { second as u32 });
                self.is_over = true;
            }
            // Refused above.
            _ => {}
        }
        Ok(())
    }
}

fn near(a: &[f32; 3], b: &[f32; 3]) -> bool {
    let square = a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b));
    square < SAME * SAME
}

fn no_home() -> Refusal {
    Refusal::new(MavMissionResult::MAV_MISSION_ERROR, format_args!("on the earth, but no home is set"))
}

/// In N, m. An item that says no place on the earth is where the `last` one is.
fn place(item: &Item, home: Option<&Home>, last: [f32; 3]) -> Result<[f32; 3], Refusal> {
    let up = if item.is_local() {
        -item.z
    } else if item.is_above_sea() {
        (f64::from(item.z) - home.ok_or_else(no_home)?.altitude) as f32
    } else {
        item.z
    };
    let [n1, n2, _] = last;
    let [n1, n2] = spot(item, up, home, [n1, n2])?;
    Ok([n1, n2, -up])
}

/// n1 and n2, m, of an item that counts as `up` m above home. One that says no place on the earth
/// is where the `last` one is.
pub(super) fn spot(item: &Item, up: f32, home: Option<&Home>, last: [f32; 2]) -> Result<[f32; 2], Refusal> {
    if item.is_local() {
        return Ok([item.x, item.y].map(|steps| (f64::from(steps) * METRES) as f32));
    }
    if !item.is_placed() {
        return Ok(last);
    }
    let home = home.ok_or_else(no_home)?;
    let place = [item.x, item.y].map(|steps| f64::from(steps) * DEGREES);
    let [n1, n2] = home.local(place, home.altitude + f64::from(up)).map(|number| number as f32);
    if n1.abs() <= FURTHEST && n2.abs() <= FURTHEST {
        return Ok([n1, n2]);
    }
    Err(Refusal::invalid(format_args!("more than 100 km from home")))
}

/// From home, m.
const FURTHEST: f32 = 1e5;
