use std::sync::Arc;

use base64::Engine as _;
use glam::{Vec2, Vec3, Vec4};
use relievo_map::{Limits, Wrap};
use relievo_scene::{LoadOptions, Mesh, Model, Scene, UvTransform};

use crate::glb::{Glb, ONE_NODE, SQUARE, SQUARE_UVS, container, png, square};

pub(crate) fn load(bytes: &[u8]) -> Result<Model, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.glb");
    std::fs::write(&path, bytes).unwrap();
    Model::load(&path, &Limits::default(), true).map_err(|error| error.message)
}

/// A file with one primitive of the given attributes.
fn primitive(glb: &Glb, members: &str) -> Vec<u8> {
    glb.finish(&format!(r#""meshes":[{{"primitives":[{{{members}}}]}}],{ONE_NODE}"#))
}

#[test]
fn a_square_with_texture_coordinates_equals_the_built_in_quad() {
    let model = load(&square("", ONE_NODE)).unwrap();
    assert_eq!(*model.parts[0].mesh, Mesh::quad());
    assert_eq!(model.parts[0].material, None);
    assert_eq!(model.notes, Vec::<String>::new());
}

#[test]
fn nodes_place_one_shared_mesh_several_times() {
    let rest = r#""nodes":[
        {"children":[1,2],"translation":[0,0,5],"scale":[2,2,2]},
        {"mesh":0,"translation":[1,0,0]},
        {"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 3,0,0,1]},
        {"mesh":0}],
        "scenes":[{"nodes":[3]},{"nodes":[0]}],"scene":1"#;
    let model = load(&square("", rest)).unwrap();
    assert_eq!(model.parts.len(), 2);
    assert!(Arc::ptr_eq(&model.parts[0].mesh, &model.parts[1].mesh));
    assert_eq!(model.parts[0].transform.transform_point3(Vec3::X), Vec3::new(4.0, 0.0, 5.0));
    // The matrix turns X to Y.
    assert_eq!(model.parts[1].transform.transform_point3(Vec3::X), Vec3::new(6.0, 2.0, 5.0));
}

#[test]
fn without_a_scene_every_node_that_is_no_child_is_drawn() {
    let model = load(&square("", r#""nodes":[{"children":[1]},{"mesh":0},{"mesh":0}]"#)).unwrap();
    assert_eq!(model.parts.len(), 2);
}

#[test]
fn strips_and_fans_become_triangles_with_the_same_winding() {
    let corners = [[-1.0f32, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0]];
    for (mode, order) in [(5, [0u16, 1, 2, 3]), (6, [0, 1, 3, 2])] {
        let mut glb = Glb::default();
        let positions = glb.vectors(&corners);
        let indices = glb.indices(&order);
        let members = format!(r#""attributes":{{"POSITION":{positions}}},"indices":{indices},"mode":{mode}"#);
        let model = load(&primitive(&glb, &members)).unwrap();
        let mesh = &model.parts[0].mesh;
        assert_eq!(mesh.triangles.len(), 2);
        // No normals in the file: flat ones, which show the winding.
        assert!(mesh.normals.iter().all(|&n| n == Vec3::Z), "mode {mode}");
    }
}

#[test]
fn quantised_and_sparse_numbers_are_decoded() {
    let mut glb = Glb::default();
    let bytes: Vec<u8> = SQUARE.iter().flatten().flat_map(|&x| [(x as i8 * 127) as u8]).collect();
    let view = glb.view(&bytes);
    let positions = glb.accessor(view, 5120, 4, "VEC3", r#","normalized":true"#);
    let bytes: Vec<u8> = SQUARE_UVS.iter().flatten().flat_map(|&x| (x as u16 * 65535).to_le_bytes()).collect();
    let view = glb.view(&bytes);
    let uvs = glb.accessor(view, 5123, 4, "VEC2", r#","normalized":true"#);
    let (index, value) = (glb.view(&[3]), glb.view(&[0u8, 0, 127]));
    let sparse = format!(
        r#","normalized":true,"sparse":{{"count":1,"indices":{{"bufferView":{index},"componentType":5121}},"values":{{"bufferView":{value}}}}}"#
    );
    let view = glb.view(&[0u8, 0, 127, 0, 0, 127, 0, 0, 127, 127, 0, 0]);
    let normals = glb.accessor(view, 5120, 4, "VEC3", &sparse);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let members =
        format!(r#""attributes":{{"POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs}}},"indices":{indices}"#);
    let file = glb.finish(&format!(
        r#""extensionsRequired":["KHR_mesh_quantization"],"meshes":[{{"primitives":[{{{members}}}]}}],{ONE_NODE}"#
    ));
    assert_eq!(*load(&file).unwrap().parts[0].mesh, Mesh::quad());
}

/// A square whose material has these members, and textures 0 and 1.
fn textured(material: &str) -> Vec<u8> {
    let mut glb = Glb::default();
    let positions = glb.vectors(&SQUARE);
    let uvs = glb.vectors(&SQUARE_UVS);
    let normals = glb.vectors(&[[0.0f32, 0.0, 1.0]; 4]);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let views = [glb.view(&png([255, 0, 0])), glb.view(&png([128, 128, 255]))];
    let images = views.map(|view| format!(r#"{{"bufferView":{view},"mimeType":"image/png"}}"#)).join(",");
    glb.finish(&format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs}}},
        "indices":{indices},"material":0}}]}}],"images":[{images}],"textures":[{{"source":0}},{{"source":1}}],
        "materials":[{{{material}}}],"extensionsUsed":["KHR_texture_transform"],{ONE_NODE}"#
    ))
}

/// The members of a material whose textures have these transforms, if any.
fn with_transforms(color: &str, normal: &str) -> Vec<u8> {
    let extension = |json: &str| match json {
        "" => String::new(),
        json => format!(r#","extensions":{{"KHR_texture_transform":{json}}}"#),
    };
    textured(&format!(
        r#""pbrMetallicRoughness":{{"baseColorTexture":{{"index":0{}}}}},"normalTexture":{{"index":1{}}}"#,
        extension(color),
        extension(normal)
    ))
}

#[test]
fn a_transform_that_all_textures_share_is_the_materials() {
    let json = r#"{"offset":[0.25,-1],"rotation":1.5707964,"scale":[2,-0.5]}"#;
    let model = load(&with_transforms(json, json)).unwrap();
    let expected = UvTransform { offset: Vec2::new(0.25, -1.0), rotate: 90.0, scale: Vec2::new(2.0, -0.5) };
    assert_eq!((model.materials[0].uv, &model.notes[..]), (expected, &[][..]));
    let model = load(&with_transforms("{}", "")).unwrap();
    assert_eq!((model.materials[0].uv, &model.notes[..]), (UvTransform::default(), &[][..]));
}

#[test]
fn transforms_that_cannot_be_drawn_are_noted_once() {
    let note = |color: &str, normal: &str| {
        let model = load(&with_transforms(color, normal)).unwrap();
        assert_eq!(model.notes.len(), 1, "{:?}", model.notes);
        (model.materials[0].uv.scale, model.notes[0].clone())
    };
    let (scale, text) = note(r#"{"scale":[2,2]}"#, "");
    assert_eq!(scale, Vec2::splat(2.0));
    assert!(text.contains("KHR_texture_transform") && text.contains("normal: drawn as base colour"), "{text}");
    for bad in
        [r#"{"scale":[0,1]}"#, r#"{"offset":[1]}"#, r#"{"rotation":"x"}"#, r#"{"scale":[1e30,1]}"#, r#"{"offset":3}"#]
    {
        let (scale, text) = note("", bad);
        assert_eq!(scale, Vec2::ONE);
        assert!(text.contains("normal texture is drawn unmoved"), "{bad}: {text}");
    }
    let (_, text) = note(r#"{"texCoord":1}"#, "");
    assert!(text.contains("second set of texture coordinates"), "{text}");
}

#[test]
fn a_material_seen_from_both_sides_says_so_to_the_one_that_replaces_it() {
    assert_eq!(load(&textured(r#""doubleSided":true"#)).unwrap().materials[0].two_sided, Some(true));
    assert_eq!(load(&textured(r#""doubleSided":false"#)).unwrap().materials[0].two_sided, None);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("leaf.glb"), textured(r#""doubleSided":true"#)).unwrap();
    let two_sided = |key: &str| {
        let text = format!("[materials.m]\n{key}\n[[objects]]\nmesh = \"leaf.glb\"\nmaterial = \"m\"\n");
        Scene::parse(&text, "leaf.toml", folder.path(), &LoadOptions::default()).unwrap().materials[0].is_two_sided()
    };
    assert_eq!(["", "two_sided = false", "two_sided = true"].map(two_sided), [true, false, true]);
}

#[test]
fn tangents_of_the_file_are_kept_and_missing_ones_are_generated_mirrored_or_not() {
    let build = |uvs: [[f32; 2]; 4], tangents: Option<[f32; 4]>| {
        let mut glb = Glb::default();
        let positions = glb.vectors(&SQUARE);
        let normals = glb.vectors(&[[0.0f32, 0.0, 1.0]; 4]);
        let uvs = glb.vectors(&uvs);
        let mut members = format!(r#""POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs}"#);
        if let Some(tangent) = tangents {
            members += &format!(r#","TANGENT":{}"#, glb.vectors(&[tangent; 4]));
        }
        let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
        let model = load(&primitive(&glb, &format!(r#""attributes":{{{members}}},"indices":{indices}"#))).unwrap();
        model.parts[0].mesh.tangents.clone()
    };
    assert!(build(SQUARE_UVS, Some([0.0, 2.0, 0.0, -1.0])).iter().all(|&t| t == Vec4::new(0.0, 1.0, 0.0, -1.0)));
    assert!(build(SQUARE_UVS, None).iter().all(|&t| t == Vec4::new(1.0, 0.0, 0.0, 1.0)));
    let mirrored = SQUARE_UVS.map(|[u, v]| [1.0 - u, v]);
    assert!(build(mirrored, None).iter().all(|&t| t == Vec4::new(-1.0, 0.0, 0.0, -1.0)));
    // Without a length they are repaired.
    assert!(build(SQUARE_UVS, Some([0.0; 4])).iter().all(|t| t.truncate().length() == 1.0 && t.w == 1.0));
}

#[test]
fn the_files_own_materials_come_with_embedded_and_external_images() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("my normal.png"), png([128, 128, 255])).unwrap();
    let mut glb = Glb::default();
    let positions = glb.vectors(&SQUARE);
    let uvs = glb.vectors(&SQUARE_UVS);
    let color = glb.view(&png([255, 0, 0]));
    let arm = glb.view(&png([0, 51, 255]));
    let rest = format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs}}},"mode":6,"material":1}}]}}],
        "materials":[{{"name":"unused"}},{{"name":"red","alphaMode":"BLEND","emissiveFactor":[1,0,0],
            "pbrMetallicRoughness":{{"baseColorFactor":[0.5,1,1,1],"metallicFactor":0.25,
                "baseColorTexture":{{"index":0}},"metallicRoughnessTexture":{{"index":1}}}},
            "occlusionTexture":{{"index":1,"strength":0.5}},"normalTexture":{{"index":2}}}}],
        "textures":[{{"source":0,"sampler":0}},{{"source":1}},{{"source":2}}],"samplers":[{{"wrapS":33071,"wrapT":33071}}],
        "images":[{{"bufferView":{color},"mimeType":"image/png"}},{{"bufferView":{arm},"mimeType":"image/png"}},
            {{"uri":"my%20normal.png"}}],{ONE_NODE}"#
    );
    let path = folder.path().join("wall.glb");
    std::fs::write(&path, glb.finish(&rest)).unwrap();
    let model = Model::load(&path, &Limits::default(), true).unwrap();
    let [material] = &model.materials[..] else { panic!("only the used material is read") };
    assert_eq!(model.parts[0].material, Some(0));
    assert_eq!((material.name.as_str(), material.relief.technique.name()), ("wall.glb:red", "normal"));
    assert_eq!((material.base_color, material.metallic, material.roughness), ([0.5, 1.0, 1.0], 0.25, 1.0));
    assert_eq!(material.wrap, Wrap::Clamp);
    let maps = &material.maps;
    assert_eq!(maps.base_color.as_ref().unwrap().grid.texels()[0], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(maps.roughness.as_ref().unwrap().grid().texels()[0], 0.2);
    assert_eq!(maps.metallic.as_ref().unwrap().grid().texels()[0], 1.0);
    assert_eq!(maps.ao.as_ref().unwrap().grid().texels()[0], 0.5);
    assert!(maps.normal.as_ref().unwrap().grid().texels()[0][2] == 1.0);
    assert!(model.notes.iter().any(|note| note.contains("transparency")));
    assert!(model.notes.iter().any(|note| note.contains("emissive")));

    // In a scene: the file's own material, unless the object names another.
    let text = "[materials.m]\n[[objects]]\nmesh = \"wall.glb\"\n[[objects]]\nmesh = \"wall.glb\"\nmaterial = \"m\"\nscale = 2\n";
    let scene = Scene::parse(text, "s.toml", folder.path(), &LoadOptions::default()).unwrap();
    let names: Vec<_> = scene.objects.iter().map(|object| scene.materials[object.material].name.as_str()).collect();
    assert_eq!(names, ["wall.glb:red", "m"]);
    assert!(Arc::ptr_eq(&scene.objects[0].mesh, &scene.objects[1].mesh));
    assert_eq!(scene.objects[1].transform.transform_point3(Vec3::X), Vec3::X * 2.0);

    // Not read when not asked for: then a broken image does not matter.
    std::fs::write(folder.path().join("my normal.png"), b"broken").unwrap();
    assert!(Model::load(&path, &Limits::default(), true).is_err());
    let model = Model::load(&path, &Limits::default(), false).unwrap();
    assert!(model.materials.is_empty() && model.parts[0].material.is_none());
}

#[test]
fn text_gltf_finds_its_buffer_in_a_file_beside_it_or_in_a_data_uri() {
    let folder = tempfile::tempdir().unwrap();
    let bin: Vec<u8> = SQUARE.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(folder.path().join("a b.bin"), &bin).unwrap();
    let path = folder.path().join("mesh.gltf");
    let load = |uri: &str| {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":48,"uri":"{uri}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":48}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":6}}]}}],{ONE_NODE}}}"#
        );
        std::fs::write(&path, json).unwrap();
        Model::load(&path, &Limits::default(), true).map_err(|error| error.to_string())
    };
    let from_file = load("a%20b.bin").unwrap();
    assert_eq!(from_file.parts[0].mesh.triangles.len(), 2);
    let base64 = base64::prelude::BASE64_STANDARD.encode(&bin);
    let inline = load(&format!("data:application/octet-stream;base64,{base64}")).unwrap();
    assert_eq!(inline.parts[0].mesh, from_file.parts[0].mesh);
    assert!(load("data:application/octet-stream;base64,!!!!").unwrap_err().contains("not valid base64"));
    assert!(load("https://example.org/a.bin").unwrap_err().contains("names a file by https:"));
    assert!(load("missing.bin").unwrap_err().contains("missing.bin: cannot read it"));
    std::fs::write(folder.path().join("short.bin"), &bin[..40]).unwrap();
    assert!(load("short.bin").unwrap_err().contains("should have 48 bytes but has 40"));
}

#[test]
fn broken_structures_are_refused() {
    let node = |node: &str| square("", &format!(r#""nodes":[{node}],"scenes":[{{"nodes":[0]}}]"#));
    let table: Vec<(&str, Vec<u8>, &str)> = vec![
        (
            "a cycle",
            square("", r#""nodes":[{"children":[1]},{"children":[0]}],"scenes":[{"nodes":[0]}]"#),
            "node 0 is reached twice",
        ),
        ("its own child", node(r#"{"children":[0]}"#), "node 0 is reached twice"),
        ("a missing node", node(r#"{"children":[9]}"#), "it names node 9, but has 1"),
        ("a missing mesh", node(r#"{"mesh":9}"#), "it names mesh 9, but has 1"),
        ("a missing scene", square("", r#""scenes":[],"scene":3"#), "it names scene 3, but has 0"),
        ("a missing material", square(r#","material":5"#, ONE_NODE), "it names material 5, but has 0"),
        ("no nodes", square("", r#""scenes":[{"nodes":[]}]"#), "there are no triangles in it"),
        ("an unknown primitive", square(r#","mode":9"#, ONE_NODE), "mesh 0, primitive 0: unknown kind of primitive"),
        (
            "compression",
            square("", &format!(r#""extensionsRequired":["KHR_draco_mesh_compression"],{ONE_NODE}"#)),
            "it needs the glTF extension KHR_draco_mesh_compression, which is not read",
        ),
        (
            "a texture without an image",
            square(
                r#","material":0"#,
                &format!(r#""textures":[{{}}],"materials":[{{"normalTexture":{{"index":0}}}}],{ONE_NODE}"#),
            ),
            "texture 0 has no PNG or JPEG image",
        ),
        ("no JSON", container(b"", b""), "its glTF JSON is broken"),
        ("garbage", b"hello".to_vec(), "its glTF JSON is broken"),
        ("nothing", Vec::new(), "the file is empty"),
        ("only a header", b"glTF\x02\0\0\0\x05\0\0\0".to_vec(), "the GLB file is cut short"),
        ("version 1", b"glTF\x01\0\0\0\x0c\0\0\0".to_vec(), "this is glTF version 1"),
        ("deep JSON", vec![b'['; 100_000], "its glTF JSON is broken"),
    ];
    for (name, bytes, expected) in table {
        let error = load(&bytes).expect_err(name);
        assert!(error.starts_with(expected), "{name}\n  expected: {expected}\n  found:    {error}");
    }
}

#[test]
fn an_infinite_place_is_refused() {
    let node = square("", r#""nodes":[{"mesh":0,"translation":[1e39,0,0]}],"scenes":[{"nodes":[0]}]"#);
    let error = load(&node).expect_err("1e39 is infinite in f32");
    // With serde_json's `float_roundtrip`, which other crates may ask for, the JSON reader refuses the number itself.
    let (ours, theirs) =
        ("node 0 has a place or turn that is not finite", "its glTF JSON is broken: number out of range");
    assert!(error.starts_with(ours) || error.starts_with(theirs), "{error}");
}

#[test]
fn broken_ranges_are_refused() {
    // (bytes of the view, component, count, type, further members, expected)
    let float = |n: usize| vec![0u8; 4 * n];
    type Case = (Vec<u8>, u32, usize, &'static str, &'static str, &'static str);
    let table: Vec<Case> = vec![
        (float(12), 5126, 5, "VEC3", "", "mesh 0, primitive 0, positions: 5 elements reach beyond their buffer"),
        (
            float(12),
            5126,
            usize::MAX,
            "VEC3",
            "",
            "mesh 0, primitive 0, positions: 18446744073709551615 elements reach beyond",
        ),
        (float(12), 5126, 4, "VEC3", r#","byteOffset":4"#, "mesh 0, primitive 0, positions: 4 elements reach beyond"),
        (
            float(12),
            5126,
            4,
            "VEC3",
            r#","byteOffset":18446744073709551615"#,
            "mesh 0, primitive 0, positions: 4 elements reach beyond",
        ),
        (float(12), 5126, 4, "VEC2", "", "mesh 0, primitive 0, positions: expected Vec3"),
        (float(12), 5555, 4, "VEC3", "", "mesh 0, primitive 0, positions: numbers of an unknown type"),
        (float(12), 5126, 4, "VEC9", "", "mesh 0, primitive 0, positions: expected Vec3"),
        (
            [f32::NAN; 12].map(f32::to_le_bytes).concat(),
            5126,
            4,
            "VEC3",
            "",
            "mesh 0, primitive 0: a position is not a finite number",
        ),
        (
            [f32::INFINITY; 12].map(f32::to_le_bytes).concat(),
            5126,
            4,
            "VEC3",
            "",
            "mesh 0, primitive 0: a position is not a finite number",
        ),
        (float(12), 5126, 4, "VEC3", "", "there are no triangles in it"),
        (float(12), 5126, 0, "VEC3", "", "mesh 0, primitive 0: it names vertex 0, but has 0"),
        (float(6), 5126, 2, "VEC3", "", "mesh 0, primitive 0: it names vertex 2, but has 2"),
    ];
    for (bytes, component, count, kind, more, expected) in table {
        let mut glb = Glb::default();
        let view = glb.view(&bytes);
        let positions = glb.accessor(view, component, count, kind, more);
        let indices = glb.indices(&[0, 1, 2]);
        let file = primitive(&glb, &format!(r#""attributes":{{"POSITION":{positions}}},"indices":{indices}"#));
        let error = load(&file).unwrap_err();
        assert!(error.starts_with(expected), "\n  expected: {expected}\n  found:    {error}");
    }
}

#[test]
fn an_accessor_without_bytes_cannot_ask_for_much_memory() {
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"accessors":[{{"componentType":5126,"count":1000000000000,"type":"VEC3"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],{ONE_NODE}}}"#
    );
    let error = load(&container(json.as_bytes(), b"")).unwrap_err();
    assert!(error.contains("1000000000000 elements without any bytes"), "{error}");
}

#[test]
fn lists_of_different_lengths_are_refused() {
    let mut glb = Glb::default();
    let positions = glb.vectors(&SQUARE);
    let uvs = glb.vectors(&SQUARE_UVS[..3]);
    let normals = glb.vectors(&[[0.0f32, 0.0, 1.0]; 4]);
    for normals in [format!(r#","NORMAL":{normals}"#), String::new()] {
        let members = format!(r#""attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs}{normals}}},"mode":6"#);
        let error = load(&primitive(&glb, &members)).unwrap_err();
        assert!(error.contains("4 positions but 3 uvs"), "{error}");
    }
}

#[test]
fn points_and_lines_are_left_out_with_a_note() {
    let mut glb = Glb::default();
    let positions = glb.vectors(&SQUARE);
    let file = glb.finish(&format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"mode":0}},
        {{"attributes":{{"POSITION":{positions}}},"mode":6}},{{"attributes":{{"POSITION":{positions}}},"mode":3}}]}}],{ONE_NODE}"#
    ));
    let model = load(&file).unwrap();
    assert_eq!(model.parts.len(), 1);
    assert!(model.parts[0].mesh.uvs.iter().all(|&uv| uv == Vec2::ZERO) && !model.parts[0].has_uvs);
    assert_eq!(model.notes.iter().filter(|note| note.contains("points and lines are left out")).count(), 1);
}

#[test]
fn a_node_scaled_to_nothing_is_left_out_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let rest = r#""nodes":[{"mesh":0,"scale":[1,0,1]},{"mesh":0}],"scenes":[{"nodes":[0,1]}]"#;
    std::fs::write(folder.path().join("a.glb"), square("", rest)).unwrap();
    let scene =
        Scene::parse("[[objects]]\nmesh = \"a.glb\"\n", "s.toml", folder.path(), &LoadOptions::default()).unwrap();
    assert_eq!(scene.objects.len(), 1);
    assert!(scene.notes.iter().any(|note| note.contains("scaled to nothing")), "{:?}", scene.notes);
}
