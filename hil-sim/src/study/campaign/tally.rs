//! What is kept of a campaign's flights for its summary and its page: of each the numbers that
//! percentiles, bins and ranks are of, and no row.

use std::collections::BTreeMap;

use super::fly::{INSTANTS, Row, Verdict};

/// The numbers of a campaign's flights, a column a quantity, in the order of the flights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    pub(super) good: Vec<bool>,
    pub(super) dc_max_m: Vec<f64>,
    pub(super) dc_rms_m: Vec<f64>,
    /// Of those that reached their path.
    pub(super) reached_s: Vec<f64>,
    pub(super) start_distance_m: Vec<f64>,
    pub(super) start_speed: Vec<f64>,
    pub(super) start_tilt_deg: Vec<f64>,
    pub(super) start_rod_deg: Vec<f64>,
    pub(super) payload_mass: Vec<f64>,
    pub(super) wind: Vec<f64>,
    pub(super) least_q3: Vec<f64>,
    pub(super) least_q_b3: Vec<f64>,
    pub(super) least_tension: Vec<f64>,
    /// d_C at each of the instants.
    pub(super) dc_over_time_m: [Counted; INSTANTS],
}

impl Tally {
    /// Takes a flight.
    pub(super) fn add(&mut self, row: &Row) {
        self.good.push(row.verdict == Verdict::Good);
        self.dc_max_m.push(row.dc_max_m);
        self.dc_rms_m.push(row.dc_rms_m);
        self.reached_s.extend(row.reached_s);
        self.start_distance_m.push(row.start_distance_m);
        self.start_speed.push(row.start_speed);
        self.start_tilt_deg.push(row.start_tilt_deg);
        self.start_rod_deg.push(row.start_rod_deg);
        self.payload_mass.push(row.payload_mass);
        self.wind.push(row.wind);
        self.least_q3.push(row.least_q3);
        self.least_q_b3.push(row.least_q_b3);
        self.least_tension.push(row.least_tension);
        for (counted, text) in self.dc_over_time_m.iter_mut().zip(row.dc_over_time_m.split(';')) {
            if let Ok(distance) = text.parse() {
                counted.add(distance);
            }
        }
    }
}

/// Values by how often they came: few where rows round them, as d_C over time is to 0.1 mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Counted(BTreeMap<i64, usize>);

impl Counted {
    fn add(&mut self, value: f64) {
        *self.0.entry(ordered(value.to_bits().cast_signed())).or_default() += 1;
    }

    /// The `share` percentile, linear between values, as `compare` has it; 0 without any.
    pub(super) fn percentile(&self, share: f64) -> f64 {
        let Some(last) = self.0.values().sum::<usize>().checked_sub(1) else { return 0.0 };
        let at = share * last as f64;
        let (below, above) = (self.at(at as usize), self.at((at as usize + 1).min(last)));
        below + (above - below) * at.fract()
    }

    /// The value at a place in their order, from 0.
    fn at(&self, place: usize) -> f64 {
        let mut passed = 0;
        let found = self.0.iter().find(|(_, count)| {
            passed += *count;
            passed > place
        });
        found.map_or(0.0, |(key, _)| f64::from_bits(ordered(*key).cast_unsigned()))
    }
}

/// Bits of a number as an integer of its place in `f64::total_cmp`'s order, and back.
fn ordered(bits: i64) -> i64 {
    bits ^ ((bits >> 63).cast_unsigned() >> 1).cast_signed()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::compare::percentile;

    #[test]
    fn counted_values_have_the_percentiles_of_all() {
        let mut values = vec![0.3, 0.1, f64::INFINITY, 0.1, -2.0, 100.0, 0.3, 0.3, -0.0, 0.0, 7.5];
        let mut counted = Counted::default();
        assert_eq!(counted.percentile(0.5), 0.0);
        values.iter().for_each(|value| counted.add(*value));
        for share in [0.0, 0.1, 0.25, 0.5, 0.77, 0.9] {
            assert_eq!(counted.percentile(share).to_bits(), percentile(&mut values, share).to_bits(), "{share}");
        }
    }
}
