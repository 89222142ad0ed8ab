//! `--features-default`: what an undeclared feature is; `--constant`: numbers from outside.

use std::collections::BTreeMap;

use clap::{Args, ValueEnum};

use super::input::plain_name;
use crate::permute::constant;

/// The option, for every command that composes.
#[derive(Args, Clone, Default)]
pub struct Arguments {
    /// The value of a feature that nothing chooses [default: the manifest's `features_default`,
    /// else `error`].
    #[arg(long, value_name = "on|off|error", value_enum)]
    features_default: Option<Undeclared>,
    /// The value of `constants::NAME` where no axis has the name: a literal of WGSL, whose suffix
    /// is its type, such as `4u`, `0.5f` or `true`.
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',', value_parser = parse_constant,
        allow_hyphen_values = true)]
    constant: Vec<(String, String)>,
}

/// A constant as the option has it.
fn parse_constant(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    Ok((plain_name(name)?, constant::parse(value)?))
}

#[derive(Clone, Copy, ValueEnum)]
enum Undeclared {
    On,
    Off,
    Error,
}

impl Arguments {
    /// The constants by name.
    pub fn constants(&self) -> BTreeMap<String, String> {
        self.constant.iter().cloned().collect()
    }

    /// What was asked for, or else what the manifest says.
    pub fn undeclared(&self, of_manifest: Option<bool>) -> Option<bool> {
        match self.features_default {
            None => of_manifest,
            Some(Undeclared::On) => Some(true),
            Some(Undeclared::Off) => Some(false),
            Some(Undeclared::Error) => None,
        }
    }
}
