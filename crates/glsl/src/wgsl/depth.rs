//! Which textures and samplers are compared with. GLSL says so where a texture meets its sampler, WGSL where
//! each of them is declared. So what a function does with a parameter decides what it is given, and what it
//! is given decides what it can do.

use std::collections::{BTreeMap, BTreeSet};

use super::Writer;
use super::flow::each_expr;
use super::globals::root_var;
use crate::tree::{ExprKind, Shader};
use crate::types::{Opaque, Type};

/// Variables and parameters, by number.
#[derive(Debug, Default)]
pub(super) struct Compared {
    /// Textures that are compared with, by themselves or where they are passed on.
    pub(super) textures: BTreeSet<u32>,
    /// Samplers that compare.
    pub(super) samplers: BTreeSet<u32>,
}

impl Writer<'_> {
    /// Finds what is compared with. A parameter that is given both kinds is refused.
    pub(super) fn plan_comparisons(&mut self) {
        let passed = passed_resources(self.shader);
        let mut found = compared_here(self.shader);
        for set in [&mut found.textures, &mut found.samplers] {
            spread(set, &passed);
        }
        for (param, given) in &passed {
            for (set, what) in [(&found.textures, "texture"), (&found.samplers, "sampler")] {
                let compared = given.intersection(set).count();
                if (1..given.len()).contains(&compared) {
                    let var = self.var(*param);
                    let message = format!(
                        "`{}` is given a {what} that is compared with and one that is not: WGSL has two \
                         types for these",
                        var.name
                    );
                    self.refuse(var.at, message);
                }
            }
        }
        self.compared = found;
    }
}

/// Each texture and sampler that functions take, with what they are given.
fn passed_resources(shader: &Shader) -> BTreeMap<u32, BTreeSet<u32>> {
    let mut passed: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    let bodies = shader.functions.iter().filter_map(|function| function.body.as_ref());
    bodies.for_each(|body| {
        each_expr(body, shader, &mut |expr| {
            let ExprKind::Call(callee, arguments) = &expr.kind else { return };
            let params = &shader.functions[*callee as usize].params;
            for (param, argument) in params.iter().zip(arguments) {
                if let (true, Some(root)) = (argument.ty.is_opaque(), root_var(argument)) {
                    passed.entry(*param).or_default().insert(root);
                }
            }
        });
    });
    passed
}

/// What meets a sampler that compares.
fn compared_here(shader: &Shader) -> Compared {
    let mut found = Compared::default();
    let bodies = shader.functions.iter().filter_map(|function| function.body.as_ref());
    bodies.for_each(|body| {
        each_expr(body, shader, &mut |expr| {
            if let ExprKind::Construct(parts) = &expr.kind
                && let (Type::Opaque(Opaque { shadow: true, .. }), [texture, sampler]) =
                    (&expr.ty, parts.as_slice())
            {
                found.textures.extend(root_var(texture));
                found.samplers.extend(root_var(sampler));
            }
        });
    });
    found
}

/// Follows arguments: to what is given, and to parameters that are given nothing else.
fn spread(set: &mut BTreeSet<u32>, passed: &BTreeMap<u32, BTreeSet<u32>>) {
    loop {
        let before = set.len();
        for (param, given) in passed {
            if set.contains(param) {
                set.extend(given);
            } else if given.is_subset(set) {
                set.insert(*param);
            }
        }
        if set.len() == before {
            return;
        }
    }
}
