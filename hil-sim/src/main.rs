//! The program: flies scenarios with the controller in the loop, and evaluates the law for other
//! programs.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run().unwrap_or_else(|error| {
        eprintln!("hil-sim: {error}");
        ExitCode::FAILURE
    })
}
