//! A relief for an engine of one's own, without any graphics API: writes the WGSL, the textures' bytes and the settings of a brick
//! wall to a folder, and says how to bind them.
//!
//! ```sh
//! cargo run -p relievo-shader --example write_shader -- folder
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use relievo_march::{Cones, ReliefMap, Shadow, Technique};
use relievo_shader::{MarchUniforms, Permutation, TextureBytes, TextureSource, shader_source};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or("relievo-shader".to_owned()));
    fs::create_dir_all(&folder)?;

    let map = relievo_make::brick_wall(256)?.height.ok_or("the wall has heights")?;
    let heights = ReliefMap::with_mips(&map).with_cones(Cones::Relaxed);
    let relief = Permutation { technique: Technique::Cone, shadow: Shadow::Exact, ..Permutation::default() };
    let wgsl = relief.texture_declarations(0, 0) + &shader_source(&relief)?;
    fs::write(folder.join("relief.wgsl"), &wgsl)?;
    println!("relief.wgsl: {} lines", wgsl.lines().count());

    for (binding, global) in relief.textures().iter().enumerate() {
        let texture = match global.source {
            TextureSource::Pyramid => TextureBytes::pyramid(&heights),
            TextureSource::Cones => TextureBytes::cones(&heights, Cones::Relaxed),
            _ => TextureBytes::heights(&heights),
        };
        let bytes: Vec<u8> = texture.mips.iter().flat_map(|mip| mip.bytes.iter().copied()).collect();
        fs::write(folder.join(format!("{}.bin", global.name)), &bytes)?;
        let ([width, height], mips) = (texture.size(), texture.mips.len());
        let format = texture.format.name();
        println!(
            "{}: binding {binding}, {format}, {width}×{height}, {mips} mip levels, {} bytes",
            global.name,
            bytes.len()
        );
    }
    fs::write(folder.join("options.bin"), MarchUniforms::default().to_bytes())?;
    println!("options.bin: {} bytes, a uniform RelievoMarchOptions", MarchUniforms::SIZE);
    Ok(())
}
