//! Columns of a log over time, taken at any instant.

use crate::report::log::{self, ReadError};

/// Rows further apart than this, s, have nothing between them.
const GAP_S: f64 = 0.25;

/// An instant this near to a row is the row's, s: logs count microseconds.
const SAME_S: f64 = 1e-6;

/// Some columns of one topic, each row with its time, s.
pub struct Series<const N: usize> {
    rows: Vec<(f64, [f64; N])>,
}

/// Two rows and where an instant stands between them.
pub struct Between<'a, const N: usize> {
    /// The row before.
    pub from: &'a [f64; N],
    /// The row after.
    pub to: &'a [f64; N],
    /// Between the rows, 0 to 1.
    pub share: f64,
    /// From one to the other, s.
    pub span: f64,
}

impl<const N: usize> Series<N> {
    /// The rows of `names` whose numbers `are_there`; `None` where the log lacks one of them, or
    /// all rows.
    ///
    /// # Errors
    /// [`ReadError`] for what is no log.
    pub fn read(
        bytes: &[u8],
        names: [&'static str; N],
        are_there: fn(&[f64; N]) -> bool,
    ) -> Result<Option<Self>, ReadError> {
        let mut rows = match log::read(bytes, names) {
            Ok(rows) => rows,
            Err(ReadError::Missing(name)) if name != "t_s" => return Ok(None),
            Err(error) => return Err(error),
        };
        rows.retain(|(t_s, row)| t_s.is_finite() && are_there(row));
        // A clock that was set back: what is said again is not heard.
        let mut last = f64::NEG_INFINITY;
        rows.retain(|(t_s, _)| {
            let is_later = *t_s > last;
            last = last.max(*t_s);
            is_later
        });
        Ok((!rows.is_empty()).then_some(Self { rows }))
    }

    /// The same in other numbers.
    pub fn map<const M: usize>(self, of: impl Fn(&[f64; N]) -> [f64; M]) -> Series<M> {
        Series { rows: self.rows.iter().map(|(t_s, row)| (*t_s, of(row))).collect() }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// From the first row to the last, s.
    pub fn span(&self) -> [f64; 2] {
        [self.rows[0].0, self.rows[self.rows.len() - 1].0]
    }

    /// Around `t_s`; `None` outside of the log and in gaps of it.
    pub fn around(&self, t_s: f64) -> Option<Between<'_, N>> {
        let after = self.rows.partition_point(|row| row.0 <= t_s + SAME_S);
        let (before, from) = self.rows.get(after.checked_sub(1)?)?;
        if (t_s - before).abs() <= SAME_S {
            return Some(Between { from, to: from, share: 0.0, span: 0.0 });
        }
        let (next, to) = self.rows.get(after)?;
        let span = next - before;
        (span <= GAP_S).then(|| Between { from, to, share: (t_s - before) / span, span })
    }

    /// Linearly between the rows at `t_s`.
    pub fn at(&self, t_s: f64) -> Option<[f64; N]> {
        self.around(t_s).map(|Between { from, to, share, .. }| {
            std::array::from_fn(|i| if share == 0.0 { from[i] } else { from[i] + share * (to[i] - from[i]) })
        })
    }

    /// The mean of the rows within `period` seconds up to `t_s`; between rows that are further
    /// apart, as [`at`](Self::at).
    pub fn mean(&self, t_s: f64, period: f64) -> Option<[f64; N]> {
        let place = |t_s: f64| self.rows.partition_point(|row| row.0 <= t_s + SAME_S);
        let rows = &self.rows[place(t_s - period)..place(t_s)];
        if rows.is_empty() {
            return self.at(t_s);
        }
        let share = 1.0 / rows.len() as f64;
        Some(std::array::from_fn(|i| rows.iter().map(|(_, row)| row[i]).sum::<f64>() * share))
    }
}

impl Series<6> {
    /// Position and velocity at `t_s` by the cubic that has the rows' positions and velocities.
    pub fn motion(&self, t_s: f64) -> Option<[f64; 6]> {
        let Between { from, to, share: u, span } = self.around(t_s)?;
        if span == 0.0 {
            return Some(*from);
        }
        let mut motion = [0.0; 6];
        for axis in 0..3 {
            let (a, b, da, db) = (from[axis], to[axis], from[3 + axis] * span, to[3 + axis] * span);
            let (bend, twist) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
            motion[axis] = a + u * (da + u * (bend + u * twist));
            motion[3 + axis] = (da + u * (2.0 * bend + u * 3.0 * twist)) / span;
        }
        Some(motion)
    }
}
