//! Where a flight stays, and what it keeps out of: load, UAV and the cable between them.

use controller::Vector3;
use serde::Deserialize;

use super::probe::length;
use super::{Place, Report};
use crate::describe::input::{Invalid, all_within, join, within};

/// Regions with the distance that is kept from their edges.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Fence {
    /// m.
    #[serde(default = "one_metre")]
    pub margin_m: f64,
    /// To stay in, each of them.
    #[serde(default)]
    pub inside: Vec<Region>,
    /// To keep out of.
    #[serde(default)]
    pub outside: Vec<Region>,
}

/// From one look at the cable to the next, m: what it passes between them is 0.3 mm nearer, at 1 m.
const STEP: f64 = 0.05;

/// For what the law leaves of gusts, and somewhat more.
fn one_metre() -> f64 {
    1.0
}

/// A polygon or a cylinder, from one height to another.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Corners, n1 and n2, m, in either order.
    polygon: Option<Vec<[f64; 2]>>,
    /// Of a cylinder, n1 and n2, m.
    center: Option<[f64; 2]>,
    /// Of a cylinder, m.
    radius: Option<f64>,
    /// From and to, above the origin of N, m; all heights if left out.
    up_m: Option<[f64; 2]>,
}

/// A place where the fence is not kept.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{what} {}: {distance:.2} m from it where {margin:.2} m are to be kept, at {place}", if *.is_inside { "leaves the fence" } else { "enters a keep-out" })]
pub struct Breach {
    /// The load, the UAV or the cable.
    pub what: &'static str,
    /// Of a region to stay in.
    pub is_inside: bool,
    /// Which, counted from 0.
    pub region: usize,
    /// How far inside, or outside, of it, m; negative beyond its edge.
    pub distance: f64,
    /// What was to be kept, m.
    pub margin: f64,
    /// Where the load is then.
    pub place: Place,
}

impl Fence {
    /// Checks the numbers; `at` is the field's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is out of range.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        within(&join(at, "margin_m"), self.margin_m, 0.0..=1e3)?;
        for (name, regions) in [("inside", &self.inside), ("outside", &self.outside)] {
            for (index, region) in regions.iter().enumerate() {
                region.check(&join(at, &format!("{name}[{index}]")))?;
            }
        }
        Ok(())
    }

    /// The worst place of each leg and region where load, UAV or cable are nearer to its edge than
    /// the margin.
    #[must_use]
    pub fn breaches(&self, report: &Report) -> Vec<Breach> {
        let mut worst: Vec<Breach> = Vec::new();
        let nodes = report.lap.nodes();
        let pairs = nodes.iter().zip(&report.uavs);
        for (index, (node, uav)) in pairs.enumerate() {
            let (next, next_uav) = nodes.get(index + 1).map_or((node, uav), |next| (next, &report.uavs[index + 1]));
            // The two bodies' ways are as good as straight between nodes; the cable goes sideways.
            let steps = (length(&(next.position() - node.position())) / STEP).ceil().max(1.0);
            let between =
                |from: &Vector3<f64>, to: &Vector3<f64>, step: u32| from + (to - from) * (f64::from(step) / steps);
            let cables = (0..steps as u32).map(|step| {
                ("the cable", [between(&node.position(), &next.position(), step), between(uav, next_uav, step)])
            });
            let bodies = [("the load", [node.position(), next.position()]), ("the UAV", [*uav, *next_uav])];
            let ways: Vec<_> = bodies.into_iter().chain(cables).collect();
            let regions = self.inside.iter().map(|region| (true, region)).enumerate();
            for (region, (is_inside, shape)) in
                regions.chain(self.outside.iter().map(|region| (false, region)).enumerate())
            {
                for &(what, way) in &ways {
                    let distance = shape.distance(&way, is_inside);
                    // On the edge is over it.
                    if distance > self.margin_m {
                        continue;
                    }
                    let breach =
                        Breach { what, is_inside, region, distance, margin: self.margin_m, place: node.place() };
                    let same = |other: &&mut Breach| {
                        (other.is_inside, other.region, other.place.leg) == (is_inside, region, node.leg)
                    };
                    match worst.iter_mut().find(same) {
                        Some(known) if known.distance <= distance => {}
                        Some(known) => *known = breach,
                        None => worst.push(breach),
                    }
                }
            }
        }
        worst
    }
}

impl Region {
    fn check(&self, at: &str) -> Result<(), Invalid> {
        match (&self.polygon, self.center, self.radius) {
            (Some(corners), None, None) => {
                within(&join(at, "polygon.len"), corners.len(), 3..=10_000)?;
                for (index, corner) in corners.iter().enumerate() {
                    all_within(&join(at, &format!("polygon[{index}]")), *corner, 1e5)?;
                }
            }
            (None, Some(center), Some(radius)) => {
                all_within(&join(at, "center"), center, 1e5)?;
                within(&join(at, "radius"), radius, 0.01..=1e5)?;
            }
            _ => return Err(Invalid::new(at, "give either polygon, or center and radius")),
        }
        if let Some([low, high]) = self.up_m {
            within(&join(at, "up_m[0]"), low, -1e5..=1e5)?;
            within(&join(at, "up_m[1]"), high, low..=1e5)?;
        }
        Ok(())
    }

    /// How far all of a straight way is inside, or outside, m.
    fn distance(&self, way: &[Vector3<f64>; 2], is_inside: bool) -> f64 {
        let [from, to] = way.map(|point| [point.x, point.y]);
        let from_edge = match (&self.polygon, self.center, self.radius) {
            (Some(corners), ..) => {
                let next = corners.iter().cycle().skip(1);
                let edges = corners.iter().zip(next).map(|(a, b)| between([from, to], [*a, *b]));
                let least = edges.fold(f64::INFINITY, f64::min);
                // A way that crosses the edge is at no distance from it.
                if contains(corners, from) { least } else { -least }
            }
            (None, Some(center), Some(radius)) if is_inside => {
                radius - [from, to].map(|point| size(less(point, center))).into_iter().fold(0.0, f64::max)
            }
            (None, Some(center), Some(radius)) => radius - to_way(center, [from, to]),
            // Refused where it was read.
            _ => f64::INFINITY,
        };
        let [low, high] = self.up_m.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let ups = way.map(|point| -point.z);
        let (least, most) = (ups[0].min(ups[1]), ups[0].max(ups[1]));
        if is_inside {
            from_edge.min(least - low).min(high - most)
        } else {
            (-from_edge).max(low - most).max(least - high)
        }
    }
}

fn less([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a - c, b - d]
}

fn size([a, b]: [f64; 2]) -> f64 {
    a.hypot(b)
}

fn turn([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * d - b * c
}

/// Distance of a point from a straight way.
fn to_way(point: [f64; 2], [from, to]: [[f64; 2]; 2]) -> f64 {
    let (chord, [x, y]) = (less(to, from), less(point, from));
    let square = chord[0] * chord[0] + chord[1] * chord[1];
    let along = if square > 0.0 { ((x * chord[0] + y * chord[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    size([x - chord[0] * along, y - chord[1] * along])
}

/// Distance of two straight ways, 0 where they cross.
fn between(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> f64 {
    let side = |[from, to]: [[f64; 2]; 2], point| turn(less(to, from), less(point, from));
    let parted = |way: [[f64; 2]; 2], ends: [[f64; 2]; 2]| side(way, ends[0]) * side(way, ends[1]) < 0.0;
    if parted(one, other) && parted(other, one) {
        return 0.0;
    }
    let ends = [(one[0], other), (one[1], other), (other[0], one), (other[1], one)];
    ends.into_iter().map(|(point, way)| to_way(point, way)).fold(f64::INFINITY, f64::min)
}

/// Whether a point lies within a polygon: by how many edges are to one side of it.
fn contains(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crossed = corners
        .iter()
        .zip(next)
        .filter(|([ax, ay], [bx, by])| (*ay > y) != (*by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax);
    crossed.count() % 2 == 1
}
