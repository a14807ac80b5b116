//! Written maps are read back, the same map gives the same bytes, and an error leaves the old file.

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use relievo_map::{
    BitDepth, Channel, ColorEncoding, ColorMap, FileTexel, Grid, HeightMap, Limits, NormalMap, NormalY, ScalarMap,
    White, decode_color, encode_png, read_color, read_height, read_normal, read_scalar, write_color, write_exr,
    write_height, write_normal, write_png8, write_png16, write_scalar,
};

fn limits() -> Limits {
    Limits::default()
}

#[test]
fn heights_survive_png_to_16_bits_and_exr_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let map = HeightMap::new(Grid::from_fn(31, 17, |x, y| ((x * 37 + y * 101) % 1000) as f32 / 999.0));
    let (png, exr) = (folder.path().join("h.png"), folder.path().join("h.EXR"));
    write_height(&png, &map).unwrap();
    write_height(&exr, &map).unwrap();
    let read = read_height(&png, White::High, &limits()).unwrap();
    for (a, b) in read.map.grid().texels().iter().zip(map.grid().texels()) {
        assert!((a - b).abs() <= 0.5 / 65535.0 + 1e-7);
    }
    assert_eq!(read.notes, [""; 0]);
    assert_eq!(read_height(&exr, White::High, &limits()).unwrap().map, map);
}

#[test]
fn one_three_and_four_channels_are_written_as_such() {
    fn check<T: FileTexel + std::fmt::Debug>(folder: &Path, grid: &Grid<T>) {
        let path = folder.join("c");
        let texels = |path: &Path| read_color(path, &limits()).unwrap().map.grid.into_texels();
        let expect: Vec<[f32; 4]> = (grid.texels().iter())
            .map(|t| match t.channels() {
                &[v] => [v, v, v, 1.0],
                &[r, g, b] => [r, g, b, 1.0],
                other => [other[0], other[1], other[2], other[3]],
            })
            .collect();
        write_exr(&path, grid).unwrap();
        assert_eq!(texels(&path), expect);
        for (write, step) in [(write_png8 as fn(&Path, &Grid<T>) -> _, 255.0), (write_png16, 65535.0f32)] {
            write(&path, grid).unwrap();
            for (got, want) in texels(&path).iter().flatten().zip(expect.iter().flatten()) {
                assert!((got - want.clamp(0.0, 1.0)).abs() <= 0.5 / step + 1e-7, "{got} {want}");
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let value = |x: u32, y: u32, c: u32| (x * 5 + y * 3 + c * 7) as f32 / 60.0 - 0.1;
    check(folder.path(), &Grid::from_fn(7, 5, |x, y| value(x, y, 0)));
    check(folder.path(), &Grid::from_fn(7, 5, |x, y| [0, 1, 2].map(|c| value(x, y, c))));
    check(folder.path(), &Grid::from_fn(7, 5, |x, y| [0, 1, 2, 3].map(|c| value(x, y, c))));
}

#[test]
fn normals_keep_their_bytes_through_any_number_of_round_trips() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("n.png");
    let map = NormalMap::new(Grid::from_fn(16, 16, |x, y| {
        let (u, v) = ((x as f32 - 8.0) / 12.0, (y as f32 - 8.0) / 12.0);
        [u, v, (1.0 - u * u - v * v).max(0.0).sqrt()].map(|n| NormalMap::decode8(NormalMap::encode8(n)))
    }));
    for (y, bits) in
        [(NormalY::Up, BitDepth::Eight), (NormalY::Down, BitDepth::Eight), (NormalY::Down, BitDepth::Sixteen)]
    {
        write_normal(&path, &map, y, bits).unwrap();
        let first = fs::read(&path).unwrap();
        let read = read_normal(&path, y, &limits()).unwrap().map;
        write_normal(&path, &read, y, bits).unwrap();
        assert_eq!(fs::read(&path).unwrap(), first, "{y:?} {bits:?}");
        if bits == BitDepth::Eight && y == NormalY::Up {
            assert_eq!(read, map);
        }
    }
    let exr = folder.path().join("n.exr");
    write_normal(&exr, &map, NormalY::Down, BitDepth::Eight).unwrap();
    for (a, b) in
        read_normal(&exr, NormalY::Down, &limits()).unwrap().map.grid().texels().iter().zip(map.grid().texels())
    {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-6), "{a:?} {b:?}");
    }
}

#[test]
fn the_neutral_normal_is_written_as_128_128_255_and_stays_so_through_100_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("n.png");
    let mut map = NormalMap::new(Grid::from_fn(2, 2, |_, _| [0.0, 0.0, 1.0]));
    for round in 0..100 {
        write_normal(&path, &map, NormalY::Up, BitDepth::Eight).unwrap();
        let read = read_color(&path, &limits()).unwrap().map;
        let stored = read.grid.get(0, 0).map(|c| (c * 255.0).round());
        assert_eq!(stored, [128.0, 128.0, 255.0, 255.0], "round {round}");
        map = read_normal(&path, NormalY::Up, &limits()).unwrap().map;
    }
}

#[test]
fn colours_are_srgb_in_png_and_light_in_exr_and_opaque_ones_have_no_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let (png, exr) = (folder.path().join("c.png"), folder.path().join("c.exr"));
    let map = |alpha| ColorMap {
        grid: Grid::from_fn(3, 3, |x, y| [x as f32 / 2.0, y as f32 / 2.0, 1.0, alpha]),
        encoding: ColorEncoding::Srgb,
    };
    write_color(&exr, &map(1.0)).unwrap();
    let read = read_color(&exr, &limits()).unwrap().map;
    assert_eq!((read.encoding, &read.grid), (ColorEncoding::Linear, &map(1.0).to_linear()));
    write_color(&png, &read).unwrap();
    assert_eq!(read_color(&png, &limits()).unwrap().map.grid.get(1, 1)[0], 128.0 / 255.0);
    assert!(read_scalar(&png, Channel::Alpha, &limits()).is_err());
    write_color(&png, &map(0.5)).unwrap();
    assert_eq!(*read_scalar(&png, Channel::Alpha, &limits()).unwrap().map.grid().get(0, 0), 128.0 / 255.0);
}

#[test]
fn the_same_map_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    // Large enough for several blocks, which threads compress.
    let grid = Grid::from_fn(500, 400, |x, y| ((x * y) as f32).sin());
    let (a, b) = (folder.path().join("a.exr"), folder.path().join("b.exr"));
    write_exr(&a, &grid).unwrap();
    let first = fs::read(&a).unwrap();
    for _ in 0..5 {
        write_exr(&b, &grid).unwrap();
        assert!(fs::read(&b).unwrap() == first);
    }
    assert!(encode_png(&grid, BitDepth::Sixteen).unwrap() == encode_png(&grid, BitDepth::Sixteen).unwrap());
}

#[test]
fn png_bytes_in_memory_are_a_whole_file() {
    let grid = Grid::from_fn(4, 3, |x, y| [x as f32 / 3.0, y as f32 / 2.0, 0.0]);
    let read = decode_color("memory", &encode_png(&grid, BitDepth::Sixteen).unwrap(), &limits()).unwrap().map;
    assert!((read.grid.get(1, 1)[0] - 1.0 / 3.0).abs() < 1e-5);
}

#[test]
fn an_unknown_ending_is_refused_and_a_missing_folder_explained() {
    let folder = tempfile::tempdir().unwrap();
    let map = ScalarMap::new(Grid::from_fn(2, 2, |_, _| 0.5));
    for name in ["a.jpg", "a", "png"] {
        let message = write_scalar(&folder.path().join(name), &map).unwrap_err().to_string();
        assert!(message.contains(name) && message.contains(".png or .exr"), "{message}");
    }
    assert!(write_scalar(&folder.path().join("none/a.png"), &map).is_err());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

proptest! {
    #[test]
    fn any_size_survives_a_round_trip(width in 1u32..70, height in 1u32..40, seed in any::<u32>()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("any.exr");
        let grid = Grid::from_fn(width, height, |x, y| f32::from((x.wrapping_mul(seed) ^ y) as u16) / 65535.0);
        let map = HeightMap::new(grid);
        write_height(&path, &map).unwrap();
        prop_assert_eq!(&read_height(&path, White::High, &limits()).unwrap().map, &map);
        let path = folder.path().join("any.png");
        write_height(&path, &map).unwrap();
        prop_assert_eq!(&read_height(&path, White::High, &limits()).unwrap().map, &map);
    }
}
