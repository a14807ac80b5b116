use relievo_map::Grid;

use super::comparison::{Comparison, ComparisonEntry};
use crate::colors::heat;
use crate::metric::HIT_ERROR_WHITE;
use crate::sheet::{SheetError, Tile, check_size, contact_sheet, scale};

/// A map shown under each technique's picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HeatMap {
    /// FLIP per pixel, black 0 to white 1.
    Flip,
    /// Hit error, black 0 to white 8 texels; green where only one of technique and truth hits.
    Hits,
    /// Height look-ups: black 0, white the largest 99th percentile of all techniques, rounded up to a power of two.
    Fetches,
}

/// Lines under each picture of a sheet.
const LINES: usize = 6;

impl HeatMap {
    /// All kinds with their names.
    pub const ALL: [(&'static str, Self); 3] = [("flip", Self::Flip), ("hits", Self::Hits), ("fetches", Self::Fetches)];

    /// The value that is drawn white, one for all techniques.
    fn white(self, entries: &[ComparisonEntry]) -> f32 {
        match self {
            Self::Flip => 1.0,
            Self::Hits => HIT_ERROR_WHITE,
            Self::Fetches => {
                let most = entries.iter().map(|entry| entry.fetches.p99).fold(1.0, f64::max);
                (most.min(1e6).ceil() as u32).next_power_of_two() as f32
            }
        }
    }

    /// The map's scale: its name and the value of white.
    fn scale(self, white: f32, width: u32, height: u32) -> Grid<[u8; 3]> {
        match self {
            Self::Flip => scale("FLIP", "0", "1", width, height),
            Self::Hits => scale("texels off", "0", &format!("{white} or more"), width, height),
            Self::Fetches => scale("fetches", "0", &format!("{white} or more"), width, height),
        }
    }

    fn draw(self, entry: &ComparisonEntry, white: f32) -> Grid<[u8; 3]> {
        let map = match self {
            Self::Flip => &entry.flip.map,
            Self::Hits => &entry.hit_error_map,
            Self::Fetches => &entry.fetch_map,
        };
        heat(map, white)
    }
}

/// Checks that the [`sheet`](Comparison::sheet) of a comparison can be drawn, before any picture is.
///
/// `picture` is the scene's width and height.
///
/// # Errors
/// If the sheet would be larger than any picture may be.
pub fn check_sheet(picture: [u32; 2], techniques: usize, heat_maps: usize) -> Result<(), SheetError> {
    let rows = u32::try_from(heat_maps).unwrap_or(u32::MAX).saturating_add(1);
    check_size([picture[0], picture[1].saturating_mul(rows)], techniques.saturating_add(1), LINES)
}

impl Comparison {
    /// Draws the comparison as one labelled picture: the truth first, then every technique with its figures, and under each
    /// picture the requested heat maps, with their scales under the truth.
    ///
    /// # Errors
    /// If the sheet would be larger than any picture may be.
    pub fn sheet(&self, title: &str, heat_maps: &[HeatMap]) -> Result<Grid<[u8; 3]>, SheetError> {
        let (width, height) = (self.truth.width(), self.truth.height());
        check_sheet([width, height], self.entries.len(), heat_maps.len())?;
        let maps: Vec<(HeatMap, f32)> = heat_maps.iter().map(|&map| (map, map.white(&self.entries))).collect();
        let truth = Tile {
            picture: stacked(&self.truth, maps.iter().map(|(map, white)| map.scale(*white, width, height))),
            lines: vec![
                "truth".to_owned(),
                format!("displaced\t{}² vertices", self.truth_grids.iter().max().unwrap_or(&0)),
                format!("triangles\t{:.2} M", self.truth_triangles as f64 / 1e6),
                format!("time\t{:.0} ms + {:.0} ms build", self.truth_frame_ms, self.truth_build_ms),
            ],
        };
        let tiles = self.entries.iter().map(|entry| {
            let texels = &entry.hits.texels;
            let lines: [String; LINES] = [
                entry.technique.to_string(),
                format!("FLIP\t{:.4}   {:.1} dB", entry.flip.mean, entry.psnr),
                format!("texels off\t{:.2}   p99 {:.1}", texels.mean, texels.p99),
                format!("wrong hits\t{:.1} %   outline {:.3}", entry.hits.wrong * 100.0, entry.hits.outline_iou),
                format!("fetches\t{:.1}   max {:.0}", entry.fetches.mean, entry.fetches.max),
                format!("time\t{:.0} ms", entry.frame_ms),
            ];
            Tile {
                picture: stacked(&entry.picture, maps.iter().map(|(map, white)| map.draw(entry, *white))),
                lines: lines.into(),
            }
        });
        let tiles: Vec<Tile> = std::iter::once(truth).chain(tiles).collect();
        let mut notes = vec![
            "FLIP (0 equal, 1 as different as can be) and PSNR: against displaced geometry. Texels off: how far what is seen lies \
             from what is there, on the mesh, found in f64; wrong by more than one texel. Outline: pixels in which both show relief, over those in which either does. All \
             where the flat polygons show; reliefs in shells, wherever they or the truth do."
                .to_owned(),
        ];
        notes.extend(self.truth_notes.iter().map(|note| format!("Beware: {note}.")));
        if heat_maps.contains(&HeatMap::Hits) {
            notes.push("Green in a map of hits: only one of technique and truth hits.".to_owned());
        }
        contact_sheet(title, &tiles, None, &notes)
    }
}

/// Stacks pictures of one size, one under the other.
fn stacked(first: &Grid<[u8; 3]>, others: impl Iterator<Item = Grid<[u8; 3]>>) -> Grid<[u8; 3]> {
    let mut texels = first.texels().to_vec();
    let mut rows = first.height();
    for other in others {
        rows += other.height();
        texels.extend_from_slice(other.texels());
    }
    // The sheet's size was checked, and with it this one's.
    Grid::new(first.width(), rows, texels).unwrap_or_else(|_| first.clone())
}
