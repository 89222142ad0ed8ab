//! Checks the attributes of a text, since clang ignores those that it does not know.

use super::token::{Token, msl_tokens};
use lamplight_diagnostic::source::line_and_column;

/// What an attribute may have in its brackets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AttributeValue {
    Nothing,
    /// A number up to this one.
    Number(u32),
    Word(&'static [&'static str]),
    Name,
}

/// What an attribute may stand behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Behind {
    Parameter,
    Member,
    /// A parameter or a member.
    Either,
    /// A whole declaration: a function or a variable.
    Item,
}

use AttributeValue::{Name, Nothing, Number, Word};
use Behind::{Either, Item, Member, Parameter};

/// Slots of Metal's argument tables, and its limits for the rest, on macOS.
const BUFFERS: u32 = 30;
const TEXTURES: u32 = 127;
const SAMPLERS: u32 = 15;
const COLORS: u32 = 7;
const ATTRIBUTES: u32 = 30;

/// The attributes of the Metal Shading Language Specification that naga's writer uses.
const KNOWN: &[(&str, AttributeValue, Behind)] = &[
    ("amplification_id", Nothing, Parameter),
    ("attribute", Number(ATTRIBUTES), Member),
    ("barycentric_coord", Nothing, Either),
    ("base_instance", Nothing, Parameter),
    ("base_vertex", Nothing, Parameter),
    ("buffer", Number(BUFFERS), Parameter),
    ("center_no_perspective", Nothing, Member),
    ("center_perspective", Nothing, Member),
    ("centroid_no_perspective", Nothing, Member),
    ("centroid_perspective", Nothing, Member),
    ("clip_distance", Nothing, Member),
    ("color", Number(COLORS), Either),
    ("depth", Word(&["any", "greater", "less"]), Member),
    ("dispatch_threads_per_threadgroup", Nothing, Parameter),
    ("early_fragment_tests", Nothing, Item),
    ("flat", Nothing, Member),
    ("front_facing", Nothing, Parameter),
    ("index", Number(1), Either),
    ("function_constant", Number(65_535), Item),
    ("instance_id", Nothing, Parameter),
    ("invariant", Nothing, Member),
    ("max_total_threads_per_threadgroup", Number(1024), Item),
    ("point_coord", Nothing, Parameter),
    ("point_size", Nothing, Member),
    ("position", Nothing, Either),
    ("primitive_id", Nothing, Parameter),
    ("sample_id", Nothing, Parameter),
    ("sample_mask", Nothing, Either),
    ("sample_no_perspective", Nothing, Member),
    ("sample_perspective", Nothing, Member),
    ("sampler", Number(SAMPLERS), Parameter),
    ("simdgroup_index_in_threadgroup", Nothing, Parameter),
    ("simdgroups_per_threadgroup", Nothing, Parameter),
    ("stage_in", Nothing, Parameter),
    ("texture", Number(TEXTURES), Parameter),
    ("thread_index_in_simdgroup", Nothing, Parameter),
    ("thread_index_in_threadgroup", Nothing, Parameter),
    ("thread_position_in_grid", Nothing, Parameter),
    ("thread_position_in_threadgroup", Nothing, Parameter),
    ("threadgroup_position_in_grid", Nothing, Parameter),
    ("threadgroups_per_grid", Nothing, Parameter),
    ("threads_per_simdgroup", Nothing, Parameter),
    ("user", Name, Member),
    ("vertex_id", Nothing, Parameter),
];

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MslAttribute<'t> {
    pub name: &'t str,
    /// What is in its brackets.
    pub given: Option<&'t str>,
    /// First byte in the text.
    pub at: usize,
}

impl MslAttribute<'_> {
    /// The number in its brackets.
    pub fn number(&self) -> Option<u32> {
        self.given?.parse().ok()
    }
}

/// The attributes between `[[` and `]]`, whose first token is at `start`, and the index of the
/// token after them. `None` if there are no such brackets.
pub fn attribute_list<'t>(
    tokens: &[Token<'t>],
    start: usize,
) -> Option<(Vec<MslAttribute<'t>>, usize)> {
    if !opens_attributes(tokens, start) {
        return None;
    }
    let (mut found, mut at) = (Vec::new(), start + 2);
    while tokens.get(at)?.text != "]" {
        let token = tokens.get(at)?;
        at += 1;
        let mut given = None;
        if tokens.get(at)?.text == "(" {
            given = Some(tokens.get(at + 1)?.text);
            at += 2;
            if tokens.get(at)?.text != ")" {
                return None;
            }
            at += 1;
        }
        found.push(MslAttribute { name: token.text, given, at: token.at });
        match tokens.get(at)?.text {
            "," => at += 1,
            "]" => {}
            _ => return None,
        }
    }
    (tokens.get(at + 1)?.text == "]").then_some((found, at + 2))
}

/// Whether `[[` is there, without a space.
fn opens_attributes(tokens: &[Token<'_>], start: usize) -> bool {
    match tokens.get(start..start + 2) {
        Some([first, second]) => {
            first.text == "[" && second.text == "[" && first.end() == second.at
        }
        _ => false,
    }
}

/// The first mistake in the attributes of a text, in clang's format.
pub fn first_mistake(text: &str) -> Option<String> {
    let tokens = msl_tokens(text);
    let (mut brackets, mut braces) = (0u32, 0u32);
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        match token.text {
            "(" => brackets += 1,
            ")" => brackets = brackets.saturating_sub(1),
            "{" => braces += 1,
            "}" => braces = braces.saturating_sub(1),
            "[" if opens_attributes(&tokens, at) => {
                let behind = if brackets > 0 {
                    Parameter
                } else if braces > 0 {
                    Member
                } else {
                    Item
                };
                let Some((found, next)) = attribute_list(&tokens, at) else {
                    return Some(mistake_text(text, token.at, "an attribute is not well formed"));
                };
                let wrong = found.iter().find_map(|attribute| {
                    Some((attribute.at, wrong_attribute(attribute, behind)?))
                });
                if let Some((at, message)) = wrong {
                    return Some(mistake_text(text, at, &message));
                }
                at = next;
                continue;
            }
            _ => {}
        }
        at += 1;
    }
    None
}

fn mistake_text(text: &str, at: usize, message: &str) -> String {
    let (line, column) = line_and_column(text, at);
    format!("{line}:{column}: error: {message}")
}

fn wrong_attribute(attribute: &MslAttribute<'_>, behind: Behind) -> Option<String> {
    let name = attribute.name;
    let Some((_, given, place)) = KNOWN.iter().find(|(known, ..)| *known == name) else {
        return Some(format!("there is no attribute `{name}`"));
    };
    let is_right = match given {
        Nothing => attribute.given.is_none(),
        Number(most) => attribute.number().is_some_and(|number| number <= *most),
        Word(words) => attribute.given.is_some_and(|word| words.contains(&word)),
        Name => attribute.given.is_some(),
    };
    if !is_right {
        let found = attribute.given.map_or("nothing".to_owned(), |given| format!("`{given}`"));
        return Some(format!("the attribute `{name}` cannot be given {found}"));
    }
    let is_in_place = *place == behind || *place == Either && behind != Item;
    (!is_in_place).then(|| format!("the attribute `{name}` does not belong here"))
}
