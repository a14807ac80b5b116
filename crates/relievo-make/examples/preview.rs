//! Writes every generated material as pictures, one per map and one simply lit, into the folder given as argument:
//! `cargo run --release -p relievo-make --example preview -- FOLDER [SIZE]`

use image::{Rgb, RgbImage};
use relievo_map::{MapSet, NormalMap, linear_to_srgb, srgb_to_linear};
use std::path::Path;
use std::time::Instant;

/// A picture's name and its display values, 0..1, at a texel.
type Picture<'a> = (&'a str, &'a dyn Fn(u32, u32) -> [f32; 3]);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("usage: preview FOLDER [SIZE]")?;
    let size = arguments.next().map_or(Ok(512), |text| text.parse())?;
    std::fs::create_dir_all(&folder)?;
    for name in relievo_make::names() {
        let start = Instant::now();
        let maps = relievo_make::make(name, size)?;
        eprintln!("{name} {size}: {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
        let MapSet { base_color: Some(color), normal: Some(normal), height: Some(height), .. } = &maps else {
            return Err("the material is not complete".into());
        };
        let (Some(roughness), Some(ao)) = (&maps.roughness, &maps.ao) else {
            return Err("the material is not complete".into());
        };
        let rgb = |x, y| {
            let [r, g, b, _] = *color.grid.get(x, y);
            [r, g, b]
        };
        let pictures: [Picture<'_>; 6] = [
            ("lit", &|x, y| {
                let (n, rough, open) = (*normal.grid().get(x, y), *roughness.grid().get(x, y), *ao.grid().get(x, y));
                light(rgb(x, y), n, rough, open)
            }),
            ("color", &rgb),
            ("normal", &|x, y| normal.grid().get(x, y).map(|n| f32::from(NormalMap::encode8(n)) / 255.0)),
            ("height", &|x, y| [*height.grid().get(x, y); 3]),
            ("roughness", &|x, y| [*roughness.grid().get(x, y); 3]),
            ("ao", &|x, y| [*ao.grid().get(x, y); 3]),
        ];
        // All six side by side, too.
        let mut sheet = RgbImage::new(3 * size, 2 * size);
        for (k, (map, texel)) in pictures.iter().enumerate() {
            let picture = RgbImage::from_fn(size, size, |x, y| {
                Rgb(texel(x, y).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))
            });
            picture.save(Path::new(&folder).join(format!("{name}-{map}.png")))?;
            let (left, top) = (k as u32 % 3 * size, k as u32 / 3 * size);
            image::imageops::replace(&mut sheet, &picture, left.into(), top.into());
        }
        sheet.save(Path::new(&folder).join(format!("{name}.png")))?;
    }
    Ok(())
}

/// One sun from the upper left and a grey sky, seen straight on.
fn light(color: [f32; 3], n: [f32; 3], roughness: f32, open: f32) -> [f32; 3] {
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let sun = [-0.45, 0.55, 0.70];
    let half = [-0.244, 0.298, 0.923];
    let diffuse = dot(n, sun).max(0.0);
    let shininess = 2.0 / roughness.powi(4).max(1e-3);
    let gloss = 0.04 * (shininess + 2.0) / 8.0 * dot(n, half).max(0.0).powf(shininess) * diffuse;
    color.map(|c| linear_to_srgb(srgb_to_linear(c) * (1.35 * diffuse + 0.42 * open) + gloss))
}
