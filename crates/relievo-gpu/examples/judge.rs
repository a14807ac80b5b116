#![allow(clippy::all, clippy::pedantic, missing_docs)]
use relievo_gpu::*;
use relievo_scene::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let sets: Vec<Override> = args[2..].iter().filter(|a| a.contains('=')).map(|a| a.parse().unwrap()).collect();
    let options = LoadOptions { overrides: sets, ..Default::default() };
    let scene = Scene::load(std::path::Path::new(&args[1]), &options).unwrap();
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let Gpu { device, queue, .. } = pollster::block_on(Gpu::open(&instance, &AdapterChoice::default())).unwrap();
    for (name, edge) in [("plane", Edge::Wrap), ("shell", Edge::Silhouette)] {
        let mut scene = scene.clone();
        for m in &mut scene.materials { m.relief.edge = edge; m.relief.grid=1200; if args[2..].iter().any(|a| a=="disp") { m.relief.technique = SurfaceTechnique::Displacement }}
        let cpu = relievo_cpu::Renderer::new(&scene).unwrap().render(&relievo_cpu::RenderOptions::default()).unwrap().aovs;
        let size = scene.materials[0].maps.height.as_ref().unwrap().grid().width() as f32;
        for m in &mut scene.materials { m.relief.technique = SurfaceTechnique::default(); }
        let mut r = Renderer::new(&device, &queue, &scene, wgpu::TextureFormat::Rgba8Unorm, &RendererOptions::default()).unwrap();
        let px = [scene.image.width, scene.image.height];
        let g = r.measure(px).unwrap();
        let o = Offscreen::new(&device, &queue, px, wgpu::TextureFormat::Rgba8Unorm).unwrap(); let mut t = f64::INFINITY;
        for _ in 0..8 { let s = std::time::Instant::now(); o.draw(&mut r).unwrap(); o.pixels().unwrap(); t = t.min(s.elapsed().as_secs_f64()); }
        let (mut mask, mut over, mut both, mut sh) = (0, 0, 0, 0);
        for i in 0..cpu.depth.texels().len() {
            let (a, b) = (cpu.depth.texels()[i], g.depth.texels()[i]);
            if a.is_finite() != b.is_finite() { mask += 1; continue; }
            if !a.is_finite() { continue; }
            both += 1;
            let (ua, ub) = (cpu.uv.texels()[i], g.uv.texels()[i]);
            let d = ((ua[0]-ub[0])*size).hypot((ua[1]-ub[1])*size);
            if d > 1.0 { over += 1; }
            if (cpu.shadow.texels()[i]-g.shadow.texels()[i]).abs()>0.5 { sh += 1; }
        }
        println!("{name}: frame {:.1} ms; both {both} mask {mask} over a texel {over} shadow differs {sh}", t*1e3);
    }
}
