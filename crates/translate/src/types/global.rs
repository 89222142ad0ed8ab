//! The items of all modules: their types, and what names mean in a module.

use std::collections::BTreeMap;

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

use super::constant::{Folded, default_type, fold_all};
use super::scope::Scope;
use crate::condition::Condition;
use crate::tree::{Constant, Count, Field, Function, Import, Item, ItemPath, Module, Node, Space};
use crate::tree::{Type, whole_conditions};
use crate::wesl::untranslated;

/// What all items of a package are.
#[derive(Debug, Default)]
pub struct Globals {
    /// Several under one path have different conditions.
    items: BTreeMap<ItemPath, Vec<Global>>,
    /// By module: what its imports mean.
    imports: BTreeMap<Vec<String>, BTreeMap<String, ItemPath>>,
}

/// An item.
#[derive(Debug, Clone)]
pub struct Global {
    pub condition: Condition,
    pub kind: GlobalKind,
}

#[derive(Debug, Clone)]
pub enum GlobalKind {
    Function(Signature),
    Structure(Vec<MemberType>),
    Constant {
        ty: Type,
        /// The values of its components, where it is abstract.
        value: Option<Vec<Folded>>,
    },
    Variable(Type, Space),
    Alias(Type),
}

#[derive(Debug, Clone)]
pub struct Signature {
    pub parameters: Vec<MemberType>,
    pub result: Type,
}

/// A member or a parameter, and when it exists.
#[derive(Debug, Clone, PartialEq)]
pub struct MemberType {
    pub condition: Condition,
    pub name: String,
    pub ty: Type,
}

impl Globals {
    /// Collects the items, and replaces the names of types in modules by what they mean.
    pub fn of(modules: &mut [Module]) -> Result<Self, Diagnostics> {
        let mut globals = Self::default();
        for module in modules.iter() {
            globals.import(module);
            globals.declare(module);
        }
        let mut errors = Vec::new();
        for module in modules.iter_mut() {
            let path = module.path.clone();
            for node in &mut module.items {
                globals.resolve_item(&path, node, &mut errors);
            }
        }
        globals.items.clear();
        for module in modules.iter() {
            globals.declare(module);
        }
        if errors.is_empty() { Ok(globals) } else { Err(errors) }
    }

    fn import(&mut self, module: &Module) {
        let imports = module.imports.iter();
        let meanings =
            imports.map(|Import { alias, path, condition: _ }| (alias.clone(), path.clone()));
        self.imports.insert(module.path.clone(), meanings.collect());
    }

    fn declare(&mut self, module: &Module) {
        let conditions = whole_conditions(&module.items);
        for (node, condition) in module.items.iter().zip(conditions) {
            let kind = match &node.body {
                Item::Function(function) => GlobalKind::Function(signature_of(function)),
                Item::Structure(structure) => GlobalKind::Structure(fields_of(&structure.members)),
                Item::Constant(constant) => {
                    let ty = constant.given.clone().unwrap_or(Type::Unknown);
                    GlobalKind::Constant { ty, value: None }
                }
                Item::Variable(variable) => {
                    GlobalKind::Variable(variable.ty.clone(), variable.space)
                }
                Item::Alias(_, ty) => GlobalKind::Alias(ty.clone()),
                Item::Assertion(_) => continue,
            };
            let path = ItemPath { module: module.path.clone(), name: node.body.name().to_owned() };
            self.items.entry(path).or_default().push(Global { condition, kind });
        }
    }

    /// What a name of a module means, as it is written there.
    pub fn meaning(&self, module: &[String], name: &str) -> Option<ItemPath> {
        let own = ItemPath { module: module.to_vec(), name: name.to_owned() };
        if self.items.contains_key(&own) {
            return Some(own);
        }
        if let Some(found) = self.imports.get(module).and_then(|imports| imports.get(name)) {
            return Some(found.clone());
        }
        let (parents, last) = name.rsplit_once("::")?;
        let mut segments: Vec<String> = Vec::new();
        for (index, segment) in parents.split("::").enumerate() {
            match (segment, index) {
                ("package", 0) => {}
                ("super", 0) => segments.extend_from_slice(module.split_last()?.1),
                ("super", _) => drop(segments.pop()?),
                (_, 0) => match self.imports.get(module).and_then(|all| all.get(segment)) {
                    Some(path) => {
                        segments.extend_from_slice(&path.module);
                        segments.push(path.name.clone());
                    }
                    None => segments.push(segment.to_owned()),
                },
                _ => segments.push(segment.to_owned()),
            }
        }
        Some(ItemPath { module: segments, name: last.to_owned() })
    }

    /// Whether a module can only mean an item by the item's own name.
    pub fn is_known_as(&self, module: &[String], path: &ItemPath) -> bool {
        let imports = self.imports.get(module).into_iter().flatten();
        let mut aliases = imports.filter(|(_, target)| *target == path).map(|(alias, _)| alias);
        let is_own = path.module == module;
        let first = aliases.next();
        (is_own || first.is_some())
            && first.into_iter().chain(aliases).all(|alias| *alias == path.name)
    }

    /// The items of a path.
    pub fn items(&self, path: &ItemPath) -> &[Global] {
        self.items.get(path).map_or(&[], Vec::as_slice)
    }

    /// The members of a structure, of all of its declarations.
    pub fn members(&self, path: &ItemPath) -> Vec<MemberType> {
        let mut found = Vec::new();
        for Global { condition, kind } in self.items(path) {
            let GlobalKind::Structure(members) = kind else { continue };
            let within = |member: &MemberType| MemberType {
                condition: condition.clone().and(member.condition.clone()),
                ..member.clone()
            };
            found.extend(members.iter().map(within));
        }
        found
    }

    fn resolve_item(&self, module: &[String], node: &mut Node<Item>, errors: &mut Diagnostics) {
        let span = node.span;
        let mut resolve = |ty: &mut Type| {
            if let Err(error) = self.resolve(module, ty, span, 0) {
                errors.push(error);
            }
        };
        match &mut node.body {
            Item::Function(function) => {
                function.parameters.iter_mut().for_each(|node| resolve(&mut node.body.ty));
                function.result.iter_mut().for_each(|field| resolve(&mut field.ty));
            }
            Item::Structure(structure) => {
                structure.members.iter_mut().for_each(|node| resolve(&mut node.body.ty));
            }
            Item::Constant(constant) => constant.given.iter_mut().for_each(resolve),
            Item::Variable(variable) if variable.ty == Type::Unknown => {}
            Item::Variable(variable) => resolve(&mut variable.ty),
            Item::Alias(_, ty) => resolve(ty),
            Item::Assertion(_) => {}
        }
    }

    /// Replaces names within a type by what they mean in a module.
    pub fn resolve(
        &self,
        module: &[String],
        ty: &mut Type,
        span: Span,
        depth: usize,
    ) -> Result<(), Diagnostic> {
        match ty {
            Type::Array(element, count) => {
                if let Count::Named(name) = count {
                    let is_constant =
                        |one: &Global| matches!(one.kind, GlobalKind::Constant { .. });
                    let path = self.meaning(module, name);
                    let path = path.filter(|path| self.items(path).iter().any(is_constant));
                    *count = Count::Constant(path.ok_or_else(|| missing(name, span))?);
                }
                self.resolve(module, element, span, depth)
            }
            Type::Pointer(_, target) => self.resolve(module, target, span, depth),
            Type::Named(name) => {
                let unknown = || {
                    Diagnostic::error(codes::MISSING_ITEM, format!("there is no type `{name}`"))
                        .at(span, "used here")
                };
                let path = self.meaning(module, name).ok_or_else(unknown)?;
                let mut meanings = Vec::new();
                for global in self.items(&path) {
                    meanings.push(match &global.kind {
                        GlobalKind::Alias(target) if depth < ALIASES => {
                            let mut target = target.clone();
                            self.resolve(&path.module, &mut target, span, depth + 1)?;
                            target
                        }
                        GlobalKind::Structure(_) => Type::Structure(path.clone()),
                        _ => return Err(unknown()),
                    });
                }
                let first = meanings.first().cloned().ok_or_else(unknown)?;
                if meanings.iter().any(|other| *other != first) {
                    let what =
                        format!("`{name}`, which is several types, each under its condition");
                    return Err(untranslated(span, what));
                }
                *ty = first;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Finds the types of constants that have none written, in any order of their declarations.
    pub fn type_constants(&mut self, modules: &[Module], errors: &mut Diagnostics) {
        let mut left = usize::MAX;
        loop {
            let mut failed = Vec::new();
            for module in modules {
                for (node, condition) in module.items.iter().zip(whole_conditions(&module.items)) {
                    if let Item::Constant(constant) = &node.body {
                        failed.extend(self.type_constant(module, constant, &condition).err());
                    }
                }
            }
            if failed.is_empty() {
                return;
            }
            if failed.len() >= left {
                errors.extend(failed);
                return;
            }
            left = failed.len();
        }
    }

    /// The type and the value of one declaration: others of its name have other conditions.
    fn type_constant(
        &mut self,
        module: &Module,
        constant: &Constant,
        condition: &Condition,
    ) -> Result<(), Diagnostic> {
        let path = ItemPath { module: module.path.clone(), name: constant.name.clone() };
        let mut value = constant.value.clone();
        let mut scope = Scope::new(self, &module.path);
        scope.condition = condition.clone();
        scope.expression(&mut value)?;
        let folded = fold_all(&value, self);
        let found = match (&constant.given, constant.id) {
            (Some(given), _) => given.clone(),
            (None, Some(_)) => default_type(&value.ty),
            (None, None) => value.ty,
        };
        let declared = self.items.entry(path).or_default().iter_mut();
        for global in declared.filter(|global| global.condition == *condition) {
            if let GlobalKind::Constant { ty, value } = &mut global.kind {
                *ty = found.clone();
                *value = folded.clone().filter(|_| ty.is_abstract());
            }
        }
        Ok(())
    }

    /// The values of the components of an abstract constant, if they are the same under all
    /// conditions.
    pub fn constant(&self, path: &ItemPath) -> Option<&[Folded]> {
        let mut values = self.items(path).iter().filter_map(|global| match &global.kind {
            GlobalKind::Constant { value, .. } => Some(value.as_deref()),
            _ => None,
        });
        let first = values.next()??;
        values.all(|other| other == Some(first)).then_some(first)
    }
}

fn missing(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(codes::MISSING_ITEM, format!("there is no `{name}`")).at(span, "used here")
}

/// The most aliases of aliases that are followed.
const ALIASES: usize = 32;

fn signature_of(function: &Function) -> Signature {
    let result = function.result.as_ref().map_or(Type::Nothing, |field| field.ty.clone());
    Signature { parameters: fields_of(&function.parameters), result }
}

fn fields_of(nodes: &[Node<Field>]) -> Vec<MemberType> {
    let conditions = whole_conditions(nodes);
    let made = |(node, condition): (&Node<Field>, Condition)| MemberType {
        condition,
        name: node.body.name.clone(),
        ty: node.body.ty.clone(),
    };
    nodes.iter().zip(conditions).map(made).collect()
}
