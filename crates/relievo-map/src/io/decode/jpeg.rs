//! Check for truncated JPEG files, whose missing part the decoder fills with grey.

/// True if the file reaches its end-of-image marker (`FF D9`). Follows the segments from the beginning, so that the
/// marker of an embedded thumbnail does not count.
pub(super) fn is_complete(bytes: &[u8]) -> bool {
    // After the start-of-image marker.
    let mut at = 2;
    let mut seen_scan = false;
    loop {
        // To the next marker: in a scan `FF 00` is data and `FF D0`..`FF D7` are restarts; several `FF` are padding.
        let marker = loop {
            match (bytes.get(at), bytes.get(at + 1)) {
                (Some(0xff), Some(0xff)) => at += 1,
                (Some(0xff), Some(0x00 | 0x01 | 0xd0..=0xd7)) => at += 2,
                (Some(0xff), Some(&marker)) => break marker,
                (Some(_), Some(_)) => at += 1,
                _ => return false,
            }
        };
        if marker == 0xd9 {
            return seen_scan;
        }
        seen_scan |= marker == 0xda;
        let Some(length) = bytes.get(at + 2..).and_then(|b| b.first_chunk()).map(|b| u16::from_be_bytes(*b)) else {
            return false;
        };
        at += 2 + usize::from(length.max(2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_marker_of_a_thumbnail_does_not_count() {
        // Start, an APP1 segment of 6 bytes with an end marker in it, a scan with stuffing and a restart.
        let cut = b"\xff\xd8\xff\xe1\0\x06\0\0\xff\xd9\xff\xda\0\x02\x12\xff\0\x34\xff\xd3\x56";
        assert!(!is_complete(cut));
        assert!(is_complete(&[cut, &b"\xff\xd9"[..]].concat()));
        assert!(!is_complete(b"\xff\xd8\xff\xd9"));
        assert!(!is_complete(b"\xff\xd8\xff"));
    }
}
