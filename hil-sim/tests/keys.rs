//! The page of keys against what reads scenario files.

use hil_sim::describe::keys::{Key, SECTIONS, Section, Values, page};
use hil_sim::describe::scenario::Scenario;
use toml::{Table, Value};

/// The table of a section in a scenario, made if it is not there: the part of its name before a
/// comma.
fn within<'a>(scenario: &'a mut Table, section: &Section) -> &'a mut Table {
    let name = section.table.split(',').next().unwrap_or_default();
    name.split('.').filter(|part| !part.is_empty()).fold(scenario, |table, part| {
        let entry = table.entry(part).or_insert_with(|| Table::new().into());
        match entry {
            Value::Array(list) => list.first_mut().and_then(Value::as_table_mut).expect("a list of tables"),
            table => table.as_table_mut().expect("a table"),
        }
    })
}

/// The section's least scenario with a key at a value.
fn with(section: &Section, name: &str, value: Value) -> Table {
    let mut scenario: Table = toml::from_str(section.least).expect("TOML");
    within(&mut scenario, section).insert(name.to_owned(), value);
    scenario
}

fn read(scenario: Table) -> Result<Scenario, String> {
    Scenario::from_table("keys", scenario).map_err(|invalid| invalid.to_string())
}

#[test]
fn the_page_in_the_repository_is_the_one_that_is_printed() {
    let kept = include_str!("../../docs/scenario.md");
    assert!(kept == page(), "docs/scenario.md is not what `hil-sim keys` prints");
}

#[test]
fn a_scenario_of_nothing_is_the_papers_figure() {
    let nothing = read(Table::new()).unwrap();
    let figure = Scenario::parse("keys.toml", include_str!("../scenarios/fig3a.toml")).unwrap();
    // But for its caption, and for how often it is logged.
    let Scenario { title, figure: panel, log_period_s, .. } = figure.clone();
    assert_eq!(Scenario { title, figure: panel, log_period_s, ..nothing }, figure);
    let tracking: Table = toml::from_str("controller = { law = \"track\" }").unwrap();
    let figure = Scenario::parse("keys.toml", include_str!("../scenarios/fig3b.toml")).unwrap();
    assert_eq!(read(tracking).unwrap().controller.law, figure.controller.law);
}

/// A name that nobody uses is refused with the names that are known: those of the page.
#[test]
fn every_key_that_is_read_is_on_the_page() {
    for section in SECTIONS {
        let error = read(with(section, "nobody", 1.into())).expect_err(section.table);
        let (_, list) = error.split_once("expected").unwrap_or_else(|| panic!("{}: {error}", section.table));
        let list = list.lines().next().unwrap_or_default();
        let known: Vec<&str> = list.split('`').skip(1).step_by(2).collect();
        // The keys of all curves stand in a section of their own.
        let is_curve = section.table.starts_with("path,") && !section.table.contains("route");
        let common = SECTIONS.iter().find(|other| other.table == "path" && is_curve);
        let listed: Vec<&str> =
            section.keys.iter().chain(common.map_or(&[][..], |common| common.keys)).map(|key| key.name).collect();
        for name in &known {
            assert!(listed.contains(name) || section.table == "path", "{}: {name} is not on the page", section.table);
        }
        for name in &listed {
            assert!(known.contains(name), "{}: {name} is not read", section.table);
        }
    }
}

/// Both ends of each range are taken, and a little beyond is refused with the key's name.
#[test]
fn ranges_are_the_ones_that_are_refused_beyond() {
    let beyond = |value: f64, sign: f64| value + sign * (1e-6 * value.abs()).max(1e-9);
    for section in SECTIONS {
        for Key { name, values, .. } in section.keys {
            let what = format!("{}.{name}", section.table);
            let accepted = |value: Value| {
                read(with(section, name, value.clone())).unwrap_or_else(|error| panic!("{what} = {value}: {error}"));
            };
            let refused = |value: Value| {
                let error = read(with(section, name, value.clone())).expect_err(&format!("{what} = {value}"));
                assert!(error.contains(name), "{what} = {value}: {error}");
            };
            let each = |count: usize, value: f64| Value::Array(vec![value.into(); count]);
            match *values {
                Values::Number(low, high) => {
                    [low, high].into_iter().for_each(|end| accepted(end.into()));
                    refused(beyond(low, -1.0).into());
                    refused(beyond(high, 1.0).into());
                }
                Values::Whole(low, high) => {
                    [low, high].into_iter().for_each(|end| accepted((end as i64).into()));
                    refused((low as i64 - 1).into());
                    // Seeds go on.
                    if high < 1 << 53 {
                        refused((high as i64 + 1).into());
                    }
                }
                Values::Each(count, low, high) => {
                    [low, high].into_iter().for_each(|end| accepted(each(count, end)));
                    refused(each(count, beyond(low, -1.0)));
                    refused(each(count, beyond(high, 1.0)));
                    refused(each(count + 1, low));
                }
                Values::Word(words) => {
                    for word in words {
                        // What law flies depends on the course that is given.
                        accepted(word.parse::<bool>().map_or_else(|_| (*word).into(), Value::from));
                    }
                    refused("nobody".into());
                }
                Values::Other(_) => {}
            }
        }
    }
}

/// A key at its default is a key left out.
#[test]
fn defaults_are_what_is_taken() {
    for section in SECTIONS {
        for Key { name, default, .. } in section.keys.iter().filter(|key| !key.default.starts_with('(')) {
            let without = || {
                let mut scenario: Table = toml::from_str(section.least).expect("TOML");
                within(&mut scenario, section).remove(*name);
                read(scenario)
            };
            if default.is_empty() {
                assert!(without().is_err(), "{}.{name} need not be given", section.table);
                continue;
            }
            let value: Table = toml::from_str(&format!("value = {default}")).expect("TOML");
            let given = read(with(section, name, value["value"].clone()));
            assert_eq!(given, without(), "{}.{name}", section.table);
            assert!(given.is_ok(), "{}.{name}: {given:?}", section.table);
        }
    }
}
