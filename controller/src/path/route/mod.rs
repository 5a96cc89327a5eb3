//! Routes: curves of any length through space, open or closed, that may cross themselves, stand
//! upright and stop.

// Indices are compile-time numbers of fields and axes.
#![allow(clippy::indexing_slicing)]

pub(crate) mod build;
mod fields;
mod table;

pub use table::{BEYOND, End, Knot, RouteTable, Run, Table};

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;
use crate::path::curve::{Sum, now};
use crate::path::nearest::{Local, Nearest, newton, track};
use crate::path::spline::{POINTS, Weights};
use crate::path::{Outputs, Path};

/// A place of a run: a span and how far along it, 0 to 1; less before the first span of an open
/// run, more behind its last.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place<T> {
    span: usize,
    along: T,
}

impl<T: Real> Place<T> {
    /// `step` on, at most a span, in a run of `spans`.
    #[inline(always)]
    fn advance(&mut self, step: T, spans: usize, is_closed: bool) {
        self.along += step;
        let last = spans.saturating_sub(1);
        if self.along >= T::one() && (is_closed || self.span < last) {
            self.along -= T::one();
            self.span = if self.span < last { self.span.wrapping_add(1) } else { 0 };
        } else if self.along < T::zero() && (is_closed || self.span > 0) {
            self.along += T::one();
            self.span = if self.span > 0 { self.span.wrapping_sub(1) } else { last };
        }
    }

    /// The splines' weights there, or at the end it is beyond.
    #[inline(always)]
    fn weights(&self) -> Weights<T> {
        Weights::at(self.along - self.outside())
    }

    /// How far outside its span it is, of an open run's ends.
    #[inline(always)]
    fn outside(&self) -> T {
        self.along - self.along.clamp(T::zero(), T::one())
    }
}

/// Knots that a search looks at in one call.
pub const SEARCHED: usize = 64;

/// Newton steps from the last sample's nearest point to the present one. The error falls
/// quadratically from the part of a span that is flown in a sample: of 5 % of a span, where it
/// bends by a third, two leave a millionth.
const NEWTON_STEPS: usize = 2;

/// Newton steps that end a search.
const SEARCH_STEPS: usize = 8;

/// The longest Newton step, in spans.
const LONGEST: f64 = 0.5;

/// A search of a run's control polygon under way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Search<T> {
    /// The next edge to look at, counted from the run's first knot.
    next: usize,
    distance_squared: T,
    /// Where on which edge it is nearest so far.
    edge: usize,
    along: T,
}

impl<T: Real> Search<T> {
    fn new() -> Self {
        Self { next: 0, distance_squared: T::lit(1e30), edge: 0, along: T::zero() }
    }

    /// Looks at the edge from `knot`.
    fn look(&mut self, edge: usize, knot: &Knot<T>, position: &Vector3<T>) {
        let (step, r) = (Vector3::from(knot.step), position - Vector3::from(knot.point));
        let along = (r.dot(&step) / step.dot(&step)).clamp(T::zero(), T::one());
        let away = r - step * along;
        let distance_squared = away.dot(&away);
        if distance_squared < self.distance_squared {
            *self = Self { distance_squared, edge, along, ..*self };
        }
    }
}

/// A route as a [`Path`]. Its splines are of degree 7 over the whole numbers, so that all is C⁶
/// (the yaw, of degree 3, C²), whatever the length at the same cost. With c the curve, n1 and n2
/// its fields and σ the parameter of its point nearest to the payload,
///
/// ```text
/// r = p − c(σ),   r·c′(σ) = 0,   ρ = c′/|c′|                       (15.3)
/// h1 = r·n1(σ),   h2 = r·n2(σ),   v_d(σ),   ψ_d(σ)                 (15.10)
/// ```
///
/// **h1 and h2 are in m, and |(h1, h2)| is the distance to the curve**, to within the few percent
/// that the fields, splines themselves, are short of unit length where the curve bends. They turn
/// with the curve as little as can be, so that no direction of it is special.
///
/// The nearest point is followed by its parameter, so another branch can't catch it, wherever that
/// passes; only [`Path::search`] looks at the whole run, 64 knots a call. It is followed
/// by up to a span from sample to sample.
///
/// An open run goes on straight beyond its ends, with v_d as it is there: the route's
/// [builder](crate::build_route) lets it lead back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Route<T, S> {
    table: S,
    run: usize,
    is_backward: bool,
    end: End,
    place: Place<T>,
    /// P₃ of the place's span, and c less it about the place.
    anchor: Vector3<T>,
    local: Local<T>,
    nearest: Nearest<T>,
    search: Search<T>,
    is_resumed: bool,
}

/// Makes `local` the curve about `place` of the span of `window`, less its anchor, from the
/// `weights` there.
#[inline(never)]
fn expand<T: Real>(window: &[Knot<T>; POINTS], weights: &Weights<T>, place: &Place<T>, local: &mut Local<T>) {
    let [k0, k1, k2, k3, k4, k5, k6, _] = window;
    let steps = [k0, k1, k2, k3, k4, k5, k6].map(|knot| Vector3::from(knot.step));
    weights.taylor_of_steps(steps, local);
    let outside = place.outside();
    if outside != T::zero() {
        straighten(local, outside);
    }
}

/// Goes straight on by `outside`.
#[cold]
fn straighten<T: Real>(local: &mut Local<T>, outside: T) {
    let [c, c_1, bends @ ..] = local;
    *c += *c_1 * outside;
    *bends = [Vector3::zeros(); POINTS - 2];
}

/// The fields n1 and n2 now, and their change by σ.
struct Fields<T> {
    normals: [Vector3<T>; 2],
    changes: [Vector3<T>; 2],
}

impl<T: Real> Fields<T> {
    /// Adds one axis' part to h1 and h2.
    // Axis by axis and apart, so that the numbers at work fit the registers.
    #[inline(never)]
    fn add<const AXIS: usize>(
        &mut self,
        window: &[Knot<T>; POINTS],
        weights: &Weights<T>,
        nearest: &Nearest<T>,
        surfaces: &mut [Series<T, 7>; 2],
    ) {
        let points = |n: usize| window.each_ref().map(|knot| knot.normals[n][AXIS]);
        let [first, second] = weights.taylor::<7, 2>([points(0), points(1)]);
        (self.normals[0][AXIS], self.changes[0][AXIS]) = (first[0], first[1]);
        (self.normals[1][AXIS], self.changes[1][AXIS]) = (second[0], second[1]);
        let r = nearest.error[AXIS];
        let heights = [first, second].map(|taylor| r * nearest.advance.compose(&taylor));
        if AXIS == 0 {
            *surfaces = heights;
        } else {
            surfaces[0] += heights[0];
            surfaces[1] += heights[1];
        }
    }
}

impl<T: Real, S: Table<T>> Route<T, S> {
    /// The route of a table, at the beginning of its first run.
    ///
    /// All numbers finite: points within ±10⁵ m, steps within ±1 km, speeds within ±100 m/s; at
    /// each knot the curve moves by at least 1 mm a knot, and the fields' determinant with its
    /// tangent is at least a third.
    ///
    /// # Errors
    /// The first number that is out of its range.
    pub fn new(table: S) -> Result<Self, OutOfRange<T>> {
        let runs = table.runs().len();
        OutOfRange::check("runs", T::lit(runs as f64), 1.0, 1e6)?;
        for run in table.runs() {
            // Infinite is an answer here.
            OutOfRange::check("dwell", if run.dwell > T::zero() { T::zero() } else { run.dwell }, 0.0, 0.0)?;
        }
        let zero = T::zero();
        let mut route = Self {
            table,
            run: 0,
            is_backward: false,
            end: End::Stay,
            place: Place { span: 0, along: zero },
            anchor: Vector3::zeros(),
            local: [Vector3::zeros(); POINTS],
            nearest: Nearest::none(),
            search: Search::new(),
            is_resumed: false,
        };
        for run in 0..runs {
            route.run = run;
            route.check_run()?;
        }
        route.begin_run(0);
        Ok(route)
    }

    fn check_run(&mut self) -> Result<(), OutOfRange<T>> {
        let run = self.current();
        OutOfRange::check("knots of a run", T::lit(run.knots as f64), POINTS as f64, 1e7)?;
        let end = run.first.saturating_add(run.knots);
        let Some(knots) = self.table.knots().get(run.first..end) else {
            let (knots, most) = (T::lit(end as f64), T::lit(self.table.knots().len() as f64));
            return OutOfRange::within("last knot of a run", knots, T::zero(), most);
        };
        knots.iter().try_for_each(Knot::check)?;
        for span in 0..self.spans() {
            let place = Place { span, along: T::zero() };
            let Some(window) = self.window(&place) else { continue };
            let mut local = self.local;
            let weights = place.weights();
            expand(window, &weights, &place, &mut local);
            let [_, c_1, ..] = local;
            let length = c_1.dot(&c_1).sqrt();
            OutOfRange::check("length of a span", length, 1e-3, 1e3)?;
            let normal = |n: usize| weights.value(&window.each_ref().map(|knot| Vector3::from(knot.normals[n])));
            let (n1, n2) = (normal(0), normal(1));
            let determinant = n1.cross(&n2).dot(&c_1) / length;
            OutOfRange::check("determinant of normals and tangent", determinant, 0.33, 1.5)?;
        }
        Ok(())
    }

    /// The table.
    pub fn table(&self) -> &S {
        &self.table
    }

    /// The table alone.
    pub fn into_table(self) -> S {
        self.table
    }

    /// Which run is flown.
    pub fn run(&self) -> usize {
        self.run
    }

    /// The parameter of the nearest point at the last sample, from 0 at the run's first span;
    /// beyond an open run's ends, beyond its range.
    pub fn parameter(&self) -> T {
        T::lit(self.place.span as f64) + self.place.along
    }

    /// The curve's point there, N, m.
    pub fn point(&self) -> Vector3<T> {
        let [c, ..] = &self.local;
        self.anchor + c
    }

    /// The acceleration of a load that flies the route there as it is laid, N, m/s².
    pub fn acceleration(&self) -> Vector3<T> {
        let Some(window) = self.window(&self.place) else { return Vector3::zeros() };
        let mut local = self.local;
        let weights = self.place.weights();
        expand(window, &weights, &self.place, &mut local);
        let is_backward = self.is_backward;
        let way = |knot: &Knot<T>| if is_backward { -knot.speed[1] } else { knot.speed[0] };
        let [taylor] = weights.taylor::<6, 1>([window.each_ref().map(way)]);
        let (first, second) = (local[1], local[2] + local[2]);
        let per_length = T::one() / first.dot(&first).sqrt();
        // dσ/dt = v/|c′|, and its derivative by σ.
        let rate = taylor[0] * per_length;
        let change = taylor[1] * per_length - rate * first.dot(&second) * (per_length * per_length);
        second * (rate * rate) + first * (rate * change)
    }

    /// By how much the tangent turns there over a span, rad.
    pub fn turn(&self) -> T {
        let [_, first, half, ..] = &self.local;
        let across = first.cross(half);
        across.dot(&across).sqrt() * T::lit(2.0) / first.dot(first)
    }

    /// Goes to the place `parameter` of run `run`, as if the payload had been nearest to it: for
    /// what looks along a route without flying it.
    pub fn go_to(&mut self, run: usize, parameter: T) {
        self.begin_run(run);
        let last = self.spans().saturating_sub(1);
        let span = parameter.max(T::zero()).to_f64() as usize;
        let span = span.min(last);
        self.settle(Place { span, along: parameter - T::lit(span as f64) });
    }

    /// The same, joined where it was left, at first at its beginning, rather than where it is
    /// nearest: for a mission, whose end may be as near as its beginning, and whose legs may cross.
    pub fn resumed(self) -> Self {
        Self { is_resumed: true, ..self }
    }

    /// Whether nothing comes after the run that is flown.
    pub fn is_last_run(&self) -> bool {
        let last = self.table.runs().len().saturating_sub(1);
        let is_at_end = self.run == if self.is_backward { 0 } else { last };
        is_at_end && matches!(self.end, End::Stay | End::Back(0) | End::Again(0))
    }

    /// The same, with something to fly after the last run.
    pub fn with_end(self, end: End) -> Self {
        Self { end, ..self }
    }

    /// Goes to the beginning of run `run`, on the way back to its end; to the last run's where
    /// there are fewer. For a payload at rest there.
    pub fn begin_run(&mut self, run: usize) {
        self.run = run.min(self.table.runs().len().saturating_sub(1));
        let beyond = if self.current().is_closed { 0 } else { BEYOND };
        let span = if self.is_backward { self.spans().saturating_sub(beyond) } else { beyond };
        self.settle(Place { span, along: T::zero() });
    }

    fn current(&self) -> Run<T> {
        self.table.runs().get(self.run).copied().unwrap_or_default()
    }

    /// The way of this route that is flown after the last run, if another round is.
    fn another_round(&mut self) -> Option<End> {
        let left = match &mut self.end {
            End::Stay => return None,
            End::Back(left) | End::Again(left) => left,
        };
        *left = left.checked_sub(1)?;
        Some(self.end)
    }

    fn spans(&self) -> usize {
        (self.current().knots).saturating_sub(POINTS - 1)
    }

    /// The knots of `place`; none only where a run has none.
    #[inline(always)]
    fn window(&self, place: &Place<T>) -> Option<&[Knot<T>; POINTS]> {
        self.table.knots().get(self.current().first.saturating_add(place.span)..)?.first_chunk()
    }

    /// Remembers `place` as the last sample's.
    fn settle(&mut self, place: Place<T>) {
        self.place = place;
        let mut local = self.local;
        if let Some(window) = self.window(&place) {
            let [_, _, _, anchor, ..] = window;
            expand(window, &place.weights(), &place, &mut local);
            (self.anchor, self.local) = (Vector3::from(anchor.point), local);
        }
    }

    /// r of a payload at `position` and the remembered place.
    #[inline(always)]
    fn error(&self, position: &Vector3<T>) -> Vector3<T> {
        let [c, ..] = &self.local;
        position - self.anchor - c
    }

    /// Looks at the run's next [`SEARCHED`] knots; when all have been seen, the route is at the
    /// nearest point.
    fn look(&mut self, position: &Vector3<T>) -> bool {
        let run = self.current();
        let edges = run.knots.saturating_sub(1);
        let mut search = self.search;
        let begin = run.first.saturating_add(search.next);
        let count = SEARCHED.min(edges.saturating_sub(search.next));
        let knots = self.table.knots().get(begin..begin.saturating_add(count)).unwrap_or_default();
        for (edge, knot) in (search.next..).zip(knots) {
            search.look(edge, knot, position);
        }
        search.next = search.next.saturating_add(SEARCHED);
        let is_complete = search.next >= edges;
        self.search = if is_complete { Search::new() } else { search };
        if is_complete {
            self.settle(self.place_of(search.edge, search.along));
            self.approach(position);
        }
        is_complete
    }

    /// Goes to the nearest point by Newton's steps from the remembered place, at most four spans
    /// away.
    fn approach(&mut self, position: &Vector3<T>) {
        let Run { is_closed, .. } = self.current();
        for _ in 0..SEARCH_STEPS {
            let (r, [_, c_1, c_2, ..]) = (self.error(position), self.local);
            let step = newton(&r, &c_1, &(c_2 + c_2), T::lit(LONGEST));
            let mut place = self.place;
            place.advance(step, self.spans(), is_closed);
            self.settle(place);
        }
    }

    /// The place whose weights are about the control polygon's edge `edge`: three spans before it.
    fn place_of(&self, edge: usize, along: T) -> Place<T> {
        let Run { is_closed, .. } = self.current();
        let spans = self.spans();
        match edge.checked_sub(3) {
            Some(span) if span < spans => Place { span, along },
            Some(span) if is_closed => Place { span: span.saturating_sub(spans), along },
            None if is_closed => Place { span: spans.saturating_add(edge).saturating_sub(3), along },
            Some(span) => {
                let last = spans.saturating_sub(1);
                Place { span: last, along: along + T::lit(span.saturating_sub(last) as f64) }
            }
            None => Place { span: 0, along: along - T::lit(3_usize.saturating_sub(edge) as f64) },
        }
    }
}

impl<T: Real, S: Table<T>> Path<T> for Route<T, S> {
    #[inline(never)]
    fn evaluate(&mut self, position: &PositionSeries<T>, outputs: &mut Outputs<T>) {
        let p = now(position);
        let one = T::one();
        let step = track::<_, NEWTON_STEPS>(&self.local, &self.error(&p), T::lit(LONGEST)).clamp(-one, one);
        let Run { first, is_closed, .. } = self.current();
        self.place.advance(step, self.spans(), is_closed);
        let place = self.place;
        let is_backward = self.is_backward;
        let Some(window) = self.table.knots().get(first.saturating_add(place.span)..).and_then(<[_]>::first_chunk)
        else {
            *outputs = Outputs::none();
            return;
        };
        let mut weights = place.weights();
        expand(window, &weights, &place, &mut self.local);
        let [_, _, k2, k3, k4, k5, ..] = window;
        self.anchor = Vector3::from(k3.point);
        let mut yaw = weights.taylor_of_cubic([k2.yaw, k3.yaw, k4.yaw, k5.yaw]);
        if place.outside() != T::zero() {
            weights.hold();
            yaw = [yaw[0], T::zero(), T::zero()];
        }

        let [c, c_1, ..] = self.local;
        let r = p - self.anchor - c;
        self.nearest.solve(position, &r, &self.local);
        let nearest = &self.nearest;
        let (mut square, mut speed) = (Sum::empty(), Sum::empty());
        for (d, p) in nearest.first.iter().zip(position) {
            let d = d.truncate();
            square.add_square(&d);
            speed.add_product(&d, &p.differentiate());
        }
        let length = square.0.sqrt();
        let [way] = weights.taylor::<6, 1>([window.each_ref().map(|knot| knot.speed[usize::from(is_backward)])]);
        let prescribed = nearest.advance.compose(&way);
        let prescribed = if is_backward { -prescribed } else { prescribed };
        outputs.speed_error = speed.0 / length - prescribed;
        outputs.prescribed = prescribed;
        outputs.tangent = c_1 * (one / length.value());
        outputs.yaw = nearest.advance.compose(&yaw);
        outputs.reach_margin = nearest.divisor / nearest.speed_squared;

        let zeros = [Vector3::zeros(); 2];
        let mut fields = Fields { normals: zeros, changes: zeros };
        fields.add::<0>(window, &weights, nearest, &mut outputs.surfaces);
        fields.add::<1>(window, &weights, nearest, &mut outputs.surfaces);
        fields.add::<2>(window, &weights, nearest, &mut outputs.surfaces);
        // r moves by dp − c′ dσ and n by n′ dσ, with ∇σ = c′/divisor.
        let grad_sigma = c_1 * (one / nearest.divisor);
        for n in 0..2 {
            let (normal, change) = (fields.normals[n], fields.changes[n]);
            outputs.gradients[n] = normal + grad_sigma * (r.dot(&change) - c_1.dot(&normal));
        }
    }

    fn search(&mut self, position: &Vector3<T>) -> bool {
        if self.is_resumed {
            self.approach(position);
            return true;
        }
        self.look(position)
    }

    fn dwell(&self) -> Option<T> {
        let Run { is_closed, dwell, .. } = self.current();
        (!is_closed).then_some(dwell)
    }

    fn go_on(&mut self) -> bool {
        let last = self.table.runs().len().saturating_sub(1);
        let next = if self.is_backward { self.run.checked_sub(1) } else { Some(self.run.saturating_add(1)) };
        match next.filter(|&run| run <= last) {
            Some(run) => self.begin_run(run),
            None => match self.another_round() {
                None | Some(End::Stay) => return false,
                Some(End::Back(_)) => {
                    self.is_backward = !self.is_backward;
                    self.begin_run(self.run);
                }
                Some(End::Again(_)) => self.begin_run(if self.is_backward { last } else { 0 }),
            },
        }
        true
    }

    fn set_backward(&mut self, is_backward: bool) -> bool {
        self.is_backward = is_backward;
        true
    }
}
