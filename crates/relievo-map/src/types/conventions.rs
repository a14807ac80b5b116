//! Conventions in which image files differ: white, the direction of Y, and packed channels.

/// What white means in a height file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum White {
    /// White is the highest: a height or displacement map.
    #[default]
    High,
    /// White is the deepest: a depth map.
    Deep,
}

/// Where +Y of a normal file points in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NormalY {
    /// Up: OpenGL, glTF, Blender, Unity, Godot.
    #[default]
    Up,
    /// Down: DirectX, Unreal.
    Down,
}

/// Which number of a texel is meant; one file may pack several maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Grey as it is; of colours the Rec. 709 luminance of the stored values.
    #[default]
    Luminance,
    /// The first channel.
    Red,
    /// The second channel.
    Green,
    /// The third channel.
    Blue,
    /// The alpha channel; an error in a file that has none.
    Alpha,
}
