//! Lists of steps applied to maps.

use relievo_map::{Grid, NormalMap, Wrap, periodic};

use super::combine::{combine, masked};
use super::error::EditError;
use super::filter::{blur, deband, median, sharpen};
use super::orientation::{reoriented, reoriented_normals};
use super::resize::resize;
use super::step::{OtherMap, Step};
use super::tone::{curve, invert, levels};

/// Applies `steps`, one after the other, to a map of one number per texel. `load` reads the other maps that steps name.
///
/// # Errors
/// If a step cannot be done, or `load` fails.
pub fn apply_steps<E: From<EditError>>(
    grid: Grid<f32>,
    steps: &[Step],
    wrap: Wrap,
    mut load: impl FnMut(OtherMap<'_>) -> Result<Grid<f32>, E>,
) -> Result<Grid<f32>, E> {
    steps.iter().try_fold(grid, |grid, step| apply(&grid, step, wrap, &mut load))
}

/// Applies `steps` to colours with alpha, channel by channel. Of alpha only the place and size change. `load` reads the
/// other maps that steps name, one channel (0 to 3) of colours at a time.
///
/// # Errors
/// If a step cannot be done, or `load` fails.
pub fn apply_steps_to_color<E: From<EditError>>(
    grid: &Grid<[f32; 4]>,
    steps: &[Step],
    wrap: Wrap,
    mut load: impl FnMut(OtherMap<'_>, usize) -> Result<Grid<f32>, E>,
) -> Result<Grid<[f32; 4]>, E> {
    let geometric: Vec<Step> = steps.iter().filter(|step| step.is_geometric()).cloned().collect();
    let mut channel = |k: usize| {
        let steps = if k == 3 { &geometric } else { steps };
        apply_steps(grid.map(|texel| texel[k]), steps, wrap, |other| load(other, k))
    };
    let [r, g, b, a] = [channel(0)?, channel(1)?, channel(2)?, channel(3)?];
    let texel = |x, y| [*r.get(x, y), *g.get(x, y), *b.get(x, y), *a.get(x, y)];
    Ok(Grid::from_fn(r.width(), r.height(), texel))
}

/// Applies `steps` to normals, which can only be rotated and flipped.
///
/// # Errors
/// If a step is another edit.
pub fn apply_steps_to_normals(map: NormalMap, steps: &[Step]) -> Result<NormalMap, EditError> {
    steps.iter().try_fold(map, |map, step| match step.orientation() {
        Some(orientation) => Ok(reoriented_normals(&map, orientation)),
        None => Err(EditError::Normals),
    })
}

fn apply<E: From<EditError>>(
    grid: &Grid<f32>,
    step: &Step,
    wrap: Wrap,
    load: &mut impl FnMut(OtherMap<'_>) -> Result<Grid<f32>, E>,
) -> Result<Grid<f32>, E> {
    let texels = |fraction: f32| fraction * grid.width() as f32;
    Ok(match step {
        Step::Levels { low, high, gamma } => levels(grid, *low, *high, *gamma),
        Step::Curve(points) => curve(grid, points)?,
        Step::Blur { radius } => blur(grid, texels(*radius), wrap),
        Step::Sharpen { radius, amount } => sharpen(grid, texels(*radius), *amount, wrap),
        Step::Median { radius } => median(grid, *radius, wrap)?,
        Step::Invert => invert(grid),
        Step::Combine { mode, file } => combine(grid, &load(OtherMap::Map(file))?, *mode)?,
        Step::Mask { file, mask } => {
            let mask = load(OtherMap::Mask(mask))?;
            masked(grid, &load(OtherMap::Map(file))?, &mask)?
        }
        Step::Resize { width, height } => resize(grid, *width, *height, wrap)?,
        Step::Reorient(orientation) => reoriented(grid, *orientation),
        Step::Tile => periodic(grid),
        Step::Deband => deband(grid, 255.0, wrap),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn steps(text: &str) -> Vec<Step> {
        text.split(' ').map(|step| step.parse().unwrap()).collect()
    }

    #[test]
    fn steps_are_applied_in_their_order_to_what_the_callback_loads() {
        let grid = Grid::new(2, 1, vec![0.25, 0.75]).unwrap();
        let load = |other: OtherMap<'_>| match other {
            OtherMap::Map(path) => {
                assert_eq!(path, Path::new("other.png"));
                Ok::<_, EditError>(Grid::filled(2, 1, 0.5))
            }
            OtherMap::Mask(_) => Ok(Grid::new(2, 1, vec![1.0, 0.0]).unwrap()),
        };
        let apply = |text| apply_steps(grid.clone(), &steps(text), Wrap::Repeat, load).unwrap().into_texels();
        assert_eq!(apply("max=other.png invert"), [0.5, 0.25]);
        assert_eq!(apply("invert max=other.png"), [0.75, 0.5]);
        assert_eq!(apply("mask=other.png,m.png"), [0.5, 0.75]);
        let refused = apply_steps(grid.clone(), &steps("max=other.png"), Wrap::Repeat, |_| Err(EditError::Curve));
        assert_eq!(refused, Err(EditError::Curve));
    }

    #[test]
    fn alpha_only_moves() {
        let grid = Grid::new(2, 1, vec![[0.0, 0.25, 0.5, 0.75], [1.0; 4]]).unwrap();
        let load = |_: OtherMap<'_>, _| Err(EditError::Curve);
        let edited = apply_steps_to_color(&grid, &steps("invert flip=x"), Wrap::Repeat, load).unwrap();
        assert_eq!(edited.texels(), [[0.0, 0.0, 0.0, 1.0], [1.0, 0.75, 0.5, 0.75]]);
    }

    #[test]
    fn normals_can_only_be_reoriented() {
        let normals = NormalMap::new(Grid::filled(2, 2, [0.6, 0.0, 0.8]));
        let flipped = apply_steps_to_normals(normals.clone(), &steps("flip=x")).unwrap();
        assert!((flipped.grid().get(0, 0)[0] + 0.6).abs() < 1e-6);
        assert_eq!(apply_steps_to_normals(normals, &steps("flip=x blur=0.1")), Err(EditError::Normals));
    }
}
