use relievo_map::Grid;

use crate::compare::{Comparison, Entry};
use crate::{SheetError, Tile, contact_sheet, heat};

/// A map shown under each technique's picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeatMap {
    /// FLIP per pixel, black 0 to white 1.
    Flip,
    /// Hit error, black 0 to white 8 texels; green where only one of technique and oracle hits.
    Hits,
    /// Height look-ups, black 0 to white 64.
    Fetches,
}

impl HeatMap {
    /// All kinds with their names.
    pub const ALL: [(&'static str, Self); 3] = [("flip", Self::Flip), ("hits", Self::Hits), ("fetches", Self::Fetches)];

    /// What a heat map's white stands for.
    fn legend(self) -> &'static str {
        match self {
            Self::Flip => "FLIP, white = 1",
            Self::Hits => "hit error, white = 8 texels or more, green = only one of technique and truth hits",
            Self::Fetches => "fetches, white = 64 or more",
        }
    }

    fn draw(self, entry: &Entry) -> Grid<[u8; 3]> {
        match self {
            Self::Flip => heat(&entry.flip.map, 1.0),
            Self::Hits => heat(&entry.hit_error_map, 8.0),
            Self::Fetches => heat(&entry.fetch_map, 64.0),
        }
    }
}

impl Comparison {
    /// The comparison as one labelled picture: the truth first, then every technique with its figures, and under each
    /// picture the heat maps asked for.
    ///
    /// # Errors
    /// If the sheet would be larger than any picture may be.
    pub fn sheet(&self, title: &str, heat_maps: &[HeatMap]) -> Result<Grid<[u8; 3]>, SheetError> {
        let black = self.truth.map(|_| [0; 3]);
        let truth = Tile {
            picture: stacked(&self.truth, heat_maps.iter().map(|_| black.clone())),
            lines: vec![
                "truth".to_owned(),
                format!("displaced geometry\t{}² vertices", self.truth_grids.iter().max().unwrap_or(&0)),
                format!("triangles\t{:.2} M", self.truth_triangles as f64 / 1e6),
                format!("time\t{:.0} ms + {:.0} ms build", self.truth_frame_ms, self.truth_build_ms),
            ],
        };
        let tiles = self.entries.iter().map(|entry| {
            let texels = &entry.hits.texels;
            Tile {
                picture: stacked(&entry.picture, heat_maps.iter().map(|map| map.draw(entry))),
                lines: vec![
                    entry.contender.to_string(),
                    format!("FLIP\t{:.4}   {:.1} dB", entry.flip.mean, entry.psnr),
                    format!("hit error, texels\t{:.2}   p99 {:.1}", texels.mean, texels.p99),
                    format!("wrong by over a texel\t{:.1} %", entry.hits.wrong * 100.0),
                    format!("fetches per pixel\t{:.1}   max {:.0}", entry.fetches.mean, entry.fetches.max),
                    format!("time\t{:.0} ms", entry.frame_ms),
                ],
            }
        });
        let tiles: Vec<Tile> = std::iter::once(truth).chain(tiles).collect();
        let mut notes = vec![
            "FLIP and PSNR against displaced geometry; hit error and wrong hits against the first intersection in f64; \
             both where the flat polygons show."
                .to_owned(),
        ];
        notes.extend(heat_maps.iter().map(|map| format!("Heat map: {}.", map.legend())));
        contact_sheet(title, &tiles, None, &notes)
    }
}

/// Pictures of one size, one under the other.
fn stacked(first: &Grid<[u8; 3]>, others: impl Iterator<Item = Grid<[u8; 3]>>) -> Grid<[u8; 3]> {
    let mut texels = first.texels().to_vec();
    let mut rows = first.height();
    for other in others {
        if rows + other.height() > Grid::<()>::MAX_SIDE {
            break;
        }
        rows += other.height();
        texels.extend_from_slice(other.texels());
    }
    Grid::new(first.width(), rows, texels).unwrap_or_else(|_| first.clone())
}
