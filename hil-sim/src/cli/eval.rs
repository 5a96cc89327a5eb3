//! `eval`: the law for other programs, one JSON object a line.

use hil_sim::study::eval::evaluate;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::process::ExitCode;

use super::Ended;

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = r#"Examples:
  hil-sim eval < points.jsonl > answers.jsonl

  echo '{"law":"follow","arithmetic":"f32","vehicle":{"payload_mass":0.5,"uav_mass":2.5,"inertia":[0.03,0.03,0.05],"rod_length":2.0,"gravity":9.81},"path":{"kind":"circle","radius":5.0,"p3":-10.0,"speed":1.0},"x":[0,9,-10,0,0,0,0,0,0,0,0,0,0,0,0,0],"zeta":[0,0,0,0],"gains":{"k":[[64,192,240,160,60,12],[64,192,240,160,60,12],[1,5,10,10,5],[1,2]]}}' | hil-sim eval

  echo '{"law":"track","arithmetic":"witness","vehicle":{"payload_mass":0.5,"uav_mass":2.5,"inertia":[0.03,0.03,0.05],"rod_length":2.0,"gravity":9.81},"reference":{"kind":"circle","radius":5.0,"p3":-10.0,"rate":1.0},"time":0.0,"x":[0,9,-10,0,0,0,0,0,0,0,0,0,0,0,0,0],"zeta":[0,0,0,0],"gains":{"k":[[64,192,240,160,60,12],[64,192,240,160,60,12],[64,192,240,160,60,12],[1,2]]}}' | hil-sim eval

"x" are the paper's coordinates: p, alpha, beta, phi, theta, psi, v, alpha_dot, beta_dot, omega; gains are low order first."#;

/// What some programs begin a text with.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// Answers every line of standard input on standard output, an empty one with an error.
pub fn evaluate_lines() -> Ended {
    let mut input = BufReader::new(io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    let mut code = ExitCode::SUCCESS;
    let mut line = Vec::new();
    let mut is_first = true;
    while input.read_until(b'\n', &mut line)? > 0 {
        let text = match line.strip_prefix(BYTE_ORDER_MARK) {
            Some(text) if is_first => text,
            _ => &line,
        };
        is_first = false;
        match evaluate(text) {
            Ok(answer) => serde_json::to_writer(&mut output, &answer)?,
            Err(invalid) => {
                code = ExitCode::FAILURE;
                serde_json::to_writer(&mut output, &serde_json::json!({ "error": invalid.to_string() }))?;
            }
        }
        output.write_all(b"\n")?;
        // Someone may be waiting for the answer before asking on.
        if input.buffer().is_empty() {
            output.flush()?;
        }
        line.clear();
    }
    output.flush()?;
    Ok(code)
}
