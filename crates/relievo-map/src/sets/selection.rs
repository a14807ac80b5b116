//! The best file of a folder for every map of a material.

use std::path::Path;

use super::file_name::ParsedName;
use super::folder_maps::FolderMaps;
use super::listing::{Candidate, FolderListing};
use super::main_material::keep_main_material;
use super::map_role::{HeightKind, MapRole};
use super::map_slot::{MapSlot, fit, precision};
use crate::types::{Channel, NormalY, White};

/// Most ignored files that are named; the rest is only counted.
const MAX_IGNORED_NOTES: usize = 20;

/// Selects the best file for every slot.
pub(super) fn select(dir: &Path, mut listing: FolderListing) -> FolderMaps {
    let mut ignored: Vec<String> = Vec::new();
    let mut adopted: Vec<String> = Vec::new();
    keep_main_material(&mut listing.candidates, &mut ignored, &mut adopted);
    let candidates = &listing.candidates;
    let contest = Contest::between(candidates);

    let mut found = FolderMaps::default();
    let mut parts = Vec::new();
    for (slot, winner) in MapSlot::ALL.into_iter().zip(contest.winners) {
        let Some((i, channel)) = winner else { continue };
        let mut detail = assign(&mut found, slot, &candidates[i], channel);
        if channel != Channel::Luminance {
            detail.push_str(&format!(", {}", format!("{channel:?}").to_ascii_lowercase()));
        }
        parts.push(format!("{} from {}{detail}", slot.name(), candidates[i].file));
    }
    found.notes.push(format!("{}: {}.", dir.display(), parts.join("; ")));
    found.notes.extend(adopted);

    ignored.extend(contest.notes_on_losers(candidates));
    ignored
        .extend(listing.unknown.iter().map(|file| format!("{file}: ignored: its name does not say which map it is.")));
    ignored.extend(listing.not_images.iter().map(|file| format!("{file}: ignored: not an image that can be read.")));
    let more = ignored.len().saturating_sub(MAX_IGNORED_NOTES);
    ignored.truncate(MAX_IGNORED_NOTES);
    found.notes.extend(ignored);
    if more > 0 {
        found.notes.push(format!("{}: {more} more files were ignored.", dir.display()));
    }
    found
}

/// The candidates, by index, that win and lose the slots.
struct Contest {
    /// For every slot the winner and the channel that holds the map.
    winners: [Option<(usize, Channel)>; 6],
    /// For every candidate the first winner that it lost to, and the slot.
    lost_to: Vec<Option<(usize, MapSlot)>>,
}

impl Contest {
    /// Ranks the candidates of every slot; of equals the first by name wins.
    fn between(candidates: &[Candidate]) -> Self {
        let mut lost_to = vec![None; candidates.len()];
        let mut winners = [None; 6];
        for (slot, winner) in MapSlot::ALL.into_iter().zip(&mut winners) {
            let key = |i: usize, rank: u32| {
                let c = &candidates[i];
                (rank, c.name.resolution, c.name.bits, precision(slot, &c.extension))
            };
            let fitting: Vec<_> =
                (0..candidates.len()).filter_map(|i| fit(candidates[i].name.role, slot).map(|f| (i, f))).collect();
            let Some(&(best, (_, channel))) = fitting.iter().rev().max_by_key(|(i, (rank, _))| key(*i, *rank)) else {
                continue;
            };
            *winner = Some((best, channel));
            for (i, _) in fitting {
                lost_to[i] = lost_to[i].or((i != best).then_some((best, slot)));
            }
        }
        Self { winners, lost_to }
    }

    /// One sentence for every candidate that won no slot.
    fn notes_on_losers(&self, candidates: &[Candidate]) -> Vec<String> {
        let mut notes = Vec::new();
        for (i, c) in candidates.iter().enumerate() {
            if self.winners.iter().flatten().any(|&(winner, _)| winner == i) {
                continue;
            }
            if let MapRole::Unused(why) = c.name.role {
                notes.push(format!("{}: ignored: {why}.", c.file));
            } else if let Some((winner, slot)) = self.lost_to[i] {
                notes.push(format!("{}: ignored: {}.", c.file, why_lost(c, &candidates[winner], slot)));
            }
        }
        notes
    }
}

/// Enters the winner of a slot; returns the conventions assumed for it, as the end of a note.
fn assign(found: &mut FolderMaps, slot: MapSlot, winner: &Candidate, channel: Channel) -> String {
    let (path, role) = (winner.path.clone(), winner.name.role);
    match slot {
        MapSlot::BaseColor => found.base_color = Some(path),
        MapSlot::Normal => {
            let y = if let MapRole::Normal(Some(y)) = role { y } else { NormalY::Up };
            found.normal = Some((path, y));
            return match role {
                MapRole::Normal(_) if winner.name.unreal => " (Unreal's convention: +Y down)",
                MapRole::Normal(Some(NormalY::Down)) => ", +Y down",
                MapRole::Normal(Some(NormalY::Up)) => ", +Y up",
                _ => ", +Y up assumed, as the name does not tell (normal_y = \"down\" changes it)",
            }
            .to_owned();
        }
        MapSlot::Height => {
            found.height = Some(path);
            if role == MapRole::Height(HeightKind::Depth) {
                found.height_white = White::Deep;
                return ", a depth map, so white is deep".to_owned();
            }
        }
        MapSlot::Roughness => {
            found.roughness = Some((path, channel));
            let smooth = matches!(role, MapRole::Packed(packed) if packed.smooth);
            found.roughness_is_gloss = smooth || role == MapRole::Gloss;
            if smooth {
                return ", smoothness inverted (Unity's convention)".to_owned();
            }
            if found.roughness_is_gloss {
                return ", gloss inverted".to_owned();
            }
        }
        MapSlot::Metallic => found.metallic = Some((path, channel)),
        MapSlot::Ao => found.ao = Some((path, channel)),
    }
    String::new()
}

/// The reason why `loser` was not taken for `slot`, as the end of a sentence.
fn why_lost(loser: &Candidate, winner: &Candidate, slot: MapSlot) -> String {
    let (a, b, file) = (&loser.name, &winner.name, &winner.file);
    let rank = |name: &ParsedName| fit(name.role, slot).map(|f| f.0);
    if rank(a) != rank(b) {
        return match (slot, a.role) {
            (MapSlot::Normal, MapRole::Normal(Some(NormalY::Down))) => format!("{file} has the same with +Y up"),
            (MapSlot::Normal, _) => format!("{file} says which way its Y points"),
            (MapSlot::Height, _) => format!("{file} is the fuller height"),
            (_, MapRole::Gloss) => format!("{file} is the roughness"),
            _ => format!("{file} is a map of its own"),
        };
    }
    if a.resolution != b.resolution {
        format!("{file} is larger")
    } else if a.bits != b.bits || loser.extension != winner.extension {
        format!("{file} keeps more of the same map")
    } else {
        format!("{file} is the same kind of map, and the first by name")
    }
}
