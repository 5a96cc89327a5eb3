//! What rates and distances of a finite number of flights are worth: confidence, and what they
//! depend on.

use statrs::function::beta::inv_beta_reg;

use super::tally::Tally;

/// Probability that an interval holds the true rate, at the least.
pub const CONFIDENCE: f64 = 0.95;

/// The interval of Clopper and Pearson for a rate of which `count` of `of` flights were seen:
/// exact, and not of zero width where none or all were.
#[must_use]
pub fn interval(count: usize, of: usize) -> [f64; 2] {
    let (k, n) = (count as f64, of as f64);
    let tail = 0.5 * (1.0 - CONFIDENCE);
    let low = if count == 0 { 0.0 } else { inv_beta_reg(k, n - k + 1.0, tail) };
    let high = if count >= of { 1.0 } else { inv_beta_reg(k + 1.0, n - k, 1.0 - tail) };
    [low, high]
}

/// A drawn number: what it is, and its column.
type Drawn = (&'static str, fn(&Tally) -> &[f64]);

/// What a campaign draws, as its tally has it.
const DRAWN: [Drawn; 6] = [
    ("distance at the start", |tally| &tally.start_distance_m),
    ("speed at the start", |tally| &tally.start_speed),
    ("tilt at the start", |tally| &tally.start_tilt_deg),
    ("rod angle at the start", |tally| &tally.start_rod_deg),
    ("payload", |tally| &tally.payload_mass),
    ("mean wind", |tally| &tally.wind),
];

/// Bins of equally many flights.
const BINS: usize = 20;

/// Flights in a bin, below which its mean says nothing.
const LEAST: usize = 5;

/// The share of the variance of d_C's rank that each drawn number explains alone, largest first:
/// the correlation ratio over bins of equally many flights, less what chance alone would give (ε²).
/// It sees dependences that are not monotonous, as on a mass that may be too small or too large.
/// Empty where there are too few flights to say.
#[must_use]
pub fn sensitivity(tally: &Tally) -> Vec<(&'static str, f64)> {
    let n = tally.dc_max_m.len();
    if n < BINS * LEAST {
        return Vec::new();
    }
    let distance = ranks(&tally.dc_max_m);
    let middle = 0.5 * (n as f64 - 1.0);
    let total: f64 = distance.iter().map(|rank| (rank - middle).powi(2)).sum();
    let mut found: Vec<(&str, f64)> = DRAWN
        .into_iter()
        .map(|(name, column)| (name, column(tally)))
        .filter(|(_, values)| values.iter().any(|value| *value != values[0]))
        .map(|(name, values)| {
            let order = order(values);
            let between: f64 = (0..BINS)
                .map(|bin| {
                    let bin = &order[bin * n / BINS..(bin + 1) * n / BINS];
                    let mean = bin.iter().map(|&flight| distance[flight]).sum::<f64>() / bin.len() as f64;
                    bin.len() as f64 * (mean - middle).powi(2)
                })
                .sum();
            let chance = (total - between) / (n - BINS) as f64 * (BINS - 1) as f64;
            (name, ((between - chance) / total).max(0.0))
        })
        .collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

/// The flights in the order of their values.
fn order(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    order
}

/// The place of each flight in the order of values, from 0; equal ones share theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for equal in order(values).chunk_by(|&a, &b| values[a].total_cmp(&values[b]).is_eq()) {
        for &flight in equal {
            ranks[flight] = first as f64 + 0.5 * (equal.len() as f64 - 1.0);
        }
        first += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::super::fly::Row;
    use super::*;

    #[test]
    fn intervals_are_those_of_the_binomial() {
        // None of n: 1 − (α/2)^(1/n), in closed form; and the mirror image.
        for n in [10, 200, 10_000] {
            let high = 1.0 - 0.025_f64.powf(1.0 / n as f64);
            assert!((interval(0, n)[1] - high).abs() < 1e-9, "{n}: {:?}", interval(0, n));
            assert!((interval(n, n)[0] - (1.0 - high)).abs() < 1e-9 && interval(n, n)[1] == 1.0);
            assert_eq!(interval(0, n)[0], 0.0);
        }
        // At the ends of the interval the tails of the binomial distribution hold 2.5 % each.
        let (k, n) = (7_usize, 50_usize);
        let [low, high] = interval(k, n);
        let weight = |p: f64, i: usize| {
            let choose = (0..i).fold(1.0, |product, j| product * (n - j) as f64 / (j + 1) as f64);
            choose * p.powi(i as i32) * (1.0 - p).powi((n - i) as i32)
        };
        let above: f64 = (k..=n).map(|i| weight(low, i)).sum();
        let below: f64 = (0..=k).map(|i| weight(high, i)).sum();
        assert!((above - 0.025).abs() < 1e-9 && (below - 0.025).abs() < 1e-9, "{above} {below}");
    }

    #[test]
    fn what_distance_depends_on_comes_first_and_the_rest_is_near_zero() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut tally = Tally::default();
        for _ in 0..4000 {
            let (payload_mass, wind, start_speed) = (random(), random(), random());
            // Not monotonous in the mass.
            let dc_max_m = (payload_mass - 0.5).abs() + 0.2 * wind;
            tally.add(&Row { payload_mass, wind, start_speed, dc_max_m, ..Row::nothing() });
        }
        let found = sensitivity(&tally);
        assert_eq!(found.iter().map(|(name, _)| *name).take(2).collect::<Vec<_>>(), ["payload", "mean wind"]);
        // Of the sum's variance, 0.25/12 and 0.04/12, the mass has 86 %.
        assert!((found[0].1 - 0.86).abs() < 0.05 && found[1].1 < 0.2, "{found:?}");
        assert_eq!(found.len(), 3);
        assert!(found[2].1 < 0.01, "{found:?}");
    }
}
