//! The summary as Markdown.

use super::findings::Findings;
use super::sentences::sentences;
use super::tables;
use crate::sweep::Results;

pub(super) fn summary(results: &Results) -> String {
    let findings = Findings::new(results);
    let machine = &results.machine;
    let mut out =
        format!("Relievo {} on {} ({} threads, {})", results.relievo, machine.cpu, machine.threads, machine.system);
    if let Some(adapter) = &machine.adapter {
        out += &format!("; {adapter}");
    }
    out += ".\n\n";
    for sentence in sentences(&findings) {
        out += &format!("- {sentence}\n");
    }
    for table in tables::all(&findings) {
        out += &format!("\n## {}\n\n{}\n\n", table.title, table.text);
        out += &line(table.head.iter().map(String::as_str));
        out += &line(table.head.iter().map(|_| "---"));
        for row in &table.rows {
            out += &line(row.iter().map(|cell| cell.text.as_str()));
        }
    }
    out
}

fn line<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let cells: Vec<String> = cells.map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}
