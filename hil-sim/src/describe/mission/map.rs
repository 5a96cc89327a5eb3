//! Missions drawn on a map, KML, GPX and GeoJSON, or listed in a table. Lines and points are flown
//! in the file's order, polygons are what the flight stays in.

use autopilot::Course;
use controller::{Vector3, Waypoint};
use geojson::{GeoJson, GeometryValue};
use kml::types::{AltitudeMode, Coord, Geometry};
use kml::{Kml, KmlReader};
use quick_xml::events::Event;

use super::{Defaults, Home, Local, LocalEdge, MissionError, NO_HOME, NO_TERRAIN, csv, is_place, placed};

/// Where a point is, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spot {
    /// Latitude and longitude, degrees.
    Earth([f64; 2]),
    /// n1 and n2, m.
    Local([f64; 2]),
}

/// Above what a point is, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Height {
    /// The sea.
    Amsl(f64),
    /// The home.
    Relative(f64),
    /// The ground under it.
    Terrain(f64),
}

/// What a map or a table says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map {
    /// The home, where the file says it.
    pub home: Option<Home>,
    /// Points, in the order flown.
    pub points: Vec<(Spot, Height)>,
    /// Polygons to stay in, by their corners' latitudes and longitudes, degrees.
    pub inside: Vec<Vec<[f64; 2]>>,
    /// What was passed over.
    pub notes: Vec<String>,
}

/// Points nearer than this are one, m: no leg is shorter.
const SAME: f64 = controller::SHORTEST_LEG;
/// From home, m.
const FURTHEST: f64 = 1e5;

impl Map {
    /// The map in N, as [`Mission::local`](super::Mission::local).
    pub(super) fn local(
        &self,
        home: Option<Home>,
        terrain: Option<f64>,
        defaults: &Defaults,
    ) -> Result<Local, MissionError> {
        let home = home.or(self.home).map(placed).transpose()?;
        let needed = || home.ok_or_else(|| MissionError(NO_HOME.to_owned()));
        let mut waypoints: Vec<Waypoint<f64>> = Vec::new();
        for (index, (spot, height)) in self.points.iter().enumerate() {
            let named = |error: MissionError| MissionError(format!("point {}: {error}", index + 1));
            let up = match height {
                Height::Relative(up) => *up,
                Height::Amsl(altitude) => altitude - needed().map_err(named)?.altitude,
                Height::Terrain(above) => {
                    let ground = terrain.ok_or_else(|| named(MissionError(NO_TERRAIN.to_owned())))?;
                    ground + above - needed().map_err(named)?.altitude
                }
            };
            let [n1, n2] = match spot {
                Spot::Local(place) => *place,
                Spot::Earth(place) => {
                    needed().and_then(|home| from_home(home, *place, home.altitude + up)).map_err(named)?
                }
            };
            let point = [n1, n2, 0.0 - up];
            let is_same = |before: &Waypoint<f64>| {
                let away = Vector3::from(before.point) - Vector3::from(point);
                away.dot(&away) < SAME * SAME
            };
            if !waypoints.last().is_some_and(is_same) {
                let Defaults { speed, corner_m, .. } = *defaults;
                waypoints.push(Waypoint { point, corner: Some(corner_m), speed, yaw: None, stop: None });
            }
        }
        if waypoints.len() < 2 {
            return Err(MissionError("all points are one where a route needs at least 2".to_owned()));
        }
        let polygon = |corners: &Vec<[f64; 2]>| {
            let corner = |place: &[f64; 2]| needed().and_then(|home| from_home(home, *place, home.altitude));
            Ok((true, LocalEdge::Polygon(corners.iter().map(corner).collect::<Result<_, MissionError>>()?)))
        };
        let regions = self.inside.iter().map(polygon).collect::<Result<_, MissionError>>()?;
        let course = Course { is_closed: defaults.is_closed, ..Course::default() };
        Ok(Local { home, waypoints, course, regions, notes: self.notes.clone() })
    }

    /// With as many points as a route needs.
    fn checked(self) -> Result<Self, MissionError> {
        match self.points.len() {
            count @ 0..2 => Err(MissionError(format!("{count} points to fly to where a route needs at least 2"))),
            _ => Ok(self),
        }
    }
}

/// n1 and n2 of a place of the earth, m.
fn from_home(home: Home, [latitude, longitude]: [f64; 2], altitude: f64) -> Result<[f64; 2], MissionError> {
    if !is_place([latitude, longitude]) {
        return Err(MissionError(format!("{latitude}, {longitude} is no latitude and longitude in degrees")));
    }
    let [north, east] = home.local([latitude, longitude], altitude);
    if north.hypot(east) > FURTHEST {
        let away = 1e-3 * north.hypot(east);
        return Err(MissionError(format!("{latitude}, {longitude} is {away:.0} km from home: at most 100")));
    }
    Ok([north, east])
}

/// A table: its points in the order flown.
pub fn table(file: &str, text: &str) -> Result<Map, MissionError> {
    // Whoever asks names the file.
    let within = |csv::PointsError { line, column, message, .. }| {
        let column = column.map_or(String::new(), |column| format!("column {column}: "));
        MissionError(format!("line {line}: {column}{message}"))
    };
    let csv::Rows { columns, rows } = csv::rows(file, text, 100_000).map_err(within)?;
    let points = rows.iter().map(|(_, point)| columns.spot(point)).collect();
    Map { points, notes: vec![format!("columns: {columns}")], ..Map::default() }.checked()
}

/// KML: placemarks' lines and points; one that is named home is that.
pub fn kml(text: &str) -> Result<Map, MissionError> {
    closed(text)?;
    let read: Kml<f64> = KmlReader::from_string(text).read().map_err(MissionError::new)?;
    let mut map = Map::default();
    take_kml(&read, &mut map)?;
    map.checked()
}

/// That whatever is opened in an XML text is closed: KML's reader looks for that for ever.
fn closed(text: &str) -> Result<(), MissionError> {
    let mut reader = quick_xml::Reader::from_str(text);
    let mut open = 0_usize;
    loop {
        match reader.read_event().map_err(MissionError::new)? {
            Event::Start(_) => open += 1,
            Event::End(_) => open = open.saturating_sub(1),
            Event::Eof if open == 0 => return Ok(()),
            Event::Eof => return Err(MissionError("the file ends before its last element does".to_owned())),
            _ => {}
        }
    }
}

fn take_kml(element: &Kml<f64>, map: &mut Map) -> Result<(), MissionError> {
    match element {
        Kml::KmlDocument(document) => document.elements.iter().try_for_each(|element| take_kml(element, map)),
        Kml::Document { elements, .. } => elements.iter().try_for_each(|element| take_kml(element, map)),
        Kml::Folder(folder) => folder.elements.iter().try_for_each(|element| take_kml(element, map)),
        Kml::Placemark(placemark) => {
            let name = placemark.name.as_deref().unwrap_or("a placemark");
            let Some(geometry) = &placemark.geometry else { return Ok(()) };
            match geometry {
                Geometry::Point(point) if name.eq_ignore_ascii_case("home") => {
                    let Coord { x: longitude, y: latitude, z } = point.coord;
                    map.home = Some(Home { latitude, longitude, altitude: z.unwrap_or(0.0) });
                    Ok(())
                }
                geometry => take_geometry(geometry, name, map),
            }
        }
        Kml::Point(point) => take_geometry(&Geometry::Point(point.clone()), "a point", map),
        Kml::LineString(line) => take_geometry(&Geometry::LineString(line.clone()), "a line", map),
        Kml::Polygon(polygon) => take_geometry(&Geometry::Polygon(polygon.clone()), "a polygon", map),
        _ => Ok(()),
    }
}

fn take_geometry(geometry: &Geometry<f64>, name: &str, map: &mut Map) -> Result<(), MissionError> {
    let mut fly = |coords: &[Coord<f64>], mode: &AltitudeMode| {
        for Coord { x: longitude, y: latitude, z } in coords {
            let height = match (mode, z) {
                (AltitudeMode::Absolute, Some(z)) => Height::Amsl(*z),
                (AltitudeMode::RelativeToGround, Some(z)) => Height::Terrain(*z),
                (AltitudeMode::Absolute | AltitudeMode::RelativeToGround, None) => {
                    return Err(MissionError(format!("{name}: a coordinate without altitude")));
                }
                _ => {
                    let message = "its altitudeMode is clampToGround, so that it has no height: absolute has one";
                    return Err(MissionError(format!("{name}: {message}")));
                }
            };
            map.points.push((Spot::Earth([*latitude, *longitude]), height));
        }
        Ok(())
    };
    match geometry {
        Geometry::Point(point) => fly(std::slice::from_ref(&point.coord), &point.altitude_mode),
        Geometry::LineString(line) => fly(&line.coords, &line.altitude_mode),
        Geometry::LinearRing(ring) => fly(&ring.coords, &ring.altitude_mode),
        Geometry::Polygon(polygon) => {
            let corners = polygon.outer.coords.iter().map(|coord| [coord.y, coord.x]);
            map.inside.push(polygon_of(corners.collect()));
            Ok(())
        }
        Geometry::MultiGeometry(many) => {
            many.geometries.iter().try_for_each(|geometry| take_geometry(geometry, name, map))
        }
        _ => {
            map.notes.push(format!("{name}: passed over"));
            Ok(())
        }
    }
}

/// A polygon without the last corner that repeats the first.
fn polygon_of(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

/// GPX: its routes, or else its tracks, or else its waypoints; a waypoint that is named home is
/// that. Elevations are above the sea.
pub fn gpx(text: &str) -> Result<Map, MissionError> {
    let read = gpx::read(text.as_bytes()).map_err(MissionError::new)?;
    let mut map = Map::default();
    let is_home =
        |waypoint: &&gpx::Waypoint| waypoint.name.as_deref().is_some_and(|name| name.eq_ignore_ascii_case("home"));
    if let Some(home) = read.waypoints.iter().find(is_home) {
        let (longitude, latitude) = home.point().x_y();
        map.home = Some(Home { latitude, longitude, altitude: home.elevation.unwrap_or(0.0) });
    }
    let routes: Vec<&gpx::Waypoint> = read.routes.iter().flat_map(|route| &route.points).collect();
    let segments = read.tracks.iter().flat_map(|track| &track.segments);
    let tracks: Vec<&gpx::Waypoint> = segments.flat_map(|segment| &segment.points).collect();
    let waypoints = read.waypoints.iter().filter(|waypoint| !is_home(waypoint)).collect();
    let flown = [routes, tracks, waypoints].into_iter().find(|points| !points.is_empty()).unwrap_or_default();
    for (index, waypoint) in flown.into_iter().enumerate() {
        let (longitude, latitude) = waypoint.point().x_y();
        let elevation =
            waypoint.elevation.ok_or_else(|| MissionError(format!("point {}: it has no elevation", index + 1)))?;
        map.points.push((Spot::Earth([latitude, longitude]), Height::Amsl(elevation)));
    }
    map.checked()
}

/// GeoJSON: lines and points of three numbers, longitude, latitude and height.
pub fn geojson(text: &str) -> Result<Map, MissionError> {
    let read: GeoJson = text.parse().map_err(MissionError::new)?;
    let mut map = Map::default();
    match &read {
        GeoJson::Geometry(geometry) => take_json(&geometry.value, &mut map)?,
        GeoJson::Feature(feature) => take_feature(feature, &mut map)?,
        GeoJson::FeatureCollection(collection) => {
            collection.features.iter().try_for_each(|feature| take_feature(feature, &mut map))?;
        }
    }
    map.checked()
}

fn take_feature(feature: &geojson::Feature, map: &mut Map) -> Result<(), MissionError> {
    let Some(geometry) = &feature.geometry else { return Ok(()) };
    let name = feature.property("name").and_then(serde_json::Value::as_str);
    if let (true, GeometryValue::Point { coordinates }) =
        (name.is_some_and(|name| name.eq_ignore_ascii_case("home")), &geometry.value)
    {
        let altitude = coordinates.as_slice().get(2).copied().unwrap_or(0.0);
        let [latitude, longitude] = corner(coordinates)?;
        map.home = Some(Home { latitude, longitude, altitude });
        return Ok(());
    }
    take_json(&geometry.value, map)
}

/// Latitude and longitude of a position.
fn corner(position: &geojson::Position) -> Result<[f64; 2], MissionError> {
    match *position.as_slice() {
        [longitude, latitude, ..] => Ok([latitude, longitude]),
        _ => Err(MissionError("a position without longitude and latitude".to_owned())),
    }
}

fn take_json(geometry: &GeometryValue, map: &mut Map) -> Result<(), MissionError> {
    let item = |position: &geojson::Position| match *position.as_slice() {
        [longitude, latitude, altitude, ..] => Ok((Spot::Earth([latitude, longitude]), Height::Amsl(altitude))),
        _ => Err(MissionError("a position without its third number, the height".to_owned())),
    };
    match geometry {
        GeometryValue::Point { coordinates } => map.points.push(item(coordinates)?),
        GeometryValue::LineString { coordinates } | GeometryValue::MultiPoint { coordinates } => {
            for position in coordinates {
                map.points.push(item(position)?);
            }
        }
        GeometryValue::MultiLineString { coordinates } => {
            for position in coordinates.iter().flatten() {
                map.points.push(item(position)?);
            }
        }
        GeometryValue::Polygon { coordinates } => {
            let outer = coordinates.first().into_iter().flatten();
            let corners: Result<_, MissionError> = outer.map(corner).collect();
            map.inside.push(polygon_of(corners?));
        }
        GeometryValue::GeometryCollection { geometries } => {
            geometries.iter().try_for_each(|geometry| take_json(&geometry.value, map))?;
        }
        other => map.notes.push(format!("{}: passed over", other.type_name())),
    }
    Ok(())
}
