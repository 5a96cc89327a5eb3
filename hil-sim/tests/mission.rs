//! Missions from files: the same flight in each format is the same route.

use std::f64::consts::TAU;

use hil_sim::describe::mission::{self, Defaults, Home, Local, LocalEdge, Mission};
use hil_sim::describe::scenario::{Law, Scenario};
use serde_json::json;

const HOME: Home = Home { latitude: 53.527, longitude: -113.529, altitude: 668.0 };

/// Latitude, longitude and height above home of a flight with a vertical leg and a return.
const FLIGHT: [[f64; 3]; 5] = [
    [53.5271, -113.5288, 12.0],
    [53.5271, -113.5288, 30.0],
    [53.5284, -113.5301, 30.0],
    [53.5292, -113.5262, 24.5],
    [53.5275, -113.5279, 18.0],
];

fn read(text: &str) -> Mission {
    mission::read("flight", text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn local(text: &str, home: Option<Home>) -> Local {
    read(text).local(home, None, &Defaults::default()).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn plan(frame: u32) -> String {
    let items: Vec<_> = FLIGHT
        .iter()
        .enumerate()
        .map(|(index, [latitude, longitude, up])| {
            let height = if frame == 0 { up + HOME.altitude } else { *up };
            json!({
                "type": "SimpleItem", "command": 16, "frame": frame, "autoContinue": true, "doJumpId": index + 1,
                "params": [if index == 3 { 5 } else { 0 }, 0, 0, null, latitude, longitude, height]
            })
        })
        .collect();
    json!({
        "fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
        "mission": {
            "version": 2, "plannedHomePosition": [HOME.latitude, HOME.longitude, HOME.altitude],
            "cruiseSpeed": 15, "hoverSpeed": 5, "items": items
        },
        "geoFence": {
            "version": 2,
            "circles": [{ "circle": { "center": [53.528, -113.528], "radius": 30.0 }, "inclusion": false }],
            "polygons": [{ "polygon": [[53.52, -113.54], [53.52, -113.52], [53.535, -113.52]], "inclusion": true }]
        }
    })
    .to_string()
}

fn waypoints() -> String {
    let line = |index: usize, frame: u32, [latitude, longitude, up]: [f64; 3]| {
        format!("{index}\t{}\t{frame}\t16\t0\t0\t0\t0\t{latitude}\t{longitude}\t{up}\t1\n", u8::from(index == 0))
    };
    let mut text = String::from("QGC WPL 110\n") + &line(0, 0, [HOME.latitude, HOME.longitude, HOME.altitude]);
    for (index, point) in FLIGHT.iter().enumerate() {
        text += &line(index + 1, 3, *point);
    }
    text
}

fn kml(mode: &str) -> String {
    let coordinates: String =
        FLIGHT.iter().map(|[lat, lon, up]| format!("{lon},{lat},{} ", up + HOME.altitude)).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Folder>\
         <Placemark><name>legs</name><LineString><altitudeMode>{mode}</altitudeMode><coordinates>{coordinates}</coordinates>\
         </LineString></Placemark></Folder></Document></kml>"
    )
}

fn gpx() -> String {
    let points: String = FLIGHT
        .iter()
        .map(|[lat, lon, up]| format!("<rtept lat=\"{lat}\" lon=\"{lon}\"><ele>{}</ele></rtept>", up + HOME.altitude))
        .collect();
    format!(
        "<?xml version=\"1.0\"?><gpx version=\"1.1\" creator=\"test\" xmlns=\"http://www.topografix.com/GPX/1/1\"><rte>{points}</rte></gpx>"
    )
}

fn geojson() -> String {
    let coordinates: Vec<_> = FLIGHT.iter().map(|[lat, lon, up]| json!([lon, lat, up + HOME.altitude])).collect();
    json!({ "type": "FeatureCollection", "features": [
        { "type": "Feature", "properties": {}, "geometry": { "type": "LineString", "coordinates": coordinates } }
    ] })
    .to_string()
}

fn table(names: &str, row: impl Fn([f64; 3]) -> String) -> String {
    FLIGHT.iter().fold(format!("{names}\n"), |text, point| text + &row(*point) + "\n")
}

#[test]
fn the_same_flight_in_each_format_is_the_same_route() {
    let wanted = local(&plan(3), None);
    assert_eq!(wanted.waypoints.len(), FLIGHT.len());
    let [lat, lon] = [(53.5284_f64 - HOME.latitude).to_radians(), (-113.5301 - HOME.longitude).to_radians()];
    let [n, e, d] = wanted.waypoints[2].point;
    // A ball of the mean radius is right to a third of a percent.
    assert!((n / (6.371e6 * lat) - 1.0).abs() < 4e-3, "{n}");
    assert!((e / (6.371e6 * lon * HOME.latitude.to_radians().cos()) - 1.0).abs() < 4e-3, "{e}");
    assert_eq!(d, -30.0);
    let feet = |up: f64| up / 0.3048;
    let amsl = |up: f64| up + HOME.altitude;
    for (what, text, home) in [
        ("plan above the sea", plan(0), None),
        ("waypoints", waypoints(), None),
        ("KML", kml("absolute"), Some(HOME)),
        ("GPX", gpx(), Some(HOME)),
        ("GeoJSON", geojson(), Some(HOME)),
        ("CSV", table("lat,lon,alt", |[a, o, up]| format!("{a},{o},{}", amsl(up))), Some(HOME)),
        (
            "CSV in feet",
            table("longitude_deg,latitude_deg,alt_rel_ft", |[a, o, up]| format!("{o},{a},{}", feet(up))),
            Some(HOME),
        ),
    ] {
        let found = local(&text, home);
        assert_eq!(found.waypoints.len(), wanted.waypoints.len(), "{what}");
        for (found, wanted) in found.waypoints.iter().zip(&wanted.waypoints) {
            for (found, wanted) in found.point.iter().zip(wanted.point) {
                assert!((found - wanted).abs() < 0.01, "{what}: {found} against {wanted}");
            }
        }
    }
}

/// n1 and n2 against the lengths of meridian and parallel, less what an arc is longer than its
/// tangent's part: to a centimetre at 5 km, all round.
#[test]
fn the_plane_about_home_is_exact_to_a_centimetre_at_5_km() {
    // WGS 84.
    let (a, flattening) = (6_378_137.0_f64, 1.0_f64 / 298.257_223_563);
    let e2 = flattening * (2.0 - flattening);
    let home = Home { altitude: 0.0, ..HOME };
    let curvature = |latitude: f64| {
        let w = 1.0 - e2 * latitude.to_radians().sin().powi(2);
        (a * (1.0 - e2) / w.powf(1.5), a / w.sqrt())
    };
    for step in 0..16 {
        let (sin, cos) = (TAU * f64::from(step) / 16.0).sin_cos();
        let latitude = home.latitude + 0.0449 * sin;
        let longitude = home.longitude + 0.0755 * cos;
        // Along the meridian by Simpson's rule, then along the parallel there.
        let middle = curvature(0.5 * (home.latitude + latitude)).0;
        let meridian = (curvature(home.latitude).0 + 4.0 * middle + curvature(latitude).0) / 6.0;
        let north = meridian * (latitude - home.latitude).to_radians();
        let radius = curvature(latitude).1 * latitude.to_radians().cos();
        let turn = (longitude - home.longitude).to_radians();
        // The parallel is a circle about the axis, seen at the latitude of home.
        let east = radius * turn.sin();
        let curved = radius * (1.0 - turn.cos()) * home.latitude.to_radians().sin();
        let fallen = north - north.powi(3) / (6.0 * middle * middle);
        let text = format!("lat,lon,alt\n{latitude},{longitude},0\n{},{longitude},50\n", latitude + 1e-4);
        let [n, e, _] = local(&text, Some(home)).waypoints[0].point;
        assert!(n.hypot(e) > 4.9e3);
        assert!((e - east).abs() < 0.01, "{e} against {east}");
        assert!((n - fallen - curved).abs() < 0.01, "{n} against {}", fallen + curved);
    }
}

#[test]
fn stops_speeds_take_off_and_fences_are_read() {
    let item = |command: u32, params: [serde_json::Value; 7]| json!({ "type": "SimpleItem", "command": command, "frame": 3, "params": params });
    let [lat, lon, _] = FLIGHT[2];
    let null = || serde_json::Value::Null;
    let mut value: serde_json::Value = serde_json::from_str(&plan(3)).unwrap();
    value["mission"]["items"] = json!([
        item(22, [json!(0), json!(0), json!(0), null(), json!(0), json!(0), json!(20)]),
        item(178, [json!(1), json!(3.5), json!(-1), json!(0), json!(0), json!(0), json!(0)]),
        item(82, [json!(0), json!(0), json!(0), null(), json!(lat), json!(lon), json!(20)]),
        item(93, [json!(7), json!(0), json!(0), json!(0), json!(0), json!(0), json!(0)]),
        item(206, [json!(25), json!(0), json!(1), json!(0), json!(0), json!(0), json!(0)]),
        item(20, [json!(0), json!(0), json!(0), json!(0), json!(0), json!(0), json!(0)]),
    ]);
    let defaults = Defaults { corner_m: 3.0, ..Defaults::default() };
    let local = read(&value.to_string()).local(None, None, &defaults).unwrap();
    assert!(local.notes.iter().any(|note| note.contains("item 5: command 206")), "{:?}", local.notes);
    let [first, second, third] = local.waypoints[..] else { panic!("{:?}", local.waypoints) };
    assert_eq!((first.point, third.point), ([0.0, 0.0, -20.0], [0.0, 0.0, -20.0]));
    assert!(second.corner.is_none() && second.stop == Some(7.0));
    assert!(local.waypoints.iter().all(|waypoint| waypoint.speed == 3.5));
    assert!(local.course.lands);
    let regions: Vec<bool> = local.regions.iter().map(|(is_inside, _)| *is_inside).collect();
    assert_eq!(regions, [true, false]);
    assert!(matches!(&local.regions[1].1, LocalEdge::Circle(_, radius) if *radius == 30.0));

    // And all of it stands in the scenario that is written.
    let text = mission::toml(&local, "x", 60.0);
    let scenario = Scenario::parse("route.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let Law::Follow { path, .. } = &scenario.controller.law else { panic!("it follows") };
    let route = path.route().unwrap();
    let [first, second, _] = route.waypoints()[..] else { panic!("{text}") };
    assert!(route.lands() && second.stop == Some(7.0));
    assert!(second.corner.is_none() && first.corner == Some(3.0) && first.speed == 3.5);
    let fence = scenario.fence.unwrap();
    assert_eq!((fence.inside.len(), fence.outside.len()), (1, 1));
}

#[test]
fn what_is_unclear_is_refused_by_name() {
    let refusal = |text: &str, home: Option<Home>| match mission::read("flight", text) {
        Err(error) => error.to_string(),
        Ok(mission) => mission.local(home, None, &Defaults::default()).expect_err(text).to_string(),
    };
    let flat = FLIGHT.iter().map(|[lat, lon, _]| json!([lon, lat])).collect::<Vec<_>>();
    for (text, home, message) in [
        (gpx(), None, "--home"),
        (kml("relativeToGround"), Some(HOME), "--terrain"),
        (kml("clampToGround"), Some(HOME), "clampToGround"),
        (json!({ "type": "LineString", "coordinates": flat }).to_string(), Some(HOME), "height"),
        (plan(10), None, "--terrain"),
        (plan(7), None, "item 1: frame 7 not supported: 0, 1, 3, 5, 6 are"),
        (plan(3).replace("\"command\":16", "\"command\":18"), None, "item 1: command 18 not supported: 16, 17"),
        (waypoints().replace("110", "120"), None, "QGC WPL 110"),
        (waypoints().replace("\t1\n", "\n"), None, "line 2: 11 fields"),
        (table("lat,lon,agl", |[a, o, up]| format!("{a},{o},{up}")), Some(HOME), "agl"),
        (table("lat,east,up", |[a, o, up]| format!("{a},{o},{up}")), Some(HOME), "together"),
        (table("lat,lon,alt", |[a, o, up]| format!("{o},{a},{up}")), Some(HOME), "no latitude"),
        ("north,east,up\n0,0,10\n".to_owned(), None, "1 points"),
        ("north,east,up\n0,0,10\n0,0,10\n".to_owned(), None, "all points are one"),
        ("north,east,up\n0,0,10\n0,nan,10\n".to_owned(), None, "line 3: column 2: NaN is outside"),
        (json!({ "type": "Polygon", "coordinates": [[[1], [2], [3]]] }).to_string(), Some(HOME), "longitude"),
        ("{\"fileType\": \"Pan\"}".to_owned(), None, "neither a plan"),
        // Cut off within an element.
        (kml("absolute").split_once("</coordinates>").expect("it has some").0.to_owned(), None, "the file ends"),
        (table("lat,lon,alt", |[a, o, up]| format!("{a},{},{up}", o + 2.0)), Some(HOME), "km from home"),
    ] {
        let error = refusal(&text, home);
        assert!(error.contains(message), "{error}, where {message} was to be named, of {text}");
    }
    // What the terrain is may be told.
    let told = read(&kml("relativeToGround")).local(Some(HOME), Some(0.0), &Defaults::default()).unwrap();
    assert_eq!(told.waypoints[1].point[2], -30.0);
}

/// Lengths in N need no home, in whatever unit and order.
#[test]
fn tables_of_lengths_are_read_as_they_say() {
    for text in [
        "north,east,down\n1,2,-3\n4,5,-6\n",
        "x,y,z_up\n1,2,3\n4,5,6\n",
        "east_cm,north_cm,up_cm\n200,100,300\n500,400,600\n",
        "alt_ft,y_ft,x_ft\n9.842519685,6.56167979,3.280839895\n19.68503937,16.40419948,13.12335958\n",
    ] {
        let found = local(text, None);
        for (found, wanted) in found.waypoints.iter().zip([[1.0, 2.0, -3.0], [4.0, 5.0, -6.0]]) {
            assert!(found.point.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-8), "{text}: {found:?}");
        }
    }
}

/// A fence that is not understood is no fence that may be left out, and an item no other one.
#[test]
fn what_has_another_type_in_a_plan_is_named() {
    for (place, value, message) in [
        ("/mission", json!("x"), "mission is \"x\": an object is wanted"),
        ("/mission/items", json!({}), "mission: items is {}: a list is wanted"),
        ("/mission/items", json!(null), "mission: it has no items"),
        ("/mission/plannedHomePosition", json!([53.5]), "plannedHomePosition: 3 numbers"),
        ("/mission/items/1", json!("x"), "item 2: type is missing: SimpleItem or ComplexItem"),
        ("/mission/items/1/type", json!("Foo"), "item 2: type is \"Foo\""),
        ("/mission/items/1/command", json!("16"), "item 2: command is \"16\": a whole number"),
        ("/mission/items/1/frame", json!(-1), "item 2: frame is -1: a whole number"),
        ("/mission/items/1/doJumpId", json!("x"), "item 2: doJumpId is \"x\""),
        ("/mission/items/1/params/4", json!("53"), "item 2: params: 7 numbers"),
        ("/mission/items/1/params/4", json!(500.0), "item 2: latitude 500 is outside"),
        ("/mission/items/1/params/6", json!(null), "item 2: height NaN not in"),
        ("/geoFence", json!("x"), "geoFence is \"x\": an object"),
        ("/geoFence/polygons", json!("x"), "geoFence: polygons is \"x\": a list"),
        ("/geoFence/polygons/0/polygon/0", json!([53.5]), "geoFence polygon 1: corner 1: 2 numbers"),
        ("/geoFence/polygons/0/polygon", json!([[53.5, -113.5]]), "geoFence polygon 1: 1 corners"),
        ("/geoFence/polygons/0/inclusion", json!("yes"), "inclusion is \"yes\": true or false"),
        ("/geoFence/circles/0/circle", json!([]), "geoFence circle 1: circle is []: an object"),
        ("/geoFence/circles/0/circle/radius", json!(null), "geoFence circle 1: radius is null: a number"),
        ("/geoFence/circles/0/circle/center", json!([]), "geoFence circle 1: center: 2 numbers"),
    ] {
        let mut plan: serde_json::Value = serde_json::from_str(&plan(3)).expect("a plan");
        *plan.pointer_mut(place).expect(place) = value;
        let refused = mission::read("flight", &plan.to_string())
            .and_then(|mission| mission.local(None, None, &Defaults::default()))
            .expect_err(place)
            .to_string();
        assert!(refused.contains(message), "{place}: {refused}");
    }
}
