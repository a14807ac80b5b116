//! Properties of recipes, and the errors of wrong ones.

use proptest::prelude::*;
use relievo_make::{MakeError, Recipe, built_in, names, recipe_text};
use relievo_map::{Grid, MapSet};

/// A small recipe that is right.
const PLAIN: &str = r#"
seed = 3
[steps.bumps]
op = "noise"
cells = 4
octaves = 3
[steps.height]
op = "formula"
formula = "0.5 + 0.2 * bumps"
[steps.paint]
op = "formula"
formula = "mix(#804020, #c0b0a0, height)"
[steps.matt]
op = "formula"
formula = "0.9"
[output]
height = "height"
color = "paint"
roughness = "matt"
"#;

fn recipes() -> impl Iterator<Item = &'static str> {
    names().iter().copied().filter(|name| recipe_text(name).is_some())
}

fn maps(maps: &MapSet) -> [(&'static str, Grid<f32>); 4] {
    [
        ("height", maps.height.as_ref().unwrap().grid().clone()),
        ("green", maps.base_color.as_ref().unwrap().grid.map(|c| c[1])),
        ("roughness", maps.roughness.as_ref().unwrap().grid().clone()),
        ("normal x", maps.normal.as_ref().unwrap().grid().map(|n| n[0])),
    ]
}

/// The mean step from each column to the next, the last one to the first.
fn steps(grid: &Grid<f32>) -> Vec<f32> {
    let (w, h) = (grid.width(), grid.height());
    let step = |x: u32| (0..h).map(|y| (grid.get(x, y) - grid.get((x + 1) % w, y)).abs()).sum::<f32>() / h as f32;
    (0..w).map(step).collect()
}

fn transposed(grid: &Grid<f32>) -> Grid<f32> {
    Grid::from_fn(grid.height(), grid.width(), |x, y| *grid.get(y, x))
}

/// The step across the seam is not above the largest inside, but for a tenth, as a joint may lie on the seam: rolled by
/// half, it would not be found.
fn tiles(grid: &Grid<f32>) -> bool {
    let steps = steps(grid);
    let (seam, inside) = steps.split_last().unwrap();
    *seam <= 1.1 * inside.iter().copied().fold(0.0, f32::max)
}

#[test]
fn every_recipe_tiles_in_every_map_and_both_directions() {
    for name in recipes() {
        for (map, grid) in maps(&built_in(name).unwrap().make(512).unwrap()) {
            assert!(tiles(&grid) && tiles(&transposed(&grid)), "{name}: {map}");
        }
    }
}

#[test]
fn a_crop_is_found_not_to_tile() {
    let (_, grid) = maps(&built_in("bricks-running").unwrap().make(512).unwrap())[0].clone();
    let crop = Grid::from_fn(400, 400, |x, y| *grid.get(x + 30, y));
    assert!(!tiles(&crop));
}

#[test]
fn recipes_have_a_description_a_height_scale_and_use_their_range_of_heights() {
    for name in recipes() {
        let recipe = built_in(name).unwrap();
        assert!(!recipe.description().is_empty() && (0.005..0.3).contains(&recipe.height_scale()), "{name}");
        let maps = recipe.make(256).unwrap();
        let texels = maps.height.as_ref().unwrap().grid().texels();
        let (low, high) = texels.iter().fold((1.0f32, 0.0f32), |(l, h), &x| (l.min(x), h.max(x)));
        assert!(high - low > 0.3 && high > 0.75, "{name}: {low} to {high}");
    }
}

#[test]
fn another_seed_gives_another_material_of_the_same_kind() {
    let text = recipe_text("cobbles").unwrap();
    let make = |seed| Recipe::parse("cobbles", text, seed).unwrap().make(128).unwrap();
    assert_eq!(make(Some(7)), make(Some(7)));
    assert_ne!(make(Some(7)), make(Some(8)));
    assert_eq!(make(None), make(Some(0)));
}

#[test]
fn a_recipe_may_change_another_one() {
    let text = "base = \"tiles\"\nheight_scale = 0.1\n[steps.tiles]\ncolumns = 3\n";
    let changed = Recipe::parse("mine", text, None).unwrap();
    assert_eq!(changed.height_scale(), 0.1);
    assert_ne!(changed.make(64).unwrap(), built_in("tiles").unwrap().make(64).unwrap());
}

#[test]
fn memory_grows_with_the_square_of_the_size() {
    let recipe = built_in("cobbles").unwrap();
    let ratio = recipe.bytes(2048) as f64 / recipe.bytes(1024) as f64;
    assert!((3.9..4.1).contains(&ratio), "{ratio}");
    assert!(recipe.bytes(1024) > 1024 * 1024 * 40);
}

#[test]
fn impossible_sizes_are_refused() {
    let recipe = Recipe::parse("plain", PLAIN, None).unwrap();
    for size in [0, 1 << 15, u32::MAX] {
        assert_eq!(recipe.make(size), Err(MakeError::Size { size }));
    }
}

#[test]
fn steps_that_divide_by_nothing_give_maps_without_nan() {
    let text = PLAIN.replace("0.5 + 0.2 * bumps", "bumps / (u - u)").replace("\"0.9\"", "\"0 / 0\"");
    let maps = Recipe::parse("odd", &text, None).unwrap().make(16).unwrap();
    assert!(maps.height.unwrap().grid().texels().iter().all(|h| (0.0..=1.0).contains(h)));
    assert!(maps.base_color.unwrap().grid.texels().iter().flatten().all(|c| (0.0..=1.0).contains(c)));
    assert!(maps.normal.unwrap().grid().texels().iter().flatten().all(|n| n.is_finite()));
}

/// The error of [`PLAIN`] with one piece exchanged.
fn said(piece: &str, by: &str) -> String {
    assert_eq!(PLAIN.matches(piece).count(), 1, "{piece}");
    Recipe::parse("r.toml", &PLAIN.replace(piece, by), None).unwrap_err().to_string()
}

#[test]
fn mistakes_name_the_line_and_the_nearest_name() {
    for (piece, by, says) in [
        ("cells = 4", "cells = 0", "r.toml:5: cells in [steps.bumps] must be a whole number from 1 to 4096, found 0"),
        (
            "cells = 4",
            "cells = [4, 2, 1]",
            "r.toml:5: cells in [steps.bumps] must be one whole number or a list of two",
        ),
        ("cells = 4", "cels = 4", "r.toml:5: unknown key \"cels\" in [steps.bumps]; did you mean \"cells\"?"),
        ("cells = 4", "gain = nan", "r.toml:5: gain in [steps.bumps] must be a number from 0 to 1, found NaN"),
        ("cells = 4", "warp = [\"bumps\"]", "r.toml:5: warp in [steps.bumps] must be a list of 2 names of steps"),
        ("op = \"noise\"", "op = \"nois\"", "r.toml:4: op = \"nois\" is not known; did you mean \"noise\"?"),
        ("op = \"noise\"", "", "r.toml:3: [steps.bumps] needs op: one of noise"),
        (
            "op = \"noise\"",
            "op = \"noise\"\nbasis = \"simplex\"",
            "r.toml:5: basis = \"simplex\" in [steps.bumps] is not known",
        ),
        ("* bumps", "* bump", "r.toml:9: there is no step \"bump\"; did you mean \"bumps\"?"),
        ("* bumps", "* bumps.edge", "the step bumps has no output \"edge\"; it has value"),
        ("* bumps", "* bumps)", "r.toml:9: in the formula, column 18"),
        ("* bumps", "* height", "r.toml:9: these steps need each other in a circle: height needs height"),
        ("* bumps", "* luminance(paint)", "circle: height needs paint needs height"),
        ("height = \"height\"", "height = \"paint\"", "r.toml:17: paint is a colour, but a number is needed here"),
        ("height = \"height\"", "", "r.toml:16: [output] needs height"),
        ("height = \"height\"", "height = 3", "r.toml:17: height in [output] must be a text, found 3"),
        ("[output]", "[outputs]", "r.toml:16: unknown key \"outputs\" in the recipe; did you mean \"output\"?"),
        ("seed = 3", "seed = -1", "r.toml:2: seed in the recipe must be a whole number from 0 to 4294967295"),
        (
            "seed = 3",
            "base = \"cobles\"",
            "r.toml:2: there is no built-in recipe \"cobles\"; did you mean \"cobbles\"?",
        ),
        ("seed = 3", "base = \"bricks-stack\"", "\"bricks-stack\" is itself a change of another recipe"),
        ("seed = 3", "seed = = 3", "r.toml:2: this is not valid TOML"),
        ("[steps.matt]", "[steps.\"a b\"]", "r.toml:13: a step cannot be called \"a b\""),
        ("[steps.matt]", "[steps.u]", "r.toml:13: a step cannot be called \"u\""),
    ] {
        let said = said(piece, by);
        assert!(said.contains(says), "{by}\n  {said}\n  {says}");
    }
    let empty = Recipe::parse("r.toml", "", None).unwrap_err().to_string();
    assert!(empty.contains("the recipe needs steps"), "{empty}");
    let long = Recipe::parse("r.toml", &"#".repeat(1 << 20), None).unwrap_err().to_string();
    assert!(long.contains("r.toml: the recipe has 1048576 bytes"), "{long}");
}

#[test]
fn a_step_that_no_map_needs_must_be_right_as_well() {
    let text = format!("{PLAIN}\n[steps.a]\nop = \"blur\"\ninput = \"b\"\n[steps.b]\nop = \"blur\"\ninput = \"a\"\n");
    let said = Recipe::parse("r.toml", &text, None).unwrap_err().to_string();
    assert!(said.contains("a needs b needs a"), "{said}");
}

#[test]
fn bonds_that_do_not_close_are_refused() {
    let text = PLAIN.replace(
        "op = \"noise\"\ncells = 4\noctaves = 3",
        "op = \"bricks\"\nbond = \"herringbone\"\ncolumns = 6\nrows = 8",
    );
    let said = Recipe::parse("r.toml", &text, None).unwrap_err().to_string();
    assert!(said.contains("r.toml:6: columns must be a multiple of 4 in this bond"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Recipes with bytes exchanged, cut out and doubled are refused or followed, and never panic.
    #[test]
    fn mutated_recipes_are_refused_or_followed(
        which in 0..3usize,
        at in 0.0..1.0f64,
        length in 0..40usize,
        by in "[-a-z0-9\"\\[\\]=.#\n(),*é]{0,12}",
    ) {
        let text = [PLAIN, recipe_text("rivets").unwrap(), recipe_text("bricks-stack").unwrap()][which];
        let mut start = (at * text.len() as f64) as usize;
        while !text.is_char_boundary(start) { start -= 1; }
        let mut end = (start + length).min(text.len());
        while !text.is_char_boundary(end) { end += 1; }
        let mutated = format!("{}{by}{}", &text[..start], &text[end..]);
        if let Ok(recipe) = Recipe::parse("mutated", &mutated, None)
            && which == 0
        {
            let _ = recipe.make(1);
        }
    }
}
