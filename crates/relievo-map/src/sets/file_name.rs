//! File names of maps: `Bricks102_2K-JPG_NormalGL` is the normals, +Y up, of `bricks102` at 2048.

use super::map_role::MapRole;
use super::name_tokens::{NameToken, is_noise, tokenize};
use super::role_names::{SPECULAR, role_of_name};
use crate::types::NormalY;

/// The meaning of a file name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ParsedName {
    /// The material: the rest without map and resolution. Lower case, no separators.
    pub(super) material: String,
    pub(super) role: MapRole,
    /// True if only Unreal's naming convention tells the direction of the normals' Y.
    pub(super) unreal: bool,
    /// Texels per side as the name says, else 0.
    pub(super) resolution: u32,
    /// Bits per sample as the name says, else 0.
    pub(super) bits: u32,
}

/// Parses the name of a file (without extension); `None` if it names no map.
pub(super) fn parse_file_name(stem: &str) -> Option<ParsedName> {
    let mut tokens = tokenize(stem);
    let resolution = tokens.iter().map(|t| if let NameToken::Resolution(r) = t { *r } else { 0 }).max().unwrap_or(0);
    let mut bits = 0;
    let all = tokens.clone();
    let mut role = take_role(&mut tokens, &mut bits);
    // Poliigon appends the workflow: `X_COL_2K_METALNESS` is a colour, `X_METALNESS_2K_METALNESS` the metalness.
    if let [before @ .., NameToken::Resolution(_)] = tokens.as_slice()
        && matches!(role, Some(MapRole::Metallic | MapRole::Unused(SPECULAR)))
    {
        let mut before = before.to_vec();
        if let Some(earlier) = take_role(&mut before, &mut bits)
            && before.iter().any(|t| matches!(t, NameToken::Word(_)))
        {
            (role, tokens) = (Some(earlier), before);
        }
    }
    let material = tokens.iter().filter_map(NameToken::word).filter(|word| !is_noise(word)).collect();
    // Unreal's normals point +Y down; there, `T_…_N` is how a texture of normals is called.
    let unreal = role == Some(MapRole::Normal(None))
        && stem.get(..2).is_some_and(|start| start.eq_ignore_ascii_case("T_"))
        && all.get(tokens.len()).and_then(NameToken::word) == Some("n");
    role.map(|role| ParsedName {
        material,
        role: if unreal { MapRole::Normal(Some(NormalY::Down)) } else { role },
        unreal,
        resolution,
        bits,
    })
}

/// Takes the map's name off the end of the tokens, and the noise after it.
fn take_role(tokens: &mut Vec<NameToken>, bits: &mut u32) -> Option<MapRole> {
    loop {
        match tokens.last()? {
            NameToken::Word(word) if is_noise(word) => {}
            NameToken::Word(word) if word.chars().all(char::is_numeric) => {
                // `DISP16` is a 16-bit file; any other number a variant.
                if let Ok(n @ (8 | 16 | 32)) = word.parse() {
                    *bits = n;
                }
            }
            NameToken::Word(_) => break,
            NameToken::Resolution(_) => {}
        }
        tokens.pop();
    }
    let words: Vec<&str> = tokens.iter().rev().map_while(NameToken::word).collect();
    // The longest ending first: `base_color` before `color`.
    for count in (1..=words.len().min(4)).rev() {
        let joined: String = words[..count].iter().rev().copied().collect();
        if let Some(role) = role_of_name(&joined, count == 1, tokens.len() > count) {
            tokens.truncate(tokens.len() - count);
            return Some(role);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sets::map_role::{HeightKind, PackedChannels};
    use crate::types::Channel;

    fn role_of(stem: &str) -> Option<MapRole> {
        parse_file_name(stem).map(|named| named.role)
    }

    fn material_of(stem: &str) -> String {
        parse_file_name(stem).unwrap().material
    }

    const UP: MapRole = MapRole::Normal(Some(NormalY::Up));
    const DOWN: MapRole = MapRole::Normal(Some(NormalY::Down));
    const HEIGHT: MapRole = MapRole::Height(HeightKind::Displacement);

    #[test]
    fn the_names_of_the_libraries_and_engines_are_understood() {
        for (stem, role) in [
            // ambientCG
            ("Bricks102_1K-JPG_Color", MapRole::BaseColor),
            ("Bricks102_1K-JPG_NormalGL", UP),
            ("Bricks102_1K-JPG_NormalDX", DOWN),
            ("Bricks102_1K-JPG_Displacement", HEIGHT),
            ("Bricks102_1K-JPG_Roughness", MapRole::Roughness),
            ("Bricks102_1K-JPG_AmbientOcclusion", MapRole::Ao),
            ("Metal012_2K-PNG_Metalness", MapRole::Metallic),
            // Poly Haven
            ("brick_wall_003_diff_1k", MapRole::BaseColor),
            ("brick_wall_003_nor_gl_4k", UP),
            ("brick_wall_003_nor_dx_4k", DOWN),
            ("brick_wall_003_disp_4k", HEIGHT),
            ("rusty_metal_rough_2k", MapRole::Roughness),
            ("brick_wall_003_arm_2k", MapRole::Packed(PackedChannels::ARM)),
            ("brick_wall_003_spec_ior_2k", MapRole::Unused(SPECULAR)),
            // Poliigon
            ("BricksOld01_COL_VAR1_3K", MapRole::BaseColor),
            ("BricksOld01_DISP16_3K", HEIGHT),
            ("BricksOld01_NRM_3K", MapRole::Normal(None)),
            ("BricksOld01_GLOSS_3K", MapRole::Gloss),
            ("MetalX_COL_2K_METALNESS", MapRole::BaseColor),
            ("MetalX_METALNESS_2K_METALNESS", MapRole::Metallic),
            ("MetalX_ROUGHNESS_2K_METALNESS", MapRole::Roughness),
            ("WoodX_NRM_2K_SPECULAR", MapRole::Normal(None)),
            ("Poliigon_BrickWall_8320_BaseColor", MapRole::BaseColor),
            // freepbr, Substance, Textures.com, Unreal, Unity, glTF
            ("red-brick_normal-ogl", UP),
            ("red-brick_normal-dx", DOWN),
            ("wall_Normal_OpenGL", UP),
            ("wall_Normal_DirectX", DOWN),
            ("wall_Mixed_AO", MapRole::Ao),
            ("TexturesCom_Wall_1K_albedo", MapRole::BaseColor),
            ("T_Brick_D", MapRole::BaseColor),
            ("T_Brick_N", DOWN),
            ("T_Brick_Normal", MapRole::Normal(None)),
            ("Brick_N", MapRole::Normal(None)),
            ("T_Brick_ORM", MapRole::Packed(PackedChannels::ARM)),
            ("wall_AlbedoTransparency", MapRole::BaseColor),
            ("wall_occlusionRoughnessMetallic", MapRole::Packed(PackedChannels::ARM)),
            ("Brick_wall_016_ambientOcclusion", MapRole::Ao),
            // Plain.
            ("base_color", MapRole::BaseColor),
            ("height", HEIGHT),
            ("normal", MapRole::Normal(None)),
            ("heightmap", HEIGHT),
            ("Normal Map", MapRole::Normal(None)),
            ("AOmap", MapRole::Ao),
            ("stone.depth", MapRole::Height(HeightKind::Depth)),
            ("stone_preview", MapRole::Unused("a preview picture, not a map")),
        ] {
            assert_eq!(role_of(stem), Some(role), "{stem}");
        }
    }

    #[test]
    fn names_that_name_no_map_are_not_guessed() {
        for stem in
            ["Bricks102", "readme", "n", "rough_stone", "painted_metal_plate", "", "_", "2K", "ground_a", "Карта"]
        {
            assert_eq!(role_of(stem), None, "{stem}");
        }
    }

    #[test]
    fn the_three_letters_of_a_packed_map_say_which_channel_is_which() {
        let rma = PackedChannels {
            ao: Some(Channel::Blue),
            roughness: Some(Channel::Red),
            metallic: Some(Channel::Green),
            smooth: false,
        };
        assert_eq!(role_of("x_RMA"), Some(MapRole::Packed(rma)));
        assert_eq!(
            role_of("x_mro").map(|r| matches!(r, MapRole::Packed(p) if p.metallic == Some(Channel::Red))),
            Some(true)
        );
        assert_eq!(role_of("x_aro"), None);
    }

    #[test]
    fn the_material_is_what_is_left_of_the_name() {
        assert_eq!(material_of("Bricks102_1K-JPG_Color"), "bricks102");
        assert_eq!(material_of("brick_wall_003_nor_gl_4k"), "brickwall003");
        assert_eq!(material_of("BricksOld01_COL_VAR1_3K"), "bricksold01");
        assert_eq!(material_of("BricksOld01_DISP16_3K"), "bricksold01");
        assert_eq!(material_of("MetalX_COL_2K_METALNESS"), "metalx");
        assert_eq!(material_of("base_color"), "");
    }

    proptest::proptest! {
        #[test]
        fn no_name_is_too_odd(start in "\\PC{0,12}", end in "(_normalGL|_2K|16|_diff|-|\\.|[A-Za-z0-9]){0,6}") {
            let named = parse_file_name(&format!("{start}{end}"));
            proptest::prop_assert!(named.is_none_or(|n| n.material.len() <= 4 * (start.len() + end.len())));
        }
    }

    #[test]
    fn resolution_and_bits_are_read_from_the_name() {
        let of = |stem: &str| parse_file_name(stem).map(|n| (n.resolution, n.bits)).unwrap();
        assert_eq!(of("a_disp_4k"), (4096, 0));
        assert_eq!(of("a_2048x1024_height"), (2048, 0));
        assert_eq!(of("a_512_height"), (512, 0));
        assert_eq!(of("a_DISP16_3K"), (3072, 16));
        assert_eq!(of("a_height"), (0, 0));
    }
}
