//! Functions that the translated text needs beside the author's.

use super::Writer;
use super::value::Value;
use crate::types::Type;

/// Bits that are not a finite number.
pub(super) const FLOAT_OF_BITS: &str =
    "fn NAME(bits: u32) -> f32 {\n    return bitcast<f32>(bits);\n}";

impl Writer<'_> {
    /// A constant that is none to WGSL, since it goes through a function.
    pub(super) fn unfolded(&mut self, ty: &Type, value: &Value) -> Value {
        let ty = self.type_text(ty);
        let helper = self.helper_for(&format!("unfolded_{ty}"), "", |name| {
            format!("fn {name}(value: {ty}) -> {ty} {{\n    return value;\n}}")
        });
        Value::primary(format!("{helper}({})", value.text), true)
    }

    /// A function whose text has `NAME` for its name.
    pub(super) fn helper(&mut self, name: &str, text: &str) -> String {
        self.helper_for(name, "", |name| text.replace("NAME", name))
    }

    /// A function for some types: the same key gives the same function.
    pub(super) fn helper_for(
        &mut self,
        name: &str,
        key: &str,
        text: impl FnOnce(&str) -> String,
    ) -> String {
        let key = format!("{name} {key}");
        if let Some(text) = self.helpers.get(&key) {
            let rest = text.strip_prefix("fn ").unwrap_or(text);
            return rest.split('(').next().unwrap_or_default().to_owned();
        }
        if self.taken.contains(name) && !self.globals.contains(name) {
            self.globals.insert(name.to_owned());
        }
        let name = self.global_name(name);
        let text = text(&name);
        self.helpers.insert(key, text);
        name
    }
}
