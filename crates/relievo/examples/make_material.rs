//! Makes a material from nothing and writes its height and colour maps.
//!
//! ```sh
//! cargo run --release -p relievo --features make,io --example make_material -- FOLDER
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::PathBuf;

use relievo::make::make;
use relievo::map::{write_color, write_height};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(std::env::temp_dir, PathBuf::from);
    let maps = make("cobbles", 512)?;
    let height = maps.height.ok_or("cobbles have heights")?;
    let color = maps.base_color.ok_or("cobbles have colours")?;
    write_height(&folder.join("cobbles_Displacement.png"), &height)?;
    write_color(&folder.join("cobbles_Color.png"), &color)?;
    println!("cobbles_Displacement.png and cobbles_Color.png are in {}", folder.display());
    Ok(())
}
