//! A route as the items of a mission, by which a target takes it.

use std::f64::consts::TAU;

use autopilot::{Setting, Settings};
use controller::{End, Waypoint};
use link::Home;
use link::dialect::{MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMissionType};
use rig::Refused;

use crate::describe::parameters::Unsupported;
use crate::describe::path::RouteSpec;

/// Steps of an item's n1 and n2, 1/m.
const STEPS: f64 = 1e4;

/// The items of `route`, in order, about the origin of N. A stop is an item of its own, at the same
/// place. Places are rounded to 0.1 mm, and all numbers to f32.
///
/// # Errors
/// [`Unsupported`] for what no mission says.
pub fn items(route: &RouteSpec) -> Result<Vec<MISSION_ITEM_INT_DATA>, Unsupported> {
    if route.is_pointing() {
        return Err(Unsupported("path.yaw: a mission says no line to point to".into()));
    }
    let waypoints = route.waypoints();
    let has_stops = waypoints.iter().any(|waypoint| waypoint.stop.is_some());
    // Items take 0 for no heading: then all are said a turn further on.
    let is_north = |waypoint: &Waypoint<f64>| waypoint.yaw.is_some_and(|yaw| yaw as f32 == 0.0);
    let turn = if waypoints.iter().any(is_north) { TAU } else { 0.0 };
    let mut all: Vec<MISSION_ITEM_INT_DATA> = Vec::new();
    let mut push = |command: MavCmd, params: [f32; 4], [n1, n2, n3]: [f64; 3]| {
        let [param1, param2, param3, param4] = params;
        let (target_system, target_component) = link::CONTROLLER;
        let step = |x: f64| (x * STEPS).round() as i32;
        all.push(MISSION_ITEM_INT_DATA {
            param1,
            param2,
            param3,
            param4,
            x: step(n1),
            y: step(n2),
            z: n3 as f32,
            seq: all.len() as u16,
            command: command as u16,
            target_system,
            target_component,
            frame: MavFrame::MAV_FRAME_LOCAL_NED as u8,
            current: u8::from(all.is_empty()),
            autocontinue: 1,
            mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION as u8,
        });
    };
    let mut speed = None;
    for Waypoint { point, corner, speed: onward, yaw, stop } in waypoints {
        let heading = yaw.map_or(f32::NAN, |yaw| (yaw + turn).to_degrees() as f32);
        match corner {
            Some(corner) => push(MavCmd::MAV_CMD_NAV_WAYPOINT, [0.0, *corner as f32, 0.0, heading], *point),
            None => push(MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT, [0.0, 0.0, 0.0, heading], *point),
        }
        match stop {
            Some(dwell) if dwell.is_finite() => {
                push(MavCmd::MAV_CMD_NAV_LOITER_TIME, [*dwell as f32, 0.0, 0.0, f32::NAN], *point);
            }
            Some(_) => push(MavCmd::MAV_CMD_NAV_LOITER_UNLIM, [0.0, 0.0, 0.0, f32::NAN], *point),
            None => {}
        }
        if speed.replace(*onward) != Some(*onward) {
            push(MavCmd::MAV_CMD_DO_CHANGE_SPEED, [1.0, *onward as f32, -1.0, 0.0], *point);
        }
    }
    let mut jump = |times: f32| push(MavCmd::MAV_CMD_DO_JUMP, [0.0, times, 0.0, 0.0], [0.0; 3]);
    match route.end() {
        _ if route.is_closed() && has_stops => {
            return Err(Unsupported("path.stops: a mission that closes has none; end it with { again }".into()));
        }
        _ if route.is_closed() => jump(-1.0),
        End::Stay | End::Back(0) | End::Again(0) => {}
        End::Again(times) => jump(times as f32),
        End::Back(_) => return Err(Unsupported("path.end: a mission says no way back; add its points".into())),
    }
    if route.lands() {
        push(MavCmd::MAV_CMD_NAV_LAND, [0.0, 0.0, 0.0, f32::NAN], waypoints[waypoints.len() - 1].point);
    }
    Ok(all)
}

/// The same as ground stations draw them: places in latitude, longitude and height above `home`, to
/// half a hundredth of a metre, and none where an item has none.
pub fn on_earth(items: &[MISSION_ITEM_INT_DATA], home: Home) -> Vec<MISSION_ITEM_INT_DATA> {
    // Commands beyond are no places.
    const LAST: u16 = MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT as u16;
    let item = |item: &MISSION_ITEM_INT_DATA| {
        let [x, y] = home.place([item.x, item.y].map(|step| (f64::from(step) / STEPS) as f32));
        if item.command <= LAST {
            let frame = MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT as u8;
            MISSION_ITEM_INT_DATA { x, y, z: -item.z, frame, ..item.clone() }
        } else {
            MISSION_ITEM_INT_DATA { x: 0, y: 0, z: 0.0, frame: MavFrame::MAV_FRAME_MISSION as u8, ..item.clone() }
        }
    };
    items.iter().map(item).collect()
}

/// Sets the mission's numbers that no item says.
///
/// # Errors
/// One is outside its range.
pub fn set_pace(route: &RouteSpec, settings: &mut Settings) -> Result<(), Refused<f32>> {
    settings.set(Setting::MISSION_ACCELERATION, route.acceleration() as f32)?;
    settings.set(Setting::MISSION_SPEED, route.waypoints()[0].speed as f32)
}
