//! `--features-default`: what an undeclared feature is.

use clap::{Args, ValueEnum};

/// The option, for every command that composes.
#[derive(Args, Clone, Copy, Default)]
pub struct Arguments {
    /// What a feature is that nothing chooses [default: the manifest's `features_default`, else
    /// `error`].
    #[arg(long, value_name = "on|off|error", value_enum)]
    features_default: Option<Undeclared>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Undeclared {
    On,
    Off,
    Error,
}

impl Arguments {
    /// What was asked for, or else what the manifest says.
    pub fn undeclared(self, of_manifest: Option<bool>) -> Option<bool> {
        match self.features_default {
            None => of_manifest,
            Some(Undeclared::On) => Some(true),
            Some(Undeclared::Off) => Some(false),
            Some(Undeclared::Error) => None,
        }
    }
}
