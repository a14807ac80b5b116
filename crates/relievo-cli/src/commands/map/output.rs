//! Writing maps: kind of files, names, and the direction of normals.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use relievo_map::{
    BitDepth, HeightMap, MapSet, NormalMap, NormalY, ScalarMap, write_color, write_exr, write_height, write_normal,
    write_png8, write_png16,
};
use serde::Serialize;

use super::job::{JobOutput, MapJob, is_same};
use crate::outputs::{check_folder, check_outputs, extension, make_folder};
use crate::scene_args::OUTPUT;

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
pub(crate) enum Format {
    /// PNG with 8 bits per channel
    Png8,
    /// PNG with 16 bits per channel; colours have 8
    Png16,
    /// OpenEXR with 32-bit floats
    Exr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
pub(crate) enum UpOrDown {
    /// OpenGL, glTF, Blender, Unity
    Up,
    /// DirectX, Unreal
    Down,
}

impl From<UpOrDown> for NormalY {
    fn from(y: UpOrDown) -> Self {
        if y == UpOrDown::Up { Self::Up } else { Self::Down }
    }
}

/// Options for writing maps: the same for every verb.
#[derive(Args, Serialize)]
pub(crate) struct MapOutput {
    /// Kind of files; a file named with -o that ends in .exr is OpenEXR in any case
    #[arg(long, value_name = "KIND", default_value = "png16", help_heading = OUTPUT)]
    pub(crate) format: Format,
    /// Direction of +Y of the normals that are written
    #[arg(long, value_name = "WAY", default_value = "up", help_heading = OUTPUT)]
    pub(crate) normal_y: UpOrDown,
}

impl MapOutput {
    /// The ending of the files in a folder.
    pub(crate) fn ending(&self) -> &'static str {
        if self.format == Format::Exr { "exr" } else { "png" }
    }

    /// The ending of a file's name that says which map it is.
    pub(crate) fn normal_suffix(&self) -> &'static str {
        if self.normal_y == UpOrDown::Up { "NormalGL" } else { "NormalDX" }
    }

    pub(crate) fn height(&self, path: &Path, map: &HeightMap) -> Result<()> {
        if self.format == Format::Png8 && !is_exr(path) {
            write_png8(path, map.grid())?;
        } else {
            write_height(path, map)?;
        }
        Ok(())
    }

    pub(crate) fn normal(&self, path: &Path, map: &NormalMap) -> Result<()> {
        let bits = if self.format == Format::Png8 { BitDepth::Eight } else { BitDepth::Sixteen };
        Ok(write_normal(path, map, self.normal_y.into(), bits)?)
    }

    pub(crate) fn scalar(&self, path: &Path, map: &ScalarMap) -> Result<()> {
        if is_exr(path) {
            write_exr(path, map.grid())?;
        } else if self.format == Format::Png8 {
            write_png8(path, map.grid())?;
        } else {
            write_png16(path, map.grid())?;
        }
        Ok(())
    }

    /// Path of a job's map: the file that was named, or one in a folder, by its suffix.
    pub(crate) fn path_for(&self, job: &MapJob, suffix: &str) -> Result<PathBuf> {
        let path = match &job.output {
            JobOutput::File(path) => path.clone(),
            JobOutput::Folder { folder, name } => self.path(folder, name, suffix),
        };
        if is_same(&path, &job.input) {
            bail!("{}: this would overwrite the map that is read; choose another folder", path.display());
        }
        Ok(path)
    }

    /// Path of a map of the material `name`.
    pub(crate) fn path(&self, folder: &Path, name: &str, suffix: &str) -> PathBuf {
        folder.join(format!("{name}_{suffix}.{}", self.ending()))
    }

    /// Refuses, before any work is done, a folder for the material `name` that could not be written into.
    pub(crate) fn check_material(&self, folder: &Path, name: &str) -> Result<()> {
        check_folder(folder)?;
        if !folder.is_dir() {
            return Ok(());
        }
        let suffixes = ["Color", "Displacement", self.normal_suffix(), "Roughness", "Metalness", "AmbientOcclusion"];
        let paths = suffixes.map(|suffix| self.path(folder, name, suffix));
        check_outputs(&paths.each_ref().map(PathBuf::as_path), None)
    }

    /// Writes the maps that there are into a folder, under names by which folders of maps are recognised. Returns the files.
    pub(crate) fn material(&self, folder: &Path, name: &str, maps: &MapSet) -> Result<Vec<PathBuf>> {
        make_folder(folder)?;
        let mut files = Vec::new();
        let mut file = |suffix: &str| {
            let path = self.path(folder, name, suffix);
            files.push(path.clone());
            path
        };
        if let Some(map) = &maps.base_color {
            write_color(&file("Color"), map)?;
        }
        if let Some(map) = &maps.height {
            self.height(&file("Displacement"), map)?;
        }
        if let Some(map) = &maps.normal {
            self.normal(&file(self.normal_suffix()), map)?;
        }
        for (map, suffix) in
            [(&maps.roughness, "Roughness"), (&maps.metallic, "Metalness"), (&maps.ao, "AmbientOcclusion")]
        {
            if let Some(map) = map {
                self.scalar(&file(suffix), map)?;
            }
        }
        Ok(files)
    }
}

fn is_exr(path: &Path) -> bool {
    extension(path) == "exr"
}
