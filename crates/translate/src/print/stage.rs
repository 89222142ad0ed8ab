//! What a stage takes and returns: variables of the stage in the place of parameters and results.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::facts::{Facts, StageField};
use super::names::Names;
use crate::tree::{Field, Function, Node, Stage, StageBinding, StagePlace, Type, kept_siblings};
use crate::wesl::untranslated;

/// What a stage returns.
#[derive(Debug, Clone)]
pub enum StageResult {
    Nothing,
    /// The output that the result goes to.
    One(String),
    /// Members, and whether each exists under all conditions.
    Fields(Vec<(bool, StageField)>),
}

/// Built-in values that a stage takes: the stage, the name, and the text.
const INPUTS: &[(Stage, &str, &str)] = &[
    (Stage::Vertex, "vertex_index", "uint(gl_VertexIndex)"),
    (Stage::Vertex, "instance_index", "uint(gl_InstanceIndex)"),
    (Stage::Fragment, "position", "gl_FragCoord"),
    (Stage::Fragment, "front_facing", "gl_FrontFacing"),
    (Stage::Fragment, "sample_index", "uint(gl_SampleID)"),
    (Stage::Compute, "local_invocation_id", "gl_LocalInvocationID"),
    (Stage::Compute, "local_invocation_index", "gl_LocalInvocationIndex"),
    (Stage::Compute, "global_invocation_id", "gl_GlobalInvocationID"),
    (Stage::Compute, "workgroup_id", "gl_WorkGroupID"),
    (Stage::Compute, "num_workgroups", "gl_NumWorkGroups"),
];

/// Built-in values that a stage returns.
const OUTPUTS: &[(Stage, &str, &str)] =
    &[(Stage::Vertex, "position", "gl_Position"), (Stage::Fragment, "frag_depth", "gl_FragDepth")];

/// Whether a field comes in or goes out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    In,
    Out,
}

impl Direction {
    fn word(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Out => "out",
        }
    }
}

/// The variables of a stage in one direction.
#[derive(Clone, Copy)]
pub struct Variables<'a> {
    pub stage: Stage,
    pub direction: Direction,
    pub names: &'a Names,
}

impl Variables<'_> {
    /// The text of a field of the stage in expressions.
    pub fn one(&self, name: &str, place: &StagePlace, span: Span) -> Result<String, Diagnostic> {
        match place {
            StagePlace::Location(_) => {
                Ok(self.names.invented(&format!("{}_{name}", self.direction.word())))
            }
            StagePlace::Builtin(builtin) => {
                let table = if self.direction == Direction::In { INPUTS } else { OUTPUTS };
                let found =
                    table.iter().find(|(of, known, _)| *of == self.stage && known == builtin);
                let (.., text) = found.ok_or_else(|| {
                    untranslated(span, format!("the built-in value `{builtin}` here"))
                })?;
                Ok((*text).to_owned())
            }
        }
    }

    /// The members of a structure of the stage.
    pub fn fields(&self, members: &[Node<Field>]) -> Result<Vec<StageField>, Diagnostic> {
        let mut fields = Vec::new();
        for node in members {
            let Field { name, binding, span, ty: _ } = &node.body;
            let Some(binding) = binding else {
                return Err(untranslated(*span, "a member of a stage without a place"));
            };
            let variable = self.one(name, &binding.place, *span)?;
            fields.push(StageField { name: name.clone(), variable });
        }
        Ok(fields)
    }

    /// The declaration of a variable.
    pub fn declaration(&self, field: &Field) -> Result<String, Diagnostic> {
        let Some(StageBinding { place, interpolation, invariant }) = &field.binding else {
            return Err(untranslated(field.span, "a field of a stage without a location"));
        };
        let variable = self.one(&field.name, place, field.span)?;
        let location = match place {
            StagePlace::Location(location) => location,
            StagePlace::Builtin(_) if *invariant => return Ok(format!("invariant {variable};")),
            StagePlace::Builtin(_) => return Ok(String::new()),
        };
        let mut words = String::new();
        let is_varying = (self.stage, self.direction) != (Stage::Vertex, Direction::In)
            && (self.stage, self.direction) != (Stage::Fragment, Direction::Out);
        if let Some(found) = interpolation.as_ref().filter(|_| is_varying) {
            words += match found.kind.as_str() {
                "flat" => "flat ",
                "linear" => "noperspective ",
                _ => "",
            };
            words += match found.sampling.as_deref() {
                Some("centroid") => "centroid ",
                Some("sample") => "sample ",
                _ => "",
            };
        }
        let (ty, lengths) = self.names.declared_type(&field.ty, field.span)?;
        let word = self.direction.word();
        Ok(format!("layout(location = {location}) {words}{word} {ty} {variable}{lengths};"))
    }
}

/// Where the result of a stage goes.
pub fn stage_result(
    function: &Function,
    stage: Stage,
    facts: &Facts,
    names: &Names,
) -> Result<StageResult, Diagnostic> {
    let variables = Variables { stage, direction: Direction::Out, names };
    let Some(field) = &function.result else { return Ok(StageResult::Nothing) };
    if let (Type::Structure(path), None) = (&field.ty, &field.binding) {
        let members = facts.stage_members(path);
        let fields = variables.fields(members)?;
        let always = members.iter().map(|node| node.branch.is_none());
        return Ok(StageResult::Fields(always.zip(fields).collect()));
    }
    let Some(binding) = &field.binding else {
        return Err(untranslated(field.span, "a result of a stage without a place"));
    };
    let name = result_name(&binding.place);
    Ok(StageResult::One(variables.one(&name, &binding.place, field.span)?))
}

/// The name of an output that has none: `color` for the first one.
fn result_name(place: &StagePlace) -> String {
    match place {
        StagePlace::Location(0) => "color".to_owned(),
        StagePlace::Location(location) => format!("color{location}"),
        StagePlace::Builtin(name) => name.clone(),
    }
}

/// The declarations of what a stage takes or returns, as fields with their conditions. Built-in
/// values need none.
pub fn declared_fields(
    function: &Function,
    facts: &Facts,
    direction: Direction,
) -> Vec<Node<Field>> {
    let fields: Vec<Node<Field>> = match direction {
        Direction::In => function.parameters.clone(),
        Direction::Out => function
            .result
            .iter()
            .map(|field| {
                let mut body = field.clone();
                if let Some(binding) = &body.binding {
                    body.name = result_name(&binding.place);
                }
                let span = body.span;
                Node { lead: Vec::new(), branch: None, body, trail: None, span }
            })
            .collect(),
    };
    let mut declared = Vec::new();
    for node in fields {
        match (&node.body.ty, &node.body.binding) {
            (Type::Structure(path), None) => declared.extend_from_slice(facts.stage_members(path)),
            _ => declared.push(node),
        }
    }
    let mut declared = kept_siblings(&declared, |node| match &node.body.binding {
        Some(StageBinding { place: StagePlace::Location(_), .. }) => true,
        Some(StageBinding { invariant, .. }) => *invariant && direction == Direction::Out,
        None => false,
    });
    for node in &mut declared {
        node.lead.clear();
    }
    declared
}
