//! `cargo xtask target`: build, emulate, compare with the host and with the expected values.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use cases::{Case, Visitor};

use crate::cycles;
use crate::emulator::{self, MACHINES, Output};
use crate::image::Image;
use crate::report::{Case as Row, Extremes, Report};
use crate::toolchain::{Toolchain, root};

/// The path whose code stands for the controller's: the paper's, which adds least of its own.
const PLAIN: &str = "circle";
/// What is no step, and is done where there is more stack.
const LAYING: &str = "laying";

/// Measures, prints, and compares with the expected values or replaces them.
pub fn run(json: bool, refresh: bool) -> Result<()> {
    let image = Image::build(&Toolchain::find()?)?;
    if !image.panic_free {
        // Said now, since a panic that happens ends the emulation below.
        eprintln!("a panic is reachable: the bench links only with its feature reachable-panics");
    }
    let outputs = MACHINES.map(|(core, machine)| emulator::bench(machine, &image.path).map(|output| (core, output)));
    let outputs = outputs.into_iter().collect::<Result<Vec<_>>>()?;
    let rows = rows(&image, &outputs)?;
    let report = summary(&image, &rows, &outputs);

    if json {
        println!("{}", serde_json::to_string(&report)?);
    } else {
        println!("{}", crate::report::table(&image, &rows, &report));
    }
    ensure!(image.allocators.is_empty(), "the image holds an allocator: {}", image.allocators.join(", "));
    ensure!(report.no_soft_double, "the image emulates double precision: {}", image.soft_doubles.join(", "));
    report.check_proofs()?;

    let path = root().join("firmware/bench/expected.json");
    if refresh {
        return std::fs::write(&path, serde_json::to_string_pretty(&report)? + "\n")
            .context("cannot write the expected values");
    }
    let text = std::fs::read_to_string(&path)
        .with_context(|| format!("cannot read {} (--refresh makes it)", path.display()))?;
    let expected: Report = serde_json::from_str(&text).with_context(|| format!("in {}", path.display()))?;
    report.check_against(&expected).with_context(|| format!("worse than {} allows", path.display()))
}

/// Digests of the same cases on the host.
#[derive(Default)]
struct Host(BTreeMap<String, u64>);

impl Visitor for Host {
    fn visit<C: Case>(&mut self, name: &str, case: Option<C>) {
        if let Some(mut case) = case {
            self.0.insert(name.to_owned(), cases::exercise(&mut case, cases::STATES, C::step).value());
        }
    }
}

/// One row a case, with the costs of the first core.
fn rows(image: &Image, outputs: &[(&str, Output)]) -> Result<Vec<Row>> {
    let mut host = Host::default();
    cases::visit_all(&mut host);
    let [(_, machine), ..] = MACHINES;
    let (_, first) = outputs.first().context("there is a machine")?;
    // What is no step is not traced.
    let steps: Vec<_> = first.cases.iter().filter(|(name, _)| name != LAYING).cloned().collect();
    let cycles = cycles::measure(machine, image, &steps)?;
    let row = |(name, measured): &(String, emulator::Measured)| {
        let stack_bound = image.calls.stack(measured.entry)?;
        ensure!(
            measured.stack <= u64::from(stack_bound),
            "{name} touched {} bytes of stack, but its call graph allows {stack_bound}: the analysis is wrong",
            measured.stack
        );
        let cores = outputs.iter().map(|(core, output)| {
            let digest = output.cases.iter().find(|(case, _)| case == name).map(|(_, measured)| measured.digest);
            ((*core).to_owned(), digest.is_some() && digest == host.0.get(name).copied())
        });
        Ok(Row {
            name: name.clone(),
            instructions: Extremes { best: measured.best, worst: measured.worst, mean: measured.mean },
            cycles: cycles.get(name).copied().unwrap_or_default(),
            code_bytes: image.calls.code_bytes(&image.calls.reachable(measured.entry)),
            stack_painted: measured.stack,
            stack_bound,
            ram_bytes: measured.ram,
            identical: cores.collect(),
        })
    };
    first.cases.iter().map(row).collect()
}

/// The whole in a few numbers.
fn summary(image: &Image, rows: &[Row], outputs: &[(&str, Output)]) -> Report {
    let roots = cases::roots().value();
    let code: BTreeMap<String, u32> = rows.iter().map(|row| (row.name.clone(), row.code_bytes)).collect();
    Report {
        instructions: rows.iter().map(|row| (row.name.clone(), row.instructions)).collect(),
        cycles: rows.iter().filter(|row| row.name != LAYING).map(|row| (row.name.clone(), row.cycles)).collect(),
        code_bytes: code.get(PLAIN).copied().unwrap_or(0),
        code_bytes_by_case: code,
        ram_bytes_by_case: rows.iter().map(|row| (row.name.clone(), row.ram_bytes)).collect(),
        ram_bytes: rows.iter().filter(|row| row.name != LAYING).map(|row| row.ram_bytes).max().unwrap_or(0),
        stack_bytes: rows.iter().filter(|row| row.name != LAYING).map(|row| row.stack_bound).max().unwrap_or(0),
        laying_stack_bytes: rows.iter().find(|row| row.name == LAYING).map_or(0, |row| row.stack_bound),
        bit_identical: rows.iter().all(|row| row.identical.iter().all(|(_, same)| *same))
            && outputs.iter().all(|(_, output)| output.roots == roots),
        panic_free: image.panic_free,
        no_soft_double: image.soft_doubles.is_empty(),
    }
}

#[cfg(test)]
mod tests {
    use cases::Digest;

    fn digest(numbers: &[f32]) -> u64 {
        let mut digest = Digest::default();
        numbers.iter().for_each(|&number| digest.take(number));
        digest.value()
    }

    /// "foob" is a test vector of draft-eastlake-fnv; read as a float it has these bits.
    #[test]
    fn the_digest_is_fnv_1a() {
        assert_eq!(digest(&[f32::from_bits(u32::from_le_bytes(*b"foob"))]), 0xDD12_0E79_0C25_12AF);
    }

    #[test]
    fn the_digest_sees_every_bit() {
        let one = digest(&[1.0, 0.0]);
        assert_ne!(digest(&[1.0, -0.0]), one);
        assert_ne!(digest(&[1.0_f32.next_up(), 0.0]), one);
        assert_ne!(digest(&[0.0, 1.0]), one);
    }
}
