//! Declarations.

use super::{Parser, Res};
use crate::ast::{
    Base, Block, Declarator, Expr, Function, Item, Member, Name, Param, Qual, Sizes, TypeSpec, Vars,
};
use crate::lexer::{Kind, mark};

/// Words that stand before a type.
const QUALIFIERS: &[&str] = &[
    "const",
    "in",
    "out",
    "inout",
    "uniform",
    "attribute",
    "varying",
    "highp",
    "mediump",
    "lowp",
    "volatile",
    "nonuniformEXT",
    "perprimitiveEXT",
];

/// Words that stand before a type and that some versions leave to authors for names. Where one is a
/// qualifier, a word follows it, or the `;` behind a layout for all.
const YOUNG_QUALIFIERS: &[&str] = &[
    "buffer",
    "shared",
    "centroid",
    "flat",
    "smooth",
    "noperspective",
    "sample",
    "patch",
    "invariant",
    "precise",
    "coherent",
    "restrict",
    "readonly",
    "writeonly",
    "subroutine",
];

/// How many sizes an array may have.
const DIMENSIONS: usize = 8;

impl<'a> Parser<'a, '_> {
    /// Whether the next word is a qualifier.
    fn is_at_qualifier(&self) -> bool {
        let word = self.text_of(self.token());
        QUALIFIERS.contains(&word) || YOUNG_QUALIFIERS.contains(&word) && self.is_before_type()
    }

    fn is_before_type(&self) -> bool {
        let after = self.ahead(1).kind;
        after == Kind::Word || after == mark(";")
    }

    /// Whether the next word begins a declaration, whatever follows.
    pub(super) fn is_at_declaration(&self) -> bool {
        let word = self.text_of(self.token());
        ["struct", "precision", "layout"].contains(&word) || self.is_at_qualifier()
    }

    /// A declaration, with its `;` or its body.
    pub(super) fn item(&mut self) -> Res<Item<'a>> {
        if self.take(";") {
            return Ok(Item::Nothing);
        }
        if self.take_word("precision") {
            self.name()?;
            self.name()?;
            self.expect(";")?;
            return Ok(Item::Nothing);
        }
        let quals = self.qualifiers()?;
        if !quals.is_empty() {
            if self.take(";") {
                return Ok(Item::Quals(quals, Vec::new()));
            }
            if self.token().kind == Kind::Word {
                let after = self.ahead(1).kind;
                if after == mark("{") && !self.is_word("struct") {
                    return self.block(quals);
                }
                if after == mark(";") || after == mark(",") {
                    return self.qualified_names(quals);
                }
            }
        }
        let ty = self.type_spec()?;
        if self.take(";") {
            return Ok(Item::Vars(Vars { quals, ty, names: Vec::new() }));
        }
        if self.token().kind == Kind::Word && self.ahead(1).kind == mark("(") {
            self.result_quals(&quals)?;
            return self.function(ty);
        }
        let mut names = vec![self.declarator()?];
        while self.take(",") {
            names.push(self.declarator()?);
        }
        self.expect(";")?;
        Ok(Item::Vars(Vars { quals, ty, names }))
    }

    /// A result has a precision, and no place.
    fn result_quals(&mut self, quals: &[Qual<'a>]) -> Res<()> {
        const FIT: [&str; 6] = ["const", "highp", "lowp", "mediump", "precise", "subroutine"];
        let word = quals.iter().find_map(|qual| match qual {
            Qual::Word(name) if !FIT.contains(&name.text) => Some(*name),
            Qual::Word(_) | Qual::Layout(_) => None,
        });
        match word {
            Some(name) => self.fail(name.at, format!("a result is not `{}`", name.text)),
            None => Ok(()),
        }
    }

    fn qualified_names(&mut self, quals: Vec<Qual<'a>>) -> Res<Item<'a>> {
        let mut names = vec![self.name()?];
        while self.take(",") {
            names.push(self.name()?);
        }
        self.expect(";")?;
        Ok(Item::Quals(quals, names))
    }

    pub(super) fn qualifiers(&mut self) -> Res<Vec<Qual<'a>>> {
        let mut quals = Vec::new();
        while self.token().kind == Kind::Word {
            let word = self.text_of(self.token());
            if word == "layout" && self.ahead(1).kind == mark("(") {
                self.at += 2;
                quals.push(self.layout()?);
            } else if self.is_at_qualifier() {
                quals.push(Qual::Word(self.name()?));
            } else {
                break;
            }
        }
        Ok(quals)
    }

    fn layout(&mut self) -> Res<Qual<'a>> {
        let mut list = Vec::new();
        if self.is(")") {
            let at = self.token().at;
            return self.fail(at, "a layout has at least one word".to_owned());
        }
        while !self.take(")") {
            let name = self.name()?;
            let value = if self.take("=") { Some(self.assignment()?) } else { None };
            list.push((name, value));
            if !self.is(")") {
                self.expect(",")?;
            }
        }
        Ok(Qual::Layout(list))
    }

    pub(super) fn type_spec(&mut self) -> Res<TypeSpec<'a>> {
        let start = self.token().at;
        let base = if self.take_word("struct") {
            let name = if self.is("{") { None } else { Some(self.name()?) };
            self.expect("{")?;
            Base::Struct(name, self.deeper(Self::members)?)
        } else {
            let token = self.token();
            if token.kind != Kind::Word {
                let found = self.describe(token);
                return self.fail(token.at, format!("expected a declaration, found {found}"));
            }
            Base::Name(self.name()?.text)
        };
        let sizes = self.sizes()?;
        Ok(TypeSpec { base, sizes, at: start.to(self.last_at()) })
    }

    fn members(&mut self) -> Res<Vec<Member<'a>>> {
        let mut members = Vec::new();
        while !self.take("}") {
            let quals = self.qualifiers()?;
            let ty = self.type_spec()?;
            let mut names = vec![self.member_name()?];
            while self.take(",") {
                names.push(self.member_name()?);
            }
            self.expect(";")?;
            members.push(Member { quals, ty, names });
        }
        Ok(members)
    }

    fn member_name(&mut self) -> Res<Declarator<'a>> {
        let name = self.name()?;
        let sizes = self.sizes()?;
        Ok(Declarator { name, sizes, init: None })
    }

    fn sizes(&mut self) -> Res<Sizes<'a>> {
        let mut sizes: Vec<Option<Expr<'a>>> = Vec::new();
        while self.take("[") {
            if sizes.len() >= DIMENSIONS {
                let at = self.token().at;
                return self.fail(at, format!("an array has at most {DIMENSIONS} sizes here"));
            }
            if self.take("]") {
                sizes.push(None);
                continue;
            }
            sizes.push(Some(self.expression()?));
            self.expect("]")?;
        }
        Ok(sizes)
    }

    pub(super) fn declarator(&mut self) -> Res<Declarator<'a>> {
        let name = self.name()?;
        let sizes = self.sizes()?;
        let init = if self.take("=") { Some(self.initializer()?) } else { None };
        Ok(Declarator { name, sizes, init })
    }

    fn block(&mut self, quals: Vec<Qual<'a>>) -> Res<Item<'a>> {
        let name = self.name()?;
        self.expect("{")?;
        let members = self.deeper(Self::members)?;
        let instance = if self.is(";") { None } else { Some((self.name()?, self.sizes()?)) };
        self.expect(";")?;
        Ok(Item::Block(Box::new(Block { quals, name, members, instance })))
    }

    fn function(&mut self, ty: TypeSpec<'a>) -> Res<Item<'a>> {
        let name: Name<'a> = self.name()?;
        self.expect("(")?;
        let params = self.params()?;
        let body = if self.take(";") {
            None
        } else {
            self.expect("{")?;
            Some(self.statements()?)
        };
        Ok(Item::Function(Box::new(Function { ty, name, params, body })))
    }

    fn params(&mut self) -> Res<Vec<Param<'a>>> {
        let mut params = Vec::new();
        if self.is_word("void") && self.ahead(1).kind == mark(")") {
            self.at += 2;
            return Ok(params);
        }
        if self.take(")") {
            return Ok(params);
        }
        loop {
            let quals = self.qualifiers()?;
            let ty = self.type_spec()?;
            let name = if self.token().kind == Kind::Word { Some(self.name()?) } else { None };
            let sizes = self.sizes()?;
            params.push(Param { quals, ty, name, sizes });
            if self.take(")") {
                return Ok(params);
            }
            self.expect(",")?;
        }
    }
}
