//! The keys of the scene file, defined once: the reader refuses all others, and the documentation is made from them.

use crate::reader::MAX;

/// One key of the scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneKey {
    /// The table it stands in, as its header is written.
    pub table: &'static str,
    /// The key.
    pub key: &'static str,
    /// What it takes: type, unit and range.
    pub value: &'static str,
    /// What holds without it; `required`, or `–` if it is simply not there.
    pub default: &'static str,
    /// What it does.
    pub meaning: &'static str,
}

const fn key(
    table: &'static str,
    key: &'static str,
    value: &'static str,
    default: &'static str,
    meaning: &'static str,
) -> SceneKey {
    SceneKey { table, key, value, default, meaning }
}

pub(crate) const ROOT: &str = "the scene file";
pub(crate) const IMAGE: &str = "[image]";
pub(crate) const CAMERA: &str = "[camera]";
pub(crate) const LIGHT: &str = "[[lights]]";
pub(crate) const SHADING: &str = "[shading]";
pub(crate) const MATERIAL: &str = "[materials.NAME]";
pub(crate) const RELIEF: &str = "[materials.NAME.relief]";
pub(crate) const OBJECT: &str = "[[objects]]";

/// Every key of the scene file, table by table.
pub const SCENE_KEYS: &[SceneKey] = &[
    key(ROOT, "image", "table", "defaults", "the picture"),
    key(ROOT, "camera", "table", "defaults", "the eye"),
    key(ROOT, "lights", "list of tables", "none", "the lights; without any only the ambient part is drawn"),
    key(ROOT, "shading", "table", "defaults", "how light becomes colour"),
    key(ROOT, "materials", "table of tables", "none", "the materials, by name"),
    key(ROOT, "objects", "list of tables", "required", "the things in the scene, at least one"),
    key(IMAGE, "width", "pixels, 1 to 16384", "800", "width of the picture; width × height at most 134217728"),
    key(IMAGE, "height", "pixels, 1 to 16384", "600", "height of the picture"),
    key(IMAGE, "background", "3 numbers, 0 to 1", "[0.1, 0.1, 0.1]", "display RGB where nothing is hit"),
    key(IMAGE, "samples", "1 to 4096", "1", "samples per pixel"),
    key(CAMERA, "position", "3 numbers", "[0, 0, 3]", "the eye, scene units"),
    key(CAMERA, "target", "3 numbers", "[0, 0, 0]", "the point in the middle of the picture, not the eye itself"),
    key(CAMERA, "up", "3 numbers", "[0, 1, 0]", "up in the picture, not along the line of sight"),
    key(CAMERA, "vertical_fov", "degrees, above 0 and below 180", "45", "angle between the lower and the upper border"),
    key(CAMERA, "near", "number above 0", "0.01", "nothing nearer is drawn, scene units"),
    key(LIGHT, "kind", "\"point\", \"directional\" or \"spot\"", "required", "where the light comes from"),
    key(LIGHT, "position", "3 numbers", "required for point and spot", "scene units"),
    key(
        LIGHT,
        "direction",
        "3 numbers, not all 0",
        "required for directional and spot",
        "the way the light travels; any length",
    ),
    key(LIGHT, "color", "3 numbers, 0 or more", "[1, 1, 1]", "linear RGB"),
    key(
        LIGHT,
        "intensity",
        "number, 0 or more",
        "1",
        "factor on the colour; `pbr`: falls off with the squared distance",
    ),
    key(
        LIGHT,
        "radius",
        "number, 0 or more",
        "0",
        "size of the light, scene units (directional: tangent of the half-angle): softens `exact` shadows only; 0 = sharp",
    ),
    key(LIGHT, "inner_angle", "degrees, 0 to 90", "20", "spot: full light inside, from the axis; below outer_angle"),
    key(LIGHT, "outer_angle", "degrees, above 0 to 90", "30", "spot: no light outside, from the axis"),
    key(SHADING, "model", "\"blinn-phong\" or \"pbr\"", "\"blinn-phong\"", "the reflection model"),
    key(
        SHADING,
        "color_space",
        "\"linear\" or \"display\"",
        "\"linear\"",
        "decode sRGB maps and encode the picture, or take numbers as they are",
    ),
    key(SHADING, "ambient", "number, 0 or more", "0.1", "factor on the base colour that is there without any light"),
    key(SHADING, "specular", "number, 0 or more", "0.2", "blinn-phong: strength of the highlight"),
    key(SHADING, "shininess", "number above 0", "32", "blinn-phong: exponent of the highlight"),
    key(SHADING, "environment", "image file", "–", "equirectangular picture of the surroundings"),
    key(
        MATERIAL,
        "from",
        "folder or \"make:NAME\"",
        "–",
        "maps recognised by their file names, or generated; maps named below take their place",
    ),
    key(
        MATERIAL,
        "base_color",
        "image file, or 3 numbers 0 to 1",
        "[1, 1, 1]",
        "the colour; numbers are a linear factor where `from` brings a map",
    ),
    key(MATERIAL, "normal", "image file", "–", "tangent-space normals"),
    key(
        MATERIAL,
        "normal_y",
        "\"up\" or \"down\"",
        "\"up\"; in a folder as the name says",
        "green of the normal map: up = OpenGL, glTF; down = DirectX",
    ),
    key(MATERIAL, "height", "image file", "–", "heights"),
    key(
        MATERIAL,
        "white",
        "\"high\" or \"deep\"",
        "\"high\"; in a folder as the name says",
        "what white means in the height map",
    ),
    key(MATERIAL, "roughness", "image file, or number 0 to 1", "1", "0 mirror, 1 matt; a number is a factor on a map"),
    key(
        MATERIAL,
        "metallic",
        "image file, or number 0 to 1",
        "0; 1 with a map",
        "0 dielectric, 1 metal; a number is a factor on a map",
    ),
    key(MATERIAL, "ao", "image file", "–", "ambient occlusion: white is open"),
    key(
        MATERIAL,
        "height_scale",
        "number, 0 or more",
        "0.1; for make: the maker's own",
        "distance between height 0 and 1, as a fraction of one texture repeat along u",
    ),
    key(MATERIAL, "depth", "number, 0 or more", "–", "the same distance in object units; one of the two"),
    key(MATERIAL, "midlevel", "number, 0 to 1", "1", "the height that lies on the polygon: 1 = all relief is below it"),
    key(
        MATERIAL,
        "filter",
        "\"linear\" or \"trilinear\"",
        "\"linear\"",
        "how maps are filtered; `relief.lod = true` filters all maps by level, the height map too",
    ),
    key(MATERIAL, "wrap", "\"repeat\", \"clamp\" or \"mirror\"", "\"repeat\"", "what lies beyond the maps' borders"),
    key(MATERIAL, "relief", "table", "defaults", "how the relief is drawn"),
    key(
        RELIEF,
        "technique",
        "\"none\", \"normal\", \"basic\", \"offset-limiting\", \"unity-offset\", \"steep\", \"binary\", \"relief\", \
         \"occlusion\", \"contact\", \"cone\", \"exact\" or \"displacement\"",
        "\"exact\"",
        "how the surface is found; a relief is not visible from behind, `none` and `normal` draw both sides",
    ),
    key(RELIEF, "offset_limiting", "true or false", "false", "drop the division by V.z in the layered techniques"),
    key(RELIEF, "min_layers", "number, 1 to 4096", "8", "layers when seen along the normal; at most max_layers"),
    key(RELIEF, "max_layers", "number, 1 to 4096", "32", "layers at grazing angles; the most steps of relaxed cones"),
    key(RELIEF, "refine_steps", "0 to 64", "5; binary, cone 8", "bisections of `relief`, `binary` and relaxed cones"),
    key(
        RELIEF,
        "cones",
        "\"relaxed\" or \"conservative\"",
        "\"relaxed\"",
        "what `cone` steps through: relaxed cones go through the surface at most once, then bisect; conservative ones never \
         touch it, need no limit of steps, and find what `exact` finds",
    ),
    key(
        RELIEF,
        "shadow",
        "\"none\", \"hard\", \"soft\" or \"exact\"",
        "\"none\"",
        "shadows: hard and soft are thrown by the relief on itself alone, as in the tutorials; exact by the relief and every other object",
    ),
    key(
        RELIEF,
        "edge",
        "\"clip\", \"wrap\" or \"clamp\"",
        "\"wrap\"",
        "what happens where the relief leaves the object's texture range",
    ),
    key(RELIEF, "grid", "2 to 8192", "100", "displacement: vertices per side"),
    key(
        RELIEF,
        "lod",
        "true or false",
        "false",
        "level of detail: all maps by the mip level that fits the pixel, the relief fades to `normal` where it spans less than one, highlights widen by what normals scatter",
    ),
    key(
        RELIEF,
        "write_depth",
        "true or false",
        "true for cone and exact, else false",
        "the hit, not the polygon, gives the depth, and is where lights are seen from",
    ),
    key(
        OBJECT,
        "mesh",
        "\"quad\", \"plane\", \"cube\", \"sphere\", \"cylinder\", \"torus\", or a .glb, .gltf or .obj file",
        "required",
        "the geometry",
    ),
    key(
        OBJECT,
        "material",
        "a material's name",
        "the only material; glTF: the file's own",
        "required for built-in meshes if there are several materials",
    ),
    key(OBJECT, "translate", "3 numbers", "[0, 0, 0]", "scene units; applied last"),
    key(OBJECT, "rotate", "3 numbers, degrees", "[0, 0, 0]", "about X first, then Y, then Z (the scene's axes)"),
    key(
        OBJECT,
        "scale",
        "number or 3 numbers, each of magnitude 1e-9 to 1e9",
        "1",
        "applied first; negative numbers mirror",
    ),
    key(
        OBJECT,
        "uv_repeat",
        "number or 2 numbers above 0",
        "1",
        "texture repeats over the mesh's uv range, along u and v",
    ),
];

/// The keys of a table.
pub(crate) fn keys_of(table: &str) -> impl Iterator<Item = &'static str> {
    SCENE_KEYS.iter().filter(move |key| key.table == table).map(|key| key.key)
}

/// [`SCENE_KEYS`] as a Markdown table, and the limit of all numbers, for documentation and help.
#[must_use]
pub fn scene_keys_markdown() -> String {
    let mut text = String::from("| table | key | value | default | meaning |\n|---|---|---|---|---|\n");
    let mut last = "";
    for key in SCENE_KEYS.iter().filter(|key| key.table != ROOT) {
        let table = if key.table == last { String::new() } else { format!("`{}`", key.table) };
        last = key.table;
        text += &format!("| {table} | `{}` | {} | {} | {} |\n", key.key, key.value, key.default, key.meaning);
    }
    text += &format!("\nNumbers without an upper limit of their own are of magnitude at most {MAX:e}.\n");
    text
}
