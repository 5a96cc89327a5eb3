//! Control steps on random states: the same source runs on the target, where they are measured, and
//! on the host, whose digest of all commands the target's must equal.
#![no_std]

mod alone;
mod digest;
mod filters;
mod flown;
mod laws;
mod laying;
mod paths;
mod random;

use alone::Alone;
use filters::{LoadAndNavigation, LoadBehindNavigation};
use flown::{Flown, FlownOnEstimate};
use laws::{Following, Tracking};
use laying::Laying;

pub use digest::Digest;
pub use random::Random;

/// States a case is run on.
pub const STATES: usize = 1024;
/// The first of them, for who can't wait for all.
pub const FEW: usize = 32;
/// Those of what is done on the ground, and takes as long as thousands of steps.
const RARE: usize = 16;
/// Steps on each state: the first as after engaging, the second with a last command to predict
/// from.
pub const STEPS: usize = 2;

/// A law on a path or reference, and the states it is tried on.
pub trait Case {
    /// A control step; else it is done on the ground.
    const IS_STEP: bool = true;
    /// What a step reads.
    type State;
    /// What a step returns.
    type Output;

    /// Draws a state, and sets the law's own memory (ζ, integrals, last command) as at random.
    fn prepare(&mut self, random: &mut Random) -> Self::State;
    /// One control step.
    fn step(&mut self, state: &Self::State) -> Self::Output;
    /// Feeds every number of the command to the digest.
    fn digest(&self, output: &Self::Output, digest: &mut Digest);
}

/// Who is shown every case.
pub trait Visitor {
    /// `None` where the law refused the case's parameters.
    fn visit<C: Case>(&mut self, name: &str, case: Option<C>);
}

/// Shows `visitor` all cases, one a line.
pub fn visit_all(visitor: &mut impl Visitor) {
    visitor.visit("circle", paths::circle().and_then(|path| Following::new(path, paths::on_circle)));
    visitor.visit("ellipse", paths::ellipse().and_then(|path| Following::new(path, paths::on_ellipse)));
    visitor.visit("bent", paths::bent().and_then(|path| Following::new(path, paths::on_bent)));
    visitor.visit("fourier8", paths::fourier8().and_then(|path| Following::new(path, paths::on_fourier8)));
    visitor.visit("route", paths::route().and_then(|path| Following::new(path, paths::on_route)));
    let joining = |path| Following::new(path, paths::on_circle).map(Following::joining);
    visitor.visit("joining", paths::circle().and_then(joining));
    visitor.visit("track", Tracking::new());
    visitor.visit("law-circle", paths::circle().and_then(|path| Alone::new(path, paths::on_circle)));
    visitor.visit("law-bent", paths::bent().and_then(|path| Alone::new(path, paths::on_bent)));
    visitor.visit("flown", Flown::new());
    visitor.visit("load-filter", LoadBehindNavigation::new());
    visitor.visit("load-filter-and-navigation", LoadAndNavigation::new());
    visitor.visit("flown-on-estimate", FlownOnEstimate::new());
    visitor.visit("laying", Some(Laying::new()));
}

/// Runs `case` on so many random states through `step`, [`STEPS`] each. Returns the digest of all
/// commands.
pub fn exercise<C: Case>(
    case: &mut C,
    states: usize,
    mut step: impl FnMut(&mut C, &C::State) -> C::Output,
) -> Digest {
    let mut random = Random::new(20);
    let mut digest = Digest::default();
    for _ in 0..if C::IS_STEP { states } else { states.min(RARE) } {
        let state = case.prepare(&mut random);
        for _ in 0..STEPS {
            let output = step(case, &state);
            case.digest(&output, &mut digest);
        }
    }
    digest
}

/// The digest of square roots: the special values, then every kind of positive number.
pub fn roots() -> Digest {
    let mut digest = Digest::default();
    let special = [0.0, -0.0, f32::from_bits(1), f32::MIN_POSITIVE, 1.0, 2.0, f32::MAX, f32::INFINITY];
    special.into_iter().for_each(|x| digest.take(fpu::sqrt(x)));
    let mut random = Random::new(3);
    for _ in 0..1 << 14 {
        // 31 random bits below infinity's: all exponents, subnormal numbers among them.
        digest.take(fpu::sqrt(f32::from_bits((random.bits() >> 1) % f32::INFINITY.to_bits())));
    }
    digest
}
