//! Regions to stay in or to keep out of, for load, UAV and the cable between them.

use model::Real;
use nalgebra::Vector3;

/// A region's edge, seen from above, in n1 and n2, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge<'a, T> {
    /// Its corners, in either order, at least three.
    Polygon(&'a [[T; 2]]),
    /// Centre and radius.
    Circle([T; 2], T),
}

/// A polygon or a cylinder, from one height to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region<'a, T> {
    /// To stay in; else to keep out of.
    pub is_inside: bool,
    /// Seen from above.
    pub edge: Edge<'a, T>,
    /// From and to, m above the origin of N; infinite for none.
    pub up: [T; 2],
}

impl<T: Real> Region<'_, T> {
    /// How much of `margin` the straight way `from` to `to` does not keep: its distance from the
    /// edge on the right side, m, negative on the wrong one, where that is at most `margin`. On the
    /// wrong side it is no farther than the way's nearest end is from the edge.
    ///
    /// ```
    /// use controller::{FenceEdge, FenceRegion, Vector3};
    /// let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
    /// let region = FenceRegion { is_inside: true, edge: FenceEdge::Polygon(&corners), up: [0.0, 50.0] };
    /// let cable = |x: f64| [Vector3::new(x, 5.0, -10.0), Vector3::new(x, 5.5, -12.0)];
    /// assert_eq!(region.breach(&cable(9.5), 1.0), Some(0.5));
    /// assert_eq!(region.breach(&cable(8.5), 1.0), None);
    /// ```
    pub fn breach(&self, way: &[Vector3<T>; 2], margin: T) -> Option<T> {
        let ups = way.map(|point| -point.z);
        let ([low, high], (least, most)) = (self.up, (ups[0].min(ups[1]), ups[0].max(ups[1])));
        let plan = way.map(|point| [point.x, point.y]);
        // A keep-out that is passed above or below needs no look at its edge.
        let beside = (low - most).max(least - high);
        let distance = if self.is_inside {
            self.inside(&plan, margin).min(least - low).min(high - most)
        } else if beside > margin {
            beside
        } else {
            beside.max(self.outside(&plan, margin))
        };
        // A distance that is no number keeps nothing.
        (!distance.is_finite() || distance <= margin).then_some(distance)
    }

    fn inside(&self, plan: &[[T; 2]; 2], margin: T) -> T {
        match self.edge {
            Edge::Polygon(corners) => {
                let is_right = contains(corners, plan[0]);
                let least = to_edges(corners, plan, is_right.then_some(margin));
                if is_right { least } else { -least }
            }
            Edge::Circle(center, radius) => {
                let [from, to] = plan.map(|point| size(less(point, center)));
                radius - from.max(to)
            }
        }
    }

    fn outside(&self, plan: &[[T; 2]; 2], margin: T) -> T {
        match self.edge {
            Edge::Polygon(corners) => {
                let is_right = !contains(corners, plan[0]);
                let least = to_edges(corners, plan, is_right.then_some(margin));
                if is_right { least } else { -least }
            }
            Edge::Circle(center, radius) => to_way(center, plan) - radius,
        }
    }
}

/// The least distance of a way from a polygon's edges; where more than `enough`, something more.
fn to_edges<T: Real>(corners: &[[T; 2]], way: &[[T; 2]; 2], enough: Option<T>) -> T {
    let next = corners.iter().cycle().skip(1);
    let least = enough.map_or(T::lit(1e9), |enough| enough + enough + T::one());
    corners.iter().zip(next).fold(least, |least, (a, b)| {
        let edge = [*a, *b];
        // How far their boxes are apart, which costs less.
        let apart = |axis: fn(&[T; 2]) -> T| {
            let span = |[a, b]: &[[T; 2]; 2]| (axis(a).min(axis(b)), axis(a).max(axis(b)));
            let ((low, high), (other_low, other_high)) = (span(way), span(&edge));
            (low - other_high).max(other_low - high)
        };
        if apart(|[x, _]| *x).max(apart(|[_, y]| *y)) >= least { least } else { least.min(between(way, &edge)) }
    })
}

fn less<T: Real>([a, b]: [T; 2], [c, d]: [T; 2]) -> [T; 2] {
    [a - c, b - d]
}

fn size<T: Real>([a, b]: [T; 2]) -> T {
    (a * a + b * b).sqrt()
}

fn turn<T: Real>([a, b]: [T; 2], [c, d]: [T; 2]) -> T {
    a * d - b * c
}

/// Distance of a point from a straight way.
fn to_way<T: Real>(point: [T; 2], &[from, to]: &[[T; 2]; 2]) -> T {
    let (chord, [x, y]) = (less(to, from), less(point, from));
    let square = chord[0] * chord[0] + chord[1] * chord[1];
    let along = if square > T::zero() {
        ((x * chord[0] + y * chord[1]) / square).clamp(T::zero(), T::one())
    } else {
        T::zero()
    };
    size([x - chord[0] * along, y - chord[1] * along])
}

/// Distance of two straight ways, 0 where they cross.
fn between<T: Real>(one: &[[T; 2]; 2], other: &[[T; 2]; 2]) -> T {
    let side = |[from, to]: &[[T; 2]; 2], point| turn(less(*to, *from), less(point, *from));
    let parted = |way, ends: &[[T; 2]; 2]| side(way, ends[0]) * side(way, ends[1]) < T::zero();
    if parted(one, other) && parted(other, one) {
        return T::zero();
    }
    to_way(one[0], other).min(to_way(one[1], other)).min(to_way(other[0], one)).min(to_way(other[1], one))
}

/// Whether a point lies within a polygon: by how many edges are to one side of it.
fn contains<T: Real>(corners: &[[T; 2]], [x, y]: [T; 2]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crosses = |&([ax, ay], [bx, by]): &(&[T; 2], &[T; 2])| {
        (*ay > y) != (*by > y) && x < (*bx - *ax) * (y - *ay) / (*by - *ay) + *ax
    };
    corners.iter().zip(next).filter(crosses).count() % 2 == 1
}
