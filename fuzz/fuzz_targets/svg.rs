//! SVG drawings are refused or become strokes that can be painted, whatever the bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use painted::painted;
use relievo_make::paint::{Brush, strokes_from_svg};

mod painted;

fuzz_target!(|text: &str| {
    match strokes_from_svg("fuzzed.svg", text, &Brush { taper: text.len() % 2 == 1, ..Brush::default() }) {
        Ok(strokes) => painted(&strokes),
        Err(error) => assert!(error.to_string().starts_with("fuzzed.svg")),
    }
});
