//! What a file name says about the map in it: `Bricks102_2K-JPG_NormalGL` is the normals, +Y up, of `bricks102` at 2048.

use crate::types::{Channel, NormalY};

/// The endings that are understood, for messages.
pub(crate) const KNOWN: &str = "_Color, _albedo, _diff or _basecolor; _NormalGL, _NormalDX, _nor_gl, _nor_dx or _normal; \
     _Displacement, _disp, _height, _bump or _depth; _Roughness, _rough or _gloss; _Metalness or _metallic; \
     _AmbientOcclusion or _ao; _arm, _orm or _rma (packed)";

/// What a map is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    BaseColor,
    /// `None`: the name does not tell which way Y points.
    Normal(Option<NormalY>),
    Height(HeightKind),
    Roughness,
    /// 1 − roughness.
    Gloss,
    Metallic,
    Ao,
    /// Several maps in the channels of one file.
    Packed(Packed),
    /// A known kind that is not used: why, as the end of a sentence.
    Unused(&'static str),
}

/// What sort of height a file holds, the best last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum HeightKind {
    /// White is deep.
    Depth,
    /// Often only fine detail.
    Bump,
    Displacement,
}

/// Which channel holds what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Packed {
    pub(crate) ao: Option<Channel>,
    pub(crate) roughness: Option<Channel>,
    pub(crate) metallic: Option<Channel>,
    /// The channel of the roughness holds smoothness: 1 − roughness.
    pub(crate) smooth: bool,
}

/// A file name, understood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Named {
    /// What is left without the map and the resolution: the material. Lower case, no separators.
    pub(crate) material: String,
    pub(crate) role: Role,
    /// The name follows Unreal's convention, and that is what tells which way the normals' Y points.
    pub(crate) unreal: bool,
    /// Texels per side as the name says, else 0.
    pub(crate) resolution: u32,
    /// Bits per sample as the name says, else 0.
    pub(crate) bits: u32,
}

/// What the name of a file (without extension) says; `None` if it names no map.
pub(crate) fn understand(stem: &str) -> Option<Named> {
    let mut tokens = tokens(stem);
    let resolution = tokens.iter().map(|t| if let Token::Resolution(r) = t { *r } else { 0 }).max().unwrap_or(0);
    let mut bits = 0;
    let all = tokens.clone();
    let mut understood = match_end(&mut tokens, &mut bits);
    // Poliigon appends the workflow: `X_COL_2K_METALNESS` is a colour, `X_METALNESS_2K_METALNESS` the metalness.
    if let [before @ .., Token::Resolution(_)] = tokens.as_slice()
        && matches!(understood, Some(Role::Metallic | Role::Unused(SPECULAR)))
    {
        let mut before = before.to_vec();
        if let Some(role) = match_end(&mut before, &mut bits)
            && before.iter().any(|t| matches!(t, Token::Word(_)))
        {
            (understood, tokens) = (Some(role), before);
        }
    }
    let material = tokens.iter().filter_map(Token::word).filter(|word| !is_noise(word)).collect();
    // Unreal's normals point +Y down; there, `T_…_N` is how a texture of normals is called.
    let unreal = understood == Some(Role::Normal(None))
        && stem.get(..2).is_some_and(|start| start.eq_ignore_ascii_case("T_"))
        && all.get(tokens.len()).and_then(Token::word) == Some("n");
    understood.map(|role| Named {
        material,
        role: if unreal { Role::Normal(Some(NormalY::Down)) } else { role },
        unreal,
        resolution,
        bits,
    })
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Token {
    /// Letters or digits, lower case.
    Word(String),
    /// `2K`, `2048`, `2048x2048`.
    Resolution(u32),
}

impl Token {
    fn word(&self) -> Option<&str> {
        if let Self::Word(word) = self { Some(word) } else { None }
    }
}

/// Cuts a name at separators, at humps (`NormalGL`) and between letters and digits.
fn tokens(stem: &str) -> Vec<Token> {
    let chars: Vec<char> = stem.chars().collect();
    let mut words: Vec<String> = Vec::new();
    let mut open = false;
    for (i, &c) in chars.iter().enumerate() {
        if !c.is_alphanumeric() {
            open = false;
            continue;
        }
        if let (true, Some(&before)) = (open, i.checked_sub(1).and_then(|i| chars.get(i))) {
            let hump = c.is_uppercase()
                && (before.is_lowercase()
                    || before.is_uppercase() && chars.get(i + 1).is_some_and(|next| next.is_lowercase()));
            open = !hump && before.is_numeric() == c.is_numeric();
        }
        if !open {
            words.push(String::new());
            open = true;
        }
        if let Some(word) = words.last_mut() {
            word.extend(c.to_lowercase());
        }
    }
    let mut tokens = Vec::new();
    let mut rest = words.as_slice();
    while let [first, after @ ..] = rest {
        let number: Option<u32> = first.parse().ok();
        let (token, left) = match (number, after) {
            (Some(n @ 1..=64), [k, after @ ..]) if k == "k" => (Token::Resolution(n * 1024), after),
            (Some(n), [x, m, after @ ..]) if x == "x" && m.parse::<u32>().is_ok() => {
                (Token::Resolution(n.max(m.parse().unwrap_or(0))), after)
            }
            (Some(n), [px, after @ ..]) if px == "px" => (Token::Resolution(n), after),
            (Some(n @ (256 | 512 | 1024 | 2048 | 4096 | 8192 | 16384)), after) => (Token::Resolution(n), after),
            (_, after) => (Token::Word(first.clone()), after),
        };
        tokens.push(token);
        rest = left;
    }
    tokens
}

/// Words that say nothing about the map or the material: file formats, and how the file was made.
fn is_noise(word: &str) -> bool {
    const NOISE: &[&str] = &[
        "jpg", "jpeg", "png", "exr", "tif", "tiff", "tga", "bmp", "webp", "hdr", "bit", "bits", "var", "lod", "udim",
        "seamless", "tileable", "tiled", "linear", "srgb", "raw", "copy", "lossless", "final",
    ];
    NOISE.contains(&word)
}

/// Takes the map's name off the end of the tokens, and what says nothing after it.
fn match_end(tokens: &mut Vec<Token>, bits: &mut u32) -> Option<Role> {
    loop {
        match tokens.last()? {
            Token::Word(word) if is_noise(word) => {}
            Token::Word(word) if word.chars().all(char::is_numeric) => {
                // `DISP16` is a 16-bit file; any other number a variant.
                if let Ok(n @ (8 | 16 | 32)) = word.parse() {
                    *bits = n;
                }
            }
            Token::Word(_) => break,
            Token::Resolution(_) => {}
        }
        tokens.pop();
    }
    let words: Vec<&str> = tokens.iter().rev().map_while(Token::word).collect();
    // The longest ending first: `base_color` before `color`.
    for count in (1..=words.len().min(4)).rev() {
        let joined: String = words[..count].iter().rev().copied().collect();
        if let Some(role) = role(&joined, count == 1, tokens.len() > count) {
            tokens.truncate(tokens.len() - count);
            return Some(role);
        }
    }
    None
}

/// Why specular maps are not read; also the name of Poliigon's other workflow.
const SPECULAR: &str = "a specular map, which the metallic-roughness model does not use";

/// The map of this name. `single`: it was one word; `ends`: something stands before it.
fn role(name: &str, single: bool, ends: bool) -> Option<Role> {
    let name = ["textures", "texture", "maps", "map", "tex"]
        .iter()
        .find_map(|end| name.strip_suffix(end))
        .filter(|rest| !rest.is_empty() && *rest != "bit")
        .unwrap_or(name);
    for (names, role) in NAMES {
        if names.contains(&name) {
            return Some(*role);
        }
    }
    for (convention, y) in [
        ("opengl", NormalY::Up),
        ("ogl", NormalY::Up),
        ("gl", NormalY::Up),
        ("directx", NormalY::Down),
        ("d3d", NormalY::Down),
        ("dx", NormalY::Down),
    ] {
        let rest = name.strip_suffix(convention).or_else(|| name.strip_prefix(convention));
        if rest.is_some_and(|rest| NORMAL.contains(&rest.strip_suffix("map").unwrap_or(rest))) {
            return Some(Role::Normal(Some(y)));
        }
    }
    if single {
        if let Some(packed) = packed(name) {
            return Some(Role::Packed(packed));
        }
        // Unreal's `T_Brick_N`: only as an ending.
        if ends {
            return match name {
                "d" | "bc" => Some(Role::BaseColor),
                "n" => Some(Role::Normal(None)),
                "h" => Some(Role::Height(HeightKind::Displacement)),
                "r" => Some(Role::Roughness),
                "m" => Some(Role::Metallic),
                "s" => Some(Role::Unused(SPECULAR)),
                "e" => Some(Role::Unused("an emission map, which is not used")),
                _ => None,
            };
        }
    }
    None
}

const NORMAL: &[&str] = &["normal", "normals", "norm", "nrm", "nor", "nrml", "nml"];

const NAMES: &[(&[&str], Role)] = &[
    (
        &[
            "color",
            "colour",
            "col",
            "basecolor",
            "basecolour",
            "base",
            "albedo",
            "alb",
            "diffuse",
            "diff",
            "dif",
            "albedotransparency",
            "diffusecolor",
            "colorrgb",
            "basecoloropacity",
        ],
        Role::BaseColor,
    ),
    (NORMAL, Role::Normal(None)),
    (
        &["displacement", "displace", "disp", "height", "heights", "hgt", "elevation", "parallax"],
        Role::Height(HeightKind::Displacement),
    ),
    (&["bump", "bmp"], Role::Height(HeightKind::Bump)),
    (&["depth"], Role::Height(HeightKind::Depth)),
    (&["roughness", "rough", "rgh"], Role::Roughness),
    (&["gloss", "glossiness", "gls", "smoothness"], Role::Gloss),
    (&["metallic", "metalness", "metal", "met", "mtl"], Role::Metallic),
    (&["ambientocclusion", "ao", "occlusion", "occ", "mixedao"], Role::Ao),
    (&["occlusionroughnessmetallic", "aoroughnessmetallic"], Role::Packed(ARM)),
    (
        // glTF's.
        &["metallicroughness", "roughnessmetallic"],
        Role::Packed(Packed {
            ao: None,
            roughness: Some(Channel::Green),
            metallic: Some(Channel::Blue),
            smooth: false,
        }),
    ),
    (
        // Unity: smoothness is in alpha.
        &["metallicsmoothness"],
        Role::Packed(Packed { ao: None, roughness: Some(Channel::Alpha), metallic: Some(Channel::Red), smooth: true }),
    ),
    (
        &["specular", "spec", "specularity", "specularlevel", "reflection", "refl", "reflectivity", "specior"],
        Role::Unused(SPECULAR),
    ),
    (&["emission", "emissive", "emit", "glow", "selfillum"], Role::Unused("an emission map, which is not used")),
    (&["opacity", "alpha", "transparency", "mask", "transmission"], Role::Unused("an opacity map, which is not used")),
    (&["cavity", "curvature", "convexity"], Role::Unused("a curvature map, which is not used")),
    (
        &["translucency", "translucent", "sss", "subsurface", "scattering", "thickness", "fuzz", "sheen", "anisotropy"],
        Role::Unused("of a kind that is not used"),
    ),
    (
        &["preview", "thumb", "thumbnail", "render", "icon", "sphere", "cube", "swatch"],
        Role::Unused("a preview picture, not a map"),
    ),
];

const ARM: Packed =
    Packed { ao: Some(Channel::Red), roughness: Some(Channel::Green), metallic: Some(Channel::Blue), smooth: false };

/// Three letters for the three channels: `arm`, `orm`, `rma`, … (a or o: occlusion).
fn packed(name: &str) -> Option<Packed> {
    let letters: [u8; 3] = name.as_bytes().try_into().ok()?;
    let at = |wanted: &[u8]| {
        letters.iter().position(|l| wanted.contains(l)).map(|i| [Channel::Red, Channel::Green, Channel::Blue][i])
    };
    let packed = Packed { ao: at(b"ao"), roughness: at(b"r"), metallic: at(b"m"), smooth: false };
    (packed.ao.is_some() && packed.roughness.is_some() && packed.metallic.is_some()).then_some(packed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn role_of(stem: &str) -> Option<Role> {
        understand(stem).map(|named| named.role)
    }

    fn material_of(stem: &str) -> String {
        understand(stem).unwrap().material
    }

    const UP: Role = Role::Normal(Some(NormalY::Up));
    const DOWN: Role = Role::Normal(Some(NormalY::Down));
    const HEIGHT: Role = Role::Height(HeightKind::Displacement);

    #[test]
    fn the_names_of_the_libraries_and_engines_are_understood() {
        for (stem, role) in [
            // ambientCG
            ("Bricks102_1K-JPG_Color", Role::BaseColor),
            ("Bricks102_1K-JPG_NormalGL", UP),
            ("Bricks102_1K-JPG_NormalDX", DOWN),
            ("Bricks102_1K-JPG_Displacement", HEIGHT),
            ("Bricks102_1K-JPG_Roughness", Role::Roughness),
            ("Bricks102_1K-JPG_AmbientOcclusion", Role::Ao),
            ("Metal012_2K-PNG_Metalness", Role::Metallic),
            // Poly Haven
            ("brick_wall_003_diff_1k", Role::BaseColor),
            ("brick_wall_003_nor_gl_4k", UP),
            ("brick_wall_003_nor_dx_4k", DOWN),
            ("brick_wall_003_disp_4k", HEIGHT),
            ("rusty_metal_rough_2k", Role::Roughness),
            ("brick_wall_003_arm_2k", Role::Packed(ARM)),
            ("brick_wall_003_spec_ior_2k", Role::Unused(SPECULAR)),
            // Poliigon
            ("BricksOld01_COL_VAR1_3K", Role::BaseColor),
            ("BricksOld01_DISP16_3K", HEIGHT),
            ("BricksOld01_NRM_3K", Role::Normal(None)),
            ("BricksOld01_GLOSS_3K", Role::Gloss),
            ("MetalX_COL_2K_METALNESS", Role::BaseColor),
            ("MetalX_METALNESS_2K_METALNESS", Role::Metallic),
            ("MetalX_ROUGHNESS_2K_METALNESS", Role::Roughness),
            ("WoodX_NRM_2K_SPECULAR", Role::Normal(None)),
            ("Poliigon_BrickWall_8320_BaseColor", Role::BaseColor),
            // freepbr, Substance, Textures.com, Unreal, Unity, glTF
            ("red-brick_normal-ogl", UP),
            ("red-brick_normal-dx", DOWN),
            ("wall_Normal_OpenGL", UP),
            ("wall_Normal_DirectX", DOWN),
            ("wall_Mixed_AO", Role::Ao),
            ("TexturesCom_Wall_1K_albedo", Role::BaseColor),
            ("T_Brick_D", Role::BaseColor),
            ("T_Brick_N", DOWN),
            ("T_Brick_Normal", Role::Normal(None)),
            ("Brick_N", Role::Normal(None)),
            ("T_Brick_ORM", Role::Packed(ARM)),
            ("wall_AlbedoTransparency", Role::BaseColor),
            ("wall_occlusionRoughnessMetallic", Role::Packed(ARM)),
            ("Brick_wall_016_ambientOcclusion", Role::Ao),
            // Plain.
            ("base_color", Role::BaseColor),
            ("height", HEIGHT),
            ("normal", Role::Normal(None)),
            ("heightmap", HEIGHT),
            ("Normal Map", Role::Normal(None)),
            ("AOmap", Role::Ao),
            ("stone.depth", Role::Height(HeightKind::Depth)),
            ("stone_preview", Role::Unused("a preview picture, not a map")),
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
        let rma = Packed {
            ao: Some(Channel::Blue),
            roughness: Some(Channel::Red),
            metallic: Some(Channel::Green),
            smooth: false,
        };
        assert_eq!(role_of("x_RMA"), Some(Role::Packed(rma)));
        assert_eq!(
            role_of("x_mro").map(|r| matches!(r, Role::Packed(p) if p.metallic == Some(Channel::Red))),
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
            let named = understand(&format!("{start}{end}"));
            proptest::prop_assert!(named.is_none_or(|n| n.material.len() <= 4 * (start.len() + end.len())));
        }
    }

    #[test]
    fn resolution_and_bits_are_read_from_the_name() {
        let of = |stem: &str| understand(stem).map(|n| (n.resolution, n.bits)).unwrap();
        assert_eq!(of("a_disp_4k"), (4096, 0));
        assert_eq!(of("a_2048x1024_height"), (2048, 0));
        assert_eq!(of("a_512_height"), (512, 0));
        assert_eq!(of("a_DISP16_3K"), (3072, 16));
        assert_eq!(of("a_height"), (0, 0));
    }
}
