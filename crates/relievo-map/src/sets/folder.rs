//! The maps of a material, found in a folder by their names.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::file_name::{HeightKind, KNOWN, Named, Role, understand};
use crate::io::{Limits, Loaded, MapError, name_of, read_color, read_height, read_normal, read_packed, to_scalar};
use crate::types::{Channel, Grid, MapSet, NormalY, ScalarMap, White};

/// Which files of a folder are which map of its material.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FolderMaps {
    /// Base colour.
    pub base_color: Option<PathBuf>,
    /// Normals and which way their +Y points: down for Unreal's `T_…_N`; up is assumed where the name does not tell.
    pub normal: Option<(PathBuf, NormalY)>,
    /// Heights.
    pub height: Option<PathBuf>,
    /// What white means in the height file: deep for a depth map, else high.
    pub height_white: White,
    /// Roughness, and the channel that holds it.
    pub roughness: Option<(PathBuf, Channel)>,
    /// The roughness channel holds glossiness: roughness is 1 − its value.
    pub roughness_is_gloss: bool,
    /// Metallic, and the channel that holds it.
    pub metallic: Option<(PathBuf, Channel)>,
    /// Ambient occlusion, and the channel that holds it.
    pub ao: Option<(PathBuf, Channel)>,
    /// Whole sentences: what was found, what was ignored, and why.
    pub notes: Vec<String>,
}

/// Finds the maps of one material in a folder by the endings of the file names, as they come from ambientCG, Poly
/// Haven, Poliigon and the common engines. Files are only listed, not opened; the result depends on the names alone.
///
/// Of several files for one map it takes: +Y-up normals before +Y-down before unlabelled; displacement before bump before
/// depth; a file of its own before a packed one before gloss before packed gloss; then the larger resolution (as the name says), then more
/// precision (heights and normals: EXR, TIFF, PNG, …, JPEG), then the first name. Files of a second material in the
/// same folder are left out. If there are no maps in the folder itself, a folder `textures` or `maps` in it is searched.
///
/// # Errors
/// If `dir` is no folder, cannot be listed, or holds no maps.
pub fn find_maps(dir: &Path) -> Result<FolderMaps, MapError> {
    let listing = list(dir)?;
    if listing.candidates.iter().any(|c| !matches!(c.named.role, Role::Unused(_))) {
        return Ok(choose(dir, listing));
    }
    if let Some(inner) = &listing.textures {
        let inside = list(inner)?;
        if inside.candidates.iter().any(|c| !matches!(c.named.role, Role::Unused(_))) {
            let mut found = choose(inner, inside);
            found.notes.insert(0, format!("{}: no maps here; looked into {}.", dir.display(), inner.display()));
            return Ok(found);
        }
    }
    let seen: Vec<&str> = (listing.unknown.iter())
        .chain(listing.not_images.iter())
        .chain(listing.candidates.iter().map(|c| &c.file))
        .map(String::as_str)
        .take(5)
        .collect();
    Err(MapError::NoMaps { name: name_of(dir), ignored: seen.join(", "), known: KNOWN })
}

/// Finds the maps of a material ([`find_maps`]) and reads them all.
///
/// # Errors
/// If none are found, or one that was found cannot be read.
pub fn read_folder(dir: &Path, limits: &Limits) -> Result<Loaded<MapSet>, MapError> {
    let found = find_maps(dir)?;
    let mut set = MapSet::default();
    let mut notes = found.notes;
    if let Some(path) = &found.base_color {
        set.base_color = Some(keep(read_color(path, limits)?, &mut notes));
    }
    if let Some((path, y)) = &found.normal {
        set.normal = Some(keep(read_normal(path, *y, limits)?, &mut notes));
    }
    if let Some(path) = &found.height {
        set.height = Some(keep(read_height(path, found.height_white, limits)?, &mut notes));
    }
    // A packed file is decoded once for all of its maps.
    let mut files: BTreeMap<&Path, Vec<(Channel, &mut Option<ScalarMap>)>> = BTreeMap::new();
    for (source, slot) in
        [(&found.roughness, &mut set.roughness), (&found.metallic, &mut set.metallic), (&found.ao, &mut set.ao)]
    {
        if let Some((path, channel)) = source {
            files.entry(path).or_default().push((*channel, slot));
        }
    }
    for (path, wanted) in files {
        let raster = read_packed(path, limits)?;
        for (channel, slot) in wanted {
            // Only the file itself shows whether smoothness was put there.
            if channel == Channel::Alpha && !raster.has_alpha() {
                notes.push(format!("{}: ignored as roughness: it has no alpha channel.", name_of(path)));
                continue;
            }
            *slot = Some(keep(to_scalar(&name_of(path), &raster, channel)?, &mut notes));
        }
    }
    if found.roughness_is_gloss {
        set.roughness = set.roughness.map(|gloss| inverted(&gloss));
    }
    Ok(Loaded { map: set, notes })
}

fn inverted(map: &ScalarMap) -> ScalarMap {
    let grid: Grid<f32> = map.grid().map(|&v| 1.0 - v);
    ScalarMap::new(grid)
}

/// The map; its notes go to the others, each once.
fn keep<T>(loaded: Loaded<T>, notes: &mut Vec<String>) -> T {
    for note in loaded.notes {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    loaded.map
}

/// A file whose name says that it is a map.
struct Candidate {
    path: PathBuf,
    file: String,
    /// Lower case.
    extension: String,
    named: Named,
}

/// The files of a folder, sorted by name.
#[derive(Default)]
struct Listing {
    candidates: Vec<Candidate>,
    /// Images whose names say nothing.
    unknown: Vec<String>,
    /// Everything else.
    not_images: Vec<String>,
    /// A folder that usually holds the maps.
    textures: Option<PathBuf>,
}

const IMAGES: &[&str] = &["png", "jpg", "jpeg", "tif", "tiff", "exr", "hdr", "tga", "bmp", "webp"];

fn list(dir: &Path) -> Result<Listing, MapError> {
    let name = || name_of(dir);
    let failed = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => MapError::Missing { name: name() },
        _ => MapError::Io { name: name(), doing: "list the folder", source },
    };
    if !fs::metadata(dir).map_err(failed)?.is_dir() {
        return Err(MapError::NotAFolder { name: name() });
    }
    let mut entries = fs::read_dir(dir).and_then(Iterator::collect::<io::Result<Vec<_>>>).map_err(failed)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    let mut listing = Listing::default();
    for entry in entries {
        let path = entry.path();
        let file = entry.file_name().to_string_lossy().into_owned();
        // What file managers leave behind is nobody's business.
        if file.starts_with('.') || ["thumbs.db", "desktop.ini"].contains(&file.to_ascii_lowercase().as_str()) {
            continue;
        }
        // Links are followed; a broken one is neither.
        let metadata = fs::metadata(&path);
        if metadata.as_ref().is_ok_and(fs::Metadata::is_dir) {
            if ["textures", "maps"].contains(&file.to_ascii_lowercase().as_str()) {
                listing.textures = listing.textures.or(Some(path));
            }
            continue;
        }
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        if !metadata.is_ok_and(|m| m.is_file()) || !IMAGES.contains(&extension.as_str()) {
            listing.not_images.push(file);
            continue;
        }
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        match understand(&stem) {
            Some(named) => listing.candidates.push(Candidate { path, file, extension, named }),
            None => listing.unknown.push(file),
        }
    }
    Ok(listing)
}

/// The places of a [`MapSet`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    BaseColor,
    Normal,
    Height,
    Roughness,
    Metallic,
    Ao,
}

impl Slot {
    const ALL: [Self; 6] = [Self::BaseColor, Self::Normal, Self::Height, Self::Roughness, Self::Metallic, Self::Ao];

    fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "base colour",
            Self::Normal => "normals",
            Self::Height => "height",
            Self::Roughness => "roughness",
            Self::Metallic => "metallic",
            Self::Ao => "ambient occlusion",
        }
    }
}

/// How well a role fits a slot (higher is better) and in which channel; `None` if it does not.
fn fit(role: Role, slot: Slot) -> Option<(u32, Channel)> {
    let whole = |rank| Some((rank, Channel::Luminance));
    match (slot, role) {
        (Slot::BaseColor, Role::BaseColor) => whole(2),
        (Slot::Normal, Role::Normal(Some(NormalY::Up))) => whole(2),
        (Slot::Normal, Role::Normal(Some(NormalY::Down))) => whole(1),
        (Slot::Normal, Role::Normal(None)) => whole(0),
        (Slot::Height, Role::Height(HeightKind::Displacement)) => whole(2),
        (Slot::Height, Role::Height(HeightKind::Bump)) => whole(1),
        (Slot::Height, Role::Height(HeightKind::Depth)) => whole(0),
        (Slot::Metallic, Role::Metallic) | (Slot::Ao, Role::Ao) => whole(2),
        (Slot::Roughness, Role::Roughness) => whole(3),
        (Slot::Roughness, Role::Gloss) => whole(1),
        (Slot::Roughness, Role::Packed(packed)) => {
            packed.roughness.map(|channel| (if packed.smooth { 0 } else { 2 }, channel))
        }
        (Slot::Metallic, Role::Packed(packed)) => packed.metallic.map(|channel| (1, channel)),
        (Slot::Ao, Role::Packed(packed)) => packed.ao.map(|channel| (1, channel)),
        _ => None,
    }
}

/// How much a format keeps of such a map.
fn precision(slot: Slot, extension: &str) -> usize {
    let order: &[&str] = match slot {
        Slot::Height | Slot::Normal => &["jpg", "jpeg", "webp", "bmp", "tga", "hdr", "png", "tif", "tiff", "exr"],
        // 8 bits are enough for these, so that only what JPEG loses counts.
        _ => &["hdr", "exr", "jpg", "jpeg", "webp", "bmp", "tga", "tif", "tiff", "png"],
    };
    order.iter().position(|e| *e == extension).unwrap_or(0)
}

/// Picks the best file for every slot.
fn choose(dir: &Path, mut listing: Listing) -> FolderMaps {
    let mut ignored: Vec<String> = Vec::new();
    let mut adopted: Vec<String> = Vec::new();
    leave_out_other_materials(&mut listing.candidates, &mut ignored, &mut adopted);
    let candidates = &listing.candidates;

    let mut used = vec![false; candidates.len()];
    // For each file that lost everywhere, whom it lost to first.
    let mut lost_to: Vec<Option<(usize, Slot)>> = vec![None; candidates.len()];
    let mut winners: [Option<(usize, Channel)>; 6] = [None; 6];
    for (slot, winner) in Slot::ALL.into_iter().zip(&mut winners) {
        let key = |i: usize, rank: u32| {
            let c = &candidates[i];
            (rank, c.named.resolution, c.named.bits, precision(slot, &c.extension))
        };
        let fitting: Vec<_> =
            (0..candidates.len()).filter_map(|i| fit(candidates[i].named.role, slot).map(|f| (i, f))).collect();
        // Of equals the first by name.
        let Some(&(best, (_, channel))) = fitting.iter().rev().max_by_key(|(i, (rank, _))| key(*i, *rank)) else {
            continue;
        };
        *winner = Some((best, channel));
        used[best] = true;
        for (i, _) in fitting {
            lost_to[i] = lost_to[i].or((i != best).then_some((best, slot)));
        }
    }

    let mut found = FolderMaps::default();
    let path = |i: usize| candidates[i].path.clone();
    let mut parts = Vec::new();
    for (slot, winner) in Slot::ALL.into_iter().zip(winners) {
        let Some((i, channel)) = winner else { continue };
        let c = &candidates[i];
        let mut detail = String::new();
        match (slot, c.named.role) {
            (Slot::BaseColor, _) => found.base_color = Some(path(i)),
            (Slot::Normal, role) => {
                let y = if let Role::Normal(Some(y)) = role { y } else { NormalY::Up };
                detail = match role {
                    Role::Normal(_) if c.named.unreal => " (Unreal's convention: +Y down)",
                    Role::Normal(Some(NormalY::Down)) => ", +Y down",
                    Role::Normal(Some(NormalY::Up)) => ", +Y up",
                    _ => ", +Y up assumed, as the name does not tell (normal_y = \"down\" changes it)",
                }
                .to_owned();
                found.normal = Some((path(i), y));
            }
            (Slot::Height, role) => {
                if role == Role::Height(HeightKind::Depth) {
                    found.height_white = White::Deep;
                    detail = ", a depth map, so white is deep".to_owned();
                }
                found.height = Some(path(i));
            }
            (Slot::Roughness, role) => {
                let smooth = matches!(role, Role::Packed(packed) if packed.smooth);
                found.roughness_is_gloss = smooth || role == Role::Gloss;
                if smooth {
                    detail = ", smoothness inverted (Unity's convention)".to_owned();
                } else if found.roughness_is_gloss {
                    detail = ", gloss inverted".to_owned();
                }
                found.roughness = Some((path(i), channel));
            }
            (Slot::Metallic, _) => found.metallic = Some((path(i), channel)),
            (Slot::Ao, _) => found.ao = Some((path(i), channel)),
        }
        if channel != Channel::Luminance {
            detail.push_str(&format!(", {}", format!("{channel:?}").to_ascii_lowercase()));
        }
        parts.push(format!("{} from {}{detail}", slot.name(), c.file));
    }
    found.notes.push(format!("{}: {}.", dir.display(), parts.join("; ")));
    found.notes.extend(adopted);

    for (i, c) in candidates.iter().enumerate() {
        if used[i] {
            continue;
        }
        if let Role::Unused(why) = c.named.role {
            ignored.push(format!("{}: ignored: {why}.", c.file));
        } else if let Some((winner, slot)) = lost_to[i] {
            ignored.push(format!("{}: ignored: {}.", c.file, why_lost(c, &candidates[winner], slot)));
        }
    }
    ignored
        .extend(listing.unknown.iter().map(|file| format!("{file}: ignored: its name does not say which map it is.")));
    ignored.extend(listing.not_images.iter().map(|file| format!("{file}: ignored: not an image that can be read.")));
    let more = ignored.len().saturating_sub(MOST_IGNORED);
    ignored.truncate(MOST_IGNORED);
    found.notes.extend(ignored);
    if more > 0 {
        found.notes.push(format!("{}: {more} more files were ignored.", dir.display()));
    }
    found
}

/// How many ignored files are named before the rest is only counted.
const MOST_IGNORED: usize = 20;

fn why_lost(loser: &Candidate, winner: &Candidate, slot: Slot) -> String {
    let (a, b, file) = (&loser.named, &winner.named, &winner.file);
    let rank = |named: &Named| fit(named.role, slot).map(|f| f.0);
    if rank(a) != rank(b) {
        return match (slot, a.role) {
            (Slot::Normal, Role::Normal(Some(NormalY::Down))) => format!("{file} has the same with +Y up"),
            (Slot::Normal, _) => format!("{file} says which way its Y points"),
            (Slot::Height, _) => format!("{file} is the fuller height"),
            (_, Role::Gloss) => format!("{file} is the roughness"),
            _ => format!("{file} is a map of its own"),
        };
    }
    if a.resolution != b.resolution {
        format!("{file} is larger")
    } else if a.bits != b.bits || loser.extension != winner.extension {
        format!("{file} keeps more of the same map")
    } else {
        format!("{file} is the same kind of map, and the first by name")
    }
}

/// Keeps the material with the most maps, and files of other names only where they fill its gaps: a colour of one
/// wall with the normals of another would be worse than none.
fn leave_out_other_materials(candidates: &mut Vec<Candidate>, ignored: &mut Vec<String>, adopted: &mut Vec<String>) {
    let slots = |c: &Candidate| Slot::ALL.map(|slot| fit(c.named.role, slot).is_some());
    let or = |a: [bool; 6], b: [bool; 6]| std::array::from_fn(|i| a[i] || b[i]);
    let mut materials: BTreeMap<String, [bool; 6]> = BTreeMap::new();
    for c in candidates.iter().filter(|c| !matches!(c.named.role, Role::Unused(_))) {
        let filled = materials.entry(c.named.material.clone()).or_default();
        *filled = or(*filled, slots(c));
    }
    let count = |filled: &[bool; 6]| filled.iter().filter(|f| **f).count();
    // Of equals the first by name.
    let Some((main, mut filled)) =
        materials.iter().rev().max_by_key(|(_, f)| count(f)).map(|(name, f)| (name.clone(), *f))
    else {
        return;
    };
    let mut allowed = vec![main.clone()];
    for (name, theirs) in materials {
        if name != main && !(0..6).any(|i| filled[i] && theirs[i]) {
            filled = or(filled, theirs);
            allowed.push(name);
        }
    }
    candidates.retain(|c| {
        let unused = matches!(c.named.role, Role::Unused(_));
        let keep = unused || allowed.contains(&c.named.material);
        if !keep {
            ignored.push(format!("{}: ignored: it belongs to another material than the other maps.", c.file));
        } else if !unused && c.named.material != main {
            adopted.push(format!("{}: its name differs from the other maps'; taken as the same material.", c.file));
        }
        keep
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of empty files: only names count.
    fn folder(files: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for file in files {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    fn file(path: &Option<PathBuf>) -> &str {
        path.as_ref().unwrap().file_name().unwrap().to_str().unwrap()
    }

    fn packed(source: &Option<(PathBuf, Channel)>) -> (&str, Channel) {
        let (path, channel) = source.as_ref().unwrap();
        (path.file_name().unwrap().to_str().unwrap(), *channel)
    }

    fn says(found: &FolderMaps, words: &[&str]) -> bool {
        found.notes.iter().any(|note| words.iter().all(|word| note.contains(word)))
    }

    #[test]
    fn an_ambientcg_folder_is_understood_and_the_directx_normals_are_ignored_aloud() {
        let dir = folder(&[
            "W_1K-JPG_AmbientOcclusion.jpg",
            "W_1K-JPG_Color.jpg",
            "W_1K-JPG_Displacement.jpg",
            "W_1K-JPG_NormalDX.jpg",
            "W_1K-JPG_NormalGL.jpg",
            "W_1K-JPG_Roughness.jpg",
            "W.png",
            "W_1K-JPG.mtlx",
            "W_1K-JPG.usdc",
            ".DS_Store",
        ]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(file(&found.base_color), "W_1K-JPG_Color.jpg");
        assert_eq!(file(&found.height), "W_1K-JPG_Displacement.jpg");
        let (normal, y) = found.normal.clone().unwrap();
        assert!(normal.ends_with("W_1K-JPG_NormalGL.jpg"));
        assert_eq!(y, NormalY::Up);
        assert_eq!(packed(&found.roughness), ("W_1K-JPG_Roughness.jpg", Channel::Luminance));
        assert_eq!(packed(&found.ao), ("W_1K-JPG_AmbientOcclusion.jpg", Channel::Luminance));
        assert_eq!(found.metallic, None);
        assert!(says(&found, &["base colour from W_1K-JPG_Color.jpg", "+Y up"]), "{:?}", found.notes);
        assert!(says(&found, &["NormalDX", "ignored", "NormalGL"]), "{:?}", found.notes);
        assert!(says(&found, &["W.png", "ignored"]) && says(&found, &["mtlx", "ignored"]), "{:?}", found.notes);
        assert!(!says(&found, &["DS_Store"]));
    }

    #[test]
    fn a_poly_haven_folder_with_a_packed_file_gives_its_channels() {
        let dir = folder(&["b_arm_1k.jpg", "b_diff_1k.jpg", "b_disp_1k.png", "b_nor_dx_1k.exr"]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(packed(&found.ao), ("b_arm_1k.jpg", Channel::Red));
        assert_eq!(packed(&found.roughness), ("b_arm_1k.jpg", Channel::Green));
        assert_eq!(packed(&found.metallic), ("b_arm_1k.jpg", Channel::Blue));
        assert_eq!(found.normal.as_ref().unwrap().1, NormalY::Down);
        assert!(says(&found, &["roughness from b_arm_1k.jpg, green", "+Y down"]), "{:?}", found.notes);
    }

    #[test]
    fn files_of_their_own_come_before_packed_ones() {
        let dir = folder(&["b_arm.jpg", "b_rough.jpg", "b_ao.jpg", "b_metal.jpg"]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(packed(&found.roughness), ("b_rough.jpg", Channel::Luminance));
        assert!(says(&found, &["b_arm.jpg", "ignored", "map of its own"]), "{:?}", found.notes);
        let dir = folder(&["b_arm.jpg", "b_rough.jpg"]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(packed(&found.ao), ("b_arm.jpg", Channel::Red));
        assert!(!says(&found, &["b_arm.jpg", "ignored"]), "{:?}", found.notes);
    }

    #[test]
    fn the_largest_then_the_most_precise_height_wins_and_the_others_are_named() {
        let dir = folder(&["b_disp_1k.exr", "b_disp_2k.jpg", "b_disp_2k.png", "b_disp_2k.exr", "b_disp_2k.tif"]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(file(&found.height), "b_disp_2k.exr");
        assert!(says(&found, &["b_disp_1k.exr", "b_disp_2k.exr is larger"]), "{:?}", found.notes);
        assert!(says(&found, &["b_disp_2k.jpg", "keeps more"]), "{:?}", found.notes);
        let dir = folder(&["X_DISP_3K.jpg", "X_DISP16_3K.tif", "X_BUMP_3K.tif"]);
        assert_eq!(file(&find_maps(dir.path()).unwrap().height), "X_DISP16_3K.tif");
    }

    #[test]
    fn unlabelled_normals_are_taken_as_y_up_and_it_is_said() {
        let found = find_maps(folder(&["height.png", "normal.png"]).path()).unwrap();
        assert_eq!(found.normal.as_ref().unwrap().1, NormalY::Up);
        assert!(says(&found, &["assumed", "normal_y = \"down\""]), "{:?}", found.notes);
        let found = find_maps(folder(&["normal.png", "normal_dx.png"]).path()).unwrap();
        assert_eq!(found.normal.as_ref().unwrap().1, NormalY::Down);
    }

    #[test]
    fn an_unreal_folder_has_normals_with_y_down() {
        let found =
            find_maps(folder(&["T_Brick_D.png", "T_Brick_N.png", "T_Brick_ORM.png", "T_Brick_H.png"]).path()).unwrap();
        assert_eq!(file(&found.base_color), "T_Brick_D.png");
        assert_eq!(file(&found.height), "T_Brick_H.png");
        assert_eq!(packed(&found.roughness), ("T_Brick_ORM.png", Channel::Green));
        assert_eq!(found.normal.as_ref().unwrap().1, NormalY::Down);
        assert!(says(&found, &["T_Brick_N.png (Unreal's convention: +Y down)"]), "{:?}", found.notes);
    }

    #[test]
    fn unity_smoothness_is_roughness_only_without_better_files() {
        let found = find_maps(folder(&["b_MetallicSmoothness.png"]).path()).unwrap();
        assert_eq!(packed(&found.metallic), ("b_MetallicSmoothness.png", Channel::Red));
        assert_eq!(packed(&found.roughness), ("b_MetallicSmoothness.png", Channel::Alpha));
        assert!(found.roughness_is_gloss);
        assert!(says(&found, &["smoothness inverted (Unity's convention), alpha"]), "{:?}", found.notes);
        for (better, gloss) in [("b_Roughness.png", false), ("b_ORM.png", false), ("b_Gloss.png", true)] {
            let found = find_maps(folder(&["b_MetallicSmoothness.png", better]).path()).unwrap();
            assert_eq!((packed(&found.roughness).0, found.roughness_is_gloss), (better, gloss));
        }
    }

    #[test]
    fn depth_is_white_deep_and_gloss_is_inverted_only_without_better_files() {
        let found = find_maps(folder(&["a_depth.png", "a_gloss.png"]).path()).unwrap();
        assert_eq!((found.height_white, found.roughness_is_gloss), (White::Deep, true));
        assert!(says(&found, &["white is deep"]) && says(&found, &["gloss inverted"]), "{:?}", found.notes);
        let found =
            find_maps(folder(&["a_depth.png", "a_gloss.png", "a_height.png", "a_rough.png", "a_spec.png"]).path())
                .unwrap();
        assert_eq!((found.height_white, found.roughness_is_gloss), (White::High, false));
        for lost in ["a_depth.png", "a_gloss.png", "a_spec.png"] {
            assert!(says(&found, &[lost, "ignored"]), "{lost}: {:?}", found.notes);
        }
    }

    #[test]
    fn two_materials_in_one_folder_are_not_mixed() {
        let dir = folder(&[
            "a_color.png",
            "b_color.png",
            "b_height.png",
            "b_normal.png",
            "a_normal.png",
            "a_ao.png",
            "b_x.png",
        ]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(file(&found.base_color), "a_color.png");
        assert_eq!(found.height, None);
        assert!(says(&found, &["b_height.png", "another material"]), "{:?}", found.notes);
        // Nothing twice: a name that merely differs.
        let found = find_maps(folder(&["brick_color.png", "brick_normal.png", "bricks_height.png"]).path()).unwrap();
        assert_eq!(file(&found.height), "bricks_height.png");
        assert!(says(&found, &["bricks_height.png", "differs"]), "{:?}", found.notes);
    }

    #[test]
    fn maps_in_a_textures_folder_are_found_from_above() {
        let dir = folder(&["wall.blend", "textures/wall_diff_1k.jpg"]);
        let found = find_maps(dir.path()).unwrap();
        assert_eq!(file(&found.base_color), "wall_diff_1k.jpg");
        assert!(says(&found, &["looked into"]), "{:?}", found.notes);
    }

    #[test]
    fn a_folder_without_maps_names_the_endings_that_are_known() {
        let message = find_maps(folder(&["holiday.jpg", "notes.txt"]).path()).unwrap_err().to_string();
        assert!(
            message.contains("holiday.jpg") && message.contains("_NormalGL") && message.contains("_arm"),
            "{message}"
        );
        assert!(matches!(find_maps(folder(&[]).path()), Err(MapError::NoMaps { .. })));
        assert!(matches!(find_maps(Path::new("no/such/folder")), Err(MapError::Missing { .. })));
        let dir = folder(&["a.png"]);
        assert!(matches!(find_maps(&dir.path().join("a.png")), Err(MapError::NotAFolder { .. })));
    }

    #[test]
    fn a_crowded_folder_does_not_make_endless_notes() {
        let names: Vec<String> = (0..100).map(|i| format!("x{i}.txt")).collect();
        let mut files: Vec<&str> = names.iter().map(String::as_str).collect();
        files.push("a_color.png");
        let found = find_maps(folder(&files).path()).unwrap();
        assert!(found.notes.len() < 30);
        assert!(says(&found, &["80 more"]), "{:?}", found.notes.last());
    }
}
