//! Finds the type of every expression, and what every name means.
//!
//! `let` has no type in WGSL, and a declaration of GLSL needs one. Conditions are not decided: a name
//! may have several declarations, each under its condition. They must have the same type where a use
//! may mean either.

mod builtin;
mod call;
mod constant;
mod expression;
mod global;
mod operator;
mod scope;
mod statement;

use lamplight_diagnostic::Diagnostics;

use crate::tree::Module;
pub use builtin::{DERIVATIVES, is_builtin};
pub use constant::{Folded, fold};
pub use global::{Global, GlobalKind, Globals, MemberType, Signature};

/// Types all expressions of modules that belong together. Returns what their items are.
pub fn check_modules(modules: &mut [Module]) -> Result<Globals, Diagnostics> {
    let mut globals = Globals::of(modules)?;
    let mut errors = Vec::new();
    globals.type_constants(modules, &mut errors);
    for module in modules.iter_mut() {
        statement::check_module(&globals, module, &mut errors);
    }
    if errors.is_empty() { Ok(globals) } else { Err(errors) }
}
