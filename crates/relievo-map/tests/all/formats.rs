//! Every format and bit depth gives the values that are in the file.

use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use relievo_map::{
    Channel, ColorEncoding, HeightMap, Limits, Loaded, MapError, NormalMap, NormalY, White, decode_color,
    decode_height, decode_normal, decode_scalar,
};
use tiff::encoder::colortype as tiff_color;

use crate::common::{every_format, exr_file, file, gradient, grey, ramp, raw_png, tiff_file};

fn height(bytes: &[u8]) -> Loaded<HeightMap> {
    decode_height("test", bytes, White::High, &Limits::default()).unwrap()
}

fn says<T>(loaded: &Loaded<T>, words: &str) -> bool {
    loaded.notes.iter().any(|note| note.contains(words))
}

#[test]
fn every_format_keeps_its_picture() {
    let expected = gradient(19, 13).to_rgb8();
    for (extension, bytes) in every_format() {
        let name = format!("test.{extension}");
        let loaded = decode_color(&name, &bytes, &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
        let grid = &loaded.map.grid;
        let float = ["float.tif", "hdr", "exr", "grey.exr"].contains(&extension);
        assert_eq!(loaded.map.encoding, if float { ColorEncoding::Linear } else { ColorEncoding::Srgb }, "{name}");
        if ["float.tif", "grey.exr"].contains(&extension) {
            assert_eq!((grid.width(), grid.height()), (8, 6));
            assert_eq!(grid.get(7, 5)[0], 1.0);
            continue;
        }
        assert_eq!((grid.width(), grid.height()), (19, 13), "{name}");
        // What the encoder loses; inks are another picture altogether, of which the corners are asked for.
        let tolerance = match extension {
            "jpg" | "progressive.jpg" | "lossy.webp" => 0.25,
            "hdr" => 0.01,
            "cmyk.jpg" => 0.3,
            _ => 0.5 / 255.0,
        };
        if ["grey.jpg", "grey16.png"].contains(&extension) {
            assert!(grid.texels().iter().all(|[r, g, b, _]| r == g && g == b));
            continue;
        }
        let mean = grid
            .texels()
            .iter()
            .zip(expected.pixels())
            .map(|(got, want)| (0..3).map(|c| (got[c] - f32::from(want.0[c]) / 255.0).abs()).sum::<f32>() / 3.0)
            .sum::<f32>()
            / (19.0 * 13.0);
        assert!(mean <= tolerance, "{name}: {mean}");
    }
}

#[test]
fn grey_pngs_of_1_2_4_and_8_bits_give_their_share_of_the_maximum() {
    // Two rows of eight texels, each row led by its filter byte.
    let cases: [(u8, &[u8], &[u32]); 3] = [
        (1, &[0, 0b1010_0000, 0, 0b0000_0001], &[1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]),
        (2, &[0, 0b0001_1011, 0xff, 0, 0, 0b1110_0000], &[0, 1, 2, 3, 3, 3, 3, 3, 0, 0, 0, 0, 3, 2, 0, 0]),
        (
            4,
            &[0, 0x01, 0x23, 0x45, 0x67, 0, 0x89, 0xab, 0xcd, 0xef],
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
        ),
    ];
    for (bits, rows, values) in cases {
        let loaded = height(&raw_png(8, 2, bits, 0, false, &[], rows));
        let steps = (1u32 << bits) - 1;
        for (got, want) in loaded.map.grid().texels().iter().zip(values) {
            assert_eq!(*got, (want * (255 / steps)) as f32 / 255.0, "{bits} bits");
        }
        assert!(says(&loaded, &format!("{bits} bits, so {} steps", steps + 1)), "{:?}", loaded.notes);
    }
    let loaded = height(&file(&grey(5, 4), ImageFormat::Png));
    assert!(says(&loaded, "256 steps"), "{:?}", loaded.notes);
}

#[test]
fn sixteen_bit_heights_keep_every_step_and_need_no_note() {
    let image = ImageBuffer::from_fn(256, 256, |x, y| Luma([(y * 256 + x) as u16]));
    let image = DynamicImage::ImageLuma16(image);
    for format in [ImageFormat::Png, ImageFormat::Tiff] {
        let loaded = height(&file(&image, format));
        for (i, h) in loaded.map.grid().texels().iter().enumerate() {
            assert_eq!(*h, i as f32 / 65535.0);
        }
        assert_eq!(loaded.notes, [""; 0], "{format:?}");
    }
}

#[test]
fn white_is_deep_turns_heights_over() {
    let bytes = file(&grey(9, 7), ImageFormat::Png);
    let up = height(&bytes).map;
    let down = decode_height("test", &bytes, White::Deep, &Limits::default()).unwrap().map;
    for (a, b) in up.grid().texels().iter().zip(down.grid().texels()) {
        assert_eq!(1.0 - a, *b);
    }
}

#[test]
fn palettes_give_their_colours_and_transparency() {
    let palette = [255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30];
    let rows = [0, 0b0001_1011];
    let bytes = raw_png(4, 1, 2, 3, false, &[(b"PLTE", &palette), (b"tRNS", &[255, 51])], &rows);
    let loaded = decode_color("test", &bytes, &Limits::default()).unwrap();
    let expect = [[255, 0, 0, 255], [0, 255, 0, 51], [0, 0, 255, 255], [10, 20, 30, 255]];
    for (got, want) in loaded.map.grid.texels().iter().zip(expect) {
        assert_eq!(got.map(|c| (c * 255.0).round() as u8), want);
    }
}

#[test]
fn interlaced_pngs_are_put_together() {
    // Adam7: x start, y start, x step, y step.
    let passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)];
    let (width, height_px) = (11usize, 9usize);
    let mut rows = Vec::new();
    for (x0, y0, dx, dy) in passes {
        for y in (y0..height_px).step_by(dy) {
            let row: Vec<u8> = (x0..width).step_by(dx).map(|x| (y * width + x) as u8).collect();
            if !row.is_empty() {
                rows.push(0);
                rows.extend(row);
            }
        }
    }
    let loaded = height(&raw_png(11, 9, 8, 0, true, &[], &rows));
    for (i, h) in loaded.map.grid().texels().iter().enumerate() {
        assert_eq!(*h, i as f32 / 255.0);
    }
}

#[test]
fn alpha_reaches_colours_and_is_ignored_aloud_in_heights() {
    let image = DynamicImage::ImageLumaA16(ImageBuffer::from_fn(3, 2, |x, _| image::LumaA([x as u16 * 100, 32768])));
    let bytes = file(&image, ImageFormat::Png);
    assert_eq!(decode_color("t", &bytes, &Limits::default()).unwrap().map.grid.get(1, 0)[3], 32768.0 / 65535.0);
    let loaded = height(&bytes);
    assert_eq!(*loaded.map.grid().get(2, 1), 200.0 / 65535.0);
    assert!(says(&loaded, "alpha"), "{:?}", loaded.notes);
    let alpha = decode_scalar("t", &bytes, Channel::Alpha, &Limits::default()).unwrap();
    assert_eq!(*alpha.map.grid().get(0, 0), 32768.0 / 65535.0);
}

#[test]
fn a_coloured_height_map_gives_luminance_and_says_so_but_grey_rgb_stays_exact() {
    let loaded = height(&file(&gradient(4, 4), ImageFormat::Png));
    assert!(says(&loaded, "luminance"), "{:?}", loaded.notes);
    let [r, g, b] = gradient(4, 4).to_rgb8().get_pixel(2, 3).0.map(|c| f32::from(c) / 255.0);
    assert!((loaded.map.grid().get(2, 3) - (0.2126 * r + 0.7152 * g + 0.0722 * b)).abs() < 1e-6);
    let image = grey(6, 5);
    let loaded = height(&file(&DynamicImage::ImageRgb8(image.to_rgb8()), ImageFormat::Png));
    assert!(!says(&loaded, "luminance"), "{:?}", loaded.notes);
    for (h, v) in loaded.map.grid().texels().iter().zip(image.to_luma8().pixels()) {
        assert_eq!(*h, f32::from(v.0[0]) / 255.0);
    }
}

#[test]
fn float_heights_inside_0_to_1_are_kept_and_others_rescaled_aloud() {
    for bytes in [exr_file(8, 6, &[("Y", ramp(48))]), tiff_file::<tiff_color::Gray32Float>(8, 6, &ramp(48))] {
        let loaded = height(&bytes);
        assert_eq!(loaded.map.grid().texels(), ramp(48));
        assert_eq!(loaded.notes, [""; 0]);
    }
    let metres: Vec<f32> = ramp(48).iter().map(|h| h * 8.0 - 3.0).collect();
    for bytes in [exr_file(8, 6, &[("Y", metres.clone())]), tiff_file::<tiff_color::Gray32Float>(8, 6, &metres)] {
        let loaded = height(&bytes);
        assert!(says(&loaded, "from -3 to 5"), "{:?}", loaded.notes);
        for (got, want) in loaded.map.grid().texels().iter().zip(ramp(48)) {
            assert!((got - want).abs() < 1e-6);
        }
    }
    let loaded = height(&exr_file(2, 2, &[("Y", vec![7.0; 4])]));
    assert_eq!(loaded.map.grid().texels(), [1.0; 4]);
    assert!(says(&loaded, "all heights are 7"), "{:?}", loaded.notes);
    let loaded = height(&exr_file(2, 1, &[("Y", vec![f32::MAX, f32::MIN])]));
    assert_eq!(loaded.map.grid().texels(), [1.0, 0.0]);
}

#[test]
fn heights_that_are_not_finite_are_refused_with_their_place() {
    let mut heights = ramp(48);
    (heights[13], heights[20]) = (f32::NAN, f32::INFINITY);
    for bytes in [exr_file(8, 6, &[("Y", heights.clone())]), tiff_file::<tiff_color::Gray32Float>(8, 6, &heights)] {
        let error = decode_height("rock.exr", &bytes, White::High, &Limits::default()).unwrap_err();
        assert!(matches!(error, MapError::NotFinite { count: 2, total: 48, x: 5, y: 1, .. }), "{error}");
        assert!(error.to_string().contains("rock.exr"));
    }
}

#[test]
fn a_single_exr_channel_of_any_name_is_a_height_and_a_crowd_of_unknown_ones_is_refused() {
    assert_eq!(height(&exr_file(8, 6, &[("displacement.whatever", ramp(48))])).map.grid().texels(), ramp(48));
    let loaded = height(&exr_file(8, 6, &[("Z", ramp(48)), ("id", vec![9.0; 48])]));
    assert_eq!(loaded.map.grid().texels(), ramp(48));
    assert!(says(&loaded, "Z were taken") && says(&loaded, "id"), "{:?}", loaded.notes);
    let bytes = exr_file(8, 6, &[("u", ramp(48)), ("w", ramp(48))]);
    let error = decode_height("x.exr", &bytes, White::High, &Limits::default()).unwrap_err().to_string();
    assert!(error.contains("u, w") && error.contains("R, G, B"), "{error}");
}

#[test]
fn tiffs_of_unusual_numbers_are_read() {
    let signed: Vec<i16> = (0..48).map(|i| i * 10 - 100).collect();
    let loaded = height(&tiff_file::<tiff_color::GrayI16>(8, 6, &signed));
    assert!(says(&loaded, "from -100 to 370"), "{:?}", loaded.notes);
    assert!((loaded.map.grid().get(1, 0) - 10.0 / 470.0).abs() < 1e-6);
    let loaded = height(&tiff_file::<tiff_color::Gray32>(2, 1, &[0, u32::MAX]));
    assert_eq!(loaded.map.grid().texels(), [0.0, 1.0]);
    let loaded = height(&tiff_file::<tiff_color::Gray64Float>(2, 1, &[0.25, 0.75]));
    assert_eq!(loaded.map.grid().texels(), [0.25, 0.75]);
    let color =
        decode_color("t", &tiff_file::<tiff_color::RGB32Float>(1, 1, &[0.5, 2.0, 0.0]), &Limits::default()).unwrap();
    assert_eq!(color.map.grid.texels(), [[0.5, 2.0, 0.0, 1.0]]);
    assert_eq!(color.map.encoding, ColorEncoding::Linear);
}

#[test]
fn radiance_files_of_either_signature_are_read() {
    let image = DynamicImage::ImageRgb32F(gradient(16, 9).to_rgb32f());
    let bytes = file(&image, ImageFormat::Hdr);
    let other = [b"#?RGBE".as_slice(), bytes.strip_prefix(b"#?RADIANCE").unwrap()].concat();
    let read = |bytes: &[u8]| decode_color("sky.hdr", bytes, &Limits::default()).unwrap().map;
    assert_eq!(read(&bytes), read(&other));
}

#[test]
fn an_infinite_sun_in_a_colour_file_becomes_a_very_bright_one_aloud() {
    let planes = [("R", vec![f32::INFINITY, 1.0]), ("G", vec![f32::NAN, 1.0]), ("B", vec![0.5, 3.0])];
    let loaded = decode_color("sky.exr", &exr_file(2, 1, &planes), &Limits::default()).unwrap();
    assert_eq!(loaded.map.grid.texels(), [[65504.0, 0.0, 0.5, 1.0], [1.0, 1.0, 3.0, 1.0]]);
    assert!(says(&loaded, "1 texels with NaN or infinity"), "{:?}", loaded.notes);
}

#[test]
fn normals_decode_by_the_shared_pair_and_y_down_is_the_exact_mirror() {
    let bytes = file(&gradient(17, 11), ImageFormat::Png);
    let up = decode_normal("n", &bytes, NormalY::Up, &Limits::default()).unwrap().map;
    let down = decode_normal("n", &bytes, NormalY::Down, &Limits::default()).unwrap().map;
    for ((a, b), pixel) in up.grid().texels().iter().zip(down.grid().texels()).zip(gradient(17, 11).to_rgb8().pixels())
    {
        assert_eq!(*a, pixel.0.map(NormalMap::decode8));
        assert_eq!([a[0], -a[1], a[2]], *b);
    }
}

#[test]
fn float_normals_are_understood_encoded_and_as_vectors() {
    let vectors = [[0.6, 0.0, 0.8f32], [0.0, -0.6, 0.8], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    let planes = |f: fn(f32) -> f32| {
        let plane = |c: usize| vectors.iter().map(|n| f(n[c])).collect();
        exr_file(2, 2, &[("R", plane(0)), ("G", plane(1)), ("B", plane(2))])
    };
    for bytes in [planes(|c| c), planes(|c| c * 0.5 + 0.5)] {
        let loaded = decode_normal("n.exr", &bytes, NormalY::Up, &Limits::default()).unwrap();
        for (got, want) in loaded.map.grid().texels().iter().flatten().zip(vectors.iter().flatten()) {
            assert!((got - want).abs() < 1e-6, "{got} {want}");
        }
    }
    // Flat, as vectors: nothing is negative, and still (0, 0, 1) is meant.
    let flat = exr_file(1, 1, &[("R", vec![0.0]), ("G", vec![0.0]), ("B", vec![1.0])]);
    let loaded = decode_normal("n.exr", &flat, NormalY::Up, &Limits::default()).unwrap();
    assert_eq!(loaded.map.grid().texels(), [[0.0, 0.0, 1.0]]);
}

#[test]
fn two_channel_normals_get_their_z_and_grey_files_are_refused() {
    let image = image::RgbImage::from_pixel(2, 2, image::Rgb([128, 204, 0]));
    let loaded =
        decode_normal("n", &file(&DynamicImage::ImageRgb8(image), ImageFormat::Png), NormalY::Up, &Limits::default())
            .unwrap();
    let [x, y, z] = *loaded.map.grid().get(0, 0);
    assert!((x * x + y * y + z * z - 1.0).abs() < 1e-6 && z > 0.7);
    assert!(says(&loaded, "z was made"), "{:?}", loaded.notes);
    let error = decode_normal("bump.png", &file(&grey(4, 4), ImageFormat::Png), NormalY::Up, &Limits::default());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("bump.png") && error.contains("only grey"), "{error}");
}

#[test]
fn packed_channels_are_taken_apart() {
    let bytes = file(&gradient(5, 5), ImageFormat::Png);
    for (channel, c) in [(Channel::Red, 0), (Channel::Green, 1), (Channel::Blue, 2)] {
        let map = decode_scalar("arm", &bytes, channel, &Limits::default()).unwrap().map;
        assert_eq!(*map.grid().get(3, 4), f32::from(gradient(5, 5).to_rgb8().get_pixel(3, 4).0[c]) / 255.0);
    }
    let error = decode_scalar("arm.png", &bytes, Channel::Alpha, &Limits::default()).unwrap_err().to_string();
    assert!(error.contains("arm.png") && error.contains("alpha"), "{error}");
}
