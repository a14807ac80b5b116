//! Pictures inside the page.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use relievo_map::Grid;

use super::findings::short;
use super::html::{code, escape};
use crate::{DEFAULT_PIXELS_PER_DEGREE, LabError, PictureRow, Results, flip, heat};

/// The techniques whose pictures are shown; the figures of the others are in the table.
const SHOWN: [&str; 4] = ["exact", "occlusion:8..32", "occlusion:1..16", "relief:8..32+5"];

/// Good enough to judge by eye; figures are of the files themselves.
const JPEG_QUALITY: u8 = 82;

/// The pictures of all views that fit, as HTML by material.
pub(super) struct Album {
    pub(super) sections: HashMap<String, String>,
    /// Views that did not fit.
    pub(super) left_out: usize,
}

/// One view: the rows that share a truth.
struct View<'a> {
    rows: Vec<&'a PictureRow>,
}

impl<'a> View<'a> {
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
    fn html(&self, folder: &Path) -> Result<String, LabError> {
        let truth = read(folder, &self.first().truth)?;
        let mut out = format!("<h4>{}</h4><div class=\"strip\">", escape(&self.title()));
        let _ = write!(out, "<figure>{}<figcaption>truth</figcaption></figure>", image(&truth, "truth", "truth")?);
        for technique in SHOWN {
            for row in self.rows.iter().filter(|row| row.technique == technique) {
                let picture = read(folder, &row.picture)?;
                let name = if row.lod { format!("{technique} lod") } else { technique.to_owned() };
                let seen = heat(&flip(&truth, &picture, DEFAULT_PIXELS_PER_DEGREE)?.map, 1.0);
                let _ = write!(out, "<figure>{}", image(&picture, "shot", &name)?);
                let _ = write!(out, "{}", image(&seen, "map", &format!("{name}: FLIP, black 0 to white 1"))?);
                if let Some(hits) = &row.hits {
                    let title = format!("{name}: hits off by 0 (black) to 8 texels (white)");
                    let _ = write!(out, "{}", image(&read(folder, hits)?, "map", &title)?);
                }
                let psnr = row.psnr_db.map_or_else(|| "equal".to_owned(), |psnr| format!("{psnr:.1} dB"));
                let _ = write!(
                    out,
                    "<figcaption>{}{}<br/>FLIP {} · {psnr}</figcaption></figure>",
                    code(technique),
                    if row.lod { " lod" } else { "" },
                    short(row.flip)
                );
            }
        }
        Ok(out + "</div>")
    }
}

/// Puts in as many views as fit into `bytes`: of every material the first, then of every material the next.
pub(super) fn album(folder: &Path, results: &Results, bytes: usize) -> Result<Album, LabError> {
    let mut views: Vec<Vec<View<'_>>> = Vec::new();
    for material in &results.materials {
        let mut own: Vec<View<'_>> = Vec::new();
        for row in results.pictures.iter().filter(|row| row.material == material.name) {
            match own.iter_mut().find(|view| view.first().truth == row.truth) {
                Some(view) => view.rows.push(row),
                None => own.push(View { rows: vec![row] }),
            }
        }
        // Near and steep first: there the techniques differ most.
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
            let html = if album.left_out == 0 { view.html(folder)? } else { String::new() };
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

/// FLIP and PSNR of every technique's picture.
pub(super) fn table(results: &Results, material: &str) -> String {
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
        return String::new();
    }
    let mut out =
        "<p>Mean FLIP and PSNR of the pictures.</p><div class=\"wide\"><table><tr><th>technique</th>".to_owned();
    for (minification, depth, angle) in &views {
        let distance = if *minification > 1 { format!(", 1:{minification}") } else { String::new() };
        let _ = write!(out, "<th>{angle}°, {depth} texels{distance}</th>");
    }
    out += "</tr>";
    for (technique, lod) in names {
        let _ = write!(out, "<tr><td>{}{}</td>", code(technique), if lod { " lod" } else { "" });
        for (minification, depth, angle) in &views {
            let found = rows.iter().find(|row| {
                (row.technique.as_str(), row.lod, row.minification, row.depth_texels, row.angle)
                    == (technique, lod, *minification, *depth, *angle)
            });
            let cell = found.map_or_else(String::new, |row| {
                let psnr = row.psnr_db.map_or_else(|| "equal".to_owned(), |psnr| format!("{psnr:.1} dB"));
                format!("{} · {psnr}", short(row.flip))
            });
            let _ = write!(out, "<td>{cell}</td>");
        }
        out += "</tr>";
    }
    out + "</table></div>"
}

fn failed(path: &Path, error: impl std::fmt::Display) -> LabError {
    LabError::Folder {
        path: path.to_owned(),
        doing: "reading this picture",
        source: std::io::Error::other(error.to_string()),
    }
}

/// A picture that the sweep wrote.
fn read(folder: &Path, name: &str) -> Result<Grid<[u8; 3]>, LabError> {
    let path = folder.join(name);
    let picture = image::open(&path).map_err(|error| failed(&path, error))?.into_rgb8();
    let (width, height) = picture.dimensions();
    Grid::new(width, height, picture.pixels().map(|pixel| pixel.0).collect()).map_err(|error| failed(&path, error))
}

/// An `img` with the picture in it.
fn image(picture: &Grid<[u8; 3]>, class: &str, title: &str) -> Result<String, LabError> {
    let mut bytes = Vec::new();
    let (width, height) = (picture.width(), picture.height());
    JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
        .write_image(picture.texels().as_flattened(), width, height, ExtendedColorType::Rgb8)
        .map_err(|error| failed(Path::new("report.html"), error))?;
    let title = escape(title);
    Ok(format!(
        "<img class=\"{class}\" width=\"{width}\" height=\"{height}\" alt=\"{title}\" title=\"{title}\" \
         src=\"data:image/jpeg;base64,{}\"/>",
        STANDARD.encode(bytes)
    ))
}
