//! What a route's table has besides its points: the steps between them, the normal fields, the
//! speeds and the yaws.

use model::Real;
use nalgebra::Vector3;

use super::Knot;
use super::build::{BEYOND, RoutePace};
use crate::path::spline::Weights;

fn point<T: Real>(knots: &[Knot<T>], index: usize) -> Vector3<T> {
    knots.get(index).map_or(Vector3::zeros(), |knot| Vector3::from(knot.point))
}

fn step<T: Real>(knots: &[Knot<T>], index: usize) -> Vector3<T> {
    knots.get(index).map_or(Vector3::zeros(), |knot| Vector3::from(knot.step))
}

fn length<T: Real>(vector: &Vector3<T>) -> T {
    vector.dot(vector).sqrt()
}

/// Of unit length; as it is where it has none.
fn unit<T: Real>(vector: Vector3<T>) -> Vector3<T> {
    let length = length(&vector);
    if length > T::zero() { vector * (T::one() / length) } else { vector }
}

/// Index `offset` − 3 away from `index`, round a closed run.
fn neighbour(index: usize, offset: usize, used: usize, is_closed: bool) -> usize {
    let raised = index.saturating_add(offset);
    if is_closed {
        raised.saturating_add(used).saturating_sub(3).checked_rem(used).unwrap_or(0)
    } else {
        raised.saturating_sub(3).min(used.saturating_sub(1))
    }
}

/// The control points of the span that begins at `index`, whose weights there are about it.
fn window<T: Real>(knots: &[Knot<T>], index: usize, used: usize, is_closed: bool) -> [Vector3<T>; 8] {
    core::array::from_fn(|offset| point(knots, neighbour(index, offset, used, is_closed)))
}

/// Has the curve pass through the knot's point: until there are normals, their place holds that.
pub(super) fn mark<T: Real>(knot: &mut Knot<T>) {
    knot.normals = [knot.point, [T::one(); 3]];
}

/// Sweeps over the marked points: each takes more than half of what is left of smooth data's error.
const SWEEPS: usize = 60;

/// Where spacings differ by more than this factor, marked points in a row are not interpolated: the
/// curve would swing between them. One alone moves by twice what it is missed by, and no other.
const UNEVEN: f64 = 2.0;

/// What a mark becomes that is not to be interpolated.
const PASSED_BY: f64 = 2.0;

/// The mark of a knot, or zero.
fn marked<T: Real>(knots: &[Knot<T>], index: usize) -> T {
    knots.get(index).map_or(T::zero(), |Knot { normals: [_, [mark, ..]], .. }| *mark)
}

/// Moves each marked point by what the curve misses its place, over and over (Gauss and Seidel):
/// the spline's matrix is symmetric and positive.
pub(super) fn interpolate<T: Real>(knots: &mut [Knot<T>], used: usize, is_closed: bool) {
    for index in 0..used {
        let points = window(knots, index, used, is_closed);
        let steps = points.array_windows().take(6).map(|[from, to]| length(&(to - from)));
        let (least, most) =
            steps.fold((T::lit(1e9), T::zero()), |(least, most), step| (least.min(step), most.max(step)));
        let beside = |offset: usize| marked(knots, neighbour(index, offset, used, is_closed)) != T::zero();
        let is_alone = !(0..7).filter(|&offset| offset != 3).any(beside);
        if most > least * T::lit(UNEVEN)
            && marked(knots, index) != T::zero()
            && !is_alone
            && let Some(Knot { normals: [_, mark], .. }) = knots.get_mut(index)
        {
            *mark = [T::lit(PASSED_BY); 3];
        }
    }
    let weights = Weights::at(T::zero());
    for _ in 0..SWEEPS {
        for index in 0..used {
            let Some([place, [mark, ..]]) = knots.get(index).map(|knot| knot.normals) else { continue };
            if mark != T::one() {
                continue;
            }
            let points = window(knots, index, used, is_closed);
            let curve = weights.value(&points);
            if let Some(knot) = knots.get_mut(index) {
                knot.point = (Vector3::from(knot.point) + Vector3::from(place) - curve).into();
            }
        }
    }
}

/// The steps from knot to knot, the last as the one before.
pub(super) fn steps<T: Real>(knots: &mut [Knot<T>]) {
    let count = knots.len();
    for index in 0..count {
        let from = index.min(count.saturating_sub(2));
        let step = point(knots, from.saturating_add(1)) - point(knots, from);
        if let Some(knot) = knots.get_mut(index) {
            knot.step = step.into();
        }
    }
}

/// The tangent at a control point. A closed run of `used` knots goes on with its beginning.
fn tangent<T: Real>(knots: &[Knot<T>], index: usize, used: usize, is_closed: bool) -> Vector3<T> {
    let before = match index.checked_sub(1) {
        Some(before) => step(knots, before),
        None if is_closed => step(knots, used.saturating_sub(1)),
        None => step(knots, index),
    };
    unit(unit(before) + unit(step(knots, index)))
}

/// The rotation-minimizing frame along the control points, by double reflection (Wang, Jüttler,
/// Zheng and Liu 2008). What a closed run's is turned by at its end is spread over its length.
pub(super) fn normals<T: Real>(knots: &mut [Knot<T>], used: usize, is_closed: bool) {
    let first = tangent(knots, 0, used, is_closed);
    // From the axis farthest from the tangent.
    let [x, y, z] = [first.x.abs(), first.y.abs(), first.z.abs()];
    let axis = if z <= x && z <= y {
        Vector3::z()
    } else if x <= y {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let begin = unit(axis - first * first.dot(&axis));
    let (mut t, mut n) = (first, begin);
    let mut total = T::zero();
    for index in 0..used {
        set_normals(knots, index, &t, &n);
        let way = step(knots, index);
        let next = if index.saturating_add(1) < used {
            tangent(knots, index.saturating_add(1), used, is_closed)
        } else if is_closed {
            first
        } else {
            t
        };
        let reflected = |v: &Vector3<T>, across: &Vector3<T>| {
            let square = across.dot(across);
            if square > T::zero() { v - across * (v.dot(across) * T::lit(2.0) / square) } else { *v }
        };
        let (n_half, t_half) = (reflected(&n, &way), reflected(&t, &way));
        n = reflected(&n_half, &(next - t_half));
        // What rounding leaves along the tangent, taken out.
        n = unit(n - next * next.dot(&n));
        t = next;
        total += length(&way);
    }
    if is_closed {
        let twist = begin.cross(&n).dot(&first).atan2(begin.dot(&n));
        let mut arc = T::zero();
        for index in 0..used {
            let (sin, cos) = (-twist * arc / total).sin_cos();
            let Some(knot) = knots.get_mut(index) else { continue };
            let [n1, n2] = knot.normals.map(Vector3::from);
            knot.normals = [(n1 * cos + n2 * sin).into(), (n2 * cos - n1 * sin).into()];
            arc += length(&Vector3::from(knot.step));
        }
        repeat(knots, used, |from, to| to.normals = from.normals);
    }
}

fn set_normals<T: Real>(knots: &mut [Knot<T>], index: usize, tangent: &Vector3<T>, normal: &Vector3<T>) {
    if let Some(knot) = knots.get_mut(index) {
        knot.normals = [(*normal).into(), tangent.cross(normal).into()];
    }
}

/// Carries what a closed run's first knots have over to those that repeat them.
fn repeat<T: Real>(knots: &mut [Knot<T>], used: usize, carry: impl Fn(&Knot<T>, &mut Knot<T>)) {
    for index in 0..knots.len().saturating_sub(used) {
        let from = knots.get(index).copied().unwrap_or_default();
        if let Some(to) = knots.get_mut(used.saturating_add(index)) {
            carry(&from, to);
        }
    }
}

/// v_d both ways from the wished speeds: what the curvature allows, what can be reached from the
/// speed before and left for the one behind, and an open run's stops.
pub(super) fn speeds<T: Real>(knots: &mut [Knot<T>], used: usize, is_closed: bool, pace: &RoutePace<T>) {
    for index in 0..used {
        let is_end = !is_closed && (index < BEYOND || index.saturating_add(BEYOND) >= used);
        if !is_end {
            limit(knots, index, bend_speed(&window(knots, index, used, is_closed), pace));
        }
    }
    if is_closed {
        // Twice round: what is behind the end is before the beginning.
        for _ in 0..2 {
            for index in 0..used {
                slow_from(knots, index.checked_sub(1).unwrap_or(used.saturating_sub(1)), index, index, pace);
            }
            for index in (0..used).rev() {
                let next = index.saturating_add(1);
                slow_from(knots, if next < used { next } else { 0 }, index, next, pace);
            }
        }
        repeat(knots, used, |from, to| to.speed = from.speed);
        return;
    }
    let (begin, end) = (BEYOND, used.saturating_sub(BEYOND.saturating_add(1)));
    // A second's worth of acceleration is what a start begins with: the factor of v_d brings it in
    // smoothly.
    limit_ends(knots, used, pace.acceleration);
    for index in begin.saturating_add(1)..=end {
        slow_from(knots, index.saturating_sub(1), index, index, pace);
    }
    for index in (begin..end).rev() {
        slow_from(knots, index.saturating_add(1), index, index.saturating_add(1), pace);
    }
    stop(knots, 0, end, used, pace);
    stop(knots, 1, begin, used, pace);
}

/// The speed at which the curve's bends ask for no more than `pace` allows, at the beginning of the
/// span of `points`.
fn bend_speed<T: Real>(points: &[Vector3<T>; 8], pace: &RoutePace<T>) -> T {
    let weights = Weights::at(T::zero());
    let axis = |axis: fn(&Vector3<T>) -> T| points.each_ref().map(axis);
    let taylor = weights.taylor::<7, 3>([axis(|p| p.x), axis(|p| p.y), axis(|p| p.z)]);
    let order = |k: usize| Vector3::from(taylor.map(|axis| axis.get(k).copied().unwrap_or_default()));
    let first = order(1);
    let square = first.dot(&first);
    let per_square = T::one() / square;
    // Of the derivative by the arc what is across the curve.
    let across = |k: usize, factor: f64| {
        let taylor = order(k);
        length(&(taylor - first * (first.dot(&taylor) * per_square))).max(T::lit(1e-12)) * T::lit(factor)
    };
    let Limits { second, fourth, sixth } = Limits::of(pace);
    let by_second = (second / (across(2, 2.0) * per_square)).sqrt();
    let by_fourth = (fourth / (across(4, 24.0) * per_square * per_square)).sqrt().sqrt();
    let by_sixth = (sixth / (across(6, 720.0) * per_square * per_square * per_square)).powf(T::lit(1.0 / 6.0));
    by_second.min(by_fourth).min(by_sixth)
}

/// Bounds of the position's second, fourth and sixth derivative.
struct Limits<T> {
    second: T,
    fourth: T,
    sixth: T,
}

impl<T: Real> Limits<T> {
    fn of(pace: &RoutePace<T>) -> Self {
        let RoutePace { acceleration: second, rise, .. } = *pace;
        let fourth = second / (rise * rise);
        Self { second, fourth, sixth: fourth / (rise * rise) }
    }
}

fn limit<T: Real>(knots: &mut [Knot<T>], index: usize, most: T) {
    if let Some(knot) = knots.get_mut(index) {
        knot.speed = knot.speed.map(|speed| speed.min(most));
    }
}

/// Beyond its ends a run has the speed that it has there.
fn limit_ends<T: Real>(knots: &mut [Knot<T>], used: usize, most: T) {
    for index in (0..=BEYOND).flat_map(|beyond| [beyond, used.saturating_sub(beyond.saturating_add(1))]) {
        limit(knots, index, most);
    }
}

/// Limits the speed at `index` to what leads there from that at `from`, over the step before knot
/// `behind`.
fn slow_from<T: Real>(knots: &mut [Knot<T>], from: usize, index: usize, behind: usize, pace: &RoutePace<T>) {
    let length = length(&step(knots, behind.checked_sub(1).unwrap_or(from)));
    let [speed, _] = knots.get(from).map_or([T::zero(); 2], |knot| knot.speed);
    // What changes from knot to knot is rounded off by the spline in about the time from one to the
    // next.
    let time = length / speed.max(T::lit(1e-3));
    let square = time * time;
    let Limits { second, fourth, sixth } = Limits::of(pace);
    let acceleration = second.min(fourth * square).min(sixth * square * square);
    limit(knots, index, (speed * speed + acceleration * length * T::lit(2.0)).sqrt());
}

/// Lets the speed of `way` fall to zero at knot `at`, where the way ends: evenly with the distance
/// near it, and on the other side leading back, as fast as three knots off. Odd about the stop, so
/// that the spline's zero is there too.
fn stop<T: Real>(knots: &mut [Knot<T>], way: usize, at: usize, used: usize, pace: &RoutePace<T>) {
    let forwards = way == 0;
    let place = point(knots, at);
    let RoutePace { acceleration, stop_rate, .. } = *pace;
    let even = acceleration / stop_rate;
    let mut away = T::zero();
    // Back along the way to its beginning.
    let mut index = at;
    loop {
        let square = even * even + (away - even / stop_rate) * acceleration * T::lit(2.0);
        let most = if away < even / stop_rate { stop_rate * away } else { square.sqrt() };
        if let Some(speed) = knots.get_mut(index).and_then(|knot| knot.speed.get_mut(way)) {
            *speed = speed.min(most);
        }
        let next = if forwards { index.checked_sub(1) } else { Some(index.saturating_add(1)) };
        let Some(next) = next.filter(|&next| next < used) else { break };
        away += length(&step(knots, index.min(next)));
        index = next;
    }
    let offset = |away: usize, behind: bool| {
        if behind == forwards { at.saturating_add(away) } else { at.saturating_sub(away) }
    };
    for away in 0..=BEYOND {
        let mirrored = offset(away.min(3), false);
        let wanted = length(&(point(knots, mirrored) - place)) * stop_rate;
        let speed =
            knots.get(mirrored).and_then(|knot| knot.speed.get(way)).map_or(wanted, |&speed| speed.min(wanted));
        if let Some(back) = knots.get_mut(offset(away, true)).and_then(|knot| knot.speed.get_mut(way)) {
            *back = -speed;
        }
    }
}

/// ψ_d: as given, or along the route's horizontal part. `heading` is where the run before ended,
/// and then where this one ends.
pub(super) fn yaws<T: Real>(knots: &mut [Knot<T>], used: usize, is_closed: bool, heading: &mut Option<T>) {
    let along = |knots: &[Knot<T>], index: usize| {
        let t = tangent(knots, index, used, is_closed);
        let is_level = t.x * t.x + t.y * t.y > T::lit(LEVEL * LEVEL);
        let given = knots.get(index).map(|knot| knot.yaw).filter(|yaw| yaw.is_finite());
        given.or(is_level.then(|| t.y.atan2(t.x)))
    };
    let first = (0..used).find_map(|index| along(knots, index)).unwrap_or_default();
    let begin = heading.unwrap_or(first);
    let mut wanted = begin + (first - begin).wrap_angle();
    // From the last run's to this one's over its first third, at most `TURNING`.
    let total = (0..used).fold(T::zero(), |total, index| total + length(&step(knots, index)));
    let turning = (total * T::lit(1.0 / 3.0)).min(T::lit(TURNING));
    let mut arc = T::zero();
    for index in 0..used {
        if let Some(yaw) = along(knots, index) {
            wanted += (yaw - wanted).wrap_angle();
        }
        let share = if is_closed { T::one() } else { (arc / turning).clamp(T::zero(), T::one()) };
        if let Some(knot) = knots.get_mut(index) {
            knot.yaw = begin + (wanted - begin) * share;
        }
        if index >= BEYOND.saturating_add(3) {
            arc += length(&step(knots, index));
        }
    }
    if is_closed {
        // With the turns made on the way round.
        let gained = knots.first().map_or(T::zero(), |knot| wanted + (knot.yaw - wanted).wrap_angle() - knot.yaw);
        repeat(knots, used, |from, to| to.yaw = from.yaw + gained);
    }
    *heading = Some(wanted);
}

/// Horizontal share of the tangent above which it has a heading.
const LEVEL: f64 = 0.1;
/// Length over which a run turns from the heading of the one before, m.
const TURNING: f64 = 10.0;
