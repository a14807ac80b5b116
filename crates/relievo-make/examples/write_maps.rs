//! Writes the maps of a built-in material into a folder:
//! `cargo run -p relievo-make --example write_maps -- [NAME [FOLDER [SIZE]]]`

use std::io::Write;
use std::path::PathBuf;

use relievo_map::{BitDepth, NormalY, write_color, write_height, write_normal, write_scalar};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "brick-wall".to_owned());
    let folder = arguments.next().map_or_else(|| std::env::temp_dir().join("relievo-maps"), PathBuf::from);
    let size = arguments.next().map_or(Ok(256), |text| text.parse())?;

    let maps = relievo_make::make(&name, size)?;
    std::fs::create_dir_all(&folder)?;
    let path = |map: &str| folder.join(format!("{name}_{map}.png"));
    if let Some(color) = &maps.base_color {
        write_color(&path("Color"), color)?;
    }
    if let Some(normal) = &maps.normal {
        write_normal(&path("NormalGL"), normal, NormalY::Up, BitDepth::Eight)?;
    }
    if let Some(height) = &maps.height {
        write_height(&path("Displacement"), height)?;
    }
    if let Some(roughness) = &maps.roughness {
        write_scalar(&path("Roughness"), roughness)?;
    }
    if let Some(ao) = &maps.ao {
        write_scalar(&path("AmbientOcclusion"), ao)?;
    }
    let height_scale = relievo_make::height_scale(&name)?;
    writeln!(std::io::stdout(), "{name}: {size}×{size} texels, height scale {height_scale}, in {}", folder.display())?;
    Ok(())
}
