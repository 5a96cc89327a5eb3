//! The paths that are measured, each with points of it to draw states around. Parameters are the
//! controller's at run time.

use core::f32::consts::PI;

use controller::{
    AlongTangent, Bent, Circle, Curve, Ellipse, Formula, FourierPath, Harmonics, Knot, Linear, Path, Real, Route,
    RoutePace, RouteTable, Run, Vector3, Waypoint, build_route,
};

use crate::Random;

/// Half-axes of the curves, m.
const A: f32 = 5.0;
const B: f32 = 4.0;
/// Height, m, and slope of the ellipse.
const P3: f32 = -10.0;
const SLOPE: f32 = 0.3;
/// Speed, m/s, and how much of it the bent curve changes with p1/a.
const SPEED: f32 = 1.5;
const SPEED_CHANGE: f32 = 0.5;

/// The paper's circle, yaw 0.
pub fn circle() -> Option<impl Path<f32>> {
    Circle::new(A, P3).ok()?.at_speed(1.0).ok()
}

/// The tilted ellipse, yaw along it.
pub fn ellipse() -> Option<impl Path<f32>> {
    Some(Ellipse::new(A, B, P3, SLOPE).ok()?.at_speed(SPEED).ok()?.with_yaw(AlongTangent))
}

/// The bent curve, speed and yaw changing with p1.
pub fn bent() -> Option<impl Path<f32>> {
    let along_p1 = |value, slope| Linear::new(value, Vector3::new(slope, 0.0, 0.0)).ok().map(Formula);
    let (speed, yaw) = (along_p1(SPEED, SPEED_CHANGE / A)?, along_p1(0.0, 0.2)?);
    Some(Bent::new(A, B, P3).ok()?.with_speed(speed).with_yaw(yaw))
}

/// A knotted loop of eight harmonics, yaw along it.
pub fn fourier8() -> Option<impl Path<f32>> {
    Some(FourierPath::new(KNOT).ok()?.at_speed(SPEED).ok()?.with_yaw(AlongTangent))
}

/// A trefoil as a route.
pub fn route() -> Option<impl Path<f32>> {
    let waypoints: [Waypoint<f32>; TREFOIL] = core::array::from_fn(|i| Waypoint {
        point: trefoil(i as f32 * (2.0 * PI / TREFOIL as f32)).into(),
        corner: None,
        speed: SPEED,
        yaw: None,
        stop: None,
    });
    // A closed route repeats its first seven knots.
    let mut table = RouteTable { knots: [Knot::default(); TREFOIL + 7], runs: [Run::default(); 1] };
    build_route(&waypoints, true, &RoutePace::default(), &mut table.knots, &mut table.runs).ok()?;
    Route::new(table).ok()
}

/// Waypoints of the trefoil.
const TREFOIL: usize = 48;

fn trefoil(angle: f32) -> Vector3<f32> {
    let ((sin_2, cos_2), (sin_3, cos_3)) = (Real::sin_cos(2.0 * angle), Real::sin_cos(3.0 * angle));
    let radius = A + 2.0 * cos_3;
    Vector3::new(radius * cos_2, radius * sin_2, P3 + 1.5 * sin_3)
}

/// A point of the trefoil.
pub fn on_route(random: &mut Random) -> Vector3<f32> {
    trefoil(random.around_zero(PI))
}

/// Eight harmonics that fall off as a fitted loop's do.
const KNOT: Harmonics<f32, 8> = Harmonics {
    center: [0.0, 0.0, P3],
    cos: [
        [8.0, 0.0, 0.3],
        [0.0, 0.6, 0.5],
        [0.4, 0.0, 0.2],
        [0.0, 0.1, 0.0],
        [0.05, 0.0, 0.02],
        [0.0, 0.02, 0.0],
        [0.01, 0.0, 0.01],
        [0.0, 0.005, 0.0],
    ],
    sin: [
        [0.0, 7.0, 0.0],
        [0.6, 0.0, -0.3],
        [0.0, 0.3, 0.1],
        [0.1, 0.0, 0.05],
        [0.0, -0.05, 0.0],
        [0.02, 0.0, 0.01],
        [0.0, 0.01, 0.0],
        [0.005, 0.0, 0.0],
    ],
    reference: [0.0, 0.0, 1.0],
};

/// A point of the circle.
pub fn on_circle(random: &mut Random) -> Vector3<f32> {
    let (sin, cos) = angle(random);
    Vector3::new(A * cos, A * sin, P3)
}

/// A point of the ellipse.
pub fn on_ellipse(random: &mut Random) -> Vector3<f32> {
    let (sin, cos) = angle(random);
    Vector3::new(A * cos, B * sin, P3 + SLOPE * A * cos)
}

/// A point of the bent curve.
pub fn on_bent(random: &mut Random) -> Vector3<f32> {
    let (sin, cos) = angle(random);
    // x⁴ + y⁴ = 1 along the direction of the angle.
    let (sin_2, cos_2) = (sin * sin, cos * cos);
    let scale = 1.0 / Real::sqrt(Real::sqrt(sin_2 * sin_2 + cos_2 * cos_2));
    let p1 = A * cos * scale;
    let (wave, _) = (0.5 * p1).sin_cos();
    Vector3::new(p1, B * sin * scale, P3 + 0.5 * wave)
}

/// A point of the loop of eight harmonics.
pub fn on_fourier8(random: &mut Random) -> Vector3<f32> {
    KNOT.point(random.around_zero(PI))
}

fn angle(random: &mut Random) -> (f32, f32) {
    Real::sin_cos(random.around_zero(PI))
}
