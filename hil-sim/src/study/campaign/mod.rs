//! Campaigns: thousands of flights of the supervised law, each drawn from distributions, to say how
//! often it does what it should.
//!
//! A flight is a function of the campaign's file, the seed and its own number, so the table is the
//! same on any machine, with any number of threads, in one go, interrupted and resumed, or in
//! shards.

mod draw;
mod file;
mod fly;
mod hunt;
mod page;
mod parquet;
mod replay;
mod search;
mod space;
mod start;
mod statistics;
mod store;
mod summary;
mod tally;

pub use draw::Distribution;
pub use file::{ApproachFields, BUILTIN, Campaign, Drawn, builtin};
pub use fly::{Row, Verdict, fly_run, pilot};
pub use hunt::{Find, Hunt, HuntError, hunt};
pub use page::write as write_page;
pub use parquet::{ParquetError, write as write_parquet};
pub use replay::{Replay, replay};
pub use search::Along;
pub use start::{Start, StartFields};
use store::Store;
pub use store::{Identity, Rows, Shard, StoreError, merge};
pub use summary::{Summary, summarize};
pub use tally::Tally;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::describe::input::Invalid;
use crate::fly::flight::Control;
use crate::world::Seed;

/// Why a campaign stopped.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// A flight could not be set up.
    #[error("flight {run}: {invalid}")]
    Flight {
        /// Its number.
        run: u64,
        /// Why.
        invalid: Invalid,
    },
    /// The table could not be kept.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Flies what is left of the campaign that `identity` names, keeping its table in `folder`, and
/// returns how many flights are done: all of them, unless `stop` became true. `progress` gets the
/// number of flights done, those found in the folder at once.
///
/// # Errors
/// [`CampaignError`] if a flight cannot be set up, or the table not be kept.
pub fn run(
    campaign: &Campaign,
    identity: &Identity,
    folder: &Path,
    stop: &AtomicBool,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<usize, CampaignError> {
    let (store, found) = Store::open(folder, identity)?;
    progress(found as u64);
    let left = identity.shard.runs(identity.runs).skip(found);
    let next = AtomicUsize::new(0);
    let table = Mutex::new(Table { store, done: 0, early: BTreeMap::new(), failure: None });
    let locked = || table.lock().unwrap_or_else(PoisonError::into_inner);
    // Each thread takes the next flight that nobody flies, so none waits for another's.
    rayon::broadcast(|_| {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(run) = left.clone().nth(index) else { break };
            if stop.load(Ordering::Relaxed) || locked().failure.is_some() {
                break;
            }
            let control = Control { stop, progress: &|_| {} };
            match fly_run(campaign, Seed { batch: identity.seed, run }, control, None) {
                Ok(Some(row)) => {
                    progress(1);
                    locked().take(index, row);
                }
                Ok(None) => break,
                Err(invalid) => locked().fail(index, CampaignError::Flight { run, invalid }),
            }
        }
    });
    let Table { done, failure, .. } = table.into_inner().unwrap_or_else(PoisonError::into_inner);
    match failure {
        Some((_, error)) => Err(error),
        // Rows after a gap that an interruption left are flown again.
        None => Ok(found + done),
    }
}

/// The table under way: flights end in any order, and are kept in theirs.
struct Table {
    store: Store,
    /// Flights kept since the start.
    done: usize,
    /// Those that ended before one that comes before them.
    early: BTreeMap<usize, Row>,
    /// Of the first flight that failed.
    failure: Option<(usize, CampaignError)>,
}

impl Table {
    fn take(&mut self, index: usize, row: Row) {
        self.early.insert(index, row);
        if let Err(error) = self.keep() {
            self.fail(index, error.into());
        }
    }

    /// Has those reach the disk that come next.
    fn keep(&mut self) -> Result<(), StoreError> {
        while let Some(row) = self.early.remove(&self.done) {
            self.store.append(&row)?;
            self.done += 1;
        }
        self.store.flush()
    }

    fn fail(&mut self, index: usize, error: CampaignError) {
        if self.failure.as_ref().is_none_or(|(first, _)| index < *first) {
            self.failure = Some((index, error));
        }
    }
}
