//! Wavefront OBJ (Wavefront, Appendix B1 of the Advanced Visualizer manual): the polygonal part.
//!
//! Read here and not by a crate because every error should name its line, and because faces may mix corners with and
//! without normals.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};

use super::part::{Model, ModelError, Part};
use super::read_file::read_file;
use crate::mesh::{crease_normals, has_area};
use crate::{Mesh, MeshError};
use relievo_toml::shorten;

pub(super) fn load(path: &Path) -> Result<Model, ModelError> {
    parse(&read_file(path)?, path)
}

/// A corner of a face: indices of position, uv and normal.
type Corner = (u32, Option<u32>, Option<u32>);

#[derive(Default)]
struct Lists {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    triangles: Vec<[Corner; 3]>,
}

pub(super) fn parse(bytes: &[u8], path: &Path) -> Result<Model, ModelError> {
    let mut lists = Lists::default();
    let mut notes = Vec::new();
    let mut lines = bytes.split(|&byte| byte == b'\n').enumerate();
    while let Some((number, line)) = lines.next() {
        // Names may be in any encoding; numbers are ASCII.
        let mut line = String::from_utf8_lossy(line).into_owned();
        while line.trim_end().ends_with('\\') {
            line.truncate(line.trim_end().len() - 1);
            let Some((_, more)) = lines.next() else { break };
            line.push(' ');
            line.push_str(&String::from_utf8_lossy(more));
        }
        let line = line.split('#').next().unwrap_or_default();
        read_line(line, &mut lists)
            .map_err(|message| ModelError::new(path, format!("line {}: {message}", number + 1)))?;
        if lists.triangles.len() > Mesh::MAX_TRIANGLES {
            return Err(ModelError::new(path, MeshError::TooManyTriangles(lists.triangles.len()).to_string()));
        }
    }
    let (mesh, has_uvs) = assemble(lists, path, &mut notes)?;
    let part = Part { mesh: Arc::new(mesh), material: None, has_uvs, two_sided: false, transform: Affine3A::IDENTITY };
    Ok(Model { parts: vec![part], materials: Vec::new(), notes })
}

fn read_line(line: &str, lists: &mut Lists) -> Result<(), String> {
    let mut words = line.split_whitespace();
    match words.next() {
        // More numbers may follow: a weight, or a colour per vertex.
        Some("v") => lists.positions.push(Vec3::from_array(numbers(words, "v")?)),
        Some("vt") => {
            // v may be missing, and is 0 then. It points up here, down in memory.
            let [u, v] = match words.clone().count() {
                1 => [numbers::<1>(words, "vt")?[0], 0.0],
                _ => numbers(words, "vt")?,
            };
            lists.uvs.push(Vec2::new(u, 1.0 - v));
        }
        Some("vn") => lists.normals.push(Vec3::from_array(numbers(words, "vn")?)),
        Some("f") => {
            let corners = words.map(|word| corner(word, lists)).collect::<Result<Vec<_>, _>>()?;
            if corners.len() < 3 {
                return Err(format!("a face needs at least 3 corners, found {}", corners.len()));
            }
            let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
            lists.triangles.extend(fan);
        }
        // Points, lines, curves, groups and material names draw no triangles.
        _ => {}
    }
    Ok(())
}

fn numbers<'a, const N: usize>(words: impl Iterator<Item = &'a str>, what: &str) -> Result<[f32; N], String> {
    let mut numbers = [0.0; N];
    let mut count = 0;
    for (slot, word) in numbers.iter_mut().zip(words) {
        *slot = match word.parse::<f32>() {
            Ok(number) if number.is_finite() => number,
            Ok(_) => return Err(format!("\"{what}\" has the number {}, which is not finite", shorten(word))),
            Err(_) => return Err(format!("\"{what}\" expects numbers, found \"{}\"", shorten(word))),
        };
        count += 1;
    }
    if count == N { Ok(numbers) } else { Err(format!("\"{what}\" expects {N} numbers, found {count}")) }
}

fn corner(word: &str, lists: &Lists) -> Result<Corner, String> {
    let mut parts = word.split('/');
    let mut index = |count: usize, what: &str| match parts.next() {
        None | Some("") => Ok(None),
        Some(text) => resolve(text, count, what).map(Some),
    };
    let position = index(lists.positions.len(), "vertex")?;
    let uv = index(lists.uvs.len(), "texture coordinate")?;
    let normal = index(lists.normals.len(), "normal")?;
    match (position, parts.next()) {
        (Some(position), None) => Ok((position, uv, normal)),
        _ => Err(format!("\"{}\" is not the corner of a face; expected vertex/texture/normal", shorten(word))),
    }
}

/// Resolves an index that counts from 1, or from −1 backwards; never 0.
fn resolve(text: &str, count: usize, what: &str) -> Result<u32, String> {
    let number: i64 = text.parse().map_err(|_| format!("\"{}\" is not the number of a {what}", shorten(text)))?;
    let index = if number < 0 { number.checked_add(count as i64) } else { number.checked_sub(1) };
    index
        .and_then(|index| u32::try_from(index).ok())
        .filter(|&index| (index as usize) < count)
        .ok_or_else(|| format!("the face names {what} {number}, but there are {count} up to here"))
}

fn assemble(lists: Lists, path: &Path, notes: &mut Vec<String>) -> Result<(Mesh, bool), ModelError> {
    let Lists { positions, uvs, normals, triangles: corners } = lists;
    let name = path.display();
    let before = corners.len();
    let mut kept = corners;
    kept.retain(|triangle| has_area(&positions, triangle.map(|corner| corner.0)));
    let dropped = before - kept.len();
    let indices: Vec<[u32; 3]> = kept.iter().map(|triangle| triangle.map(|corner| corner.0)).collect();
    if dropped > 0 {
        notes.push(format!("{name}: {dropped} triangles without area were left out"));
    }
    if kept.is_empty() {
        return Err(ModelError::new(path, "there are no triangles in it"));
    }
    let all = |has: fn(&Corner) -> bool| kept.iter().flatten().all(has);
    let any = |has: fn(&Corner) -> bool| kept.iter().flatten().any(has);
    let has_uvs = all(|corner| corner.1.is_some());
    if !has_uvs && any(|corner| corner.1.is_some()) {
        notes.push(format!("{name}: some faces have no texture coordinates; all are taken as having none"));
    } else if !has_uvs {
        notes.push(format!("{name}: no texture coordinates"));
    }
    let made = if all(|corner| corner.2.is_some()) {
        Vec::new()
    } else {
        notes.push(format!("{name}: no normals, or not everywhere; made from the faces, sharp from 45°"));
        crease_normals(&positions, &indices)
    };

    let mut vertices: HashMap<(u32, u32, [u32; 3]), u32> = HashMap::new();
    let (mut out_positions, mut out_normals, mut out_uvs) = (Vec::new(), Vec::new(), Vec::new());
    let triangles = kept
        .iter()
        .enumerate()
        .map(|(index, triangle)| {
            [0, 1, 2].map(|i| {
                let (position, uv, normal) = triangle[i];
                let normal = match (made.get(index), normal) {
                    (Some(made), _) => made[i],
                    (None, Some(normal)) => normals[normal as usize],
                    (None, None) => Vec3::ZERO,
                };
                let uv = if has_uvs { uv.unwrap_or(0) } else { 0 };
                *vertices.entry((position, uv, normal.to_array().map(f32::to_bits))).or_insert_with(|| {
                    out_positions.push(positions[position as usize]);
                    out_normals.push(normal);
                    out_uvs.push(if has_uvs { uvs[uv as usize] } else { Vec2::ZERO });
                    out_positions.len() as u32 - 1
                })
            })
        })
        .collect();
    Mesh::with_tangents(out_positions, out_normals, out_uvs, triangles)
        .map(|mesh| (mesh, has_uvs))
        .map_err(|error| ModelError::new(path, error.to_string()))
}
