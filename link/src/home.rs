//! Where on the earth N has its origin, and where in N a place of the earth is.

use controller::Real;

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

impl Home {
    /// Latitude and longitude, 1e-7 degrees, of the place at n1 and n2, m, in the height of home:
    /// what [`local`](Self::local) takes back there. By the second order of n1 and n2, in single
    /// precision beside home, for it is made while a controller waits: 5 km from a home within 60°
    /// of the equator it is off by less than 2 cm.
    #[must_use]
    pub fn place(&self, [n1, n2]: [f32; 2]) -> [i32; 2] {
        let (sin, cos) = Real::sin_cos(self.latitude.to_radians() as f32);
        let short = 1.0 - ECCENTRICITY as f32 * sin * sin;
        let height = self.altitude as f32;
        // Radii of curvature, along the meridian and across it.
        let across = RADIUS as f32 / Real::sqrt(short);
        let along = across * (1.0 - ECCENTRICITY as f32) / short + height;
        let across = across + height;
        let tan = sin / cos;
        let north = n1 / along - 0.5 * tan * n2 * n2 / (along * across);
        let east = n2 / (across * cos) * (1.0 + tan * n1 / across);
        let step = |degrees: f64, radians: f32| {
            let steps = libm::round(degrees * 1e7) as i64 + libm::roundf(radians.to_degrees() * 1e7) as i64;
            let turn = 3_600_000_000;
            ((steps + turn / 2).rem_euclid(turn) - turn / 2) as i32
        };
        [step(self.latitude, north), step(self.longitude, east)]
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
