//! `plant` and `pilot`: a scenario's world, and its controller, for other programs: one JSON object
//! a line, one in answer.

use hil_sim::describe::input::Invalid;
use hil_sim::study::pilot::Controller;
use hil_sim::study::plant::Plant;
use serde::Serialize;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::process::ExitCode;

use super::{Ended, load};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = r#"Examples:
  printf '{"thrust": 29.43}\n{"thrust": 29.43, "torque": [0.01, 0, 0], "periods": 500}\n' | hil-sim plant fig3a"#;

/// Each example can be pasted into a shell.
pub const PILOT_EXAMPLES: &str = r#"Examples:
  hil-sim plant fig3a < /dev/null | hil-sim pilot fig3a    the first command"#;

/// A state for every command, after that at the start.
pub fn plant(file: &Path) -> Ended {
    let mut plant = Plant::new(&load::one(file)?);
    answer(&plant.now())?;
    step_lines(|line| plant.step(line))
}

/// A command for every state.
pub fn pilot(file: &Path) -> Ended {
    let mut controller = Controller::new(&load::one(file)?)?;
    step_lines(|line| controller.step(line))
}

/// Answers every line of standard input on standard output.
fn step_lines<T: Serialize>(mut step: impl FnMut(&[u8]) -> Result<T, Invalid>) -> Ended {
    let mut code = ExitCode::SUCCESS;
    let mut input = io::stdin().lock();
    let mut line = Vec::new();
    while input.read_until(b'\n', &mut line)? > 0 {
        match step(&line) {
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
