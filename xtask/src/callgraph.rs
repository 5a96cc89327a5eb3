//! The functions of a linked image and who calls whom, read from its instructions: so it holds for
//! the project's code, for the mathematical library and for the compiler's own routines alike,
//! whoever compiled them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use anyhow::{Context, Result, bail, ensure};
use object::{Object, ObjectSection, ObjectSymbol, SectionKind, SymbolKind};

use crate::thumb::{Effect, decode};

/// One function of the image.
struct Function {
    name: String,
    /// Code and literals, bytes.
    size: u32,
    /// Most stack that its own instructions can hold at once, bytes: the sum of all they take.
    frame: u32,
    /// Entries of the functions it calls or jumps to.
    calls: BTreeSet<u32>,
    /// Why its stack can't be bounded.
    obstacle: Option<&'static str>,
}

/// The image's functions by address.
pub struct CallGraph(BTreeMap<u32, Function>);

impl CallGraph {
    /// Decodes every function of `elf`.
    pub fn read(elf: &object::File<'_>) -> Result<Self> {
        let mut extents = BTreeMap::new();
        // Mapping symbols ($t, $d) say where instructions end and literals begin.
        let mut is_code = BTreeMap::new();
        for symbol in elf.symbols() {
            let (name, address) = (symbol.name()?, symbol.address() as u32);
            if name.starts_with("$t") || name.starts_with("$d") {
                is_code.insert(address, name.starts_with("$t"));
            } else if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
                extents.insert(address & !1, (format!("{:#}", rustc_demangle::demangle(name)), symbol.size() as u32));
            }
        }
        let mut functions = BTreeMap::new();
        for section in elf.sections().filter(|section| section.kind() == SectionKind::Text) {
            let (start, code) = (section.address() as u32, section.data()?);
            for (&address, (name, size)) in extents.range(start..start + code.len() as u32) {
                let from = (address - start) as usize;
                let body =
                    code.get(from..from + *size as usize).with_context(|| format!("{name} exceeds its section"))?;
                functions.insert(address, Function::read(name, address, body, &is_code));
            }
        }
        // A jump between two functions may lead behind the other's entry.
        let entries: Vec<u32> = functions.keys().copied().collect();
        for function in functions.values_mut() {
            function.calls = function
                .calls
                .iter()
                .map(|call| entries[entries.partition_point(|entry| entry <= call).saturating_sub(1)])
                .collect();
        }
        Ok(Self(functions))
    }

    /// Most stack that a call of `entry` can take, bytes.
    pub fn stack(&self, entry: u32) -> Result<u32> {
        self.depth(entry, &mut Vec::new())
    }

    fn depth(&self, entry: u32, callers: &mut Vec<u32>) -> Result<u32> {
        let function = self.0.get(&entry).with_context(|| format!("no function at {entry:#x}"))?;
        if let Some(obstacle) = function.obstacle {
            bail!("the stack of {} has no bound: {obstacle}", function.name);
        }
        ensure!(!callers.contains(&entry), "{} calls itself", function.name);
        callers.push(entry);
        let mut below = 0;
        for &call in &function.calls {
            below = below.max(self.depth(call, callers)?);
        }
        callers.pop();
        Ok(function.frame + below)
    }

    /// Entries of all functions that `entry` can reach, itself among them.
    pub fn reachable(&self, entry: u32) -> BTreeSet<u32> {
        let (mut seen, mut open) = (BTreeSet::new(), vec![entry]);
        while let Some(next) = open.pop() {
            if seen.insert(next) {
                open.extend(self.0.get(&next).into_iter().flat_map(|function| &function.calls));
            }
        }
        seen
    }

    /// Where the functions are whose names contain `part`.
    pub fn named(&self, part: &str) -> impl Iterator<Item = Range<u32>> {
        let named = self.0.iter().filter(move |(_, function)| function.name.contains(part));
        named.map(|(&entry, function)| entry..entry + function.size)
    }

    /// Where these functions are.
    pub fn extents(&self, entries: &BTreeSet<u32>) -> impl Iterator<Item = Range<u32>> {
        let functions = entries.iter().filter_map(|&entry| Some((entry, self.0.get(&entry)?)));
        functions.map(|(entry, function)| entry..entry + function.size)
    }

    /// Code and literals of these functions, bytes.
    pub fn code_bytes(&self, entries: &BTreeSet<u32>) -> u32 {
        entries.iter().filter_map(|entry| self.0.get(entry)).map(|function| function.size).sum()
    }
}

impl Function {
    fn read(name: &str, start: u32, body: &[u8], is_code: &BTreeMap<u32, bool>) -> Self {
        let end = start + body.len() as u32;
        let half = |address: u32| {
            let at = (address - start) as usize;
            body.get(at..at + 2).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
        };
        let mut function =
            Self { name: name.to_owned(), size: end - start, frame: 0, calls: BTreeSet::new(), obstacle: None };
        let mut address = start;
        while address < end {
            if let Some((_, false)) = is_code.range(..=address).next_back() {
                address = is_code.range(address + 1..).next().map_or(end, |(&next, _)| next);
                continue;
            }
            let (effect, length) = decode(address, half(address), half(address + 2));
            match effect {
                Effect::Other => {}
                Effect::Stack(bytes) => function.frame += bytes,
                // Inside the function it is a loop or a choice, but a branch to the very start is a
                // call of itself.
                Effect::Branch(to) if to > start && to < end => {}
                Effect::Branch(to) => drop(function.calls.insert(to)),
                Effect::Indirect => function.obstacle = Some("it calls or jumps through a register"),
                Effect::UnknownStack => function.obstacle = Some("it sets the stack pointer from a register"),
            }
            address += length;
        }
        function
    }
}
