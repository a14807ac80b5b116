#![allow(clippy::all, clippy::pedantic, missing_docs)]
use relievo_cpu::*;
use relievo_scene::*;
fn load(a: &str) -> Scene {
    let mut parts = a.split('@');
    let path = parts.next().unwrap();
    let options = LoadOptions { overrides: parts.map(|p| p.parse().unwrap()).collect(), ..Default::default() };
    Scene::load(std::path::Path::new(path), &options).unwrap()
}
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mut first: Option<Frame> = None;
    for a in &args {
        let scene = load(a);
        let size = scene.materials[0].maps.height.as_ref().map_or(1.0, |h| h.grid().width() as f32);
        let f = Renderer::new(&scene).unwrap().render(&RenderOptions::default()).unwrap();
        let hits = f.aovs.hit.texels().iter().filter(|h| **h > 0.5).count();
        let mut text = String::new();
        if let Some(g) = &first {
            let (mut over, mut mask, mut n) = (0, 0, 0);
            for i in 0..f.aovs.hit.texels().len() {
                if (f.aovs.hit.texels()[i] > 0.5) != (g.aovs.hit.texels()[i] > 0.5) { mask += 1; continue; }
                if f.aovs.hit.texels()[i] < 0.5 { continue; }
                n += 1;
                let (ua, ub) = (f.aovs.uv.texels()[i], g.aovs.uv.texels()[i]);
                let d = |k: usize| { let d = ua[k]-ub[k]; (d - d.round()) * size };
                if d(0).hypot(d(1)) > 1.0 { over += 1; }
            }
            let sh = f.aovs.shadow.texels().iter().zip(g.aovs.shadow.texels()).filter(|(a, b)| (*a - *b).abs() > 0.5).count();
            text = format!("against the first: mask {mask}, over a texel (mod 1) {:.3}% shadow {sh}", 100.0 * over as f64 / n as f64);
        }
        println!("{hits} {text} {a}");
        for n in &scene.notes { println!("  note {n}"); }
        first.get_or_insert(f);
    }
}
