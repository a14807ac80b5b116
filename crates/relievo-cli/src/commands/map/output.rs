//! How maps are written.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use relievo_map::{
    BitDepth, HeightMap, MapSet, NormalMap, NormalY, ScalarMap, write_color, write_exr, write_height, write_normal,
    write_png8, write_png16,
};

use super::batch::{Job, Output, is_same};
use crate::outputs::check_outputs;
use crate::scene_args::OUTPUT;

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// PNG with 8 bits per channel
    Png8,
    /// PNG with 16 bits per channel; colours have 8
    Png16,
    /// OpenEXR with 32-bit floats
    Exr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
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

/// How maps are written: the same for every verb.
#[derive(Args)]
pub(crate) struct MapOutput {
    /// Kind of files; a file named with -o that ends in .exr is OpenEXR in any case
    #[arg(long, value_name = "KIND", default_value = "png16", help_heading = OUTPUT)]
    pub(crate) format: Format,
    /// Where +Y of the normals that are written points
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

    /// What changes the files.
    pub(crate) fn describe(&self) -> String {
        format!("format={:?} normal_y={:?}", self.format, self.normal_y)
    }

    /// Where the map of a job goes: the file that was named, or one in a folder, by its suffix.
    pub(crate) fn path_for(&self, job: &Job, suffix: &str) -> Result<PathBuf> {
        let path = match &job.output {
            Output::File(path) => path.clone(),
            Output::Folder { folder, name } => self.path(folder, name, suffix),
        };
        if is_same(&path, &job.input) {
            bail!("{}: this would overwrite the map that is read; choose another folder", path.display());
        }
        Ok(path)
    }

    /// Where a map of the material `name` goes.
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
    crate::outputs::extension(path) == "exr"
}

/// A folder to write into: there already, or made in one that is.
pub(crate) fn make_folder(folder: &Path) -> Result<()> {
    check_folder(folder)?;
    if !folder.is_dir() {
        fs::create_dir(folder).with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    }
    Ok(())
}

/// Refuses, before any work is done, a folder that could not be written into.
pub(crate) fn check_folder(folder: &Path) -> Result<()> {
    if let Ok(found) = fs::metadata(folder) {
        if !found.is_dir() {
            bail!("{}: this is a file, but a folder is needed for the maps; choose another name", folder.display());
        }
        if found.permissions().readonly() {
            bail!("{}: this folder is read-only; choose another, or make it writable", folder.display());
        }
        return Ok(());
    }
    match folder.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            bail!("{}: there is no folder {}; make it first", folder.display(), parent.display())
        }
        _ => Ok(()),
    }
}
