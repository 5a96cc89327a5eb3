//! What is in a product that we did not write: bills of materials in CycloneDX, and licences.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::{Value, json};

use crate::toolchain::root;

/// Something that is shipped.
pub struct Product {
    /// As in its files' names.
    pub name: &'static str,
    /// Of its workspace, from the root.
    pub manifest: &'static str,
    /// The package that is built.
    pub package: &'static str,
}

/// A package of somebody else's.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Component {
    name: String,
    version: String,
    licence: String,
    /// SHA-256 of the registry's archive.
    checksum: Option<String>,
    folder: PathBuf,
}

/// A product with all that is linked into it.
pub struct Bill {
    name: &'static str,
    version: String,
    components: BTreeSet<Component>,
}

/// Reads the bill of a product from cargo's own resolution.
pub fn bill(product: &Product) -> Result<Bill> {
    let manifest = root().join(product.manifest);
    let output = Command::new("cargo")
        .args(["metadata", "--format-version=1", "--locked", "--manifest-path"])
        .arg(&manifest)
        .output()
        .context("cannot run cargo metadata")?;
    ensure!(output.status.success(), "{}: {}", product.manifest, String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout)?;
    let of = |list: &Value| -> HashMap<String, Value> {
        let items = list.as_array().into_iter().flatten();
        items.map(|item| (text(item, "id"), item.clone())).collect()
    };
    let (packages, nodes) = (of(&metadata["packages"]), of(&metadata["resolve"]["nodes"]));
    let checksums = checksums(&manifest.with_file_name("Cargo.lock"))?;
    let own = packages.values().find(|package| text(package, "name") == product.package);
    let own = own.with_context(|| format!("{}: no package {}", product.manifest, product.package))?;

    let mut left = vec![text(own, "id")];
    let mut seen: BTreeSet<String> = left.iter().cloned().collect();
    let mut components = BTreeSet::new();
    while let Some(id) = left.pop() {
        let (package, node) = (&packages[&id], &nodes[&id]);
        // Ours have no source but this repository.
        if !package["source"].is_null() {
            let (name, version) = (text(package, "name"), text(package, "version"));
            components.insert(Component {
                checksum: checksums.get(&(name.clone(), version.clone())).cloned(),
                licence: package["license"].as_str().unwrap_or("NOASSERTION").to_owned(),
                folder: Path::new(&text(package, "manifest_path"))
                    .parent()
                    .context("a manifest lies somewhere")?
                    .into(),
                name,
                version,
            });
        }
        for dependency in node["deps"].as_array().into_iter().flatten() {
            // What builds or tests it is not in it.
            let kinds = dependency["dep_kinds"].as_array().into_iter().flatten();
            if kinds.clone().any(|kind| kind["kind"].is_null()) && seen.insert(text(dependency, "pkg")) {
                left.push(text(dependency, "pkg"));
            }
        }
    }
    Ok(Bill { name: product.name, version: text(own, "version"), components })
}

fn text(value: &Value, field: &str) -> String {
    value[field].as_str().unwrap_or_default().to_owned()
}

/// Checksums of a lock file by name and version.
fn checksums(lock: &Path) -> Result<HashMap<(String, String), String>> {
    let text = std::fs::read_to_string(lock).with_context(|| format!("cannot read {}", lock.display()))?;
    let mut checksums = HashMap::new();
    for package in text.split("[[package]]").skip(1) {
        let field = |name: &str| {
            let line = package.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(" = "));
            line.map(|value| value.trim_matches('"').to_owned())
        };
        if let (Some(name), Some(version), Some(checksum)) = (field("name"), field("version"), field("checksum")) {
            checksums.insert((name, version), checksum);
        }
    }
    Ok(checksums)
}

impl Component {
    /// An SPDX expression: some packages still write a slash for "or".
    fn expression(&self) -> String {
        self.licence.replace('/', " OR ").replace("  ", " ")
    }
}

impl Bill {
    /// In CycloneDX 1.6.
    pub fn json(&self) -> Value {
        let components: Vec<Value> = self
            .components
            .iter()
            .map(|component| {
                let Component { name, version, checksum, .. } = component;
                let purl = format!("pkg:cargo/{name}@{version}");
                let mut json = json!({
                    "type": "library",
                    "bom-ref": purl,
                    "name": name,
                    "version": version,
                    "licenses": [{ "expression": component.expression() }],
                    "purl": purl,
                });
                if let Some(checksum) = checksum {
                    json["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
                }
                json
            })
            .collect();
        json!({
            "bomFormat": "CycloneDX",
            "specVersion": "1.6",
            "version": 1,
            "metadata": {
                "component": {
                    "type": "application",
                    "bom-ref": self.name,
                    "name": self.name,
                    "version": self.version,
                    "licenses": [{ "expression": "MIT OR Apache-2.0" }],
                },
            },
            "components": components,
        })
    }
}

/// The licences of all that is in the products, each text once.
pub fn notices(bills: &[Bill]) -> Result<String> {
    let mut texts: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut lists = String::from(
        "What is in the files beside this one that others wrote, and on which terms. The source of each is at\n\
         https://crates.io/crates/NAME/VERSION.\n",
    );
    for bill in bills {
        writeln!(lists, "\n{}:", bill.name)?;
        for component in &bill.components {
            writeln!(lists, "  {} {}: {}", component.name, component.version, component.expression())?;
        }
    }
    let components: BTreeSet<&Component> = bills.iter().flat_map(|bill| &bill.components).collect();
    for component in components {
        for file in std::fs::read_dir(&component.folder)? {
            let path = file?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
            let is_notice =
                ["LICEN", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"].iter().any(|word| name.starts_with(word));
            if is_notice && path.is_file() {
                // Line ends and spaces at them are no other licence.
                let text: Vec<String> = String::from_utf8_lossy(&std::fs::read(&path)?)
                    .lines()
                    .map(|line| line.trim_end().to_owned())
                    .collect();
                let names = texts.entry(text.join("\n").trim().to_owned()).or_default();
                names.insert(format!("{} {}", component.name, component.version));
            }
        }
    }
    for (text, names) in texts {
        let names: Vec<String> = names.into_iter().collect();
        writeln!(lists, "\n{}\n{}\n\n{text}", "-".repeat(100), names.join(", "))?;
    }
    Ok(lists)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIMULATOR: Product = Product { name: "hil-sim", manifest: "Cargo.toml", package: "hil-sim" };

    #[test]
    fn a_bill_holds_what_is_linked_and_nothing_else() {
        let bill = bill(&SIMULATOR).unwrap();
        let of = |name: &str| bill.components.iter().find(|component| component.name == name);
        assert_eq!(of("serialport").unwrap().licence, "MPL-2.0");
        assert!(of("serialport").unwrap().checksum.as_ref().is_some_and(|checksum| checksum.len() == 64));
        // Of tests alone, and ours.
        assert!(of("proptest").is_none() && of("controller").is_none());
        assert!(bill.components.iter().all(|component| component.licence != "NOASSERTION"), "{:?}", bill.components);
        let json = bill.json();
        assert_eq!(json["components"].as_array().unwrap().len(), bill.components.len());
        assert_eq!(json["specVersion"], "1.6");
    }

    #[test]
    fn the_notices_hold_each_licence_once() {
        let notices = notices(&[bill(&SIMULATOR).unwrap(), bill(&SIMULATOR).unwrap()]).unwrap();
        assert!(notices.contains("  serialport "));
        assert_eq!(notices.matches("https://mozilla.org/MPL/2.0/").count(), 1);
    }
}
