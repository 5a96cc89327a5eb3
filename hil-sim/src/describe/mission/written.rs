//! A mission in N, written as a scenario; and a route's table for firmware.

use std::fmt::Write;

use controller::{End, Knot, RoutePace, Run, Table, Waypoint};

use super::{Home, Local, LocalEdge};
use crate::describe::course::RouteSpec;

/// The law that the built-in routes are flown with, for a state that is known without delay.
const CONTROLLER: &str = "[controller]
rate_hz = 500.0
poles = [
    [-1.5, -3.0, -4.5, -6.0, -7.5, -9.0],
    [-1.5, -3.0, -4.5, -6.0, -7.5, -9.0],
    [-1.5, -3.0, -4.5, -6.0, -7.5],
    [-3.0, -4.5],
]
observer = { payload = 8.0, rod = 8.0, torque = 8.0 }
";

/// A mission as a scenario that flies it, for `duration_s`, from rest at its beginning.
#[must_use]
pub fn toml(local: &Local, source: &str, duration_s: f64) -> String {
    let mut text = String::new();
    let Local { home, waypoints, course, regions, .. } = local;
    // Writing to a String does not fail.
    let _ = writeln!(text, "# From {source}.");
    if let Some(Home { latitude, longitude, altitude }) = home {
        let _ = writeln!(
            text,
            "# Home, the origin of N: {latitude}, {longitude} degrees, {altitude} m above the sea; heights count from there."
        );
    }
    let _ = writeln!(
        text,
        "title = {:?}\nduration_s = {duration_s:.1}\ninitial = \"steady\"\n",
        format!("Route of {source}")
    );
    let _ = writeln!(text, "[path]\nkind = \"route\"\npoints = [");
    for Waypoint { point, .. } in waypoints {
        let _ = writeln!(text, "    {},", list(point));
    }
    let _ = writeln!(text, "]\nclosed = {}", course.is_closed);
    let corner = |waypoint: &Waypoint<f64>| waypoint.corner.map_or("\"smooth\"".to_owned(), number);
    let yaw = |waypoint: &Waypoint<f64>| waypoint.yaw.map_or("\"tangent\"".to_owned(), number);
    let _ = writeln!(text, "corner_m = {}", each(waypoints.iter().map(corner)));
    let _ = writeln!(text, "speed = {}", each(waypoints.iter().map(|waypoint| number(waypoint.speed))));
    let _ = writeln!(text, "yaw = {}", each(waypoints.iter().map(yaw)));
    let stops = waypoints.iter().enumerate().filter_map(|(index, waypoint)| Some((index, waypoint.stop?)));
    let stop = |(index, dwell): (usize, f64)| match dwell.is_finite() {
        true => format!("{{ index = {index}, dwell_s = {} }}", number(dwell)),
        false => format!("{{ index = {index} }}"),
    };
    let stops = joined(stops.map(stop));
    if !stops.is_empty() {
        let _ = writeln!(text, "stops = [{stops}]");
    }
    if let End::Again(times) = course.end {
        let _ = writeln!(text, "end = {{ again = {times} }}");
    }
    if course.lands {
        // Home stands on it.
        text.push_str("end = \"land\"\n\n[cable]\n\n[ground]\n");
    }
    let _ = write!(text, "\n{CONTROLLER}");
    if !regions.is_empty() {
        let those = |wanted: bool| {
            let chosen = regions.iter().filter(|(is_inside, _)| *is_inside == wanted);
            joined(chosen.map(|(_, edge)| match edge {
                LocalEdge::Polygon(corners) => {
                    format!("{{ polygon = [{}] }}", joined(corners.iter().map(|corner| list(corner))))
                }
                LocalEdge::Circle(center, radius) => {
                    format!("{{ center = {}, radius = {} }}", list(center), number(*radius))
                }
            }))
        };
        let _ = writeln!(text, "\n[fence]\ninside = [{}]\noutside = [{}]", those(true), those(false));
    }
    text
}

/// One word if all are the same, and else their list.
fn each(parts: impl Iterator<Item = String>) -> String {
    let parts: Vec<String> = parts.collect();
    match &parts[..] {
        [first, rest @ ..] if rest.iter().all(|part| part == first) => first.clone(),
        _ => format!("[{}]", parts.join(", ")),
    }
}

fn joined(parts: impl Iterator<Item = String>) -> String {
    parts.collect::<Vec<_>>().join(", ")
}

/// To a tenth of a millimetre; never −0.
fn number(value: f64) -> String {
    format!("{:?}", (1e4 * value).round() / 1e4 + 0.0)
}

fn list(values: &[f64]) -> String {
    format!("[{}]", joined(values.iter().map(|value| number(*value))))
}

/// The table in f32 as a Rust static, for flash: `Route::new(&ROUTE)`.
#[must_use]
pub fn rust(route: &RouteSpec, source: &str) -> String {
    let mut text = String::new();
    let table = route.table();
    let (knots, runs) = (table.knots(), table.runs());
    let row = |numbers: &[f32]| joined(numbers.iter().map(|number| format!("{number:?}")));
    let _ = writeln!(text, "/// The route of {source}, in N, m.");
    if route.end() != End::Stay {
        let _ = writeln!(text, "/// Flown `with_end(End::{:?})`.", route.end());
    }
    if route.lands() {
        text.push_str("/// Flown by a rig that is `landing_at_end()`.\n");
    }
    let _ = writeln!(
        text,
        "pub static ROUTE: controller::RouteTable<[controller::Knot<f32>; {}], [controller::Run<f32>; {}]> =",
        knots.len(),
        runs.len()
    );
    let _ = writeln!(text, "    controller::RouteTable {{\n        knots: [");
    for knot in knots {
        let Knot { point, step, normals: [n1, n2], speed, yaw } = knot.cast::<f32>();
        let _ = writeln!(
            text,
            "            controller::Knot {{ point: [{}], step: [{}], normals: [[{}], [{}]], speed: [{}], yaw: {yaw:?} }},",
            row(&point),
            row(&step),
            row(&n1),
            row(&n2),
            row(&speed)
        );
    }
    let _ = writeln!(text, "        ],\n        runs: [");
    for run in runs {
        let Run { first, knots, is_closed, dwell } = run.cast::<f32>();
        let dwell = if dwell.is_finite() { format!("{dwell:?}") } else { "f32::INFINITY".to_owned() };
        let _ = writeln!(
            text,
            "            controller::Run {{ first: {first}, knots: {knots}, is_closed: {is_closed}, dwell: {dwell} }},"
        );
    }
    text.push_str("        ],\n    };\n");
    text
}

/// Its waypoints for C, with room for the table that `slung_route_build` makes of them.
#[must_use]
pub fn c(route: &RouteSpec, source: &str) -> String {
    // A literal such as 1f is none in C, and {:?} writes 1.0.
    let number = |number: f64| match number {
        number if number.is_nan() => "NAN".to_owned(),
        number if number.is_infinite() => "INFINITY".to_owned(),
        number => format!("{:?}f", number as f32),
    };
    let row = |numbers: &[f64]| joined(numbers.iter().map(|&given| number(given)));
    let (waypoints, table) = (route.waypoints(), route.table());
    let (count, knots, runs) = (waypoints.len(), table.knots().len() + waypoints.len(), table.runs().len());
    let closed = u8::from(route.is_closed());
    let mut text = format!("/* The route of {source}, in N, m. Once, before slung_create_on:\n\n");
    let _ = writeln!(
        text,
        "       slung_route_build(&route, sizeof route, route_points, {count}, {closed}, &route_pace, route_knots, {knots}, route_runs, {runs}, &error);"
    );
    if route.lands() {
        text.push_str("       slung_route_land(&route, 1);\n");
    }
    match route.end() {
        End::Back(times) => text.push_str(&format!("       slung_route_repeat(&route, {times}, 1);\n")),
        End::Again(times) => text.push_str(&format!("       slung_route_repeat(&route, {times}, 0);\n")),
        End::Stay => {}
    }
    text.push_str("*/\n#include \"slung.h\"\n\n#include <math.h>\n\n");
    let _ = writeln!(text, "static const slung_waypoint route_points[{count}] = {{");
    for &Waypoint { point, corner, speed, yaw, stop } in waypoints {
        let rest = [corner.unwrap_or(0.0), speed, yaw.unwrap_or(f64::NAN), stop.unwrap_or(-1.0)];
        let _ = writeln!(text, "    {{{{{}}}, {}}},", row(&point), row(&rest));
    }
    let RoutePace { stop_rate, rise, .. } = RoutePace::<f64>::default();
    let _ = writeln!(
        text,
        "}};\nstatic const slung_pace route_pace = {{{}}};",
        row(&[route.acceleration(), stop_rate, rise])
    );
    let _ = writeln!(text, "static slung_knot route_knots[{knots}];\nstatic slung_run route_runs[{runs}];");
    text
}
