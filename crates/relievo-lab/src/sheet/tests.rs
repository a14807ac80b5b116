use relievo_map::Grid;

use super::canvas::Color;
use super::dimensions::{GUTTER, MARGIN, PADDING};
use super::text::{BODY, HEADLINE, TITLE};
use super::*;
use crate::colors::sheet::{BACKGROUND, BRIGHT, DIM, MAT, PLAIN};

const SMALL: Color = [200, 10, 120];

fn tile(width: u32, height: u32, lines: &[&str]) -> Tile {
    Tile {
        picture: Grid::from_fn(width, height, |_, _| SMALL),
        lines: lines.iter().map(|&line| line.to_owned()).collect(),
    }
}

fn column_of(sheet: &Grid<Color>, x: u32) -> Vec<Color> {
    (0..sheet.height()).map(|y| *sheet.get(x, y)).collect()
}

fn count(sheet: &Grid<Color>, color: Color) -> usize {
    sheet.texels().iter().filter(|&&c| c == color).count()
}

#[test]
fn a_picture_is_shown_pixel_by_pixel() {
    let picture = Grid::from_fn(150, 40, |x, y| [x as u8, y as u8, (x ^ y) as u8]);
    let sheet = contact_sheet("", &[Tile { picture: picture.clone(), lines: vec![] }], None, &[]).unwrap();
    assert_eq!((sheet.width(), sheet.height()), (150 + 2 * MARGIN, 40 + 2 * MARGIN));
    for y in 0..40 {
        for x in 0..150 {
            assert_eq!(sheet.get(MARGIN + x, MARGIN + y), picture.get(x, y));
        }
    }
}

#[test]
fn a_sheet_that_would_be_too_large_is_known_before_it_is_drawn() {
    assert_eq!(check_size([800, 600], 15, 6), Ok(()));
    let tiles = vec![tile(300, 200, &["a", "b"]); 7];
    let sheet = contact_sheet("", &tiles, None, &[]).unwrap();
    assert_eq!(check_size([300, 200], 7, 2).is_ok(), sheet.width() > 0);
    for (picture, tiles) in [([16384, 8192], 15), ([100, 70_000], 1), ([70_000, 100], 1), ([4000, 4000], 20)] {
        assert!(matches!(check_size(picture, tiles, 2), Err(SheetError::TooLarge { .. })), "{picture:?} {tiles}");
    }
}

#[test]
fn a_scale_runs_from_dark_to_light_under_its_name() {
    let panel = scale("FLIP", "0", "1", 200, 90);
    assert_eq!((panel.width(), panel.height()), (200, 90));
    let (dark, light) = (crate::heat_color(0.0), crate::heat_color(1.0));
    let row = (0..90).find(|&y| (0..200).any(|x| *panel.get(x, y) == light)).unwrap();
    let (first, last) =
        ((0..200).find(|&x| *panel.get(x, row) == dark), (0..200).rfind(|&x| *panel.get(x, row) == light));
    assert!(first < last, "{first:?} {last:?}");
    assert!(count(&panel, BRIGHT) > 20, "the name");
    // Too small for anything: still of the size asked for.
    for (w, h) in [(1, 1), (3, 200), (200, 3), (64, 48)] {
        let panel = scale("hit error, texels", "0", "8 or more", w, h);
        assert_eq!((panel.width(), panel.height()), (w, h));
    }
}

#[test]
fn margins_and_gutters_stay_clear_however_long_the_text_is() {
    let long = "very ".repeat(200);
    let endless = "m".repeat(5000);
    let lines = [long.as_str(), endless.as_str(), &format!("{endless}\t{endless}"), &format!("a\t{endless}")];
    let notes = [long.clone(), endless.clone()];
    let tiles = [tile(300, 50, &lines), tile(200, 90, &lines), tile(300, 20, &["short"])];
    for columns in [1, 2, 3] {
        let sheet = contact_sheet(&endless, &tiles, Some(columns), &notes).unwrap();
        for x in (0..MARGIN).chain(sheet.width() - MARGIN..sheet.width()) {
            assert!(column_of(&sheet, x).iter().all(|&c| c == BACKGROUND), "margin at {x}");
        }
    }
    let sheet = contact_sheet("", &tiles, Some(3), &[]).unwrap();
    for x in MARGIN + 300..MARGIN + 300 + GUTTER {
        assert!(column_of(&sheet, x).iter().all(|&c| c == BACKGROUND), "gutter at {x}");
    }
    // The letters really reach up to where they are cut.
    assert!((2..12).any(|back| column_of(&sheet, MARGIN + 300 - PADDING - back).contains(&BRIGHT)));
}

#[test]
fn nothing_to_show_is_no_error() {
    let empty = contact_sheet("", &[], None, &[]).unwrap();
    assert!(empty.texels().iter().all(|&c| c == BACKGROUND));
    let titled = contact_sheet("No technique was asked for", &[], Some(3), &["A note".to_owned()]).unwrap();
    assert!(count(&titled, BRIGHT) > 100 && count(&titled, DIM) > 20);
}

#[test]
fn odd_tiles_and_columns_are_drawn_whole() {
    let tiles = [
        tile(1, 1, &["one pixel"]),
        tile(1, 900, &[]),
        tile(700, 1, &["", "", "\t", "\u{0}\u{7}\u{1F600}"]),
        tile(5, 5, &["日本語", "≤\t≥"]),
    ];
    let pixels = 1 + 900 + 700 + 25;
    for columns in [None, Some(0), Some(1), Some(3), Some(u32::MAX)] {
        let sheet = contact_sheet("Ω≤é", &tiles, columns, &["…".to_owned(), String::new()]).unwrap();
        assert_eq!(count(&sheet, SMALL), pixels, "{columns:?}");
    }
}

#[test]
fn smaller_pictures_are_centred_on_a_mat() {
    let sheet = contact_sheet("", &[tile(200, 100, &[]), tile(100, 50, &[])], Some(2), &[]).unwrap();
    let left = MARGIN + 200 + GUTTER;
    assert_eq!(*sheet.get(left, MARGIN), MAT);
    let row: Vec<u32> = (left..left + 200).filter(|&x| *sheet.get(x, MARGIN + 50) == SMALL).collect();
    assert_eq!((row[0], row.len()), (left + 50, 100));
    let column = column_of(&sheet, left + 100);
    assert_eq!(column.iter().position(|&c| c == SMALL), Some((MARGIN + 25) as usize));
}

#[test]
fn what_follows_a_tab_stands_at_the_right_edge() {
    let text_columns = |line: &str| -> Vec<u32> {
        let sheet = contact_sheet("", &[tile(300, 10, &["", line])], None, &[]).unwrap();
        (0..sheet.width()).filter(|&x| column_of(&sheet, x).iter().any(|&c| c == BRIGHT || c == PLAIN)).collect()
    };
    let (left, right) = (MARGIN + PADDING, MARGIN + 300 - PADDING);
    let both = text_columns("FLIP\t0.012");
    assert!(both.iter().all(|x| (left..right).contains(x)));
    assert!(both.iter().any(|&x| x < left + 8) && both.iter().any(|&x| x >= right - 8));
    assert!(text_columns("FLIP").iter().all(|&x| x < left + 4 * BODY.advance()));
}

#[test]
fn the_headline_is_the_largest_text() {
    assert!(HEADLINE.height() > TITLE.height() && TITLE.height() > BODY.height());
    assert!(HEADLINE.width("same words") > TITLE.width("same words"));
    assert!(TITLE.width("same words") > BODY.width("same words"));
}

#[test]
fn automatic_columns_leave_few_empty_places_and_a_handy_shape() {
    for (tiles, columns) in [(1, 1), (2, 2), (3, 3), (4, 2), (6, 3), (8, 4), (9, 3), (12, 4)] {
        let tiles = vec![tile(320, 240, &["title", "a\tb", "c\td"]); tiles];
        let sheet = contact_sheet("Headline", &tiles, None, &[]).unwrap();
        assert_eq!(sheet.width(), columns * (320 + GUTTER) - GUTTER + 2 * MARGIN, "{} tiles", tiles.len());
    }
}

#[test]
fn a_sheet_too_large_for_a_picture_is_refused_with_its_size() {
    let tall = vec![tile(1, 1000, &[]); 70];
    let error = contact_sheet("", &tall, Some(1), &[]).unwrap_err();
    assert_eq!(error, SheetError::TooLarge { width: 144, height: 70_000 + 69 * 16 + 48 });
    assert!(error.to_string().contains("144×71152"), "{error}");
    assert!(contact_sheet("", &tall, None, &[]).is_ok());
    // Within both sides, but not as a whole.
    let cross = [tile(60_000, 1, &[]), tile(1, 60_000, &[])];
    assert!(contact_sheet("", &cross, None, &[]).is_err());
}
