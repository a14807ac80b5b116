//! Writes what an engine of your own needs to draw a relief: the WGSL of a march and its textures as bytes.
//!
//! ```sh
//! cargo run --release -p relievo --features make,shader --example write_shader -- FOLDER
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use relievo::shader::{MarchUniforms, Permutation, TextureBytes, shader_source};
use relievo::{ReliefMap, Shadow, Technique};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(std::env::temp_dir, PathBuf::from);
    let map = relievo::make::brick_wall(512)?.height.ok_or("the wall has heights")?;
    let relief = ReliefMap::new(&map);

    let permutation = Permutation { technique: Technique::Exact, shadow: Shadow::Exact, ..Permutation::default() };
    let wgsl = [permutation.texture_declarations(0, 0), shader_source(&permutation)?].concat();
    fs::write(folder.join("relief.wgsl"), wgsl)?;
    fs::write(folder.join("options.bin"), MarchUniforms::default().to_bytes())?;
    for (name, texture) in [("heights", TextureBytes::heights(&relief)), ("pyramid", TextureBytes::pyramid(&relief))] {
        let [width, height] = texture.size();
        fs::write(folder.join(format!("{name}.bin")), &texture.mips[0].bytes)?;
        println!("{name}.bin: {width} × {height}, {}", texture.format.name());
    }
    println!("relief.wgsl and options.bin are in {}", folder.display());
    Ok(())
}
