//! The maps of a material, found in a folder by their names.

use std::path::Path;

use super::folder_maps::FolderMaps;
use super::listing::list;
use super::role_names::KNOWN_ENDINGS;
use super::selection::select;
use crate::io::{MapError, name_of};

/// Finds the maps of one material in a folder by the endings of the file names, as they come from ambientCG, Poly
/// Haven, Poliigon and the common engines. Files are only listed, not opened; the result depends on the names alone.
///
/// Of several files for one map it takes: +Y-up normals before +Y-down before unlabelled; displacement before bump
/// before depth; a file of its own before a packed one before gloss before packed gloss; then the larger resolution (as
/// the name says), then more precision (heights and normals: EXR, TIFF, PNG, …, JPEG), then the first name. Files of a
/// second material in the same folder are left out. If there are no maps in the folder itself, a folder `textures` or
/// `maps` in it is searched.
///
/// # Errors
/// If `dir` is no folder, cannot be listed, or holds no maps.
pub fn find_maps(dir: &Path) -> Result<FolderMaps, MapError> {
    let listing = list(dir)?;
    if listing.has_maps() {
        return Ok(select(dir, listing));
    }
    if let Some(inner) = &listing.textures {
        let inside = list(inner)?;
        if inside.has_maps() {
            let mut found = select(inner, inside);
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
    Err(MapError::NoMaps { name: name_of(dir), ignored: seen.join(", "), known: KNOWN_ENDINGS })
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;

    use super::*;
    use crate::types::{Channel, NormalY, White};

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
