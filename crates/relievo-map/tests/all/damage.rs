//! Damaged files are errors or whole pictures: never half a picture, a panic or a long wait.

use proptest::prelude::*;
use relievo_map::{Channel, Limits, NormalY, White, decode_color, decode_height, decode_normal, decode_scalar};

use crate::common::every_format;

const SMALL: Limits = Limits { max_side: 1024, max_bytes: 1 << 24 };

#[test]
fn a_file_cut_anywhere_is_an_error_or_still_the_whole_picture() {
    for (extension, bytes) in every_format() {
        let name = format!("cut.{extension}");
        let whole = decode_color(&name, &bytes, &SMALL).unwrap().map;
        let mut refused = 0;
        for length in 0..bytes.len() {
            match decode_color(&name, &bytes[..length], &SMALL) {
                Ok(loaded) => assert!(
                    loaded.map == whole,
                    "{name} cut to {length} of {} bytes: not the whole picture",
                    bytes.len()
                ),
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().contains(&name), "{error}");
                }
            }
        }
        // Nothing but the last few bytes (an end marker, a checksum, padding) may be missed.
        assert!(refused + 40 >= bytes.len(), "{name}: only {refused} of {} cuts were noticed", bytes.len());
    }
}

#[test]
fn a_file_with_any_byte_changed_never_panics() {
    for (extension, bytes) in every_format() {
        let name = format!("changed.{extension}");
        for i in 0..bytes.len() {
            for value in [0, 0xff, bytes[i] ^ 1, bytes[i] ^ 0x80] {
                let mut bytes = bytes.clone();
                bytes[i] = value;
                let _ = decode_height(&name, &bytes, White::High, &SMALL);
            }
        }
    }
}

proptest! {
    #[test]
    fn files_with_many_bytes_changed_never_panic(
        which in 0usize..15,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        cut in any::<prop::sample::Index>(),
    ) {
        let files = every_format();
        let (extension, mut bytes) = files[which % files.len()].clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let name = format!("odd.{extension}");
        let _ = decode_color(&name, &bytes, &SMALL);
        let _ = decode_normal(&name, &bytes, NormalY::Down, &SMALL);
        bytes.truncate(cut.index(bytes.len()) + 1);
        let _ = decode_scalar(&name, &bytes, Channel::Alpha, &SMALL);
    }

    #[test]
    fn noise_never_panics(name in "[a-z]{0,3}\\.(png|tga|exr)", bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = decode_color(&name, &bytes, &SMALL);
    }
}
