//! Missions of ground stations and maps, as waypoints of N.
//!
//! A file says where on the earth, and above what; [`Mission::local`] makes metres of it about a
//! home, where N has its origin, by [`Home::local`]. What MAVLink's files hold are the items that a
//! ground station sends: the flight program itself reads them, so that what is made of such a file
//! is what a vehicle flies of it.

pub mod columns;
pub mod csv;
pub mod map;
pub mod mavlink;
mod written;

pub use written::{c, rust, toml};

pub use link::Home;

use autopilot::{Course, Setting, Settings};
use controller::Waypoint;

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

/// A mission as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub enum Mission {
    /// Items of MAVLink's, which mean what they mean to the flight program.
    Items(mavlink::Items),
    /// Lines and areas on a map, or points of a table.
    Map(map::Map),
}

/// What a mission's file does not say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defaults {
    /// m/s.
    pub speed: f64,
    /// m.
    pub corner_m: f64,
    /// The last waypoint leads back to the first.
    pub is_closed: bool,
}

impl Default for Defaults {
    /// As the flight program has them.
    fn default() -> Self {
        let settings = Settings::default();
        let [speed, corner_m] = [Setting::MISSION_SPEED, Setting::MISSION_CORNER].map(|number| settings.get(number));
        Self { speed: speed.into(), corner_m: corner_m.into(), is_closed: false }
    }
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

/// A mission in N.
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// The home, if there is one.
    pub home: Option<Home>,
    /// Waypoints, no two in a row at the same place.
    pub waypoints: Vec<Waypoint<f64>>,
    /// How it ends.
    pub course: Course,
    /// Regions to stay in; or else, not to enter.
    pub regions: Vec<(bool, LocalEdge)>,
    /// What was passed over, and what a vehicle would refuse.
    pub notes: Vec<String>,
}

/// An edge in N, m.
#[derive(Clone, Debug, PartialEq)]
pub enum LocalEdge {
    /// By its corners, n1 and n2.
    Polygon(Vec<[f64; 2]>),
    /// By its centre, n1 and n2, and radius.
    Circle([f64; 2], f64),
}

/// Reads a mission: a QGroundControl plan, MAVLink waypoints (`QGC WPL 110`), KML, GPX, GeoJSON, or
/// a table. What it is shows in its text.
///
/// # Errors
/// [`MissionError`] names the item and what it says that no route can have.
pub fn read(file: &str, text: &str) -> Result<Mission, MissionError> {
    let text = text.trim_start_matches('\u{feff}');
    let begin: String = text.trim_start().chars().take(2000).collect();
    if begin.starts_with("QGC WPL") {
        mavlink::waypoints(text).map(Mission::Items)
    } else if begin.starts_with('<') && begin.contains("<gpx") {
        map::gpx(text).map(Mission::Map)
    } else if begin.starts_with('<') {
        map::kml(text).map(Mission::Map)
    } else if begin.starts_with(['{', '[']) {
        let value: serde_json::Value = serde_json::from_str(text).map_err(MissionError::new)?;
        if value.get("fileType").is_some_and(|kind| kind == "Plan") {
            mavlink::plan(&value).map(Mission::Items)
        } else if value.get("type").is_none() {
            Err(MissionError("neither a plan, with \"fileType\": \"Plan\", nor GeoJSON, with a \"type\"".to_owned()))
        } else {
            map::geojson(text).map(Mission::Map)
        }
    } else {
        map::table(file, text).map(Mission::Map)
    }
}

impl Mission {
    /// The mission in N about `home`, or else the file's own; where it counts heights above the
    /// ground, that is `terrain` m above the sea everywhere.
    ///
    /// # Errors
    /// There is no home where one is needed, or no terrain; a place is none on the earth, or farther
    /// than 100 km away; or items make no route, by the first that is at fault.
    pub fn local(
        &self,
        home: Option<Home>,
        terrain: Option<f64>,
        defaults: &Defaults,
    ) -> Result<Local, MissionError> {
        match self {
            Self::Items(items) => items.local(home, terrain, defaults),
            Self::Map(map) => map.local(home, terrain, defaults),
        }
    }
}

/// Of a home that is missing.
const NO_HOME: &str = "the file says where on the earth, but no home: give --home LAT,LON,ALT";
/// Of a ground that is not known.
const NO_TERRAIN: &str = "its height is above the terrain, which is not known: give --terrain METRES above the sea";

/// A home that is one.
fn placed(home: Home) -> Result<Home, MissionError> {
    let Home { latitude, longitude, .. } = home;
    if is_place([latitude, longitude]) {
        return Ok(home);
    }
    Err(MissionError(format!("home {latitude}, {longitude} is no latitude and longitude in degrees")))
}

fn is_place([latitude, longitude]: [f64; 2]) -> bool {
    latitude.abs() <= 90.0 && longitude.abs() <= 180.0
}
