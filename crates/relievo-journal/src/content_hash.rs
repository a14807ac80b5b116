use std::fmt;
use std::hash::Hasher;

use serde::{Deserialize, Serialize};
use siphasher::sip128::{Hasher128, SipHasher24};

/// A hash of bytes: SipHash-2-4 with 128 bits and the key 0, as 32 hexadecimal digits.
///
/// The same on every machine and with every toolchain, other than that of the standard library.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ContentHash(String);

/// Hashes bytes that come piece by piece; the pieces' borders do not count.
#[derive(Clone, Debug, Default)]
pub struct ContentHasher(SipHasher24);

impl ContentHash {
    /// Hashes these bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        let mut hasher = ContentHasher::default();
        hasher.add(bytes);
        hasher.finish()
    }
}

impl fmt::Display for ContentHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl ContentHasher {
    /// Adds bytes at the end.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    /// Adds the bits of numbers at the end.
    pub fn add_numbers(&mut self, numbers: impl IntoIterator<Item = f32>) {
        numbers.into_iter().for_each(|number| self.add(&number.to_bits().to_le_bytes()));
    }

    /// Returns the hash of all bytes.
    #[must_use]
    pub fn finish(&self) -> ContentHash {
        let hash = self.0.finish128();
        ContentHash(format!("{:016x}{:016x}", hash.h1, hash.h2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_the_specification() {
        // Computed by the algorithm of the SipHash paper, checked against its authors' vectors for another key.
        assert_eq!(ContentHash::of(b"").to_string(), "7de0a38047d74950f4f2ced447ab0242");
        assert_eq!(ContentHash::of(b"relievo").to_string(), "3736f286ba1f080e9ec4e3cab6b08bb9");
    }

    #[test]
    fn pieces_hash_as_the_whole() {
        let mut hasher = ContentHasher::default();
        ["re", "", "li", "evo"].iter().for_each(|piece| hasher.add(piece.as_bytes()));
        assert_eq!(hasher.finish(), ContentHash::of(b"relievo"));
        let mut numbers = ContentHasher::default();
        numbers.add_numbers([1.0, -0.0]);
        assert_eq!(numbers.finish(), ContentHash::of(&[0, 0, 0x80, 0x3f, 0, 0, 0, 0x80]));
    }
}
