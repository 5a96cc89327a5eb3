//! Where on the earth N has its origin, and where in N a place of the earth is.

/// The equator's radius and the first eccentricity squared of WGS 84's ellipsoid: m, and none.
const RADIUS: f64 = 6_378_137.0;
const ECCENTRICITY: f64 = 6.694_379_990_141_316e-3;

/// Where on the earth N has its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Home {
    /// Degrees, north positive.
    pub latitude: f64,
    /// Degrees, east positive.
    pub longitude: f64,
    /// m above the sea.
    pub altitude: f64,
}

impl Home {
    /// n1 and n2, m, of a latitude and longitude in degrees at an `altitude` in m above the sea: of
    /// its foot on the plane that touches WGS 84 at home. n3 is the difference of altitudes, as
    /// altimeters count it: in that plane a point 5 km away lies 2 m lower.
    ///
    /// Exact to rounding for altitudes above the ellipsoid; those above the sea, taken for these,
    /// lengthen 5 km by 8 cm at most, as in every autopilot.
    #[must_use]
    pub fn local(&self, place: [f64; 2], altitude: f64) -> [f64; 2] {
        let Self { latitude, longitude, altitude: ground } = *self;
        let [home, there] = [([latitude, longitude], ground), (place, altitude)].map(geocentric);
        let ([sin_lat, cos_lat], [sin_lon, cos_lon]) = (sin_cos(latitude), sin_cos(longitude));
        let [x, y, z] = [there[0] - home[0], there[1] - home[1], there[2] - home[2]];
        let outwards = cos_lon * x + sin_lon * y;
        [cos_lat * z - sin_lat * outwards, cos_lon * y - sin_lon * x]
    }
}

/// Cartesian, m, about the earth's centre.
fn geocentric(([latitude, longitude], altitude): ([f64; 2], f64)) -> [f64; 3] {
    let ([sin_lat, cos_lat], [sin_lon, cos_lon]) = (sin_cos(latitude), sin_cos(longitude));
    let radius = RADIUS / libm::sqrt(1.0 - ECCENTRICITY * sin_lat * sin_lat);
    let outwards = (radius + altitude) * cos_lat;
    [outwards * cos_lon, outwards * sin_lon, (radius * (1.0 - ECCENTRICITY) + altitude) * sin_lat]
}

fn sin_cos(degrees: f64) -> [f64; 2] {
    let radians = degrees.to_radians();
    [libm::sin(radians), libm::cos(radians)]
}
