//! Missions drawn on a map: KML, GPX and GeoJSON. Lines and points are flown in the file's order,
//! polygons are what the flight stays in.

use geojson::{GeoJson, GeometryValue};
use kml::types::{AltitudeMode, Coord, Geometry};
use kml::{Kml, KmlReader};

use super::{Edge, Height, Home, Item, Mission, MissionError, Region, Spot};

/// KML: placemarks' lines and points; one that is named home is that.
pub fn kml(text: &str) -> Result<Mission, MissionError> {
    let read: Kml<f64> = KmlReader::from_string(text).read().map_err(MissionError::new)?;
    let mut mission = Mission::default();
    take_kml(&read, &mut mission)?;
    Ok(mission)
}

fn take_kml(element: &Kml<f64>, mission: &mut Mission) -> Result<(), MissionError> {
    match element {
        Kml::KmlDocument(document) => document.elements.iter().try_for_each(|element| take_kml(element, mission)),
        Kml::Document { elements, .. } => elements.iter().try_for_each(|element| take_kml(element, mission)),
        Kml::Folder(folder) => folder.elements.iter().try_for_each(|element| take_kml(element, mission)),
        Kml::Placemark(placemark) => {
            let name = placemark.name.as_deref().unwrap_or("a placemark");
            let Some(geometry) = &placemark.geometry else { return Ok(()) };
            match geometry {
                Geometry::Point(point) if name.eq_ignore_ascii_case("home") => {
                    let Coord { x: longitude, y: latitude, z } = point.coord;
                    mission.home = Some(Home { latitude, longitude, altitude: z.unwrap_or(0.0) });
                    Ok(())
                }
                geometry => take_geometry(geometry, name, mission),
            }
        }
        Kml::Point(point) => take_geometry(&Geometry::Point(point.clone()), "a point", mission),
        Kml::LineString(line) => take_geometry(&Geometry::LineString(line.clone()), "a line", mission),
        Kml::Polygon(polygon) => take_geometry(&Geometry::Polygon(polygon.clone()), "a polygon", mission),
        _ => Ok(()),
    }
}

fn take_geometry(geometry: &Geometry<f64>, name: &str, mission: &mut Mission) -> Result<(), MissionError> {
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
            mission.items.push(Item::at(Spot::Earth([*latitude, *longitude]), height));
        }
        Ok(())
    };
    match geometry {
        Geometry::Point(point) => fly(std::slice::from_ref(&point.coord), &point.altitude_mode),
        Geometry::LineString(line) => fly(&line.coords, &line.altitude_mode),
        Geometry::LinearRing(ring) => fly(&ring.coords, &ring.altitude_mode),
        Geometry::Polygon(polygon) => {
            let corners = polygon.outer.coords.iter().map(|coord| Spot::Earth([coord.y, coord.x]));
            mission.regions.push(Region { is_inside: true, edge: polygon_of(corners.collect()) });
            Ok(())
        }
        Geometry::MultiGeometry(many) => {
            many.geometries.iter().try_for_each(|geometry| take_geometry(geometry, name, mission))
        }
        _ => {
            mission.notes.push(format!("{name}: passed over"));
            Ok(())
        }
    }
}

/// A polygon without the last corner that repeats the first.
fn polygon_of(mut corners: Vec<Spot>) -> Edge {
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    Edge::Polygon(corners)
}

/// GPX: its routes, or else its tracks, or else its waypoints; a waypoint that is named home is
/// that. Elevations are above the sea.
pub fn gpx(text: &str) -> Result<Mission, MissionError> {
    let read = gpx::read(text.as_bytes()).map_err(MissionError::new)?;
    let mut mission = Mission::default();
    let is_home =
        |waypoint: &&gpx::Waypoint| waypoint.name.as_deref().is_some_and(|name| name.eq_ignore_ascii_case("home"));
    if let Some(home) = read.waypoints.iter().find(is_home) {
        let (longitude, latitude) = home.point().x_y();
        mission.home = Some(Home { latitude, longitude, altitude: home.elevation.unwrap_or(0.0) });
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
        mission.items.push(Item::at(Spot::Earth([latitude, longitude]), Height::Amsl(elevation)));
    }
    Ok(mission)
}

/// GeoJSON: lines and points of three numbers, longitude, latitude and height.
pub fn geojson(text: &str) -> Result<Mission, MissionError> {
    let read: GeoJson = text.parse().map_err(MissionError::new)?;
    let mut mission = Mission::default();
    match &read {
        GeoJson::Geometry(geometry) => take_json(&geometry.value, &mut mission)?,
        GeoJson::Feature(feature) => take_feature(feature, &mut mission)?,
        GeoJson::FeatureCollection(collection) => {
            collection.features.iter().try_for_each(|feature| take_feature(feature, &mut mission))?;
        }
    }
    Ok(mission)
}

fn take_feature(feature: &geojson::Feature, mission: &mut Mission) -> Result<(), MissionError> {
    let Some(geometry) = &feature.geometry else { return Ok(()) };
    let name = feature.property("name").and_then(serde_json::Value::as_str);
    if let (true, GeometryValue::Point { coordinates }) =
        (name.is_some_and(|name| name.eq_ignore_ascii_case("home")), &geometry.value)
    {
        let altitude = coordinates.as_slice().get(2).copied().unwrap_or(0.0);
        mission.home = Some(Home { latitude: coordinates[1], longitude: coordinates[0], altitude });
        return Ok(());
    }
    take_json(&geometry.value, mission)
}

fn take_json(geometry: &GeometryValue, mission: &mut Mission) -> Result<(), MissionError> {
    let item = |position: &geojson::Position| match *position.as_slice() {
        [longitude, latitude, altitude, ..] => {
            Ok(Item::at(Spot::Earth([latitude, longitude]), Height::Amsl(altitude)))
        }
        _ => Err(MissionError("a position without its third number, the height".to_owned())),
    };
    match geometry {
        GeometryValue::Point { coordinates } => mission.items.push(item(coordinates)?),
        GeometryValue::LineString { coordinates } | GeometryValue::MultiPoint { coordinates } => {
            for position in coordinates {
                mission.items.push(item(position)?);
            }
        }
        GeometryValue::MultiLineString { coordinates } => {
            for position in coordinates.iter().flatten() {
                mission.items.push(item(position)?);
            }
        }
        GeometryValue::Polygon { coordinates } => {
            let outer = coordinates.first().into_iter().flatten();
            let corners = outer.map(|position| Spot::Earth([position[1], position[0]])).collect();
            mission.regions.push(Region { is_inside: true, edge: polygon_of(corners) });
        }
        GeometryValue::GeometryCollection { geometries } => {
            geometries.iter().try_for_each(|geometry| take_json(&geometry.value, mission))?;
        }
        other => mission.notes.push(format!("{}: passed over", other.type_name())),
    }
    Ok(())
}
