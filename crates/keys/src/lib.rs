//! Typed keys: a manifest's programs as types of an engine's language, so that a wrong key does not
//! compile.
//!
//! Every language gets a type for the values of each axis, and a structure for each program, which
//! can be written as the canonical key. That leaves out defaults, so code that was generated before
//! axes and values were added still names the same permutations. Dynamic axes are left out:
//! permutations do not differ in them. With a lock file, there are also functions from keys to the
//! numbers that this file gives them, and back.

pub mod bindings;
mod c;
mod names;
mod ordinal;
mod rust;
mod typescript;

use lamplight_bundle::key;
use lamplight_permute::{Axis, Lock, Manifest, Mode, Program, Setting};

/// A language that keys are written for.
#[derive(Debug, Clone, Copy)]
pub struct KeyLanguage {
    /// Lower-case, as on the command line.
    pub name: &'static str,
    /// One line for listings.
    pub about: &'static str,
    write: fn(&Manifest, Option<&Lock>) -> String,
}

/// Every language, by name.
pub const LANGUAGES: &[KeyLanguage] = &[c::LANGUAGE, rust::LANGUAGE, typescript::LANGUAGE];

pub fn find(name: &str) -> Option<&'static KeyLanguage> {
    LANGUAGES.iter().find(|language| language.name == name)
}

/// Whether a text begins as one that [`write()`] wrote, in any language.
pub fn is_written(head: &[u8]) -> bool {
    const MARK: &[u8] = b"Written by `lamplight keys";
    head.windows(MARK.len()).take(16).any(|window| window == MARK)
}

/// One source file with the keys of every program. With a lock that has all of their values, it has
/// their numbers too. The same manifest and lock give the same bytes.
pub fn write(manifest: &Manifest, lock: Option<&Lock>, language: &KeyLanguage) -> String {
    (language.write)(manifest, lock)
}

/// The axes that keys name, sorted by name as in keys.
fn key_axes(program: &Program) -> impl Iterator<Item = &Axis> {
    program.space.axes().iter().filter(|axis| axis.mode != Mode::Dynamic)
}

/// The part of a key that sets the axis. It is only written for a value that is not the default.
fn key_part(axis: &Axis, value: &Setting) -> String {
    match value {
        Setting::Bool(true) => axis.name.clone(),
        value => format!("{}{}{value}", axis.name, key::ASSIGNS),
    }
}

fn default_setting(axis: &Axis) -> &Setting {
    &axis.values[axis.default]
}
