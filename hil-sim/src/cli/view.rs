//! `view`: opens a report in the browser.

use std::path::Path;
use std::process::ExitCode;

use super::Ended;

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim view                       out/report.html
  hil-sim view results               results/report.html
  hil-sim view out/curves.html";

/// Opens the page, or the report in the folder.
pub fn view(file: &Path) -> Ended {
    let page = if file.is_dir() { file.join("report.html") } else { file.to_owned() };
    // The browser's own message would name neither.
    let page = page.canonicalize().map_err(|error| format!("{}: {error}", page.display()))?;
    if page.extension().is_none_or(|ending| ending != "html") {
        return Err(format!("{}: not a page: give a report's .html, or its folder", page.display()).into());
    }
    open::that(&page).map_err(|error| format!("{}: no browser could be started: {error}", page.display()))?;
    Ok(ExitCode::SUCCESS)
}
