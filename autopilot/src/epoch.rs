//! Whose time a state has: the sender's clock, which may restart, and stamps that stray from it.

/// A stamp further ahead of the last than this, µs, is not believed at once.
const LEAP_US: u64 = 2_000_000;
/// How many stamps in a row, each on the one before, make a clock that is believed.
const BELIEVED: u8 = 3;

/// The clock that states are stamped by.
#[derive(Clone, Copy, Debug, Default)]
pub struct Epoch {
    newest: Option<u64>,
    /// The last stamp of another clock, and how many have come from it in a row.
    other: Option<(u64, u8)>,
}

impl Epoch {
    /// Whether a state stamped `time_usec` is to be used: it is later than the last one, by no more
    /// than a leap, or the latest of enough that agree among themselves on another time.
    pub fn accept(&mut self, time_usec: u64) -> bool {
        let follows = |before: u64| time_usec.checked_sub(before).is_some_and(|gap| (1..=LEAP_US).contains(&gap));
        let is_believed = self.newest.is_none_or(follows) || {
            let count = self.other.filter(|&(before, _)| follows(before)).map_or(1, |(_, count)| count + 1);
            self.other = Some((time_usec, count));
            count >= BELIEVED
        };
        if is_believed {
            *self = Self { newest: Some(time_usec), other: None };
        }
        is_believed
    }
}
