//! How many of a bundle's outputs are validated.

/// How many of a bundle's outputs are validated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// A selection that has each distinct line of each target and stage. Lines that differ
    /// only in the numbers of generated names count as the same.
    Lines,
    /// All of them.
    All,
    /// None.
    Nothing,
}

impl Extent {
    /// All of them, in the order of messages.
    pub const ALL: [Self; 3] = [Self::Lines, Self::All, Self::Nothing];

    /// The value of `--validate`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::All => "all",
            Self::Nothing => "none",
        }
    }

    /// The extent of that name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|extent| extent.name() == name)
    }
}
