//! The search for the smallest point that fails: bisection along rays from the nominal, then
//! smaller and smaller turns of the best one.
//!
//! A direction is asked at a length just short of the best known, so that one that is no better
//! costs one flight. That takes failures to be monotone along a ray, which is checked at the end
//! along the one that was found, smaller and larger.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::hunt::HuntError;
use super::space::{Group, Space, length};
use crate::world::random::Stream;

/// A length is found to this share of itself.
const TOLERANCE: f64 = 0.01;

/// Directions drawn for each dimension.
const DIRECTIONS: usize = 8;

/// Turns of the best direction, rad: from here, halved while none is better, to there.
const TURNS: [f64; 2] = [0.8, 0.04];

/// Most turns tried at a time; a number that does not depend on the machine's cores, so that the
/// search does not, either.
const BATCH: usize = 8;

/// Points that are flown to see whether failures are monotone along a ray, on either side.
const CHECKED: usize = 8;

/// Whether a point fails.
pub(super) type Fails<'a> = dyn Fn(&[f64]) -> Result<bool, HuntError> + Sync + 'a;

/// A search under way.
pub(super) struct Search<'a> {
    space: &'a Space<'a>,
    fails: &'a Fails<'a>,
    random: Stream,
    flights: AtomicUsize,
}

/// Points along the ray of one that fails.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Along {
    /// Smaller ones flown.
    pub smaller: usize,
    /// Of these failed.
    pub smaller_failed: usize,
    /// Larger ones flown.
    pub larger: usize,
    /// Of these failed.
    pub larger_failed: usize,
}

impl<'a> Search<'a> {
    pub fn new(space: &'a Space<'a>, fails: &'a Fails<'a>, random: Stream) -> Self {
        Self { space, fails, random, flights: AtomicUsize::new(0) }
    }

    /// Points flown.
    pub fn flights(&self) -> usize {
        self.flights.load(Ordering::Relaxed)
    }

    pub fn fails(&self, point: &[f64]) -> Result<bool, HuntError> {
        self.flights.fetch_add(1, Ordering::Relaxed);
        (self.fails)(point)
    }

    /// Of these the smallest that fails, the first of equals.
    fn least_failing(&self, points: Vec<Vec<f64>>) -> Result<Option<Vec<f64>>, HuntError> {
        let failing = points.par_iter().map(|point| self.fails(point)).collect::<Result<Vec<_>, _>>()?;
        let failed = points.into_iter().zip(failing).filter_map(|(point, fails)| fails.then_some(point));
        Ok(failed.reduce(|least, point| if length(&point) < length(&least) { point } else { least }))
    }

    /// The least that fails of each number by itself, either way, to the end of its range: twice as
    /// many as numbers, none where none fails.
    pub fn alone(&self) -> Result<Vec<Option<Vec<f64>>>, HuntError> {
        let dimension = self.space.dimension();
        let ray = |index: usize| {
            let mut direction = vec![0.0; dimension];
            direction[index / 2] = if index.is_multiple_of(2) { -1.0 } else { 1.0 };
            let reach = self.space.reach(&direction);
            let end = scaled(&direction, reach);
            if reach > 0.0 && self.fails(&end)? { self.between(0.0, 1.0, &end).map(Some) } else { Ok(None) }
        };
        (0..2 * dimension).into_par_iter().map(ray).collect()
    }

    /// A point that fails and is smaller than `best`, of directions drawn at random, and so on from
    /// there; `best` if there is none.
    pub fn anywhere(&mut self, mut best: Option<Vec<f64>>) -> Result<Option<Vec<f64>>, HuntError> {
        let dimension = self.space.dimension();
        // Of one dimension there are two directions, which have been looked along.
        let rounds = if dimension < 2 { 0 } else { (DIRECTIONS * dimension).div_ceil(BATCH) };
        for _ in 0..rounds {
            let mut points = Vec::with_capacity(BATCH);
            for _ in 0..BATCH {
                let mut direction: Vec<f64> = (0..dimension).map(|_| self.random.normal()).collect();
                // Where there is nothing one way, there may be the other.
                for group in &self.space.groups {
                    for index in group.range.clone() {
                        let mut alone = vec![0.0; dimension];
                        alone[index] = direction[index];
                        if self.space.reach(&alone) == 0.0 {
                            direction[index] = -direction[index];
                        }
                    }
                }
                let least = best.as_ref().map_or(f64::INFINITY, |best| (1.0 - TOLERANCE) * length(best));
                let reach = self.space.reach(&direction).min(least / length(&direction));
                points.push(scaled(&direction, reach));
            }
            if let Some(found) = self.least_failing(points)? {
                best = Some(self.shortened(&found)?);
            }
        }
        Ok(best)
    }

    /// From a point that fails to one near it that is as small as can be and still fails: without
    /// what it does not need, turned, without what that brought, and shortened as far as it fails.
    pub fn shrunk(&mut self, point: Vec<f64>) -> Result<Vec<f64>, HuntError> {
        let mut best = self.shortened(&self.reduced(point)?)?;
        let mut angle = TURNS[0];
        while angle > TURNS[1] && best.len() > 1 {
            let turned = self.turned(&best, angle);
            match self.least_failing(turned)? {
                Some(found) => best = self.shortened(&found)?,
                None => angle *= 0.5,
            }
        }
        self.shortened(&self.reduced(best)?)
    }

    /// The failing point without the groups that it fails without, the smallest first.
    fn reduced(&self, mut point: Vec<f64>) -> Result<Vec<f64>, HuntError> {
        let size = |point: &[f64], group: &Group| length(&point[group.range.clone()]);
        let mut groups: Vec<&Group> = self.space.groups.iter().filter(|group| size(&point, group) > 0.0).collect();
        groups.sort_by(|a, b| size(&point, a).total_cmp(&size(&point, b)));
        // The largest alone is what is left of a point that needs no other: nothing is the nominal.
        for group in groups.iter().rev().skip(1).rev() {
            let mut without = point.clone();
            without[group.range.clone()].fill(0.0);
            if self.fails(&without)? {
                point = without;
            }
        }
        Ok(point)
    }

    /// Points at this angle from `best`, just shorter, in pairs of opposite directions.
    fn turned(&mut self, best: &[f64], angle: f64) -> Vec<Vec<f64>> {
        let size = length(best);
        let pairs = (best.len() - 1).min(BATCH / 2);
        let mut points = Vec::with_capacity(2 * pairs);
        for _ in 0..pairs {
            let mut across: Vec<f64> = best.iter().map(|_| self.random.normal()).collect();
            let along = across.iter().zip(best).map(|(a, b)| a * b).sum::<f64>() / (size * size);
            across.iter_mut().zip(best).for_each(|(a, b)| *a -= along * b);
            let unit = size / length(&across);
            for side in [-1.0, 1.0] {
                let (sin, cos) = (side * libm::sin(angle) * unit, libm::cos(angle));
                let turned: Vec<f64> = best.iter().zip(&across).map(|(b, a)| cos * b + sin * a).collect();
                let point = scaled(&turned, 1.0 - TOLERANCE);
                if self.space.reach(&point) >= 1.0 {
                    points.push(point);
                }
            }
        }
        points
    }

    /// The least of a failing point's ray that fails, from it downwards.
    fn shortened(&self, point: &[f64]) -> Result<Vec<f64>, HuntError> {
        let (mut least, mut step) = (1.0, 2.0 * TOLERANCE);
        loop {
            let next: f64 = 1.0 - step;
            if next <= 0.0 {
                return self.between(0.0, least, point);
            }
            if !self.fails(&scaled(point, next))? {
                return self.between(next, least, point);
            }
            (least, step) = (next, 2.0 * step);
        }
    }

    /// Bisects the ray of `point` between a share that does not fail and one that does.
    fn between(&self, mut good: f64, mut failing: f64, point: &[f64]) -> Result<Vec<f64>, HuntError> {
        while failing - good > TOLERANCE * failing {
            let middle = 0.5 * (good + failing);
            *(if self.fails(&scaled(point, middle))? { &mut failing } else { &mut good }) = middle;
        }
        Ok(scaled(point, failing))
    }

    /// Flies along the ray of a point that fails, and returns it with what was seen; or the least
    /// that fails of smaller ones.
    pub fn checked(&self, point: Vec<f64>) -> Result<(Vec<f64>, Along), HuntError> {
        let share = |index: usize| (index + 1) as f64 / (CHECKED + 1) as f64;
        let smaller: Vec<Vec<f64>> = (0..CHECKED).map(|index| scaled(&point, share(index))).collect();
        let beyond = self.space.reach(&point) - 1.0;
        let count = if beyond > TOLERANCE { CHECKED } else { 0 };
        let larger: Vec<Vec<f64>> =
            (1..=count).map(|index| scaled(&point, 1.0 + beyond * index as f64 / CHECKED as f64)).collect();
        let failed =
            |points: &[Vec<f64>]| points.par_iter().map(|point| self.fails(point)).collect::<Result<Vec<_>, _>>();
        let below = failed(&smaller)?;
        let above = failed(&larger)?;
        let count = |failing: &[bool]| failing.iter().filter(|fails| **fails).count();
        let along = Along {
            smaller: below.len(),
            smaller_failed: count(&below),
            larger: above.len(),
            larger_failed: count(&above),
        };
        let least = below.iter().position(|fails| *fails);
        Ok((least.map_or(point, |index| smaller[index].clone()), along))
    }
}

fn scaled(point: &[f64], factor: f64) -> Vec<f64> {
    point.iter().map(|part| factor * part).collect()
}
