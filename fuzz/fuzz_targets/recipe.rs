//! Recipes are refused or understood, whatever the bytes, and one that is understood knows what memory it takes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use relievo_make::Recipe;

fuzz_target!(|text: &str| {
    match Recipe::parse("fuzzed.toml", text, None) {
        Ok(recipe) => assert!(recipe.bytes(1024) > 0 && recipe.height_scale() > 0.0),
        Err(error) => assert!(error.to_string().starts_with("fuzzed.toml")),
    }
});
