//! `--features-default`: the value of an undeclared feature; `--constant`: values of constants.

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

/// Parses `NAME=VALUE` of `--constant`.
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

    /// The value of undeclared features: that of the option, or else that of the manifest. `None`
    /// means that asking for such a feature is an error.
    pub fn undeclared(&self, of_manifest: Option<bool>) -> Option<bool> {
        match self.features_default {
            None => of_manifest,
            Some(Undeclared::On) => Some(true),
            Some(Undeclared::Off) => Some(false),
            Some(Undeclared::Error) => None,
        }
    }
}
