use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Result, bail};
use relievo_lab::heat;
use relievo_map::{Grid, write_exr, write_picture, write_png8, write_png16};
use relievo_scene::Aovs;

use crate::outputs::extension;

/// Values that can be written beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AovKind {
    Depth,
    Normal,
    Uv,
    Fetches,
    Shadow,
    Hit,
}

const KINDS: [(&str, AovKind); 6] = [
    ("depth", AovKind::Depth),
    ("normal", AovKind::Normal),
    ("uv", AovKind::Uv),
    ("fetches", AovKind::Fetches),
    ("shadow", AovKind::Shadow),
    ("hit", AovKind::Hit),
];

/// One `--aov KIND=FILE`.
#[derive(Clone, Debug)]
pub(crate) struct AovFile {
    kind: AovKind,
    path: PathBuf,
}

impl FromStr for AovFile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let kinds = KINDS.map(|(name, _)| name).join(", ");
        let (name, path) = text.split_once('=').ok_or("expected KIND=FILE, as in depth=depth.exr")?;
        let kind = KINDS.iter().find(|(known, _)| *known == name).map(|&(_, kind)| kind);
        let kind = kind.ok_or_else(|| format!("\"{name}\" is not one of {kinds}"))?;
        let path = PathBuf::from(path);
        if !matches!(extension(&path).as_str(), "exr" | "png") {
            return Err(format!("\"{}\" must end in .exr (the numbers) or .png (to look at)", path.display()));
        }
        Ok(Self { kind, path })
    }
}

impl AovFile {
    /// The file that it is written to.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the values as they are (EXR), or as a picture to look at (PNG).
    pub(crate) fn write(&self, aovs: &Aovs) -> Result<()> {
        match extension(&self.path).as_str() {
            "exr" => self.write_values(aovs),
            "png" => self.write_view(aovs),
            other => bail!("{}: \".{other}\" is neither .exr nor .png", self.path.display()),
        }
    }

    fn write_values(&self, aovs: &Aovs) -> Result<()> {
        match self.kind {
            AovKind::Normal => write_exr(&self.path, &aovs.normal)?,
            // EXR viewers expect three channels: the third says where there is a surface.
            AovKind::Uv => write_exr(&self.path, &uv_and_hit(aovs))?,
            AovKind::Depth => write_exr(&self.path, &aovs.depth)?,
            AovKind::Fetches => write_exr(&self.path, &aovs.fetches)?,
            AovKind::Shadow => write_exr(&self.path, &aovs.shadow)?,
            AovKind::Hit => write_exr(&self.path, &aovs.hit)?,
        }
        Ok(())
    }

    fn write_view(&self, aovs: &Aovs) -> Result<()> {
        match self.kind {
            // Near is bright; 16 bits, since a relief is a small part of the range.
            AovKind::Depth => {
                let finite = || aovs.depth.texels().iter().copied().filter(|z| z.is_finite());
                let (near, far) = (finite().fold(f32::INFINITY, f32::min), finite().fold(0.0, f32::max));
                let view = |&z: &f32| if far > near { (far - z) / (far - near) } else { f32::from(u8::from(z <= far)) };
                write_png16(&self.path, &aovs.depth.map(view))?;
            }
            AovKind::Normal => write_png8(&self.path, &aovs.normal.map(|n| n.map(|x| 0.5 + 0.5 * x)))?,
            AovKind::Uv => write_png8(
                &self.path,
                &uv_and_hit(aovs).map(|[u, v, hit]| [u.rem_euclid(1.0), v.rem_euclid(1.0), *hit]),
            )?,
            AovKind::Fetches => {
                let most = aovs.fetches.texels().iter().copied().fold(0.0, f32::max);
                write_picture(&self.path, &heat(&aovs.fetches, most))?;
            }
            AovKind::Shadow => write_png8(&self.path, &aovs.shadow)?,
            AovKind::Hit => write_png8(&self.path, &aovs.hit)?,
        }
        Ok(())
    }
}

fn uv_and_hit(aovs: &Aovs) -> Grid<[f32; 3]> {
    Grid::from_fn(aovs.uv.width(), aovs.uv.height(), |x, y| {
        let [u, v] = *aovs.uv.get(x, y);
        [u, v, *aovs.hit.get(x, y)]
    })
}
