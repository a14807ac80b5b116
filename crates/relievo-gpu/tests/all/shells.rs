//! Reliefs in shells: the GPU sees what the CPU sees, and columns and walls of nearest maps are the same.

use relievo_scene::{Aovs, Scene};

use crate::common::device::gpu;
use crate::common::scene::{measured, on_cpu, parse};

const SCENE: &str = r#"
    [image]
    width = 160
    height = 120
    [camera]
    position = [2.2, 1.7, 3.2]
    target = [0.0, 0.0, 0.0]
    vertical_fov = 50
    [[lights]]
    kind = "directional"
    direction = [-0.5, -0.8, -0.6]
    [materials.m]
    from = "make:cobbles"
    depth = 0.12
    midlevel = 0.4
    [materials.m.relief]
    edge = "silhouette"
    [[objects]]
    mesh = "torus"
    material = "m"
    uv_repeat = [4, 2]
"#;

fn scene(changes: &[&str]) -> Scene {
    parse(SCENE, changes, 64)
}

/// Pixels of the first, and those where one alone sees something or where hits are over a tenth of a texel apart, of the map or
/// of the mip level that is `coarser` times coarser.
fn differing(a: &Aovs, b: &Aovs, coarser: f32) -> (usize, usize) {
    let (mut seen, mut differ) = (0, 0);
    for (i, (&da, &db)) in a.depth.texels().iter().zip(b.depth.texels()).enumerate() {
        seen += usize::from(da.is_finite());
        let apart = |k: usize| (a.uv.texels()[i][k] - b.uv.texels()[i][k]).abs() * 64.0;
        let both = da.is_finite() && db.is_finite();
        if std::env::var("DUMP").is_ok()
            && (da.is_finite() != db.is_finite() || (both && apart(0).hypot(apart(1)) > 0.1 * coarser))
        {
            eprintln!(
                "{},{}: {da} {db} {:?} {:?} fetches {} {}",
                i % 160,
                i / 160,
                a.uv.texels()[i],
                b.uv.texels()[i],
                a.fetches.texels()[i],
                b.fetches.texels()[i]
            );
        }
        differ += usize::from(da.is_finite() != db.is_finite() || (both && apart(0).hypot(apart(1)) > 0.1 * coarser));
    }
    (seen, differ)
}

#[test]
fn shells_show_on_the_gpu_what_they_show_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let cube = ["objects.0.mesh=brick-cube.obj", "objects.0.uv_repeat=1"];
    let inside = ["camera.position=[0.0, 0.05, 1.55]", "camera.target=[0.3, 0.0, 0.0]"];
    let variants: [(&str, Vec<&str>); 6] = [
        ("torus", vec![]),
        ("cube with shared normals", cube.to_vec()),
        ("cube with shared directions", vec!["objects.0.mesh=cube", "materials.m.relief.offset=shared"]),
        ("eye close to the relief", inside.to_vec()),
        ("level of detail", vec!["materials.m.relief.lod=true", "objects.0.uv_repeat=[9, 5]"]),
        (
            "both sides, clipped",
            vec!["materials.m.two_sided=true", "materials.m.relief.edge=clip", "objects.0.mesh=sphere"],
        ),
    ];
    for (name, changes) in variants {
        let scene = scene(&changes);
        // A pixel here spans 8 texels and more; near the borders of levels and of triangles seen edge-on they are chosen by
        // a hair.
        let (coarser, share) = if name == "level of detail" { (8.0, 20) } else { (1.0, 200) };
        let (seen, differ) = differing(&on_cpu(&scene).aovs, &measured(gpu, &scene), coarser);
        println!("{name}: {differ} of {seen} pixels differ");
        assert!(seen > 2000 && differ * share <= seen, "{name}: {differ} of {seen}");
    }
    // Negative control: marched in the planes of the polygons the cube shows something else.
    let plane = [&cube[..], &["materials.m.relief.edge=wrap"]].concat();
    let (seen, differ) = differing(&on_cpu(&scene(&cube)).aovs, &measured(gpu, &scene(&plane)), 1.0);
    assert!(differ * 20 > seen, "{differ} of {seen}");
}

#[test]
fn columns_of_nearest_maps_are_the_same() {
    let Some(gpu) = gpu() else { return };
    let quad = ["objects.0.mesh=quad", "materials.m.filter=nearest", "materials.m.relief.edge=wrap"];
    for wrap in ["repeat", "clamp", "mirror"] {
        let wrap = format!("materials.m.wrap={wrap}");
        let scene = scene(&[&quad[..], &[&wrap]].concat());
        let (cpu, gpu_sees) = (on_cpu(&scene).aovs, measured(gpu, &scene));
        let (seen, differ) = differing(&cpu, &gpu_sees, 1.0);
        println!("{wrap}: {differ} of {seen} pixels differ");
        assert!(seen > 2000 && differ * 200 <= seen, "{wrap}: {differ} of {seen}");
    }
    let linear = ["objects.0.mesh=quad", "materials.m.relief.edge=wrap"];
    let (seen, differ) = differing(&on_cpu(&scene(&quad)).aovs, &measured(gpu, &scene(&linear)), 1.0);
    assert!(differ * 20 > seen, "{differ} of {seen}");
}
