//! The clip space of an output's positions.

/// Clip space as an author may ask for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Clip {
    /// WebGPU's, in every target. Where an API has another one, the output converts positions.
    #[default]
    Wgpu,
    /// The API's own. Outputs do not convert the author's positions.
    Native,
}

impl Clip {
    /// Both, by their names in manifests and on the command line.
    pub const ALL: [(&'static str, Self); 2] = [("wgpu", Self::Wgpu), ("native", Self::Native)];

    /// The one of that name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(known, _)| *known == name).map(|(_, clip)| clip)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgpu => "wgpu",
            Self::Native => "native",
        }
    }
}
