//! Reads a small document and reports a misspelt key with its line: `cargo run -p relievo-toml --example line_numbers`.

#![allow(clippy::print_stdout)]

use relievo_toml::{ParseError, Value, did_you_mean, parse};

const DOCUMENT: &str = "\
# A lamp.
[lamp]
watts = 40
colr = \"warm\"
";

/// The keys that a lamp has.
const KEYS: [&str; 2] = ["watts", "color"];

fn main() -> Result<(), ParseError> {
    for table in parse(DOCUMENT)? {
        let Value::Table(entries) = table.node.value else { continue };
        for entry in entries {
            let (line, key) = (entry.node.at.line(), entry.key.as_str());
            if KEYS.contains(&key) {
                println!("line {line}: {key} is {}", entry.node.value.describe());
            } else {
                println!("line {line}: unknown key \"{key}\" in [{}]{}", table.key, did_you_mean(key, KEYS));
            }
        }
    }
    Ok(())
}
