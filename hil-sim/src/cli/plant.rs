//! `plant`: a scenario's world for other programs, one JSON command a line.

use hil_sim::study::plant::Plant;
use serde::Serialize;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::process::ExitCode;

use super::{Ended, load};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = r#"Examples:
  printf '{"thrust": 29.43}\n{"thrust": 29.43, "torque": [0.01, 0, 0], "periods": 500}\n' | hil-sim plant fig3a"#;

/// Answers every line of standard input on standard output, after the state at the start.
pub fn step_lines(file: &Path) -> Ended {
    let mut plant = Plant::new(&load::one(file)?);
    let mut code = ExitCode::SUCCESS;
    answer(&plant.now())?;
    let mut input = io::stdin().lock();
    let mut line = Vec::new();
    while input.read_until(b'\n', &mut line)? > 0 {
        match plant.step(&line) {
            Ok(state) => answer(&state)?,
            Err(invalid) => {
                code = ExitCode::FAILURE;
                answer(&serde_json::json!({ "error": invalid.to_string() }))?;
            }
        }
        line.clear();
    }
    Ok(code)
}

/// One line, at once: whoever flies waits for it.
fn answer(line: &impl Serialize) -> io::Result<()> {
    let mut text = serde_json::to_vec(line)?;
    text.push(b'\n');
    let mut output = io::stdout().lock();
    output.write_all(&text)?;
    output.flush()
}
