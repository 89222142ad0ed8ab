//! Arrays of bindings, which not every target has: those of any size and with any index.

use super::Writer;
use super::globals::{OpaqueNames, Uses};
use crate::tree::{Expr, ExprKind};
use crate::types::Type;

impl Writer<'_> {
    /// Whether an array of resources is one of bindings, which not every target has. A smaller one
    /// whose indices are known is written as a variable for each element.
    pub(super) fn is_bound_array(&self, index: u32, size: Option<u32>, uses: &Uses) -> bool {
        size.is_none_or(|size| size > 64) || uses.indexed.contains(&index)
    }

    /// The type of a resource, as an array of bindings where the variable is one.
    pub(super) fn bound_text(&self, index: u32, element: &str) -> String {
        match self.bound_arrays.get(&index) {
            Some(Some(size)) => format!("binding_array<{element}, {size}>"),
            Some(None) => format!("binding_array<{element}>"),
            None => element.to_owned(),
        }
    }

    /// Whether a variable is an array of bindings.
    pub(super) fn is_bound(&self, base: &Expr) -> bool {
        matches!(base.kind, ExprKind::Var(index) if self.bound_arrays.contains_key(&index))
    }

    /// An element of an array of bindings.
    pub(super) fn bound_element(&mut self, base: &Expr, index: &Expr) -> Option<OpaqueNames> {
        let ExprKind::Var(var) = base.kind else { return None };
        let names = self.opaque.get(&(var, Vec::new())).cloned()?;
        let value = self.value(index);
        let at = match names.sampler {
            // The index is written twice.
            Some(_) => self.kept(index.at, &value),
            None => value.text,
        };
        let element = |name: String| format!("{name}[{at}]");
        let OpaqueNames { texture, sampler, depth } = names;
        Some(OpaqueNames { texture: element(texture), sampler: sampler.map(element), depth })
    }
}

/// The array of resources that an expression indexes by what is not known.
pub(super) fn open_index(expr: &Expr) -> Option<u32> {
    match &expr.kind {
        ExprKind::Index(base, index) if index.known.is_none() => match (&base.kind, &base.ty) {
            (ExprKind::Var(var), Type::Array(element, _))
                if element.is_opaque() || matches!(**element, Type::Struct(_)) =>
            {
                Some(*var)
            }
            _ => None,
        },
        _ => None,
    }
}
