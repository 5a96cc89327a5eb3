//! One flight of a campaign again, with its full log.

use super::file::Campaign;
use super::fly::{Row, Verdict, fly_run};
use crate::describe::input::Invalid;
use crate::fly::flight::{Control, End, Moment};
use crate::report::log::{Record, Table};
use crate::report::page::{Shown, flights_page};
use crate::world::Seed;

/// A flight flown again.
pub struct Replay {
    /// Its row in the campaign's table.
    pub row: Row,
    /// A row every period: the true state, the command, and what the controller took it from. d_C
    /// and margins are empty where they were not taken.
    pub log: Table,
    /// A page to play it on.
    pub page: String,
}

/// Flies the flight that `seed` stands for; `None` if it was interrupted.
///
/// # Errors
/// As [`fly_run`].
pub fn replay(campaign: &Campaign, seed: Seed, control: Control<'_>) -> Result<Option<Replay>, Invalid> {
    let scenario = campaign.draw(seed)?.scenario;
    let mut records = Vec::new();
    let mut watch = |moment: &Moment<'_>| records.push(Record::of_moment(&scenario, moment));
    let row = fly_run(campaign, seed, control, Some(&mut watch))?;
    Ok(row.map(|row| {
        let log = Table::new(&format!("replay-{}", seed.run), &campaign.title, &records);
        let end = match row.verdict {
            Verdict::Good if scenario.lands() => End::Landed(row.end_s),
            Verdict::Good | Verdict::Held | Verdict::Off => End::Complete,
            Verdict::Crashed => End::Crashed(row.end_s),
            Verdict::Lost => End::Lost(row.end_s),
            Verdict::NonFinite => End::NotFinite(row.end_s),
        };
        let heading = format!("Flight {} of the campaign, seed {}", seed.run, seed.batch);
        let shown = Shown { scenario: &scenario, table: &log, end, ground_p3: campaign.ground_p3, legs: None };
        let page = flights_page(&heading, None, &[shown], &maud::html! {});
        Replay { row, log, page }
    }))
}
