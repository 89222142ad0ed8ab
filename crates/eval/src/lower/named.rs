//! Collects what the text names.

use super::{Loc, LoweredBody, ProgramBuilder};
use crate::code::Operand;
use crate::names::{Variable, VariableKind, VariablePlace};
use crate::program::FunctionId;
use crate::shape::Shape;
use naga::{AddressSpace, Function, Span, TypeInner};

fn place_of(loc: Loc) -> VariablePlace {
    match loc {
        Loc::Value { operand: Operand { slot, stride }, constant: _ } => {
            VariablePlace::At { slot, stride }
        }
        Loc::Place(slot) => VariablePlace::At { slot, stride: 1 },
        Loc::Through { slot, offset } => VariablePlace::Through { slot, offset },
    }
}

impl ProgramBuilder<'_> {
    /// Adds the variables of the module that have values.
    pub(super) fn name_globals(&mut self) {
        let module = self.module;
        for (handle, variable) in module.global_variables.iter() {
            let kind = match variable.space {
                AddressSpace::Private => VariableKind::Private,
                AddressSpace::Uniform
                | AddressSpace::Immediate
                | AddressSpace::Storage { access: _ } => VariableKind::Buffer,
                _ => continue,
            };
            let shape = Shape::of(&module.types, &module.types[variable.ty].inner);
            let loc = self.globals.get(handle.index()).and_then(|loc| loc.as_ref().ok());
            if let (Some(shape), Some(loc)) = (shape, loc) {
                self.program.variables.push(Variable {
                    function: None,
                    name: variable.name.clone().unwrap_or_default(),
                    kind,
                    shape,
                    place: place_of(*loc),
                    span: module.global_variables.get_span(handle),
                });
            }
        }
    }
}

impl LoweredBody<'_, '_> {
    /// Adds parameters, variables, named values and the result of the function, if the program is to
    /// have names.
    pub(super) fn name_variables(&mut self, function: &Function) {
        if !self.build.has_names {
            return;
        }
        for (argument, slot) in function.arguments.iter().zip(self.arguments.clone()) {
            let inner = &self.build.module.types[argument.ty].inner;
            let is_pointer = matches!(inner, TypeInner::Pointer { .. });
            let place = match is_pointer {
                true => VariablePlace::Through { slot, offset: 0 },
                false => VariablePlace::At { slot, stride: 1 },
            };
            self.name(&argument.name, VariableKind::Parameter, inner, place, Span::UNDEFINED);
        }
        for (handle, variable) in function.local_variables.iter() {
            let inner = &self.build.module.types[variable.ty].inner;
            let place = VariablePlace::At { slot: self.locals[handle.index()], stride: 1 };
            let span = function.local_variables.get_span(handle);
            self.name(&variable.name, VariableKind::Var, inner, place, span);
        }
        for (handle, name) in &function.named_expressions {
            let inner = self.inner(*handle);
            let Some(loc) = self.locs[handle.index()] else { continue };
            let span = function.expressions.get_span(*handle);
            self.name(&Some(name.clone()), VariableKind::Let, inner, place_of(loc), span);
        }
        if let Some(result) = &function.result {
            let inner = &self.build.module.types[result.ty].inner;
            let slot = self.build.program.functions[self.function as usize].result_slot;
            let place = VariablePlace::At { slot, stride: 1 };
            let name = Some("return".to_owned());
            self.name(&name, VariableKind::Result, inner, place, Span::UNDEFINED);
        }
    }

    fn name(
        &mut self,
        name: &Option<String>,
        kind: VariableKind,
        inner: &TypeInner,
        place: VariablePlace,
        span: Span,
    ) {
        let types = &self.build.module.types;
        let shape = match *inner {
            TypeInner::Pointer { base, space: _ } => Shape::of(types, &types[base].inner),
            ref inner => Shape::of(types, inner),
        };
        let (Some(name), Some(shape)) = (name.clone(), shape) else { return };
        let function = Some(FunctionId(self.function));
        let variable = Variable { function, name, kind, shape, place, span };
        self.build.program.variables.push(variable);
    }
}
