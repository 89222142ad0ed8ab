//! Output languages.

use std::fmt;

/// An output language, by name. Each file of `crates/emit/src/targets/` is one, and a test of that
/// package compares them with the names here: a loader knows the names without the compiler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Target(&'static str);

/// Writes a constant for each name, and the list of all.
macro_rules! targets {
    ($($constant:ident = $name:literal,)*) => {
        impl Target {
            $(#[doc = concat!("The target `", $name, "`.")]
            pub const $constant: Target = Target($name);)*
            /// Every target, by name.
            pub const ALL: &'static [Target] = &[$(Target::$constant),*];
        }
    };
}

targets! {
    ESSL300 = "essl300",
    GLSL330 = "glsl330",
    GLSL450 = "glsl450",
    HLSL = "hlsl",
    MSL = "msl",
    SPIRV = "spirv",
    WGSL = "wgsl",
}

impl Target {
    /// Lower-case name, as in manifests and on the command line.
    pub const fn name(self) -> &'static str {
        self.0
    }

    /// The target of that name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|target| target.0 == name)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}
