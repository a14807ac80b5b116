//! Pictures inside the page.

use std::collections::HashMap;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use maud::{Markup, html};
use relievo_map::Grid;

use super::format::{decibels, short};
use super::markup::void_element;
use crate::colors::heat;
use crate::error::LabError;
use crate::metric::{DEFAULT_PIXELS_PER_DEGREE, flip};
use crate::sweep::{PictureRow, Results};
use crate::technique::{BEVY, EXACT, TUTORIALS};

/// Techniques with pictures; the figures of the others are in the table.
const SHOWN: [&str; 4] = [EXACT, TUTORIALS, BEVY, "relief:8..32+5"];

/// Quality of the pictures in the page; figures are computed from the files.
const JPEG_QUALITY: u8 = 82;

/// The pictures of all views that fit into the page, as markup by material.
pub(super) struct Album {
    pub(super) sections: HashMap<String, String>,
    /// Number of views that did not fit.
    pub(super) left_out: usize,
}

/// One view: the rows with one truth.
struct PictureView<'a> {
    rows: Vec<&'a PictureRow>,
}

impl<'a> PictureView<'a> {
    fn first(&self) -> &'a PictureRow {
        self.rows[0]
    }

    fn title(&self) -> String {
        let row = self.first();
        let distance = match row.minification {
            1 => String::new(),
            n => format!(", {n} texels per pixel"),
        };
        format!(
            "{}°, {} texels deep{distance}; truth: {} with {} samples per pixel, the others {}",
            row.angle, row.depth_texels, row.truth_is, row.truth_samples, row.samples
        )
    }

    /// The pictures with heat maps.
    fn markup(&self, folder: &Path) -> Result<Markup, LabError> {
        let truth = read(folder, &self.first().truth)?;
        let truth_image = image(&truth, "truth", "truth")?;
        let shown = SHOWN.iter().flat_map(|name| self.rows.iter().filter(move |row| row.technique == *name));
        let figures: Vec<Markup> = shown.map(|row| figure(folder, &truth, row)).collect::<Result<_, _>>()?;
        Ok(html! {
            h4 { (self.title()) }
            div.strip {
                figure { (truth_image) figcaption { "truth" } }
                @for figure in figures { (figure) }
            }
        })
    }
}

/// A technique's picture with its heat maps and figures.
fn figure(folder: &Path, truth: &Grid<[u8; 3]>, row: &PictureRow) -> Result<Markup, LabError> {
    let picture = read(folder, &row.picture)?;
    let name = format!("{}{}", row.technique, lod_suffix(row.lod));
    let flip_map = heat(&flip(truth, &picture, DEFAULT_PIXELS_PER_DEGREE)?.map, 1.0);
    let mut images =
        vec![image(&picture, "shot", &name)?, image(&flip_map, "map", &format!("{name}: FLIP, black 0 to white 1"))?];
    if let Some(hits) = &row.hits {
        let title = format!("{name}: hits off by 0 (black) to 8 texels (white)");
        images.push(image(&read(folder, hits)?, "map", &title)?);
    }
    Ok(html! {
        figure {
            @for image in images { (image) }
            figcaption {
                code { (row.technique) } (lod_suffix(row.lod))
                (void_element(&html! { br; }))
                "FLIP " (short(row.flip)) " · " (decibels(row.psnr_db))
            }
        }
    })
}

fn lod_suffix(lod: bool) -> &'static str {
    if lod { " lod" } else { "" }
}

/// Renders as many views as fit into `bytes`: the first of every material, then the second of every material, …
pub(super) fn album(folder: &Path, results: &Results, bytes: usize) -> Result<Album, LabError> {
    let mut views: Vec<Vec<PictureView<'_>>> = Vec::new();
    for material in &results.materials {
        let mut own: Vec<PictureView<'_>> = Vec::new();
        for row in results.pictures.iter().filter(|row| row.material == material.name) {
            match own.iter_mut().find(|view| view.first().truth == row.truth) {
                Some(view) => view.rows.push(row),
                None => own.push(PictureView { rows: vec![row] }),
            }
        }
        // Near and at large angles first: there the techniques differ most.
        own.sort_by(|a, b| {
            let (a, b) = (a.first(), b.first());
            a.minification.cmp(&b.minification).then(b.angle.total_cmp(&a.angle))
        });
        views.push(own);
    }
    let mut album = Album { sections: HashMap::new(), left_out: 0 };
    let mut room = bytes;
    let rounds = views.iter().map(Vec::len).max().unwrap_or(0);
    for round in 0..rounds {
        for view in views.iter().filter_map(|views| views.get(round)) {
            let html = if album.left_out == 0 { view.markup(folder)?.into_string() } else { String::new() };
            if html.is_empty() || html.len() > room {
                album.left_out += 1;
                continue;
            }
            room -= html.len();
            *album.sections.entry(view.first().material.clone()).or_default() += &html;
        }
    }
    Ok(album)
}

/// A table of FLIP and PSNR of every technique's picture.
pub(super) fn table(results: &Results, material: &str) -> Markup {
    let rows: Vec<&PictureRow> = results.pictures.iter().filter(|row| row.material == material).collect();
    let mut views: Vec<(u32, f32, f32)> = Vec::new();
    let mut names: Vec<(&str, bool)> = Vec::new();
    for row in &rows {
        let view = (row.minification, row.depth_texels, row.angle);
        if !views.contains(&view) {
            views.push(view);
        }
        if !names.contains(&(row.technique.as_str(), row.lod)) {
            names.push((&row.technique, row.lod));
        }
    }
    if rows.is_empty() {
        return Markup::default();
    }
    let find = |(technique, lod): (&str, bool), view: (u32, f32, f32)| {
        rows.iter().find(|row| {
            (row.technique.as_str(), row.lod) == (technique, lod)
                && (row.minification, row.depth_texels, row.angle) == view
        })
    };
    html! {
        p { "Mean FLIP and PSNR of the pictures." }
        div.wide {
            table {
                tr {
                    th { "technique" }
                    @for (minification, depth, angle) in &views {
                        th { (angle) "°, " (depth) " texels" @if *minification > 1 { ", 1:" (minification) } }
                    }
                }
                @for name in names {
                    tr {
                        td { code { (name.0) } (lod_suffix(name.1)) }
                        @for view in &views {
                            td {
                                @if let Some(row) = find(name, *view) { (short(row.flip)) " · " (decibels(row.psnr_db)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn failed(path: &Path, error: impl std::fmt::Display) -> LabError {
    LabError::Folder {
        path: path.to_owned(),
        doing: "reading this picture",
        source: std::io::Error::other(error.to_string()),
    }
}

/// Reads a picture of the sweep.
fn read(folder: &Path, name: &str) -> Result<Grid<[u8; 3]>, LabError> {
    let path = folder.join(name);
    let picture = image::open(&path).map_err(|error| failed(&path, error))?.into_rgb8();
    let (width, height) = picture.dimensions();
    Grid::new(width, height, picture.pixels().map(|pixel| pixel.0).collect()).map_err(|error| failed(&path, error))
}

/// An `img` with the picture in it.
fn image(picture: &Grid<[u8; 3]>, class: &str, title: &str) -> Result<Markup, LabError> {
    let mut bytes = Vec::new();
    let (width, height) = (picture.width(), picture.height());
    JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
        .write_image(picture.texels().as_flattened(), width, height, ExtendedColorType::Rgb8)
        .map_err(|error| failed(Path::new("report.html"), error))?;
    let source = format!("data:image/jpeg;base64,{}", STANDARD.encode(bytes));
    Ok(void_element(&html! {
        img class=(class) width=(width) height=(height) alt=(title) title=(title) src=(source);
    }))
}
