//! The page: self-contained, and well-formed XML too.

use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::findings::Findings;
use super::markup::{Prose, legend, table, void_element};
use super::sentences::sentences;
use super::{material, overview, pictures, tables};
use crate::colors;
use crate::error::LabError;
use crate::sweep::{MaterialRow, Results};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// Renders the page. Pictures are read from `folder` and included as long as the page stays within `page_bytes`.
pub(super) fn page(folder: &Path, results: &Results, page_bytes: usize) -> Result<String, LabError> {
    let findings = Findings::new(results);
    let (head, all, others, definitions) =
        (head(), all_materials(&findings), other_backends(&findings), definitions(results));
    let sections: Vec<Markup> = results.materials.iter().map(|row| section(&findings, &row.name)).collect();
    let fixed = [&head, &all, &others, &definitions].into_iter().chain(&sections);
    let used: usize = fixed.map(|markup| markup.0.len()).sum();
    let album = pictures::album(folder, results, page_bytes.saturating_sub(used))?;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (head)
            body {
                (all)
                (others)
                @if !results.pictures.is_empty() {
                    h2 { "Pictures and curves by material" }
                    p {
                        "Click a picture to compare it with the truth: drag the divider, or hold the space bar to see the \
                         truth; turn the wheel to zoom."
                        @if album.left_out > 0 {
                            " " (album.left_out) " more views are in the folder pictures of the results."
                        }
                    }
                }
                @for (i, (row, section)) in results.materials.iter().zip(&sections).enumerate() {
                    details open=[(i == 0).then_some("open")] {
                        summary { (row.name) " " small { (description(row)) } }
                        @if let Some(pictures) = album.sections.get(&row.name) { (PreEscaped(pictures)) }
                        (section)
                    }
                }
                (definitions)
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    // Names may hold control characters; XML may not.
    Ok(page.into_string().replace(|c: char| c.is_control() && c != '\n', " "))
}

fn head() -> Markup {
    html! {
        head {
            (void_element(&html! { meta charset="utf-8"; }))
            title { "Relievo lab" }
            (void_element(&html! { meta name="viewport" content="width=device-width, initial-scale=1"; }))
            style { (PreEscaped(colors::report::style())) (PreEscaped(STYLE)) }
        }
    }
}

/// The machine, and the findings over all materials.
fn all_materials(findings: &Findings<'_>) -> Markup {
    html! {
        h1 { "Relievo lab" }
        (machine(findings.results))
        (sentence_list(findings))
        h2 { "All materials" }
        p { "Curves are means over all materials." }
        (legend(&findings.techniques))
        (plots_and_tables(findings))
    }
}

/// The findings on the other backends: times differ.
fn other_backends(findings: &Findings<'_>) -> Markup {
    let mut backends: Vec<&str> = findings.results.hits.iter().map(|row| row.backend.as_str()).collect();
    backends.dedup();
    html! {
        @for backend in backends.into_iter().filter(|backend| *backend != findings.backend) {
            @let other = Findings::of_backend(findings.results, backend);
            h2 { "On the " (backend) }
            (sentence_list(&other))
            (plots_and_tables(&other))
        }
    }
}

fn sentence_list(findings: &Findings<'_>) -> Markup {
    html! {
        ul.findings {
            @for sentence in sentences(findings) { li { (Prose(&sentence)) } }
        }
    }
}

fn plots_and_tables(findings: &Findings<'_>) -> Markup {
    html! {
        div.plots { @for plot in overview::plots(findings) { (plot) } }
        @for data in tables::all(findings) { (table(&data)) }
    }
}

/// A material's curves and tables.
fn section(findings: &Findings<'_>, name: &str) -> Markup {
    html! {
        h4 { "Equal-error curves, " (findings.depth) " texels deep: what is lower left is better" }
        (legend(&findings.techniques))
        div.plots { @for curve in material::curves(findings, name) { (curve) } }
        (material::table(findings, name))
        (pictures::table(findings.results, name))
    }
}

fn description(row: &MaterialRow) -> String {
    format!("{}, {}×{} texels, mean height {:.2}", row.source, row.width, row.height, row.mean_height)
}

fn machine(results: &Results) -> Markup {
    let machine = &results.machine;
    let adapter = machine.adapter.as_deref().map_or("no GPU was measured".to_owned(), |name| format!("GPU: {name}"));
    html! {
        p.machine {
            "Relievo " (results.relievo) " · CPU: " (machine.cpu) ", " (machine.threads) " threads (" (machine.system)
            "); marches timed on one · " (adapter)
        }
    }
}

fn definitions(results: &Results) -> Markup {
    html! {
        h2 { "What the words mean" }
        dl {
            @for (word, meaning) in &results.definitions { dt { (word) } dd { (meaning) } }
        }
    }
}
