//! Campaigns: thousands of flights of the supervised law, each drawn from distributions, to say how
//! often it does what it should.
//!
//! A flight is a function of the campaign's file, the seed and its own number, so the table is the
//! same on any machine, with any number of threads, in one go, interrupted and resumed, or in
//! shards.

mod draw;
mod file;
mod fly;
mod page;
mod parquet;
mod replay;
mod statistics;
mod store;
mod summary;

pub use draw::{Distribution, Start, StartFields};
pub use file::{ApproachFields, Campaign, Drawn};
pub use fly::{Row, Supervised, Verdict, fly_run};
pub use page::write;
pub use parquet::encode as parquet;
pub use replay::{Replay, replay};
pub use store::{Identity, Shard, Store, StoreError, merge};
pub use summary::{Summary, summarize};

use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

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

/// Flights between two writes of the table.
const BLOCK: usize = 64;

/// Flies what is left of the campaign that `identity` names, keeping its table in `folder`, and
/// returns the rows that are done: all of them, unless `stop` became true. `progress` gets the
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
) -> Result<Vec<Row>, CampaignError> {
    let (mut store, mut rows) = Store::open(folder, identity)?;
    progress(rows.len() as u64);
    let left: Vec<u64> = identity.shard.runs(identity.runs).skip(rows.len()).collect();
    for block in left.chunks(BLOCK) {
        let flown: Vec<Option<Row>> = block
            .par_iter()
            .map(|&run| {
                if stop.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                let control = Control { stop, progress: &|_| {} };
                let row = fly_run(campaign, Seed { batch: identity.seed, run }, control, &mut |_| {})
                    .map_err(|invalid| CampaignError::Flight { run, invalid })?;
                progress(u64::from(row.is_some()));
                Ok(row)
            })
            .collect::<Result<_, CampaignError>>()?;
        // Rows after a gap that an interruption left are flown again.
        let done: Vec<Row> = flown.into_iter().map_while(|row| row).collect();
        store.append(&done)?;
        let interrupted = done.len() < block.len();
        rows.extend(done);
        if interrupted {
            break;
        }
    }
    Ok(rows)
}
