//! The keys of the scene file, defined once: the reader refuses all others, and the documentation is made from them.

/// Largest length, coordinate or factor: sums and products of two stay finite in f32. The documentation of the keys
/// and the errors name it.
pub(super) const MAX_NUMBER: f32 = 1e9;

/// One key of the scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneKey {
    /// Table of the key, as its header is written.
    pub table: &'static str,
    /// Name of the key.
    pub key: &'static str,
    /// Accepted values: type, unit and range.
    pub value: &'static str,
    /// Value without the key; `required`, or `–` for none.
    pub default: &'static str,
    /// Meaning of the key.
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

pub(super) const ROOT: &str = "the scene file";
pub(super) const IMAGE: &str = "[image]";
pub(super) const CAMERA: &str = "[camera]";
pub(super) const LIGHT: &str = "[[lights]]";
pub(super) const SHADING: &str = "[shading]";
pub(super) const MATERIAL: &str = "[materials.NAME]";
pub(super) const RELIEF: &str = "[materials.NAME.relief]";
pub(super) const LAYER: &str = "[[materials.NAME.layers]]";
pub(super) const MIST: &str = "[materials.NAME.mist]";
pub(super) const OBJECT: &str = "[[objects]]";
pub(super) const TIME: &str = "[time]";
pub(super) const ANIMATE: &str = "[[animate]]";
pub(super) const KEYFRAME: &str = "[[animate.keys]]";

/// Every key of the scene file, table by table.
pub const SCENE_KEYS: &[SceneKey] = &[
    key(ROOT, "image", "table", "defaults", "the picture"),
    key(ROOT, "camera", "table", "defaults", "the camera"),
    key(ROOT, "lights", "list of tables", "none", "the lights; without any only the ambient part is drawn"),
    key(ROOT, "shading", "table", "defaults", "reflection model, colour space and environment"),
    key(ROOT, "materials", "table of tables", "none", "the materials, by name"),
    key(ROOT, "objects", "list of tables", "required", "the objects, at least one"),
    key(ROOT, "time", "table", "defaults", "the clock"),
    key(ROOT, "animate", "list of tables", "none", "keys that change in the course of time, one each"),
    key(IMAGE, "width", "pixels, 1 to 16384", "800", "width of the picture; width × height at most 134217728"),
    key(IMAGE, "height", "pixels, 1 to 16384", "600", "height of the picture"),
    key(IMAGE, "background", "3 numbers, 0 to 1", "[0.1, 0.1, 0.1]", "display RGB where nothing is hit"),
    key(IMAGE, "samples", "1 to 4096", "1", "samples per pixel"),
    key(
        CAMERA,
        "kind",
        "\"perspective\" or \"orthographic\"",
        "\"perspective\"",
        "perspective: rays from one point; orthographic: parallel rays, things are as large at any distance",
    ),
    key(CAMERA, "position", "3 numbers", "[0, 0, 3]", "position of the eye, scene units"),
    key(
        CAMERA,
        "target",
        "3 numbers",
        "[0, 0, 0]",
        "point in the middle of the picture, scene units; not the position itself",
    ),
    key(CAMERA, "up", "3 numbers", "[0, 1, 0]", "up direction of the picture; not along the view direction"),
    key(CAMERA, "vertical_fov", "degrees, above 0 and below 180", "45", "perspective: vertical field of view"),
    key(CAMERA, "size", "number above 0", "2", "orthographic: height of the picture, scene units"),
    key(CAMERA, "near", "number above 0", "0.01", "distance of the near plane, scene units"),
    key(LIGHT, "kind", "\"point\", \"directional\" or \"spot\"", "required", "kind of light"),
    key(LIGHT, "position", "3 numbers", "required for point and spot", "position of the light, scene units"),
    key(
        LIGHT,
        "direction",
        "3 numbers, not all 0",
        "required for directional and spot",
        "direction in which the light travels; any length",
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
    key(
        LIGHT,
        "inner_angle",
        "degrees, 0 to 90",
        "20",
        "spot: full light inside this angle from the axis; below outer_angle",
    ),
    key(LIGHT, "outer_angle", "degrees, above 0 to 90", "30", "spot: no light outside this angle from the axis"),
    key(SHADING, "model", "\"blinn-phong\" or \"pbr\"", "\"blinn-phong\"", "the reflection model"),
    key(
        SHADING,
        "color_space",
        "\"linear\" or \"display\"",
        "\"linear\"",
        "linear: decode sRGB maps, shade in linear light, encode the picture; display: use numbers as they are",
    ),
    key(SHADING, "ambient", "number, 0 or more", "0.1", "ambient factor on the base colour"),
    key(SHADING, "specular", "number, 0 or more", "0.2", "blinn-phong: strength of the highlight"),
    key(SHADING, "shininess", "number above 0", "32", "blinn-phong: exponent of the highlight"),
    key(SHADING, "environment", "image file", "–", "environment map, an equirectangular picture"),
    key(
        MATERIAL,
        "from",
        "folder or \"make:NAME\"",
        "–",
        "maps recognised by their file names, or generated; maps named below replace them",
    ),
    key(
        MATERIAL,
        "base_color",
        "image file, or 3 numbers 0 to 1",
        "[1, 1, 1]",
        "the colour; numbers are a linear factor where `from` brings a map",
    ),
    key(MATERIAL, "normal", "image file", "–", "tangent-space normal map"),
    key(
        MATERIAL,
        "normal_y",
        "\"up\" or \"down\"",
        "\"up\"; in a folder as the name says",
        "green of the normal map: up = OpenGL, glTF; down = DirectX",
    ),
    key(
        MATERIAL,
        "height",
        "image file, recipe file (.toml) or \"make:NAME\"",
        "–",
        "height map; of a recipe the heights alone, which change with time where it does",
    ),
    key(
        MATERIAL,
        "height_size",
        "1 to 8192",
        "--make-size; for layers the size of the height map",
        "texels per side of the heights that a recipe or layers make",
    ),
    key(
        MATERIAL,
        "height_period",
        "seconds, 0.001 to 1e6",
        "`time.loop`, else the recipe's `period`",
        "time in which a recipe goes once round its loop",
    ),
    key(
        MATERIAL,
        "layers",
        "list of tables",
        "none",
        "height maps that move over each other, blended into the height map",
    ),
    key(
        MATERIAL,
        "layer_blend",
        "\"mean\", \"add\", \"multiply\", \"max\" or \"min\"",
        "\"mean\"",
        "blending of the layers' heights, clamped to 0 to 1",
    ),
    key(
        MATERIAL,
        "white",
        "\"high\" or \"deep\"",
        "\"high\"; in a folder as the name says",
        "meaning of white in the height map",
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
        "depth of the relief: distance between height 0 and 1, as a fraction of one texture repeat along u",
    ),
    key(MATERIAL, "depth", "number, 0 or more", "–", "the same distance in object units; give one of the two"),
    key(
        MATERIAL,
        "midlevel",
        "number, 0 to 1",
        "1",
        "height that lies on the polygon: 1 = the relief is wholly below it, 0 = wholly above",
    ),
    key(
        MATERIAL,
        "filter",
        "\"linear\", \"trilinear\" or \"nearest\"",
        "\"linear\"",
        "filter of the maps; nearest makes columns with flat tops of the height map, for pixel art; `relief.lod = true` filters all maps by mip level, the height map too",
    ),
    key(MATERIAL, "wrap", "\"repeat\", \"clamp\" or \"mirror\"", "\"repeat\"", "addressing mode of the maps"),
    key(
        MATERIAL,
        "uv_offset",
        "2 numbers",
        "[0, 0]",
        "moves the maps' texture coordinates, in texture repeats; applied last",
    ),
    key(
        MATERIAL,
        "uv_velocity",
        "2 numbers of magnitude at most 1000",
        "[0, 0]",
        "movement of the maps' texture coordinates, in texture repeats per second: added to uv_offset; the picture moves the other way",
    ),
    key(
        MATERIAL,
        "uv_rotate",
        "degrees",
        "0",
        "turns the texture coordinates counter-clockwise on the picture, as KHR_texture_transform of glTF: the picture on the \
         surface turns clockwise",
    ),
    key(
        MATERIAL,
        "uv_scale",
        "number or 2 numbers, each of magnitude 1e-9 to 1e9",
        "1",
        "scales the mesh's texture coordinates (times the object's uv_repeat); applied first; negative numbers mirror",
    ),
    key(
        MATERIAL,
        "uv_rect",
        "4 numbers u0, v0, u1, v1; u0 below u1, v0 below v1",
        "–",
        "part of an atlas in the maps' own uv: there `edge` clip and clamp end, instead of at the object's texture range",
    ),
    key(
        MATERIAL,
        "two_sided",
        "true or false",
        "true if it replaces a glTF material that is doubleSided, else false",
        "the relief is visible from both sides: from behind as the same surface, from below",
    ),
    key(
        MATERIAL,
        "kind",
        "\"surface\" or \"mist\"",
        "\"surface\"",
        "mist: the relief is a medium that fills it from its heights down to its floor; base_color is the share of light \
         that it scatters; its mesh is flat, as a quad or a plane",
    ),
    key(MATERIAL, "relief", "table", "defaults", "settings of the relief"),
    key(MATERIAL, "mist", "table", "defaults", "settings of the medium; for kind = \"mist\""),
    key(
        LAYER,
        "height",
        "image file",
        "the material's height map",
        "height map of the layer; it stands still but for `velocity`",
    ),
    key(LAYER, "white", "\"high\" or \"deep\"", "\"high\"", "meaning of white in it"),
    key(
        LAYER,
        "velocity",
        "2 numbers of magnitude at most 1000",
        "[0, 0]",
        "movement of the layer along u and v, in the material's repeats per second",
    ),
    key(
        LAYER,
        "repeat",
        "whole number or 2 of them, 1 to 64",
        "1",
        "repeats of the layer's map within one repeat of the material",
    ),
    key(LAYER, "weight", "number, 0 or more", "1", "mean: share of the layer; else factor on its heights"),
    key(
        RELIEF,
        "technique",
        "\"none\", \"normal\", \"basic\", \"offset-limiting\", \"unity-offset\", \"steep\", \"binary\", \"relief\", \
         \"occlusion\", \"contact\", \"cone\", \"exact\" or \"displacement\"",
        "\"exact\"",
        "technique that finds the surface; without `two_sided` a relief is not visible from behind, `none` and `normal` draw both sides",
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
        "cones of `cone`: relaxed ones pass through the surface at most once, then bisect; conservative ones never \
         pass it, need no limit of steps, and find the hit of `exact`",
    ),
    key(
        RELIEF,
        "shadow",
        "\"none\", \"hard\", \"soft\" or \"exact\"",
        "\"none\"",
        "shadows: hard and soft are cast by the relief on itself alone, as in the tutorials; exact by the relief and every other object",
    ),
    key(
        RELIEF,
        "edge",
        "\"clip\", \"wrap\", \"clamp\" or \"silhouette\"",
        "\"wrap\"",
        "the end of the relief: clip = where the mesh ends, wrap = it repeats beyond the chart, clamp = the chart's border stretches, silhouette = the true outline, as displaced geometry has it (`exact`; others: wrap)",
    ),
    key(
        RELIEF,
        "offset",
        "\"own\" or \"shared\"",
        "\"own\"",
        "directions along which the relief rises at hard edges: own = each side along its own normals, shared = all vertices at a position along one, so that no gap opens where midlevel is below 1; shading normals stay split",
    ),
    key(
        RELIEF,
        "grid",
        "2 to 8192, \"texel\", or \"texel:N\" with N from 1 to 64",
        "100",
        "displacement: vertices per side; texel = at least N (2) vertices along every texel, however many that are: traced without being kept, on the CPU alone",
    ),
    key(
        RELIEF,
        "lod",
        "true or false",
        "false",
        "level of detail: all maps by the mip level of the pixel's footprint, the relief fades to `normal` where it spans less than a pixel, highlights widen by the scatter of the normals",
    ),
    key(
        RELIEF,
        "write_depth",
        "true or false",
        "true for cone and exact, else false",
        "the hit, not the polygon, gives the depth and the point that is lit",
    ),
    key(
        MIST,
        "density",
        "number, 0 or more",
        "1",
        "extinction per scene unit: over a unit of full mist 1/e of the light is left for 1",
    ),
    key(
        MIST,
        "softness",
        "number, 0 to 1",
        "0.1",
        "depth below the surface, as a fraction of the relief's depth, over which the density grows from 0; 0 = a hard surface",
    ),
    key(
        MIST,
        "anisotropy",
        "number above -1 and below 1",
        "0",
        "mean cosine of the angle by which light is scattered (g of Henyey and Greenstein): above 0 forwards, 0 evenly",
    ),
    key(MIST, "steps", "1 to 64", "16", "points along a ray at which arriving light is looked at"),
    key(
        OBJECT,
        "mesh",
        "\"quad\", \"plane\", \"cube\", \"sphere\", \"cylinder\", \"torus\", or a .glb, .gltf or .obj file",
        "required",
        "geometry: a built-in shape or a mesh file",
    ),
    key(
        OBJECT,
        "material",
        "a material's name",
        "the only material; glTF: the file's own",
        "required for built-in meshes if there are several materials",
    ),
    key(OBJECT, "translate", "3 numbers", "[0, 0, 0]", "translation, scene units; applied last"),
    key(
        OBJECT,
        "rotate",
        "3 numbers, degrees",
        "[0, 0, 0]",
        "rotation about X first, then Y, then Z (the scene's axes)",
    ),
    key(
        OBJECT,
        "scale",
        "number or 3 numbers, each of magnitude 1e-9 to 1e9",
        "1",
        "scale; applied first; negative numbers mirror",
    ),
    key(
        OBJECT,
        "uv_repeat",
        "number or 2 numbers above 0",
        "1",
        "texture repeats over the mesh's uv range, along u and v",
    ),
    key(
        TIME,
        "loop",
        "seconds, 0.001 to 1e6",
        "–",
        "length of the scene's loop: everything is at that time as at time 0, to the last bit",
    ),
    key(
        ANIMATE,
        "key",
        "path of a numeric key, as `--set` takes it",
        "required",
        "the key that changes, as \"camera.position\" or \"lights.0.direction\"; keys that count things do not",
    ),
    key(
        ANIMATE,
        "keys",
        "list of tables, rising in time",
        "required",
        "the keyframes; before the first and after the last its value stays",
    ),
    key(
        ANIMATE,
        "interpolation",
        "\"linear\" or \"smooth\"",
        "\"linear\"",
        "between keyframes; smooth: monotone cubics, at rest at the ends, without overshoot",
    ),
    key(ANIMATE, "loop", "true or false", "false", "the last keyframe is followed by the first"),
    key(KEYFRAME, "time", "seconds, of magnitude at most 1e6", "required", "time of the keyframe"),
    key(
        KEYFRAME,
        "value",
        "number, or list of up to 4 numbers",
        "required",
        "value at that time, as the key itself takes it",
    ),
];

/// Returns the keys of a table.
pub(super) fn keys_of(table: &str) -> impl Iterator<Item = &'static str> {
    SCENE_KEYS.iter().filter(move |key| key.table == table).map(|key| key.key)
}

/// Formats [`SCENE_KEYS`] as a Markdown table, and the limit of all numbers, for documentation and help.
#[must_use]
pub fn scene_keys_markdown() -> String {
    let mut text = String::from("| table | key | value | default | meaning |\n|---|---|---|---|---|\n");
    let mut last = "";
    for key in SCENE_KEYS.iter().filter(|key| key.table != ROOT) {
        let table = if key.table == last { String::new() } else { format!("`{}`", key.table) };
        last = key.table;
        text += &format!("| {table} | `{}` | {} | {} | {} |\n", key.key, key.value, key.default, key.meaning);
    }
    text += &format!("\nNumbers without an upper limit of their own are of magnitude at most {MAX_NUMBER:e}.\n");
    text
}
