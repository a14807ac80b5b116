//! Writes the files that the example scenes use: `cargo run -p relievo-scene --example scene_assets -- scenes`.
//!
//! Everything in them is generated, so they can be written anew at any time: `half-wall/` (maps twice as wide as high) and
//! `arch.glb` (a vault with texture coordinates and normals; tangents are left to the reader).

use std::error::Error;
use std::f32::consts::PI;
use std::path::{Path, PathBuf};

use relievo_map::{
    BitDepth, ColorMap, Grid, HeightMap, NormalMap, NormalY, write_atomic, write_color, write_height, write_normal,
};
use serde_json::json;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name the folder to write to, as in: scenes")?);
    half_wall(&folder.join("half-wall"))?;
    write_atomic(&folder.join("arch.glb"), |file| file.write_all(&arch()))?;
    Ok(())
}

/// The lower half of the brick wall: four courses, 384 × 192 texels.
fn half_wall(folder: &Path) -> Result<(), Box<dyn Error>> {
    const SIZE: u32 = 384;
    fn lower_half<T: Copy>(grid: &Grid<T>) -> Grid<T> {
        Grid::from_fn(grid.width(), grid.height() / 2, |x, y| *grid.get(x, y + grid.height() / 2))
    }
    std::fs::create_dir_all(folder)?;
    let maps = relievo_make::brick_wall(SIZE)?;
    if let Some(color) = maps.base_color {
        let grid = lower_half(&color.grid);
        write_color(&folder.join("wall_color.png"), &ColorMap { grid, ..color })?;
    }
    if let Some(height) = maps.height {
        write_height(&folder.join("wall_height.png"), &HeightMap::new(lower_half(height.grid())))?;
    }
    if let Some(normal) = maps.normal {
        let normal = NormalMap::new(lower_half(normal.grid()));
        write_normal(&folder.join("wall_normal_gl.png"), &normal, NormalY::Up, BitDepth::Eight)?;
    }
    Ok(())
}

/// A barrel vault, open at both ends, seen from inside: radius 1, length 3, u along the axis, v over the arch. One texture
/// repeat is square.
fn arch() -> Vec<u8> {
    const SEGMENTS: u32 = 48;
    const LENGTH: f32 = 3.0;
    let (mut positions, mut normals, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::<u32>::new());
    for i in 0..=SEGMENTS {
        let (sin, cos) = (PI * i as f32 / SEGMENTS as f32).sin_cos();
        for end in 0..2 {
            positions.push([-cos, sin, if end == 0 { 0.0 } else { -LENGTH }]);
            normals.push([cos, -sin, 0.0]);
            // The arch is π long: with 3 repeats along the axis and 3 over the arch, repeats are nearly square.
            uvs.push([3.0 * end as f32, 3.0 - 3.0 * i as f32 / SEGMENTS as f32]);
        }
        if i < SEGMENTS {
            let a = 2 * i;
            indices.extend([a, a + 1, a + 3, a, a + 3, a + 2]);
        }
    }
    let floats = |values: &[f32]| values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let chunks = [
        floats(positions.as_flattened()),
        floats(normals.as_flattened()),
        floats(uvs.as_flattened()),
        indices.iter().flat_map(|i| i.to_le_bytes()).collect(),
    ];
    let mut offset = 0;
    let views: Vec<_> = chunks
        .iter()
        .map(|chunk| {
            let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": chunk.len() });
            offset += chunk.len();
            view
        })
        .collect();
    let count = positions.len();
    let document = json!({
        "asset": { "version": "2.0", "generator": "relievo scene_assets" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "arch", "mesh": 0 }],
        "meshes": [{ "name": "arch", "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 }, "indices": 3
        }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
              "min": [-1.0, 0.0, -LENGTH], "max": [1.0, 1.0, 0.0] },
            { "bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5126, "count": count, "type": "VEC2" },
            { "bufferView": 3, "componentType": 5125, "count": indices.len(), "type": "SCALAR" },
        ],
        "bufferViews": views,
        "buffers": [{ "byteLength": offset }],
    });
    glb(&document.to_string(), &chunks.concat())
}

/// The GLB container: a header, the JSON padded with spaces, the buffer padded with zeros.
fn glb(json: &str, buffer: &[u8]) -> Vec<u8> {
    let pad = |bytes: &[u8], filler: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), filler);
        bytes
    };
    let (json, buffer) = (pad(json.as_bytes(), b' '), pad(buffer, 0));
    let word = |n: usize| (n as u32).to_le_bytes();
    [
        b"glTF".as_slice(),
        &word(2),
        &word(12 + 8 + json.len() + 8 + buffer.len()),
        &word(json.len()),
        b"JSON",
        &json,
        &word(buffer.len()),
        b"BIN\0",
        &buffer,
    ]
    .concat()
}
