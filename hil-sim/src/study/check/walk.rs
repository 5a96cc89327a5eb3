//! Walking a curve once round: by its tangent forwards, by Newton's method back onto it, in steps
//! that follow its bends.

use super::jumps::{Point, jump};
use super::lap::{Lap, Node};
use super::probe::{Frame, Motion, length};
use super::refusal::{Place, Reason, Refusal};
use controller::{Path, Vector3};

/// Largest turn of the tangent over one step, rad. A cubic through both ends with their tangents is
/// then within R·0.02⁴/384 = 4e-10 R of the curve.
pub(super) const TURN: f64 = 0.02;
/// Largest step as a part of the curve's extent so far, so that straight stretches do not hide a
/// bend behind them.
const STRETCH: f64 = 0.01;
/// First step, m, and the extent that steps are first measured against.
const FIRST_STEP: f64 = 1e-3;
/// A step this much smaller than the extent that still turns too far is a kink: a bend of radius
/// 5e-6 of the extent.
const SMALLEST: f64 = 1e-7;
/// Most steps of one lap.
const STEPS: usize = 200_000;
/// Furthest a closed curve may be from the origin, m: the range of the controller's own curves.
const FURTHEST: f64 = 1e5;
/// Orders whose jumps are looked for: for these the polynomial of order six predicts to third order
/// in the step, or better.
const CHECKED_ORDERS: [usize; 3] = [2, 3, 4];
/// |∇h1 × ∇h2| below this part of its largest value on the lap is zero up to rounding.
const IRREGULAR: f64 = 1e-6;

/// Walks the curve from `start`, a point on it, along ρ.
///
/// # Errors
/// [`Refusal`] with the place where it is not a closed, smooth, regular curve.
pub fn walk<P: Path<f64> + ?Sized>(path: &mut P, start: Frame) -> Result<Lap, Refusal> {
    let mut nodes = vec![Node::at(path, &start, 0.0)?];
    let mut frame = start;
    let mut arc = 0.0;
    let mut extent = FIRST_STEP / STRETCH;
    let mut step = FIRST_STEP;
    for _ in 0..STEPS {
        step = step.min(STRETCH * extent);
        let (next, taken) = advance(path, &frame, step, extent, arc)?;
        let turn = angle(&frame.tangent, &next.tangent);
        let chord = length(&(next.position - frame.position));

        let before = (frame.position - start.position).dot(&start.tangent);
        let after = (next.position - start.position).dot(&start.tangent);
        let near = length(&(next.position - start.position)) < 2.0 * taken;
        if nodes.len() > 3 && before < 0.0 && after >= 0.0 && near && next.tangent.dot(&start.tangent) > 0.0 {
            let last = length(&(start.position - frame.position));
            arc += arc_of(last, angle(&frame.tangent, &start.tangent));
            nodes.push(Node { arc, ..nodes[0] });
            regular(path, &nodes)?;
            smooth(path, &nodes)?;
            return Ok(Lap::new(nodes, true));
        }

        arc += arc_of(chord, turn);
        frame = next;
        extent = extent.max(length(&(frame.position - start.position)));
        if length(&frame.position) > FURTHEST {
            return Err(Reason::Open.at(Place::of_curve(frame.position, arc)));
        }
        nodes.push(Node::at(path, &frame, arc)?);
        step = if turn < TURN / 2.0 { taken * 1.5 } else { taken };
    }
    Err(Reason::Endless.at(Place::of_curve(frame.position, arc)))
}

/// The next point along the curve and the step that led there, halved until the curve is smooth
/// over it.
fn advance<P: Path<f64> + ?Sized>(
    path: &mut P,
    frame: &Frame,
    step: f64,
    extent: f64,
    arc: f64,
) -> Result<(Frame, f64), Refusal> {
    let here = Place::of_curve(frame.position, arc);
    let mut step = step;
    loop {
        let ahead = frame.position + frame.tangent * step;
        // A bend of TURN leaves its tangent by half TURN of the step.
        let next = Frame::on_curve(path, ahead, TURN * step);
        let reason = match next {
            Some(next) => {
                let turn = angle(&frame.tangent, &next.tangent);
                if turn <= TURN {
                    return Ok((next, step));
                }
                Reason::Kink { turn }
            }
            None if Frame::at(path, ahead).is_none() => Reason::Undefined,
            None => Reason::Ends,
        };
        step *= 0.5;
        if step < SMALLEST * extent {
            return Err(reason.at(here));
        }
    }
}

/// Looks between the nodes for a point where |∇h1 × ∇h2| is zero: the surfaces touch, or the
/// curve crosses itself.
fn regular<P: Path<f64> + ?Sized>(path: &mut P, nodes: &[Node]) -> Result<(), Refusal> {
    path.search(&nodes[0].position());
    let largest = nodes.iter().map(|node| node.regularity).fold(0.0, f64::max);
    for [before, here, after] in nodes.array_windows() {
        // Next to a zero the nodes are much closer to it than half of the way to the largest value.
        let is_least = here.regularity <= before.regularity && here.regularity <= after.regularity;
        if !is_least || here.regularity > 0.5 * largest {
            continue;
        }
        // Golden section, until the bracket is rounding.
        let chord = after.position() - before.position();
        let mut at = |part: f64| {
            Frame::on_curve(path, before.position() + chord * part, length(&chord))
                .map_or((0.0, before.position()), |frame| (frame.regularity(), frame.position))
        };
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
        while high - low > 1e-9 {
            let (left, right) = (high - ratio * (high - low), low + ratio * (high - low));
            if at(left).0 < at(right).0 { high = right } else { low = left }
        }
        let (least, position) = at(0.5 * (low + high));
        if least < IRREGULAR * largest {
            let arc = before.arc + length(&(position - before.position()));
            return Err(Reason::Irregular.at(Place::of_curve(position, arc)));
        }
    }
    Ok(())
}

/// Looks for jumps of the curve's second to fourth derivatives, where its pieces are smooth but do
/// not fit.
///
/// From each node its Taylor polynomial says what the next node's derivatives are.
fn smooth<P: Path<f64> + ?Sized>(path: &mut P, nodes: &[Node]) -> Result<(), Refusal> {
    path.search(&nodes[0].position());
    let scales = CHECKED_ORDERS
        .map(|order| nodes.iter().map(|node| length(&node.motion[order])).fold(f64::MIN_POSITIVE, f64::max));
    let errors = |(from, ()): &Point<()>, (to, ()): &Point<()>| {
        let predicted = shifted(&from.motion, to.arc - from.arc);
        let error = |i: usize| length(&(predicted[CHECKED_ORDERS[i]] - to.motion[CHECKED_ORDERS[i]])) / scales[i];
        [error(0), error(1), error(2)]
    };
    let points: Vec<Point<()>> = nodes.iter().map(|node| (*node, ())).collect();
    // The lowest order: those above it jump as well.
    match jump(path, &points, |_, _| (), errors)? {
        Some((which, place)) => Err(Reason::Jump { order: CHECKED_ORDERS[which] }.at(place)),
        None => Ok(()),
    }
}

/// A Taylor polynomial about a point `ahead`: Horner's synthetic division.
fn shifted(motion: &Motion, ahead: f64) -> Motion {
    let mut shifted = *motion;
    for first in 0..shifted.len() {
        for k in (first..shifted.len() - 1).rev() {
            shifted[k] += shifted[k + 1] * ahead;
        }
    }
    shifted
}

/// Length of an arc from its chord and turn: chord·(θ/2)/sin(θ/2), to fourth order in θ.
pub(super) fn arc_of(chord: f64, turn: f64) -> f64 {
    chord * (1.0 + turn * turn / 24.0)
}

/// Angle between two unit vectors, rad; exact for small ones too.
pub fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    length(&a.cross(b)).atan2(a.dot(b))
}

/// A point of the curve to start from: the one reached from `hint`, or else from points spread over
/// ever larger boxes.
///
/// # Errors
/// [`Refusal`] if there is no curve near any of them.
pub fn find<P: Path<f64> + ?Sized>(path: &mut P, hint: Vector3<f64>) -> Result<Frame, Refusal> {
    let boxes = [1.0, 3.0, 10.0, 30.0, 100.0, 1000.0];
    let spread = boxes.iter().flat_map(|&half| {
        (1..=40_u32).map(move |i| {
            let part = |base| half * (2.0 * van_der_corput(i, base) - 1.0);
            (Vector3::new(part(2), part(3), part(5)), half)
        })
    });
    let (mut cuts, mut defined) = (false, false);
    for (from, stride) in std::iter::once((hint, 10.0)).chain(spread) {
        cuts |= Frame::at(path, from).is_some();
        defined |= Frame::is_defined(path, from);
        if let Some(frame) = Frame::sought(path, from, stride) {
            return Ok(frame);
        }
    }
    let reason = match (cuts, defined) {
        (true, _) => Reason::NoCurve,
        (false, true) => Reason::Parallel,
        (false, false) => Reason::Undefined,
    };
    Err(reason.at(Place::of_curve(hint, 0.0)))
}

/// The i-th number of van der Corput's sequence in [0, 1): with bases 2, 3, 5 a Halton sequence.
fn van_der_corput(mut i: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0);
    while i > 0 {
        digit /= f64::from(base);
        value += digit * f64::from(i % base);
        i /= base;
    }
    value
}
