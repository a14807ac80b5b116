//! The texts of the built-in recipes, files like those of users.

macro_rules! recipes {
    ($($name:literal),+ $(,)?) => {
        /// Name and text of every built-in recipe.
        pub(crate) const RECIPES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../recipes/", $name, ".toml")))),+];
    };
}

recipes!(
    "bricks-running",
    "bricks-stack",
    "bricks-english",
    "bricks-flemish",
    "bricks-herringbone",
    "bricks-basket",
    "cobbles",
    "flagstones",
    "planks",
    "tiles",
    "hexagons",
    "roof-tiles",
    "cracked-earth",
    "rivets",
    "weave",
    "terrain",
    "clouds",
    "valley",
    "cloud-tops",
    "fog-bank",
);

/// Returns the text of a built-in recipe.
pub(crate) fn text(name: &str) -> Option<&'static str> {
    RECIPES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    RECIPES.iter().map(|(name, _)| *name)
}
