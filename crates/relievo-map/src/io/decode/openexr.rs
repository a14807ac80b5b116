//! OpenEXR with the channels that maps have: R, G, B (A), Y (A), or a single channel of any name.

use std::io::Cursor;

use exr::error::Error as ExrError;
use exr::image::FlatSamples;
use exr::image::read::image::ReadLayers;
use exr::image::read::layers::ReadChannels;
use exr::image::read::read;
use exr::meta::MetaData;

use super::request::DecodeRequest;
use crate::io::error::MapError;
use crate::io::raster::{Raster, Samples};

/// Decodes the first layer.
pub(super) fn decode(name: &str, bytes: &[u8], request: DecodeRequest<'_>) -> Result<Raster, MapError> {
    let failed = |error| from_exr_error(name, error);
    let variant = |what: String| MapError::Variant { name: name.to_owned(), format: "OpenEXR", what };
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(failed)?;
    let Some(header) = meta.headers.first() else { return Err(variant("it has no layers".to_owned())) };
    if meta.headers.iter().any(|header| header.deep) {
        return Err(variant("it holds deep data (several samples per texel)".to_owned()));
    }
    let size = header.layer_size;
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let (width, height) = (side(size.width()), side(size.height()));
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    if header.channels.list.iter().any(|channel| channel.sampling != (1, 1).into()) {
        return Err(variant(format!("its channels ({}) differ in resolution", names.join(", "))));
    }
    let Some(chosen) = choose(&names) else {
        return Err(variant(format!(
            "its channels are {}; expected R, G, B (A), Y, or a single channel",
            names.join(", ")
        )));
    };
    // All channels are decoded, then the chosen ones are interleaved.
    request.limits.check(name, width, height, 4 * (names.len() + chosen.len()) as u64 + request.map_bytes)?;

    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(failed)?;
    let layer = image.layer_data;
    let damaged =
        |reason: &str| MapError::Damaged { name: name.to_owned(), format: "OpenEXR", reason: reason.to_owned() };
    let mut planes = Vec::with_capacity(chosen.len());
    for &index in &chosen {
        planes.push(&layer.channel_data.list.get(index).ok_or_else(|| damaged("a channel is missing"))?.sample_data);
    }
    let texels = width as usize * height as usize;
    let mut samples = Vec::new();
    samples.try_reserve_exact(texels * planes.len()).map_err(|_| MapError::Memory {
        name: name.to_owned(),
        width,
        height,
    })?;
    if layer.size != size || planes.iter().any(|plane| plane.len() != texels) {
        return Err(damaged("a channel has not the size that the header gives"));
    }
    for i in 0..texels {
        samples.extend(planes.iter().map(|plane| match plane {
            FlatSamples::F16(v) => v[i].to_f32(),
            FlatSamples::F32(v) => v[i],
            FlatSamples::U32(v) => v[i] as f32,
        }));
    }
    let mut notes = Vec::new();
    if meta.headers.len() > 1 {
        notes.push(format!("{name}: the first of {} layers was taken.", meta.headers.len()));
    }
    if names.len() > chosen.len() {
        let taken: Vec<_> = chosen.iter().map(|&i| names[i].as_str()).collect();
        notes.push(format!("{name}: of the channels {}, {} were taken.", names.join(", "), taken.join(", ")));
    }
    let bits = if planes.iter().all(|plane| matches!(plane, FlatSamples::F16(_))) { 16 } else { 32 };
    let channels = chosen.len();
    Ok(Raster { width, height, channels, samples: Samples::F32(samples), bits, notes })
}

/// Which channels make the image: 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) indices.
fn choose(names: &[String]) -> Option<Vec<usize>> {
    if names.len() == 1 {
        return Some(vec![0]);
    }
    // `R` itself, or the same in the first group that has it: `diffuse.R`.
    let find = |wanted: &str| {
        names.iter().position(|name| name == wanted).or_else(|| {
            names.iter().position(|name| name.rsplit('.').next().is_some_and(|last| last.eq_ignore_ascii_case(wanted)))
        })
    };
    let alpha = find("A");
    if let (Some(r), Some(g), Some(b)) = (find("R"), find("G"), find("B")) {
        return Some([r, g, b].into_iter().chain(alpha).collect());
    }
    let grey = ["Y", "L", "V", "Z", "height", "displacement", "disp"].iter().find_map(|wanted| find(wanted));
    let rest: Vec<_> = (0..names.len()).filter(|&i| Some(i) != alpha).collect();
    match (grey, rest.as_slice()) {
        (Some(grey), _) | (None, &[grey]) => Some([grey].into_iter().chain(alpha).collect()),
        _ => None,
    }
}

fn from_exr_error(name: &str, error: ExrError) -> MapError {
    let (name, format) = (name.to_owned(), "OpenEXR");
    match error {
        ExrError::NotSupported(what) => MapError::Variant { name, format, what: what.into_owned() },
        ExrError::Io(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            MapError::Damaged { name, format, reason: "it ends too early".to_owned() }
        }
        error => MapError::Damaged { name, format, reason: error.to_string() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(names: &[&str]) -> Option<Vec<usize>> {
        choose(&names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn channels_are_found_in_any_order_and_any_group() {
        assert_eq!(chosen(&["A", "B", "G", "R"]), Some(vec![3, 2, 1, 0]));
        assert_eq!(chosen(&["x.B", "x.G", "x.R"]), Some(vec![2, 1, 0]));
        assert_eq!(chosen(&["anything"]), Some(vec![0]));
        assert_eq!(chosen(&["A", "Y"]), Some(vec![1, 0]));
        assert_eq!(chosen(&["A", "odd"]), Some(vec![1, 0]));
        assert_eq!(chosen(&["U", "W"]), None);
    }
}
