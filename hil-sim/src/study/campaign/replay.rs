//! One flight of a campaign again, with its full log.

use super::file::Campaign;
use super::fly::{Row, fly_run};
use crate::describe::input::Invalid;
use crate::fly::flight::Control;
use crate::report::log::{Record, Table};
use crate::world::Seed;

/// Flies the flight that `seed` stands for; returns its row and a log with a row every period: the true state, the command, and what
/// the controller took it from; `None` if it was interrupted. d_C and margins are empty where they were not taken.
///
/// # Errors
/// As [`fly_run`].
pub fn replay(campaign: &Campaign, seed: Seed, control: Control<'_>) -> Result<Option<(Row, Table)>, Invalid> {
    let scenario = campaign.draw(seed)?.scenario;
    let mut records = Vec::new();
    let row = fly_run(campaign, seed, control, &mut |moment| records.push(Record::of_moment(&scenario, moment)))?;
    Ok(row.map(|row| (row, Table::new(&format!("replay-{}", seed.run), &campaign.title, &records))))
}
