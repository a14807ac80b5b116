//! The names that libraries and engines give to maps.

use super::map_role::{HeightKind, MapRole, PackedChannels};
use crate::types::{Channel, NormalY};

/// The endings that are known, for messages.
pub(super) const KNOWN_ENDINGS: &str = "_Color, _albedo, _diff or _basecolor; _NormalGL, _NormalDX, _nor_gl, _nor_dx or _normal; \
     _Displacement, _disp, _height, _bump or _depth; _Roughness, _rough or _gloss; _Metalness or _metallic; \
     _AmbientOcclusion or _ao; _arm, _orm or _rma (packed)";

/// The reason why specular maps are not read; also the mark of Poliigon's other workflow.
pub(super) const SPECULAR: &str = "a specular map, which the metallic-roughness model does not use";

/// Returns the role that a name stands for. `single`: it was one word; `ends`: something stands before it.
pub(super) fn role_of_name(name: &str, single: bool, ends: bool) -> Option<MapRole> {
    let name = ["textures", "texture", "maps", "map", "tex"]
        .iter()
        .find_map(|end| name.strip_suffix(end))
        .filter(|rest| !rest.is_empty() && *rest != "bit")
        .unwrap_or(name);
    for (names, role) in ROLE_NAMES {
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
        if rest.is_some_and(|rest| NORMAL_NAMES.contains(&rest.strip_suffix("map").unwrap_or(rest))) {
            return Some(MapRole::Normal(Some(y)));
        }
    }
    if single {
        if let Some(packed) = packed_channels(name) {
            return Some(MapRole::Packed(packed));
        }
        // Unreal's `T_Brick_N`: only as an ending.
        if ends {
            return match name {
                "d" | "bc" => Some(MapRole::BaseColor),
                "n" => Some(MapRole::Normal(None)),
                "h" => Some(MapRole::Height(HeightKind::Displacement)),
                "r" => Some(MapRole::Roughness),
                "m" => Some(MapRole::Metallic),
                "s" => Some(MapRole::Unused(SPECULAR)),
                "e" => Some(MapRole::Unused("an emission map, which is not used")),
                _ => None,
            };
        }
    }
    None
}

/// Names of normal maps, which may also carry their convention.
const NORMAL_NAMES: &[&str] = &["normal", "normals", "norm", "nrm", "nor", "nrml", "nml"];

/// Names of maps, in lower case and without separators.
const ROLE_NAMES: &[(&[&str], MapRole)] = &[
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
        MapRole::BaseColor,
    ),
    (NORMAL_NAMES, MapRole::Normal(None)),
    (
        &["displacement", "displace", "disp", "height", "heights", "hgt", "elevation", "parallax"],
        MapRole::Height(HeightKind::Displacement),
    ),
    (&["bump", "bmp"], MapRole::Height(HeightKind::Bump)),
    (&["depth"], MapRole::Height(HeightKind::Depth)),
    (&["roughness", "rough", "rgh"], MapRole::Roughness),
    (&["gloss", "glossiness", "gls", "smoothness"], MapRole::Gloss),
    (&["metallic", "metalness", "metal", "met", "mtl"], MapRole::Metallic),
    (&["ambientocclusion", "ao", "occlusion", "occ", "mixedao"], MapRole::Ao),
    (&["occlusionroughnessmetallic", "aoroughnessmetallic"], MapRole::Packed(PackedChannels::ARM)),
    (
        // glTF's.
        &["metallicroughness", "roughnessmetallic"],
        MapRole::Packed(PackedChannels {
            ao: None,
            roughness: Some(Channel::Green),
            metallic: Some(Channel::Blue),
            smooth: false,
        }),
    ),
    (
        // Unity: smoothness is in alpha.
        &["metallicsmoothness"],
        MapRole::Packed(PackedChannels {
            ao: None,
            roughness: Some(Channel::Alpha),
            metallic: Some(Channel::Red),
            smooth: true,
        }),
    ),
    (
        &["specular", "spec", "specularity", "specularlevel", "reflection", "refl", "reflectivity", "specior"],
        MapRole::Unused(SPECULAR),
    ),
    (&["emission", "emissive", "emit", "glow", "selfillum"], MapRole::Unused("an emission map, which is not used")),
    (
        &["opacity", "alpha", "transparency", "mask", "transmission"],
        MapRole::Unused("an opacity map, which is not used"),
    ),
    (&["cavity", "curvature", "convexity"], MapRole::Unused("a curvature map, which is not used")),
    (
        &["translucency", "translucent", "sss", "subsurface", "scattering", "thickness", "fuzz", "sheen", "anisotropy"],
        MapRole::Unused("of a kind that is not used"),
    ),
    (
        &["preview", "thumb", "thumbnail", "render", "icon", "sphere", "cube", "swatch"],
        MapRole::Unused("a preview picture, not a map"),
    ),
];

/// Parses three letters for the three channels: `arm`, `orm`, `rma`, … (a or o: occlusion).
fn packed_channels(name: &str) -> Option<PackedChannels> {
    let letters: [u8; 3] = name.as_bytes().try_into().ok()?;
    let at = |wanted: &[u8]| {
        letters.iter().position(|l| wanted.contains(l)).map(|i| [Channel::Red, Channel::Green, Channel::Blue][i])
    };
    let packed = PackedChannels { ao: at(b"ao"), roughness: at(b"r"), metallic: at(b"m"), smooth: false };
    (packed.ao.is_some() && packed.roughness.is_some() && packed.metallic.is_some()).then_some(packed)
}
