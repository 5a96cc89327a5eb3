//! Routes from waypoints, in memory that the caller lends.

use core::mem::{align_of, size_of};

use controller::{
    Built, End, Knot, OutOfRange, Route, RouteError, RoutePace, RouteTable, Run, Waypoint, build_route,
};

use crate::pointer::{exclusive, optional, shared};
use crate::status::{Status, code, tell_of};
use crate::types::{SlungError, SlungPace, SlungWaypoint};

/// A table in memory that the caller keeps where it is.
pub type LentTable = RouteTable<&'static [Knot<f32>], &'static [Run<f32>]>;

/// Written by [`slung_route_build`]; anything else is memory in which no route is.
const CREATED: u32 = 0x51A6_2071;

/// `slung_route`: where its table is.
#[derive(Clone, Copy)]
#[repr(C, align(8))]
pub struct StoredRoute {
    created: u32,
    table: LentTable,
    end: End,
    lands: bool,
}

/// Bytes in the header's `slung_route`; a test compares.
pub const BYTES: usize = 64;
const _: () = assert!(size_of::<StoredRoute>() <= BYTES);
/// What a waypoint is read into lies in the room of a knot.
const _: () = assert!(size_of::<Waypoint<f32>>() <= size_of::<Knot<f32>>());
const _: () = assert!(align_of::<Waypoint<f32>>() <= align_of::<Knot<f32>>());
/// The header's `slung_run` is two words and eight bytes.
const _: () = assert!(size_of::<Run<f32>>() == 2 * size_of::<usize>() + 8);
const _: () = assert!(size_of::<Knot<f32>>() == 60);

impl StoredRoute {
    /// Itself, if there is one.
    ///
    /// # Errors
    /// [`Status::NotCreated`].
    pub fn check(&self) -> Result<&Self, Status> {
        if self.created == CREATED { Ok(self) } else { Err(Status::NotCreated) }
    }

    /// The route that is flown.
    ///
    /// # Errors
    /// A number of the table that has changed since it was built.
    pub fn route(&self) -> Result<Route<f32, LentTable>, OutOfRange<f32>> {
        Ok(Route::new(self.table)?.with_end(self.end))
    }

    /// Whether it ends on the ground.
    pub fn lands(&self) -> bool {
        self.lands
    }
}

impl From<&SlungWaypoint> for Waypoint<f32> {
    fn from(given: &SlungWaypoint) -> Self {
        Self {
            point: given.point_ned_m,
            corner: (given.corner_m != 0.0).then_some(given.corner_m),
            speed: given.speed_m_s,
            yaw: (!given.yaw_rad.is_nan()).then_some(given.yaw_rad),
            stop: (given.stop_s >= 0.0).then_some(given.stop_s),
        }
    }
}

/// What a refusal is called, and value, least and largest; and the waypoint that it is about.
fn reason(
    error: &RouteError<f32>,
    count: usize,
    closed: bool,
    room: [usize; 2],
) -> (Status, &'static str, [f32; 3], Option<usize>) {
    let number = |count: usize| count as f32;
    match *error {
        RouteError::Waypoint(index, OutOfRange { field, value, min, max }) => {
            (Status::OutOfRange, field, [value, min, max], Some(index))
        }
        RouteError::Pace(OutOfRange { field, value, min, max }) => {
            (Status::OutOfRange, field, [value, min, max], None)
        }
        RouteError::TooFew => {
            (Status::OutOfRange, "waypoint_count", [number(count), if closed { 3.0 } else { 2.0 }, f32::MAX], None)
        }
        RouteError::ShortLeg(index) => (Status::NoRoute, "leg", [number(index), 0.0, 0.0], Some(index)),
        RouteError::SharpTurn(index) => (Status::NoRoute, "turn", [number(index), 0.0, 0.0], Some(index)),
        RouteError::Knots => (Status::TooSmall, "knot_count", [number(room[0]), 0.0, f32::MAX], None),
        RouteError::Runs => (Status::TooSmall, "run_count", [number(room[1]), 0.0, f32::MAX], None),
    }
}

/// Makes the route through `waypoints` in lent memory; see the header.
///
/// # Safety
/// As many elements as the counts say are at the pointers; knots and runs are the route's as long
/// as it is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_route_build(
    route: *mut StoredRoute,
    bytes: usize,
    waypoints: *const SlungWaypoint,
    waypoint_count: u32,
    closed: u32,
    pace: *const SlungPace,
    knots: *mut Knot<f32>,
    knot_count: u32,
    runs: *mut Run<f32>,
    run_count: u32,
    error: *mut SlungError,
) -> i32 {
    let build = || {
        if route.is_null() {
            return Err(Status::NullPointer);
        }
        if !route.is_aligned() {
            return Err(Status::Misaligned);
        }
        if bytes < size_of::<StoredRoute>() {
            return Err(Status::TooSmall);
        }
        // SAFETY: the caller's promise.
        unsafe { (shared(waypoints)?, exclusive(knots)?, exclusive(runs)?) };
        // SAFETY: the caller's promise.
        let pace = unsafe { optional(pace)? }.map_or_else(RoutePace::default, |pace| RoutePace {
            acceleration: pace.acceleration_m_s2,
            stop_rate: pace.stop_rate_1_s,
            rise: pace.rise_s,
        });
        let (count, room) = (waypoint_count as usize, [knot_count, run_count].map(|count| count as usize));
        let is_closed = closed != 0;
        let refused = |refused: &RouteError<f32>| {
            let (status, field, numbers, waypoint) = reason(refused, count, is_closed, room);
            // SAFETY: the caller's promise.
            unsafe { tell_of(error, status, field, numbers, waypoint) }
        };
        // The waypoints are read into the last of the knots' room.
        let free = room[0].checked_sub(count).ok_or_else(|| refused(&RouteError::Knots))?;
        // SAFETY: `count` elements from `free` on lie within the knots' room, and a waypoint fits
        // that of a knot in size and alignment; each is written before it is read. Knots and runs
        // are written before references to them are made, so whatever lay there does no harm.
        let (read, knots, runs) = unsafe {
            let read = knots.add(free).cast::<Waypoint<f32>>();
            for index in 0..count {
                read.add(index).write(Waypoint::from(&waypoints.add(index).read()));
            }
            for index in 0..free {
                knots.add(index).write(Knot::default());
            }
            for index in 0..room[1] {
                runs.add(index).write(Run::default());
            }
            (
                core::slice::from_raw_parts(read, count),
                core::slice::from_raw_parts_mut(knots, free),
                core::slice::from_raw_parts_mut(runs, room[1]),
            )
        };
        let Built { knots: k, runs: r } =
            build_route(read, is_closed, &pace, knots, runs).map_err(|error| refused(&error))?;
        let table = RouteTable { knots: knots.get(..k).unwrap_or_default(), runs: runs.get(..r).unwrap_or_default() };
        // SAFETY: not null, aligned, and large enough by the caller's word. What was there needs no
        // drop.
        unsafe { route.write(StoredRoute { created: CREATED, table, end: End::Stay, lands: false }) };
        Ok(())
    };
    code(build())
}

/// What is flown after the last run: so many times the way back and forth again, or the first run
/// again of a route that ends where it begins.
///
/// # Safety
/// `route`, if not null, points to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_route_repeat(route: *mut StoredRoute, times: u32, back: u32) -> i32 {
    let repeat = || {
        // SAFETY: the caller's promise.
        let route = unsafe { exclusive(route)? };
        route.check()?;
        route.end = match (times, back) {
            (0, _) => End::Stay,
            (times, 0) => End::Again(times),
            (times, _) => End::Back(times),
        };
        Ok(())
    };
    code(repeat())
}

/// Whether the vehicle lands where the route ends.
///
/// # Safety
/// `route`, if not null, points to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_route_land(route: *mut StoredRoute, lands: u32) -> i32 {
    let land = || {
        // SAFETY: the caller's promise.
        let route = unsafe { exclusive(route)? };
        route.check()?;
        route.lands = lands != 0;
        Ok(())
    };
    code(land())
}

/// How many bytes a route takes, at most the size of `slung_route`.
#[unsafe(no_mangle)]
pub extern "C" fn slung_route_bytes() -> usize {
    size_of::<StoredRoute>()
}
