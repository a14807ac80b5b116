//! The page: it needs no other file, and is well-formed XML too.

use std::fmt::Write;
use std::path::Path;

use relievo_march::Technique;

use super::findings::Findings;
use super::{material, overview, pictures, tables};
use crate::{Candidate, LabError, Results, heat_color};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

pub(super) fn page(folder: &Path, results: &Results, page_bytes: usize) -> Result<String, LabError> {
    let findings = Findings::new(results);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><title>Relievo lab</title>\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\
         <style>{STYLE}</style></head><body>\n<h1>Relievo lab</h1>"
    );
    out += &machine(results);
    out += "<ul class=\"findings\">";
    for sentence in findings.sentences() {
        let _ = write!(out, "<li>{}</li>", text(&sentence));
    }
    out += "</ul>\n<h2>All materials</h2><p>Curves are means over all materials.</p>";
    out += &legend(&findings);
    let _ = writeln!(out, "<div class=\"plots\">{}</div>", overview::plots(&findings).concat());
    for table in tables::all(&findings) {
        out += &html_table(&table);
    }
    // Tables of a second backend, where there is one: what it costs differs.
    let mut backends: Vec<&str> = results.hits.iter().map(|row| row.backend.as_str()).collect();
    backends.dedup();
    for backend in backends.into_iter().filter(|backend| *backend != findings.backend) {
        let other = Findings::of_backend(results, backend);
        let _ = write!(out, "<h2>On the {backend}</h2><ul class=\"findings\">");
        for sentence in other.sentences() {
            let _ = write!(out, "<li>{}</li>", text(&sentence));
        }
        let _ = write!(out, "</ul><div class=\"plots\">{}</div>", overview::plots(&other).concat());
        for table in tables::all(&other) {
            out += &html_table(&table);
        }
    }
    let mut end = "\n<h2>What the words mean</h2><dl>".to_owned();
    for (word, meaning) in &results.definitions {
        let _ = write!(end, "<dt>{}</dt><dd>{}</dd>", escape(word), escape(meaning));
    }
    let _ = writeln!(end, "</dl><script>{SCRIPT}</script></body></html>");

    let sections: Vec<(&str, String)> =
        results.materials.iter().map(|m| (m.name.as_str(), section(&findings, results, &m.name))).collect();
    let used = out.len() + end.len() + sections.iter().map(|(_, html)| html.len()).sum::<usize>();
    let album = pictures::album(folder, results, page_bytes.saturating_sub(used))?;
    if !results.pictures.is_empty() {
        out += "<h2>Pictures and curves by material</h2><p>Click a picture to compare it with the truth: drag the divider, \
                or hold the space bar to see the truth; turn the wheel to zoom.";
        if album.left_out > 0 {
            let _ = write!(out, " {} more views are in the folder pictures of the results.", album.left_out);
        }
        out += "</p>";
    }
    for (i, (name, html)) in sections.iter().enumerate() {
        let open = if i == 0 { " open=\"open\"" } else { "" };
        let size = results.materials.iter().find(|m| m.name == *name);
        let size = size.map_or_else(String::new, |m| {
            format!("{}, {}×{} texels, mean height {:.2}", m.source, m.width, m.height, m.mean_height)
        });
        let _ = writeln!(
            out,
            "<details{open}><summary>{} <small>{}</small></summary>{}{html}</details>",
            escape(name),
            escape(&size),
            album.sections.get(*name).map_or("", String::as_str)
        );
    }
    Ok(out + &end)
}

fn section(findings: &Findings<'_>, results: &Results, name: &str) -> String {
    format!(
        "<h4>Equal-error curves, {} texels deep: what is lower left is better</h4>{}<div class=\"plots\">{}</div>{}{}",
        findings.depth,
        legend(findings),
        material::curves(findings, name).concat(),
        material::table(findings, name),
        pictures::table(results, name)
    )
}

fn machine(results: &Results) -> String {
    let machine = &results.machine;
    let adapter = machine.adapter.as_deref().map_or("no GPU was measured".to_owned(), |name| format!("GPU: {name}"));
    format!(
        "<p class=\"machine\">Relievo {} · CPU: {}, {} threads ({}); marches timed on one · {}</p>",
        escape(&results.relievo),
        escape(&machine.cpu),
        machine.threads,
        escape(&machine.system),
        escape(&adapter)
    )
}

/// Which colour is which technique.
fn legend(findings: &Findings<'_>) -> String {
    let mut families: Vec<&str> = Vec::new();
    for technique in &findings.techniques {
        let family = technique.parse::<Candidate>().map_or("", |candidate| candidate.family());
        if !families.contains(&family) {
            families.push(family);
        }
    }
    let entry = |family: &&str| format!("<span class=\"c{}\"><i></i>{}</span>", color(family), escape(family));
    format!("<p class=\"legend\">{}</p>", families.iter().map(entry).collect::<String>())
}

fn html_table(table: &tables::Grid) -> String {
    let mut out = format!("<h3>{}</h3><p>{}</p><div class=\"wide\"><table><tr>", text(&table.title), text(&table.text));
    for head in &table.head {
        let _ = write!(out, "<th>{}</th>", text(head));
    }
    out += "</tr>";
    for row in &table.rows {
        out += "<tr>";
        for cell in row {
            let style = cell.heat.filter(|heat| *heat > 0.005).map_or_else(String::new, |heat| {
                let [r, g, b] = heat_color(0.45 + 0.3 * heat.clamp(0.0, 1.0) as f32);
                format!(" style=\"background:rgba({r},{g},{b},{:.2})\"", 0.15 + 0.45 * heat.clamp(0.0, 1.0))
            });
            let _ = write!(out, "<td{style}>{}</td>", text(&cell.text));
        }
        out += "</tr>";
    }
    out + "</table></div>\n"
}

/// The class of a technique's colour, by its name or that of one of its settings.
pub(super) fn color(technique: &str) -> usize {
    let candidate: Option<Candidate> = technique.parse().ok();
    let family = candidate.map_or(technique, |candidate| candidate.family());
    // The walk over every cell has the place that nobody else needs: `none` is never drawn.
    Technique::ALL.iter().position(|technique| technique.name() == family).unwrap_or(0)
}

/// Text with `names` between backquotes.
fn text(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    let part = |(i, part): (usize, &&str)| if i % 2 == 1 { code(part) } else { escape(part) };
    parts.iter().enumerate().map(part).collect()
}

pub(super) fn code(text: &str) -> String {
    format!("<code>{}</code>", escape(text))
}

pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            // XML has no such characters.
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
