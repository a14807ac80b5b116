//! Pictures for the eye: `cargo test -p relievo-cpu gallery -- --ignored` leaves them in the target folder.

use std::path::PathBuf;

use relievo_cpu::Frame;

use crate::common::*;

/// Writes a picture beside the build and says where.
pub(crate) fn save(frame: &Frame, name: &str) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("gallery");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.png"));
    relievo_map::write_png8(&path, &frame.pixels.map(|c| c.map(|x| f32::from(x) / 255.0))).unwrap();
    println!("{}", path.display());
}

#[test]
#[ignore = "for the eye"]
fn meshes_walls_and_neighbours() {
    use glam::{Affine3A, Vec2, Vec3};
    use relievo_scene::HeightRange;
    let brick = |size: u32| {
        let mut material = relief(hills(4, 4), 0.03);
        material.maps = relievo_make::make("brick-wall", size).unwrap();
        material.height = HeightRange::Scale(relievo_make::height_scale("brick-wall").unwrap());
        material
    };
    for (mesh, repeat, eye) in [
        ("torus", [4.0, 2.0], Vec3::new(0.0, 1.6, 2.8)),
        ("ball", [4.0, 2.0], Vec3::new(0.8, 0.9, 2.6)),
        ("cylinder", [4.0, 1.0], Vec3::new(0.8, 1.8, 3.2)),
        ("cube", [1.0, 1.0], Vec3::new(2.2, 1.8, 3.2)),
    ] {
        let mut scene = stage(480, 360, eye);
        scene.lights.push(point_light(2.5, 2.5, 2.5));
        add(&mut scene, shape(if mesh == "ball" { "sphere" } else { mesh }), brick(512), Affine3A::IDENTITY);
        scene.objects[0].uv_repeat = Vec2::from(repeat);
        save(&draw(&scene), &format!("{mesh}-exact"));
        let truth = displaced(&scene, if mesh == "cylinder" { 100 } else { 800 });
        save(&draw(&truth), &format!("{mesh}-displaced"));
    }
    let mut scene = stage(480, 360, Vec3::new(1.6, 0.1, 0.25));
    scene.camera.target = Vec3::new(0.0, 0.0, 0.0);
    scene.lights.push(point_light(-0.5, 1.0, 0.8));
    add(&mut scene, shape("quad"), brick(512), transform(Vec3::splat(2.0), Vec3::ZERO, Vec3::ZERO));
    scene.objects[0].uv_repeat = Vec2::splat(2.0);
    save(&draw(&scene), "grazing-exact");
    save(&draw(&displaced(&scene, 1025)), "grazing-displaced");
    scene.camera.position = Vec3::new(0.8, -0.4, 1.8);
    add(
        &mut scene,
        shape("sphere"),
        plain([0.8, 0.3, 0.2]),
        transform(Vec3::splat(0.3), Vec3::ZERO, Vec3::new(0.2, 0.2, 0.1)),
    );
    add(&mut scene, shape("plane"), plain([0.6; 3]), moved(0.0, -0.6, 0.8));
    scene.lights[0].radius = 0.1;
    save(&draw(&scene), "sphere-exact");
    save(&draw(&displaced(&scene, 1025)), "sphere-displaced");
}
