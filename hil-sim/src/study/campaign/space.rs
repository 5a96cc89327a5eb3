//! All that a campaign draws for a flight as one vector: each number as a share of the way from its
//! nominal value to the ends of its range. What has no range, a choice or the place on the path,
//! stays as one flight has it.

use std::ops::Range;

use super::draw::Span;
use super::file::{Campaign, Draws};
use super::start::Deviation;

/// What is drawn together.
pub(super) struct Group {
    /// The field.
    pub name: String,
    /// Its numbers in a point.
    pub range: Range<usize>,
    spans: Vec<Span>,
    /// Drawn from a disc or ball: its length is bounded, not each number.
    is_round: bool,
    source: Source,
}

enum Source {
    /// The value with this number.
    Value(usize),
    /// The start's numbers from here on.
    Start(usize),
}

/// The box and balls that flights are drawn from.
pub(super) struct Space<'a> {
    campaign: &'a Campaign,
    base: Draws,
    pub groups: Vec<Group>,
}

impl<'a> Space<'a> {
    /// About the nominal, with all that has no range as in `base`.
    pub fn new(campaign: &'a Campaign, base: Draws) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        let mut add = |name: String, spans: Vec<Span>, is_round, source| {
            let first = groups.last().map_or(0, |group| group.range.end);
            if spans.iter().any(|span| span.below > 0.0 || span.above > 0.0) {
                groups.push(Group { name, range: first..first + spans.len(), spans, is_round, source });
            }
        };
        for (index, (field, distribution)) in campaign.distributions().enumerate() {
            add(field, distribution.spans(), distribution.is_round(), Source::Value(index));
        }
        let mut first = 0;
        for (name, count, size) in campaign.start().sizes() {
            add(format!("start.{name}"), vec![Span::about_zero(size); count], true, Source::Start(first));
            first += count;
        }
        Self { campaign, base, groups }
    }

    /// Numbers of a point.
    pub fn dimension(&self) -> usize {
        self.groups.last().map_or(0, |group| group.range.end)
    }

    /// How far in a direction the campaign draws, in lengths of it; 0 where it draws nothing.
    pub fn reach(&self, direction: &[f64]) -> f64 {
        let mut reach = f64::INFINITY;
        for Group { range, spans, is_round, .. } in &self.groups {
            let part = &direction[range.clone()];
            for (share, span) in part.iter().zip(spans) {
                let way = if *share < 0.0 { span.below } else { span.above };
                if *share != 0.0 {
                    reach = reach.min(if way > 0.0 { 1.0 / share.abs() } else { 0.0 });
                }
            }
            if *is_round {
                reach = reach.min(1.0 / length(part));
            }
        }
        if reach.is_finite() { reach } else { 0.0 }
    }

    /// The draws of a point.
    pub fn draws(&self, point: &[f64]) -> Draws {
        let mut draws = self.base.clone();
        let mut start = [0.0; 17];
        let distributions: Vec<_> = self.campaign.distributions().collect();
        for (group, numbers) in self.groups.iter().zip(self.numbers(point)) {
            match group.source {
                Source::Value(index) => draws.values[index] = distributions[index].1.value_of(&numbers),
                Source::Start(first) => start[first..first + numbers.len()].copy_from_slice(&numbers),
            }
        }
        draws.start = Deviation::of(&start);
        draws
    }

    /// The point of what was drawn.
    pub fn point(&self, draws: &Draws) -> Vec<f64> {
        let distributions: Vec<_> = self.campaign.distributions().collect();
        let start = draws.start.numbers();
        let share = |group: &Group| {
            let numbers = match group.source {
                Source::Value(index) => {
                    draws.values[index].as_ref().map_or(Vec::new(), |value| distributions[index].1.numbers(value))
                }
                Source::Start(first) => start[first..first + group.spans.len()].to_vec(),
            };
            numbers.iter().zip(&group.spans).map(|(number, span)| span.share(*number)).collect::<Vec<_>>()
        };
        self.groups.iter().flat_map(share).collect()
    }

    /// A point's numbers in their own units, a group each.
    pub fn numbers(&self, point: &[f64]) -> Vec<Vec<f64>> {
        let own = |group: &Group| {
            point[group.range.clone()].iter().zip(&group.spans).map(|(share, span)| span.at(*share)).collect()
        };
        self.groups.iter().map(own).collect()
    }
}

/// Of a vector.
pub(super) fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}
