//! What a part of a bundle was made of, so that only parts of one bundle are put together.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

/// Which parts of a bundle are here, and what they were made of. A whole bundle has none: its bytes
/// do not show how many runs made it. The lock file of integer keys is not named here, since no byte
/// of a bundle depends on it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShardOrigin {
    /// The numbers of the parts, from 1.
    pub parts: BTreeSet<u64>,
    /// The number of all parts.
    pub of: u64,
    /// The version of the tool, and a hash of its own sources and dependencies.
    pub tool: String,
    /// What was asked for besides the manifest: programs, keys, targets and conventions.
    pub settings: String,
    /// A hash of every text that was read: the manifest, the files that declare packages, lists of
    /// used permutations, and all modules.
    pub sources: String,
}

/// How two parts differ that do not belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShardMismatch {
    /// One of them is not a part.
    Whole,
    /// The number of all parts.
    Count,
    /// The tool that made them.
    Tool,
    /// What was asked for.
    Settings,
    /// The texts that were read.
    Sources,
}

impl ShardMismatch {
    /// What differs between two bundles, if something does.
    pub fn between(left: Option<&ShardOrigin>, right: Option<&ShardOrigin>) -> Option<Self> {
        let (left, right) = match (left, right) {
            (None, None) => return None,
            (Some(left), Some(right)) => (left, right),
            _ => return Some(Self::Whole),
        };
        let ShardOrigin { parts: _, of, tool, settings, sources } = left;
        let compared = [
            (*of == right.of, Self::Count),
            (*tool == right.tool, Self::Tool),
            (*settings == right.settings, Self::Settings),
            (*sources == right.sources, Self::Sources),
        ];
        compared.into_iter().find(|(is_same, _)| !is_same).map(|(_, what)| what)
    }

    /// As the end of a sentence about two shards.
    pub fn message(self) -> &'static str {
        match self {
            Self::Whole => "are not parts of one bundle: only one of them is a shard",
            Self::Count => "are parts of bundles that were divided differently",
            Self::Tool => "were made by different versions of Lamplight",
            Self::Settings => "were made with different settings",
            Self::Sources => "were made of different sources",
        }
    }
}

impl ShardOrigin {
    /// How many parts are missing, with the first of them.
    pub fn missing(&self) -> Option<(u64, u64)> {
        let first = (1..=self.of).find(|part| !self.parts.contains(part))?;
        Some((self.of.saturating_sub(self.parts.len() as u64), first))
    }
}

/// The origin of two bundles together, which belong to one; `None` once no part is missing.
pub(super) fn joined(
    left: Option<ShardOrigin>,
    right: Option<ShardOrigin>,
) -> Result<Option<ShardOrigin>, ShardMismatch> {
    if let Some(mismatch) = ShardMismatch::between(left.as_ref(), right.as_ref()) {
        return Err(mismatch);
    }
    Ok(left.map(|mut origin| {
        origin.parts.extend(right.into_iter().flat_map(|right| right.parts));
        origin
    }))
}
