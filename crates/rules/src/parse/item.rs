//! Declarations of a module, and the directives before them.

use super::{Kind, Parsed, Parser};
use crate::Place;
use crate::syntax::{
    Alias, Attribute, DeclarationKind, Directive, Filter, Function, Local, LocalId, Member, Struct,
};

impl<'t> Parser<'t> {
    pub fn module(&mut self) -> Parsed<()> {
        self.directives()?;
        while self.token().kind != Kind::End {
            if self.take(";") {
                continue;
            }
            let (place, count) = (self.token().place, self.diagnostics);
            let (attributes, filters) = self.attributes()?;
            if !self.is("fn") {
                self.refuse_filters(count, place);
            }
            self.item(attributes, filters)?;
        }
        Ok(())
    }

    fn directives(&mut self) -> Parsed<()> {
        loop {
            match self.token().text {
                "enable" | "requires" => self.extensions()?,
                "diagnostic" => {
                    self.next();
                    let filter = self.diagnostic()?;
                    self.tree.filters.extend(filter);
                    self.expect(";")?;
                }
                _ => return Ok(()),
            }
        }
    }

    /// `enable` or `requires`, up to the end.
    fn extensions(&mut self) -> Parsed<()> {
        let start = self.token().place.start;
        let word = self.next().text;
        let mut names = Vec::new();
        while self.token().kind == Kind::Word {
            names.push(self.word()?);
            if !self.take(",") {
                break;
            }
        }
        self.expect(";")?;
        if word == "enable" {
            self.tree.enabled.extend(&names);
        }
        let place = Place { start, end: self.end() };
        self.tree.extensions.push(Directive { word, names, place });
        Ok(())
    }

    fn item(&mut self, attributes: Vec<Attribute<'t>>, filters: Vec<Filter>) -> Parsed<()> {
        match self.token().text {
            "fn" => self.function(attributes, filters),
            "struct" => self.structure(),
            "alias" => {
                self.next();
                let name = self.word()?;
                self.expect("=")?;
                let of_type = self.type_name()?;
                self.tree.aliases.push(Alias { name, of_type });
                self.expect(";").map(drop)
            }
            "const_assert" => {
                self.next();
                self.expression()?;
                self.expect(";").map(drop)
            }
            "var" => self.variable(DeclarationKind::Var, attributes),
            "const" => self.variable(DeclarationKind::Const, attributes),
            "override" => self.variable(DeclarationKind::Override, attributes),
            _ => Err(self.unexpected("a declaration")),
        }
    }

    fn variable(&mut self, kind: DeclarationKind, attributes: Vec<Attribute<'t>>) -> Parsed<()> {
        let mut declaration = self.declaration(kind)?;
        declaration.attributes = attributes;
        self.tree.declarations.push(declaration);
        self.expect(";").map(drop)
    }

    fn function(&mut self, attributes: Vec<Attribute<'t>>, filters: Vec<Filter>) -> Parsed<()> {
        self.next();
        let place = self.token().place;
        let name = self.word()?;
        self.expect("(")?;
        let parameters = self.members(")")?;
        self.expect(")")?;
        let (result, result_attributes) = match self.take("->") {
            true => {
                let attributes = self.plain_attributes()?;
                (Some(self.type_name()?), attributes)
            }
            false => (None, Vec::new()),
        };
        let first_local = self.tree.locals.len() as LocalId;
        self.is_in_function = true;
        let body = self.scoped(|parser| {
            for Member { name, of_type, .. } in &parameters {
                parser.declare(name, Local { of_type: Some(*of_type), constant: None });
            }
            parser.block()
        })?;
        self.is_in_function = false;
        self.tree.functions.push(Function {
            name,
            place,
            first_local,
            attributes,
            filters,
            parameters,
            result,
            result_attributes,
            body,
        });
        Ok(())
    }

    fn structure(&mut self) -> Parsed<()> {
        self.next();
        let name = self.word()?;
        self.expect("{")?;
        let members = self.members("}")?;
        self.expect("}")?;
        self.tree.structs.push(Struct { name, members });
        Ok(())
    }

    fn members(&mut self, end: &str) -> Parsed<Vec<Member<'t>>> {
        let mut found = Vec::new();
        while !self.is(end) {
            let attributes = self.plain_attributes()?;
            let place = self.token().place;
            let name = self.word()?;
            self.expect(":")?;
            let of_type = self.type_name()?;
            found.push(Member { name, place, of_type, attributes });
            if !self.take(",") {
                break;
            }
        }
        Ok(found)
    }
}
