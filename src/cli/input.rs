//! What `compose` and `compile` share: a root module, its package, its settings.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::{DiagnosticForm, Failure, warn};
use crate::compose::{self, Composed, Keep, Language, Mangle, Options};
use crate::diagnostic::Diagnostics;
use crate::permute::{Setting, Settings};
use crate::project::{self, Project};
use crate::resolve;
use crate::source::SourceSet;

/// A root module with its settings.
#[derive(Args)]
pub struct Input {
    /// Path to the root module.
    pub file: PathBuf,
    /// The package's root directory [default: from the nearest wesl.toml, else the file's folder].
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// The source language [default: by the file's extension].
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
    /// Choose an axis's value.
    #[arg(long, value_name = "AXIS=VALUE", value_parser = axis_value)]
    set: Vec<(String, Setting)>,
    /// Turn a feature on, or off with `=false`.
    #[arg(long, value_name = "NAME[=BOOL]", value_parser = feature)]
    feature: Vec<(String, Setting)>,
    /// How imported items are named.
    #[arg(long, value_enum, default_value_t)]
    mangle: MangleName,
    /// Keep items that no entry point reaches.
    #[arg(long)]
    keep_all: bool,
}

/// [`Language`] as an option's value.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LanguageName {
    Wesl,
    Glsl,
}

impl From<LanguageName> for Language {
    fn from(name: LanguageName) -> Self {
        match name {
            LanguageName::Wesl => Self::Wesl,
            LanguageName::Glsl => Self::Glsl,
        }
    }
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum MangleName {
    /// Only names that collide change.
    #[default]
    Collisions,
    /// The underscore-count form of the WESL specification.
    Underscore,
}

fn axis_value(text: &str) -> Result<(String, Setting), String> {
    let (name, value) = text.split_once('=').ok_or("expected AXIS=VALUE")?;
    Ok((name.to_owned(), Setting::parse(value)))
}

fn feature(text: &str) -> Result<(String, Setting), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "true"));
    match Setting::parse(value) {
        value @ Setting::Bool(_) => Ok((name.to_owned(), value)),
        _ => Err(format!("a feature is `true` or `false`, not `{value}`")),
    }
}
