//! Where a lap's pieces are smooth, but do not fit.

use super::lap::Node;
use super::probe::Frame;
use super::refusal::{Place, Refusal};
use controller::Path;

/// A change larger than this share of the quantity's size counts as a jump.
const JUMP: f64 = 0.01;
/// How far the stretch between two nodes is halved.
const SMALLEST: f64 = 1e-6;

/// A node, and what `evaluate` found there.
pub type Point<D> = (Node, D);

/// Looks for a jump between neighbouring `points`: which of the `errors`, and where. None is looked
/// for beyond it.
///
/// `errors` says how far each quantity, as a part of its size, is from what the point before
/// foretells. Where one is far, the stretch between is halved, towards the larger error: of what is
/// smooth it falls, at a jump it stays.
///
/// # Errors
/// [`Refusal`] of a point between that has no derivatives.
pub fn jump<P: Path<f64> + ?Sized, D: Copy, const N: usize>(
    path: &mut P,
    points: &[Point<D>],
    evaluate: impl Fn(&mut P, &Node) -> D,
    errors: impl Fn(&Point<D>, &Point<D>) -> [f64; N],
) -> Result<Option<(usize, Place)>, Refusal> {
    let largest = |from: &Point<D>, to: &Point<D>| errors(from, to).into_iter().fold(0.0, f64::max);
    for [from, to] in points.array_windows() {
        let (mut from, mut to) = (*from, *to);
        let least = SMALLEST * (to.0.arc - from.0.arc);
        while let Some(first) = errors(&from, &to).iter().position(|error| *error > JUMP) {
            let whole = to.0.arc - from.0.arc;
            if whole < least {
                return Ok(Some((first, from.0.place())));
            }
            let half = 0.5 * whole;
            let ahead = from.0.position() + from.0.tangent() * half;
            let Some(frame) = Frame::on_curve(path, ahead, half) else { break };
            let between = Node::at(path, &frame, from.0.arc + half)?;
            let middle = (between, evaluate(path, &between));
            if largest(&from, &middle) > largest(&middle, &to) { to = middle } else { from = middle }
        }
    }
    Ok(None)
}
