#![allow(clippy::all, clippy::pedantic)]
use relievo_cpu::*;
use relievo_scene::*;
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let path = &args[1];
    let grid: u32 = args[2].parse().unwrap();
    let sets: Vec<Override> = args[3..].iter().filter(|a| a.contains('=')).map(|a| a.parse().unwrap()).collect();
    let options = LoadOptions { overrides: sets, ..Default::default() };
    let scene = Scene::load(std::path::Path::new(path), &options).unwrap();
    let run = |edge: Edge, technique: SurfaceTechnique, grid: u32| {
        let mut scene = scene.clone();
        for m in &mut scene.materials { m.relief.edge = edge; m.relief.technique = technique; m.relief.grid = grid; }
        let r = Renderer::new(&scene).unwrap();
        let start = Instant::now();
        let f = r.render(&RenderOptions::default()).unwrap();
        let t = start.elapsed().as_secs_f64();
        (f, t)
    };
    let exact = SurfaceTechnique::from_name("exact").unwrap();
    if args.iter().any(|a| a=="perf") { for _ in 0..20 { run(Edge::Silhouette, exact, 10); } return; }
    let (truth, tt) = run(Edge::Wrap, SurfaceTechnique::Displacement, grid);
    let size = scene.materials[0].maps.height.as_ref().unwrap().grid().width() as f32;
    println!("map {size}, truth {tt:.2}s");
    for (name, edge) in [("plane", Edge::Wrap), ("shell", Edge::Silhouette)] {
        let (f, t) = run(edge, exact, grid);
        let n = f.aovs.depth.texels().len();
        let (mut both, mut tm, mut fm, mut uvoff, mut mask) = (0, 0, 0, 0, 0);
        let mut ts = vec![]; let mut over = [0;3];
        for i in 0..n {
            let (a, b) = (f.aovs.depth.texels()[i], truth.aovs.depth.texels()[i]);
            let (ha, hb) = (a.is_finite(), b.is_finite());
            tm += hb as u32; fm += ha as u32;
            if ha != hb { mask += 1; }
            if ha && hb {
                both += 1;
                let (ua, ub) = (f.aovs.uv.texels()[i], truth.aovs.uv.texels()[i]);
                let d = ((ua[0]-ub[0])*size).hypot((ua[1]-ub[1])*size);
                if d > 1.0 { uvoff += 1; if d > 2.0 {over[0]+=1} if d > 4.0 {over[1]+=1} if d>16.0 {over[2]+=1} }
                ts.push((a - b).abs());
            }
        }
        ts.sort_by(f32::total_cmp);

        println!("{over:?} {name}: {t:.2}s hits {fm} truth {tm} mask differs {mask}; uv over a texel {:.3}% ; |dt| p50 {} p99 {}", 100.0*uvoff as f64/both as f64, ts[ts.len()/2], ts[ts.len()*99/100]);
    }
}
