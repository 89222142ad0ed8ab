//! What modules pass on to others: `public import`, and imports of `*`.

use super::graph::{Candidate, NodeCondition, PathTarget};
use super::lint;
use super::load::Loader;
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::wesl::{Import, Name, Visibility, Wildcard};

/// A module of which another one imports all that it shows.
#[derive(Debug, Clone)]
pub struct WildcardModule {
    pub node: u32,
    conditions: Vec<NodeCondition>,
}

impl Loader<'_> {
    /// What a module passes on under a name, with the conditions of its imports. `depth` is how many
    /// such imports led to the module: they may form a cycle.
    pub(super) fn passed_on(&mut self, node: u32, name: Name, depth: usize) -> Vec<Candidate> {
        let module = self.nodes[node as usize].module.shared();
        let mut found = Vec::new();
        let named = module.imports.iter().enumerate();
        for (index, import) in named.filter(|(_, import)| import.is_public && import.alias == name)
        {
            // What other modules pass on may change without this module.
            self.notes.is_open = true;
            if depth >= LIMITS.include_depth {
                let place = self.nodes[node as usize].module.span(import.path.range.clone());
                let message = "imports refer to each other in a cycle";
                let error = Diagnostic::error(codes::CYCLIC_IMPORT, message);
                return vec![Candidate::certain(
                    self.fail(error.at(place, "leads back to itself")),
                )];
            }
            let own = import.condition.map(|condition| NodeCondition { node, condition });
            for mut candidate in self.candidates_within(node, &import.path, Some(index), depth + 1)
            {
                candidate.conditions.extend(own);
                found.push(self.passed_candidate(node, import, candidate));
            }
        }
        found
    }

    /// What a `public import` brings; an error in its place where it cannot be passed on.
    pub(super) fn passed_candidate(
        &mut self,
        node: u32,
        import: &Import,
        candidate: Candidate,
    ) -> Candidate {
        let place = self.nodes[node as usize].module.span(import.path.parts.last.clone());
        let error = match candidate.target {
            PathTarget::Module => {
                Some(refused(place, "a `public import` of a module", "name the items to pass on"))
            }
            PathTarget::Items { node: there, name } => self.narrower(node, there, name, place),
            PathTarget::Constant(_) | PathTarget::Failed(_) => None,
        };
        match error {
            Some(error) => Candidate { target: self.fail(error), ..candidate },
            None => candidate,
        }
    }

    /// The error for passing on what is not public itself.
    fn narrower(&self, node: u32, there: u32, name: Name, place: Span) -> Option<Diagnostic> {
        let [here, other] = [node, there].map(|node| &self.nodes[node as usize]);
        // A package that is older than the word shows everything to others.
        if here.package != other.package && !other.module.says_visibility {
            return None;
        }
        let items = other.sets.get(&name)?.iter();
        let mut items = items.map(|index| &other.module.items[*index as usize]);
        let item = items.find(|item| item.visibility != Visibility::Public)?;
        let text = self.names.text(name);
        let message = format!("`{text}` is passed on, and is not public itself");
        Some(
            Diagnostic::error(codes::NOT_VISIBLE, message)
                .at(place, "passed on here")
                .at(other.module.span(item.name_range.clone()), "declared here")
                .note("help: write `public` before the declaration"),
        )
    }

    /// The modules of which a module imports all that they show. Those that it must not import so are
    /// among its broken imports.
    pub(super) fn wildcards(&mut self, node: u32) -> Vec<WildcardModule> {
        let module = self.nodes[node as usize].module.shared();
        let mut found = Vec::new();
        for wildcard in &module.wildcards {
            self.notes.is_open = true;
            match self.wildcard_modules(node, wildcard) {
                Ok(modules) => found.extend(modules),
                Err(error) => {
                    let own = wildcard.condition.map(|condition| NodeCondition { node, condition });
                    if let PathTarget::Failed(failure) = self.fail(error) {
                        let broken = &mut self.nodes[node as usize].broken_imports;
                        broken.push((own.into_iter().collect(), failure));
                    }
                }
            }
        }
        found
    }

    fn wildcard_modules(
        &mut self,
        node: u32,
        wildcard: &Wildcard,
    ) -> Result<Vec<WildcardModule>, Diagnostic> {
        let place = self.nodes[node as usize].module.span(wildcard.path.range.clone());
        // As the path of an import, it begins with a package where there is one of the name.
        let absolutes = self.absolute(node, &wildcard.path, &mut vec![usize::MAX])?;
        let mut found = Vec::new();
        for absolute in absolutes {
            let package = absolute.package.ok_or_else(|| {
                refused(place, "a `*` of the module `constants`", "name the constants")
            })?;
            let there = self.module(package, &absolute.segments, place)?;
            let there = match there {
                Some(there) => there,
                None => return Err(self.missing_module(package, &absolute.segments, place)),
            };
            self.check_wildcard(node, there, wildcard)?;
            let own = wildcard.condition.map(|condition| NodeCondition { node, condition });
            let conditions = absolute.conditions.into_iter().chain(own).collect();
            found.push(WildcardModule { node: there, conditions });
        }
        Ok(found)
    }

    /// Refuses wildcards between packages that nobody has said to be meant.
    fn check_wildcard(&self, node: u32, there: u32, wildcard: &Wildcard) -> Result<(), Diagnostic> {
        let [here, other] = [node, there].map(|node| &self.nodes[node as usize]);
        if here.package == other.package {
            return Ok(());
        }
        let is_off = |rule: &str| {
            lint::is_off(self, node, rule)
                || wildcard.off.iter().any(|name| self.names.text(*name) == rule)
        };
        let place = here.module.span(wildcard.range.clone());
        let error = |message: String, rule: &str| {
            Diagnostic::error(codes::WILDCARD_IMPORT, message)
                .at(place, "imports all that it shows")
                .note(format!(
                    "help: name the items, or write `@diagnostic(off, {rule})` before it"
                ))
        };
        if !other.module.is_wildcardable && !is_off("unsupported_wildcard") {
            let message = format!("`{}` is not made for imports of `*`", other.label);
            return Err(error(message, "unsupported_wildcard"));
        }
        if here.package != 0 && !is_off("cross_package_wildcard") {
            let message = "a package that others depend on imports `*` of another package";
            return Err(error(message.to_owned(), "cross_package_wildcard"));
        }
        Ok(())
    }

    /// What a wildcard brings under a name.
    pub(super) fn brought(
        &mut self,
        node: u32,
        wildcard: &WildcardModule,
        name: Name,
    ) -> Vec<Candidate> {
        if !self.step(1) {
            return Vec::new();
        }
        let [here, other] = [node, wildcard.node].map(|node| &self.nodes[node as usize]);
        let own = other.shows_name(name, here);
        let own = own.then_some(PathTarget::Items { node: wildcard.node, name });
        let passed = self.passed_on(wildcard.node, name, 0);
        let brought = own.map(Candidate::certain).into_iter().chain(passed);
        let with = |mut candidate: Candidate| {
            candidate.conditions.extend(&wildcard.conditions);
            Candidate { is_wildcard: true, ..candidate }
        };
        brought.map(with).collect()
    }
}

fn refused(place: Span, message: &str, label: &str) -> Diagnostic {
    Diagnostic::error(codes::SYNTAX_ERROR, message).at(place, label)
}
