//! Markup that several parts of the page share. The page is HTML that is well-formed XML too.

use maud::{Markup, PreEscaped, Render, html};

use super::tables::Table;
use crate::colors::report::{cell_background, series_class};
use crate::technique::ResolvedTechnique;

/// Text in which names between backquotes are set as code.
pub(super) struct Prose<'a>(pub(super) &'a str);

impl Render for Prose<'_> {
    fn render(&self) -> Markup {
        html! {
            @for (i, part) in self.0.split('`').enumerate() {
                @if i % 2 == 1 { code { (part) } } @else { (part) }
            }
        }
    }
}

/// Closes a void element as XML does: maud writes `<br>`, XML wants `<br/>`.
pub(super) fn void_element(element: &Markup) -> Markup {
    PreEscaped(format!("{}/>", element.0.trim_end_matches('>')))
}

/// The family of a technique, by its text; empty if unknown.
pub(super) fn family(technique: &str) -> &'static str {
    technique.parse::<ResolvedTechnique>().map_or("", |technique| technique.family())
}

/// The colours of the families of techniques.
pub(super) fn legend(techniques: &[&str]) -> Markup {
    let mut families: Vec<&str> = Vec::new();
    for technique in techniques {
        let family = family(technique);
        if !families.contains(&family) {
            families.push(family);
        }
    }
    html! {
        p.legend {
            @for family in families { span class=(series_class(family)) { i {} (family) } }
        }
    }
}

/// A table with its title and explanation.
pub(super) fn table(table: &Table) -> Markup {
    html! {
        h3 { (Prose(&table.title)) }
        p { (Prose(&table.text)) }
        div.wide {
            table {
                tr { @for head in &table.head { th { (Prose(head)) } } }
                @for row in &table.rows {
                    tr {
                        @for cell in row {
                            td style=[cell.heat.and_then(cell_background)] { (Prose(&cell.text)) }
                        }
                    }
                }
            }
        }
    }
}
