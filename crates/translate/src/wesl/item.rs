//! Global declarations.

use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_syntax::wesl::{self, Chain, ItemKind, ItemPlace, Origin};

use super::lines::trim_blank;
use super::ty::plain_type;
use super::{Reader, new_chain};
use crate::tree::{Branch, Constant, Expression, ExpressionKind, Field, Function, Import, Item};
use crate::tree::{Interpolation, ItemPath, Line, Module, Node, NumberValue, Space, Stage};
use crate::tree::{StageBinding, StagePlace, Structure, Type, Variable};

/// Reads the items at some places as a module.
pub fn read_items(
    reader: &mut Reader<'_>,
    path: &[String],
    places: &[ItemPlace],
) -> Result<Module, Diagnostics> {
    let mut errors = Vec::new();
    let mut items = Vec::new();
    let is_flat = !has_blocks(reader, places);
    for (index, place) in places.iter().enumerate() {
        match item_node(reader, index, *place, is_flat) {
            Ok(node) => items.push(node),
            Err(error) => errors.push(error),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let behind = places.last().map_or(0, |place| place.end);
    let end = trim_blank(reader.lines_before(behind.max(reader.tokens.len())));
    let doc = module_doc(reader.tokens.text);
    let imports = read_imports(reader, path);
    let source = reader.tokens.source;
    Ok(Module { path: path.to_vec(), source, doc, imports, items, end })
}

/// Whether a declaration stands in braces.
fn has_blocks(reader: &Reader<'_>, places: &[ItemPlace]) -> bool {
    let outside: Vec<usize> = (0..reader.tokens.len())
        .filter(|at| reader.tokens.is(*at, b'{'))
        .filter(|at| places.iter().all(|place| !(place.start..place.end).contains(at)))
        .collect();
    let in_braces = |place: &ItemPlace| {
        outside.iter().any(|open| (*open..reader.tokens.partner(*open)).contains(&place.start))
    };
    places.iter().any(in_braces)
}

/// The text of the lines that begin with `//!`.
fn module_doc(text: &str) -> Vec<String> {
    let head = text.lines().take_while(|line| line.trim().is_empty() || line.starts_with("//"));
    let lines = head.filter_map(|line| line.strip_prefix("//!"));
    lines.map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned()).collect()
}

fn read_imports(reader: &Reader<'_>, path: &[String]) -> Vec<Import> {
    let names = reader.tokens.names;
    let made = |import: &wesl::Import| {
        let mut segments: Vec<String> = match import.path.origin {
            Origin::Package | Origin::Scope => Vec::new(),
            Origin::Super(ups) => path[..path.len().saturating_sub(ups as usize)].to_vec(),
        };
        segments.extend(import.path.segments.iter().map(|name| names.text(*name).to_owned()));
        let name = segments.pop().unwrap_or_default();
        let condition = import.condition.map(|id| reader.table.whole(id, names));
        let path = ItemPath { module: segments, name };
        Import { condition, path, alias: names.text(import.alias).to_owned() }
    };
    reader.table.module.imports.iter().map(made).collect()
}

fn item_node(
    reader: &mut Reader<'_>,
    index: usize,
    place: ItemPlace,
    is_flat: bool,
) -> Result<Node<Item>, Diagnostic> {
    let (kind, condition) = {
        let item = &reader.table.module.items[index];
        (item.kind, item.condition)
    };
    let names = reader.tokens.names;
    let branch = condition.map(|id| match is_flat {
        true => reader.table.branch(id, names),
        false => Branch::If(reader.table.whole(id, names)),
    });
    let mut lead = match index {
        0 => reader.comments_within(0, place.start),
        _ => Vec::new(),
    };
    lead.extend(reader.lines_before(place.start));
    if index == 0 {
        lead.dedup();
        lead.retain(|line| !matches!(line, Line::Comment(text) if text.starts_with("//!")));
    }
    lead.extend(reader.comments_within(place.start, place.keyword + 1));
    let attributes = read_attributes(reader, place)?;
    reader.at = place.keyword;
    let body = read_item(reader, kind, &attributes, place)?;
    if !matches!(kind, ItemKind::Function | ItemKind::Struct) {
        lead.extend(reader.comments_within(place.keyword, place.end));
    }
    let trail = reader.comment_behind(place.end);
    reader.at = place.end;
    while lead.last() == Some(&Line::Blank) {
        lead.pop();
    }
    Ok(Node { lead, branch, body, trail, span: reader.span_from(place.keyword) })
}

/// The attributes of a node, by name, with their arguments.
type AttributeList = Vec<(String, Vec<Expression>)>;

fn read_attributes(reader: &mut Reader<'_>, place: ItemPlace) -> Result<AttributeList, Diagnostic> {
    attributes_between(reader, place.start, place.keyword)
}

fn attributes_between(
    reader: &mut Reader<'_>,
    start: usize,
    end: usize,
) -> Result<AttributeList, Diagnostic> {
    let mut found = Vec::new();
    reader.at = start;
    while reader.at < end && reader.is(b'@') {
        reader.at += 1;
        let name = reader.text().to_owned();
        reader.at += 1;
        let close = reader.is(b'(').then(|| reader.partner());
        let mut arguments = Vec::new();
        let is_known = !matches!(name.as_str(), "if" | "elif" | "else" | "diagnostic");
        if let Some(close) = close {
            reader.at += 1;
            while is_known && reader.at < close {
                arguments.push(reader.expression()?);
                reader.take(b',');
            }
            reader.at = close + 1;
        }
        if is_known {
            found.push((name, arguments));
        }
    }
    Ok(found)
}

fn read_item(
    reader: &mut Reader<'_>,
    kind: ItemKind,
    attributes: &AttributeList,
    place: ItemPlace,
) -> Result<Item, Diagnostic> {
    if kind == ItemKind::ConstAssert {
        reader.at = place.end;
        let span = reader.span_from(place.keyword);
        let text = &reader.tokens.text[span.start as usize..span.end as usize];
        return Ok(Item::Assertion(text.to_owned()));
    }
    let name_at = match kind {
        ItemKind::Var => wesl::after_template(reader.tokens, place.keyword + 1),
        _ => place.keyword + 1,
    };
    let name = reader.tokens.text(name_at).to_owned();
    if plain_type(&name).is_some() {
        let what = format!("`{name}`, a name that is a type of the language");
        return Err(reader.untranslated(reader.tokens.span(name_at), &what));
    }
    match kind {
        ItemKind::Function => read_function(reader, name, attributes),
        ItemKind::Struct => read_structure(reader, name),
        ItemKind::Const | ItemKind::Override => read_constant(reader, name, attributes, kind),
        ItemKind::Var => read_variable(reader, name, attributes, name_at),
        ItemKind::Alias => {
            reader.at += 2;
            reader.expect(b'=')?;
            Ok(Item::Alias(name, reader.ty()?))
        }
        ItemKind::ConstAssert => Ok(Item::Assertion(String::new())),
    }
}

fn read_function(
    reader: &mut Reader<'_>,
    name: String,
    attributes: &AttributeList,
) -> Result<Item, Diagnostic> {
    let mut stage = None;
    let mut workgroup = Vec::new();
    let span = reader.tokens.span(reader.at + 1);
    for (attribute, arguments) in attributes {
        match attribute.as_str() {
            "vertex" => stage = Some(Stage::Vertex),
            "fragment" => stage = Some(Stage::Fragment),
            "compute" => stage = Some(Stage::Compute),
            "workgroup_size" => workgroup.clone_from(arguments),
            _ => {}
        }
    }
    reader.at += 2;
    let close = reader.partner();
    let is_broken = reader.begins_line(reader.at + 1);
    reader.at += 1;
    let parameters = read_fields(reader, close)?.0;
    reader.at = close + 1;
    let mut result = None;
    if reader.tokens.kind(reader.at) == Some(wesl::TokenKind::Arrow) {
        reader.at += 1;
        let first = reader.at;
        let end = after_attributes(reader, first);
        let attributes = attributes_between(reader, first, end)?;
        reader.at = end;
        let binding = stage_binding(reader, &attributes, first)?;
        let ty = reader.ty()?;
        result = Some(Field { name: String::new(), ty, binding, span: reader.span_from(end) });
    }
    let body = reader.block()?;
    Ok(Item::Function(Function {
        name,
        stage,
        workgroup,
        parameters,
        is_broken,
        result,
        body,
        span,
    }))
}

/// The index after the attributes that begin at a token.
fn after_attributes(reader: &Reader<'_>, first: usize) -> usize {
    let mut at = first;
    while reader.tokens.is(at, b'@') {
        at += 2;
        if reader.tokens.is(at, b'(') {
            at = reader.tokens.partner(at) + 1;
        }
    }
    at
}

fn read_structure(reader: &mut Reader<'_>, name: String) -> Result<Item, Diagnostic> {
    reader.at += 2;
    if !reader.is(b'{') {
        return Err(reader.tokens.expected(reader.at, "`{` and the members"));
    }
    let close = reader.partner();
    reader.at += 1;
    let (members, end) = read_fields(reader, close)?;
    reader.at = close + 1;
    Ok(Item::Structure(Structure { name, members, end }))
}

/// Parameters or members before a closing bracket, and the comments after the last one.
fn read_fields(
    reader: &mut Reader<'_>,
    close: usize,
) -> Result<(Vec<Node<Field>>, Vec<Line>), Diagnostic> {
    let mut fields: Vec<Node<Field>> = Vec::new();
    let mut chain: Chain = new_chain();
    while reader.at < close {
        let first = reader.at;
        let mut lead = reader.lines_before(first);
        if fields.is_empty() {
            lead.splice(0..0, reader.comment_behind(first).map(Line::Comment));
        }
        let (branch, start) = reader.node_branch(&mut chain)?;
        lead.extend(reader.comments_within(first, start + usize::from(start > first)));
        let attributes = attributes_between(reader, first, start)?;
        let binding = stage_binding(reader, &attributes, first)?;
        reader.at = start;
        let name = reader.identifier("a name")?;
        let span = reader.span_from(start);
        reader.expect(b':')?;
        let ty = reader.ty()?;
        lead.extend(reader.comments_within(start, reader.at));
        let has_comma = reader.take(b',');
        if !has_comma && reader.at != close {
            return Err(reader.tokens.expected(reader.at, "`,`"));
        }
        let trail = reader.comment_behind(reader.at);
        let lead = if fields.is_empty() { trim_blank(lead) } else { lead };
        let body = Field { name, ty, binding, span };
        fields.push(Node { lead, branch, body, trail, span });
    }
    let end = trim_blank(reader.lines_before(close));
    Ok((fields, end))
}

/// How a field meets what is outside of its stage.
fn stage_binding(
    reader: &Reader<'_>,
    attributes: &AttributeList,
    at: usize,
) -> Result<Option<StageBinding>, Diagnostic> {
    let (mut place, mut interpolation, mut invariant) = (None, None, false);
    for (name, arguments) in attributes {
        let word = |index: usize| arguments.get(index).and_then(word_of);
        match name.as_str() {
            "location" => place = arguments.first().and_then(number_of).map(StagePlace::Location),
            "builtin" => place = word(0).map(StagePlace::Builtin),
            "interpolate" => {
                let kind = word(0).unwrap_or_default();
                interpolation = Some(Interpolation { kind, sampling: word(1) });
            }
            "invariant" => invariant = true,
            _ => {
                let what = format!("the attribute `@{name}`");
                return Err(reader.untranslated(reader.tokens.span(at), &what));
            }
        }
    }
    let needs_place = attributes.iter().any(|(name, _)| name == "location" || name == "builtin");
    if needs_place && place.is_none() {
        return Err(reader.untranslated(reader.tokens.span(at), "a location that is no number"));
    }
    Ok(place.map(|place| StageBinding { place, interpolation, invariant }))
}

fn word_of(argument: &Expression) -> Option<String> {
    match &argument.kind {
        ExpressionKind::Name(name, _) => Some(name.clone()),
        _ => None,
    }
}

fn number_of(argument: &Expression) -> Option<u32> {
    match &argument.bare().kind {
        ExpressionKind::Number(number) => match number.value {
            NumberValue::Integer(value) => u32::try_from(value).ok(),
            NumberValue::Float(_) => None,
        },
        _ => None,
    }
}

fn read_constant(
    reader: &mut Reader<'_>,
    name: String,
    attributes: &AttributeList,
    kind: ItemKind,
) -> Result<Item, Diagnostic> {
    let name_at = reader.at + 1;
    reader.at += 2;
    let span = reader.tokens.span(name_at);
    let given = reader.take(b':').then(|| reader.ty()).transpose()?;
    if !reader.take(b'=') {
        return Err(reader.untranslated(span, "an `override` without a value"));
    }
    let value = reader.expression()?;
    let id = attributes.iter().find(|(name, _)| name == "id");
    let id = id.and_then(|(_, arguments)| arguments.first()).and_then(number_of);
    if kind == ItemKind::Override && id.is_none() {
        return Err(reader.untranslated(span, "an `override` without `@id`"));
    }
    Ok(Item::Constant(Constant { name, given, value, id, span }))
}

fn read_variable(
    reader: &mut Reader<'_>,
    name: String,
    attributes: &AttributeList,
    name_at: usize,
) -> Result<Item, Diagnostic> {
    let words: Vec<&str> =
        (reader.at + 1..name_at).map(|at| reader.tokens.text(at)).filter(|w| *w != ",").collect();
    let space = match words.as_slice() {
        [] => Space::Handle,
        ["<", "uniform", ..] => Space::Uniform,
        ["<", "storage", access, ..] => Space::Storage { is_written: *access == "read_write" },
        ["<", "private", ..] => Space::Private,
        ["<", "workgroup", ..] => Space::Workgroup,
        _ => return Err(reader.untranslated(reader.here(), "this address space")),
    };
    reader.at = name_at + 1;
    let span = reader.tokens.span(name_at);
    let given = reader.take(b':').then(|| reader.ty()).transpose()?;
    let value = reader.take(b'=').then(|| reader.expression()).transpose()?;
    let number = |wanted: &str| {
        let found = attributes.iter().find(|(name, _)| name == wanted);
        found.and_then(|(_, arguments)| arguments.first()).and_then(number_of)
    };
    let binding = number("group").zip(number("binding"));
    let ty = given.unwrap_or(Type::Unknown);
    Ok(Item::Variable(Variable { name, space, ty, binding, value, span }))
}
