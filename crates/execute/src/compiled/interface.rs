//! Reads from a text what its entry point takes and returns.

use lamplight_bundle::Stage;
use lamplight_tools::metal::attributes::{MslAttribute, attribute_list};
use lamplight_tools::metal::token::{Token, msl_tokens};

/// What a parameter or a member stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InterfaceRole {
    /// The struct of the stage's inputs: `[[stage_in]]`.
    StageIn,
    Buffer(u32),
    Texture(u32),
    Sampler(u32),
    /// An attribute of a vertex, a value between the stages, or a colour.
    Location(u32),
    Position,
    Depth,
    FrontFacing,
    VertexIndex,
    InstanceIndex,
    /// The number of the sample, of which a pixel has one.
    SampleIndex,
    /// The samples that are covered, as an input.
    SampleMask,
    /// Memory that the threads of a threadgroup share. It has no attribute.
    Threadgroup,
    /// A number that an invocation of a compute stage is given, or three of them.
    Invocation(&'static str),
}

/// A parameter or a member with its attributes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InterfaceMember {
    pub name: String,
    pub role: InterfaceRole,
    /// Whether it is not interpolated (`[[flat]]`).
    pub is_flat: bool,
    /// The type, of memory that is shared.
    pub ty: String,
}

/// One entry point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interface {
    pub stage: Stage,
    pub name: String,
    pub parameters: Vec<InterfaceMember>,
    /// The struct of its `[[stage_in]]` parameter: name and members.
    pub input: Option<(String, Vec<InterfaceMember>)>,
    /// The members of its result.
    pub output: Vec<InterfaceMember>,
}

impl Interface {
    /// Reads the only entry point of a text. The error says what is not understood.
    pub fn read(text: &str) -> Result<Self, String> {
        let tokens = msl_tokens(text);
        let stages =
            [("vertex", Stage::Vertex), ("fragment", Stage::Fragment), ("kernel", Stage::Compute)];
        let found = tokens.iter().enumerate().find_map(|(at, token)| {
            let (_, stage) = stages.iter().find(|(name, _)| *name == token.text)?;
            Some((at, *stage))
        });
        let (at, stage) = found.ok_or("there is no entry point")?;
        let [returned, name, "("] = token_texts(&tokens, at + 1)? else {
            return Err(format!("`{}` is not followed by a function", tokens[at].text));
        };
        let mut parameters = Vec::new();
        let mut input = None;
        for parameter in separated_parts(&tokens, at + 4, (",", ")"))? {
            let part = read_part(&parameter)?;
            if part.role == InterfaceRole::StageIn {
                let name = parameter.first().map_or("", |token| token.text);
                input = Some((name.to_owned(), struct_members(&tokens, name)?));
            }
            parameters.push(part);
        }
        let output =
            if returned == "void" { Vec::new() } else { struct_members(&tokens, returned)? };
        if let Some(mask) = output.iter().find(|part| part.role == InterfaceRole::SampleMask) {
            return Err(format!("`{}` is a `sample_mask` that is written", mask.name));
        }
        Ok(Self { stage, name: name.to_owned(), parameters, input, output })
    }

    /// The parameters that are memory of the threadgroup.
    pub fn shared(&self) -> impl Iterator<Item = &InterfaceMember> {
        self.parameters.iter().filter(|part| part.role == InterfaceRole::Threadgroup)
    }

    /// How many locations its inputs have, and its outputs.
    pub fn locations(&self) -> (u32, u32) {
        let count = |parts: &[InterfaceMember]| {
            let locations = parts.iter().filter_map(|part| match part.role {
                InterfaceRole::Location(location) => Some(location + 1),
                _ => None,
            });
            locations.max().unwrap_or(0)
        };
        (self.input.as_ref().map_or(0, |(_, members)| count(members)), count(&self.output))
    }
}

fn token_texts<'t, const N: usize>(
    tokens: &[Token<'t>],
    at: usize,
) -> Result<[&'t str; N], String> {
    let found = tokens.get(at..at + N).ok_or("the text ends too early")?;
    Ok(std::array::from_fn(|index| found[index].text))
}

fn struct_members(tokens: &[Token<'_>], name: &str) -> Result<Vec<InterfaceMember>, String> {
    let declared =
        |at: &usize| token_texts(tokens, *at).is_ok_and(|found| found == ["struct", name, "{"]);
    let at = (0..tokens.len()).find(declared).ok_or_else(|| format!("there is no `{name}`"))?;
    separated_parts(tokens, at + 3, (";", "}"))?.iter().map(|part| self::read_part(part)).collect()
}

/// The tokens between separators, up to the end.
fn separated_parts<'t>(
    tokens: &[Token<'t>],
    start: usize,
    (separator, end): (&str, &str),
) -> Result<Vec<Vec<Token<'t>>>, String> {
    let (mut parts, mut part, mut depth) = (Vec::new(), Vec::new(), 0u32);
    for token in tokens.iter().skip(start) {
        let is_outside = depth == 0 && (token.text == separator || token.text == end);
        if is_outside && !part.is_empty() {
            parts.push(std::mem::take(&mut part));
        } else if !is_outside {
            part.push(*token);
        }
        match token.text {
            text if depth == 0 && text == end => return Ok(parts),
            "<" | "(" | "[" => depth += 1,
            ">" | ")" | "]" => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    Err("the text ends too early".to_owned())
}

/// A parameter or a member. The last word before its attributes is its name.
fn read_part(tokens: &[Token<'_>]) -> Result<InterfaceMember, String> {
    let at = (0..tokens.len()).find(|at| attribute_list(tokens, *at).is_some());
    let Some((at, (attributes, _))) = at.and_then(|at| Some((at, attribute_list(tokens, at)?)))
    else {
        return shared_memory(tokens);
    };
    let name = tokens[..at].last().map_or("", |token| token.text).to_owned();
    let role = attributes.iter().find_map(attribute_role).ok_or_else(|| {
        let names: Vec<&str> = attributes.iter().map(|attribute| attribute.name).collect();
        format!("`{name}` is `{}`, which nothing stands for on the CPU", names.join(", "))
    })?;
    let is_flat = attributes.iter().any(|attribute| attribute.name == "flat");
    Ok(InterfaceMember { name, role, is_flat, ty: String::new() })
}

/// A parameter `threadgroup TYPE& NAME`.
fn shared_memory(tokens: &[Token<'_>]) -> Result<InterfaceMember, String> {
    let words: Vec<&str> = tokens.iter().map(|token| token.text).collect();
    match words.as_slice() {
        ["threadgroup", ty @ .., "&", name] => Ok(InterfaceMember {
            name: (*name).to_owned(),
            role: InterfaceRole::Threadgroup,
            is_flat: false,
            ty: ty.concat(),
        }),
        _ => Err(format!("`{}` has no attribute", words.join(" "))),
    }
}

fn attribute_role(attribute: &MslAttribute<'_>) -> Option<InterfaceRole> {
    let user = || attribute.given?.strip_prefix("loc")?.parse().ok();
    match attribute.name {
        "stage_in" => Some(InterfaceRole::StageIn),
        "buffer" => attribute.number().map(InterfaceRole::Buffer),
        "texture" => attribute.number().map(InterfaceRole::Texture),
        "sampler" => attribute.number().map(InterfaceRole::Sampler),
        "attribute" | "color" => attribute.number().map(InterfaceRole::Location),
        "user" => user().map(InterfaceRole::Location),
        "position" => Some(InterfaceRole::Position),
        "depth" => Some(InterfaceRole::Depth),
        "front_facing" => Some(InterfaceRole::FrontFacing),
        "vertex_id" => Some(InterfaceRole::VertexIndex),
        "instance_id" => Some(InterfaceRole::InstanceIndex),
        "sample_id" => Some(InterfaceRole::SampleIndex),
        "sample_mask" => Some(InterfaceRole::SampleMask),
        "thread_position_in_grid" => Some(InterfaceRole::Invocation("global")),
        "thread_position_in_threadgroup" => Some(InterfaceRole::Invocation("local")),
        "thread_index_in_threadgroup" => Some(InterfaceRole::Invocation("index")),
        "threadgroup_position_in_grid" => Some(InterfaceRole::Invocation("group")),
        "threadgroups_per_grid" => Some(InterfaceRole::Invocation("groups")),
        "threads_per_threadgroup" => Some(InterfaceRole::Invocation("size")),
        _ => None,
    }
}
