//! Missions of ground stations and maps, as waypoints of N.
//!
//! A file says where on the earth, and above what; [`Mission::local`] makes metres of it about a
//! home, where N has its origin, by [`Home::local`], as the flight program does of the missions
//! that ground stations send it.

pub mod columns;
pub mod csv;
mod map;
mod mavlink;
mod written;

pub use written::{Defaults, c, rust, toml};

pub use link::Home;

use controller::Vector3;

/// The home that LAT,LON,ALT says, as a command line has it: degrees, and m above the sea.
///
/// # Errors
/// What is wrong with it.
pub fn home(text: &str) -> Result<Home, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|number| number.trim().parse::<f64>().map_err(|_| format!("\"{number}\" is no number")))
        .collect::<Result<_, _>>()?;
    let [latitude, longitude, altitude] =
        numbers[..].try_into().map_err(|_| "three numbers: LAT,LON,ALT".to_owned())?;
    if !(latitude.abs() <= 90.0 && longitude.abs() <= 180.0 && altitude.abs() <= 1e4) {
        return Err("latitude within ±90 and longitude within ±180 degrees, height within ±10000 m".to_owned());
    }
    Ok(Home { latitude, longitude, altitude })
}

/// Where a point of a mission is, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spot {
    /// Latitude and longitude, degrees.
    Earth([f64; 2]),
    /// n1 and n2, m.
    Local([f64; 2]),
    /// Above the home.
    Home,
    /// Above or below the point before.
    Same,
}

/// Above what a point of a mission is, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Height {
    /// The sea.
    Amsl(f64),
    /// The home.
    Relative(f64),
    /// The ground under it.
    Terrain(f64),
    /// As high as the point before.
    Same,
}

/// A point of a mission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Item {
    /// Where.
    pub spot: Spot,
    /// How high.
    pub height: Height,
    /// How long to rest there, s; infinite: until told to go on.
    pub stop: Option<f64>,
    /// Passed on a smooth curve rather than by a corner.
    pub is_smooth: bool,
    /// From there on, m/s.
    pub speed: Option<f64>,
    /// Heading there, degrees from north.
    pub heading: Option<f64>,
}

impl Item {
    /// A point that is passed.
    fn at(spot: Spot, height: Height) -> Self {
        Self { spot, height, stop: None, is_smooth: false, speed: None, heading: None }
    }
}

/// A region that the mission stays in, or keeps out of.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// To stay in; else to keep out.
    pub is_inside: bool,
    /// Its edge.
    pub edge: Edge,
}

/// The edge of a region, seen from above.
#[derive(Clone, Debug, PartialEq)]
pub enum Edge {
    /// By its corners.
    Polygon(Vec<Spot>),
    /// By its centre and radius, m.
    Circle(Spot, f64),
}

/// A mission as its file has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mission {
    /// The home, where the file says it.
    pub home: Option<Home>,
    /// In the order flown.
    pub items: Vec<Item>,
    /// Fences.
    pub regions: Vec<Region>,
    /// The speed where items say none, m/s.
    pub speed: Option<f64>,
    /// What was passed over.
    pub notes: Vec<String>,
}

/// A mission that can't be read, or not be placed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct MissionError(pub String);

impl MissionError {
    fn new(message: impl std::fmt::Display) -> Self {
        Self(message.to_string())
    }
}

/// A waypoint in N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalItem {
    /// m.
    pub point: [f64; 3],
    /// The item, for all else.
    pub item: Item,
}

/// A mission in N.
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// The home, if there is one.
    pub home: Option<Home>,
    /// Waypoints, no two in a row at the same place.
    pub items: Vec<LocalItem>,
    /// Regions, their edges local.
    pub regions: Vec<(bool, LocalEdge)>,
}

/// An edge in N, m.
#[derive(Clone, Debug, PartialEq)]
pub enum LocalEdge {
    /// By its corners, n1 and n2.
    Polygon(Vec<[f64; 2]>),
    /// By its centre, n1 and n2, and radius.
    Circle([f64; 2], f64),
}

/// Points nearer than this are one, m: no leg is shorter.
const SAME: f64 = controller::SHORTEST_LEG;

/// Reads a mission: a QGroundControl plan, MAVLink waypoints (`QGC WPL 110`), KML, GPX, GeoJSON, or
/// a table. What it is shows in its text.
///
/// # Errors
/// [`MissionError`] names the item and what it says that no route can have.
pub fn read(file: &str, text: &str) -> Result<Mission, MissionError> {
    let text = text.trim_start_matches('\u{feff}');
    let begin: String = text.trim_start().chars().take(2000).collect();
    let mission = if begin.starts_with("QGC WPL") {
        mavlink::waypoints(text)
    } else if begin.starts_with('<') && begin.contains("<gpx") {
        map::gpx(text)
    } else if begin.starts_with('<') {
        map::kml(text)
    } else if begin.starts_with(['{', '[']) {
        let value: serde_json::Value = serde_json::from_str(text).map_err(MissionError::new)?;
        if value.get("fileType").is_some_and(|kind| kind == "Plan") {
            mavlink::plan(&value)
        } else {
            map::geojson(text)
        }
    } else {
        table(file, text)
    }?;
    if mission.items.len() < 2 {
        let count = mission.items.len();
        return Err(MissionError(format!("{count} points to fly to where a route needs at least 2")));
    }
    Ok(mission)
}

fn table(file: &str, text: &str) -> Result<Mission, MissionError> {
    // Its own errors name the file.
    let within = |error: csv::PointsError| {
        MissionError(error.to_string().trim_start_matches(file).trim_start_matches(':').trim_start().to_owned())
    };
    let csv::Rows { columns, rows } = csv::rows(file, text, 100_000).map_err(within)?;
    let items = rows.iter().map(|(_, point)| {
        let (spot, height) = columns.spot(point);
        Item::at(spot, height)
    });
    Ok(Mission { items: items.collect(), notes: vec![format!("columns: {columns}")], ..Mission::default() })
}

impl Mission {
    /// The mission in N about `home`, or else the file's own; where it counts heights above the
    /// ground, that is `terrain` m above the sea everywhere.
    ///
    /// # Errors
    /// There is no home where one is needed, or no terrain; or a place is none on the earth, or
    /// farther than 100 km away.
    pub fn local(&self, home: Option<Home>, terrain: Option<f64>) -> Result<Local, MissionError> {
        let home = home.or(self.home);
        let needed = || {
            home.ok_or_else(|| {
                MissionError("the file says where on the earth, but no home: give --home LAT,LON,ALT".to_owned())
            })
        };
        let level = |spot: Spot, altitude: f64, last: [f64; 2]| -> Result<[f64; 2], MissionError> {
            match spot {
                Spot::Local(place) => Ok(place),
                Spot::Home => Ok([0.0; 2]),
                Spot::Same => Ok(last),
                Spot::Earth(place) => from_home(needed()?, place, altitude),
            }
        };
        let mut items: Vec<LocalItem> = Vec::new();
        let (mut last, mut up) = ([0.0; 2], 0.0);
        for (index, item) in self.items.iter().enumerate() {
            let named = |error: MissionError| MissionError(format!("point {}: {error}", index + 1));
            up = match item.height {
                Height::Relative(up) => up,
                Height::Same => up,
                Height::Amsl(altitude) => altitude - needed().map_err(named)?.altitude,
                Height::Terrain(above) => {
                    let ground = terrain.ok_or_else(|| {
                        named(MissionError(
                            "its height is above the terrain, which is not known: give --terrain METRES above the sea"
                                .to_owned(),
                        ))
                    })?;
                    ground + above - needed().map_err(named)?.altitude
                }
            };
            let altitude = home.map_or(0.0, |home| home.altitude) + up;
            last = level(item.spot, altitude, last).map_err(named)?;
            let point = [last[0], last[1], 0.0 - up];
            match items.last_mut().filter(|before| near(&before.point, &point)) {
                // What is done at the same place is done at one waypoint.
                Some(before) => {
                    let stop = [before.item.stop, item.stop].into_iter().flatten().reduce(|a, b| a + b);
                    let (speed, heading) = (item.speed.or(before.item.speed), item.heading.or(before.item.heading));
                    before.item = Item { stop, speed, heading, ..before.item };
                }
                None => items.push(LocalItem { point, item: *item }),
            }
        }
        let altitude = home.map_or(0.0, |home| home.altitude);
        let edge = |region: &Region| {
            let place = |spot: &Spot| level(*spot, altitude, [0.0; 2]);
            let edge = match &region.edge {
                Edge::Polygon(corners) => LocalEdge::Polygon(corners.iter().map(place).collect::<Result<_, _>>()?),
                Edge::Circle(center, radius) => LocalEdge::Circle(place(center)?, *radius),
            };
            Ok((region.is_inside, edge))
        };
        let regions = self.regions.iter().map(edge).collect::<Result<_, MissionError>>()?;
        Ok(Local { home, items, regions })
    }
}

fn near(a: &[f64; 3], b: &[f64; 3]) -> bool {
    let away = Vector3::from(*a) - Vector3::from(*b);
    away.dot(&away) < SAME * SAME
}

/// n1 and n2 of a place of the earth, m.
fn from_home(home: Home, [latitude, longitude]: [f64; 2], altitude: f64) -> Result<[f64; 2], MissionError> {
    let is_place = |latitude: f64, longitude: f64| latitude.abs() <= 90.0 && longitude.abs() <= 180.0;
    for (what, [latitude, longitude]) in [("", [latitude, longitude]), ("home ", [home.latitude, home.longitude])] {
        if !is_place(latitude, longitude) {
            return Err(MissionError(format!(
                "{what}{latitude}, {longitude} is no latitude and longitude in degrees"
            )));
        }
    }
    let [north, east] = home.local([latitude, longitude], altitude);
    if north.hypot(east) > FURTHEST {
        let away = 1e-3 * north.hypot(east);
        return Err(MissionError(format!("{latitude}, {longitude} is {away:.0} km from home: at most 100")));
    }
    Ok([north, east])
}

/// From home, m.
const FURTHEST: f64 = 1e5;
