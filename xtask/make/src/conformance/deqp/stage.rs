//! Makes shaders of the texts of a case. Inputs are uniforms, as they are the same for every vertex and
//! every fragment of dEQP's pictures; each output goes to locations of the stage.

use lamplight::bundle::Stage;

use super::parse::{Case, CaseValue, Role, shape_of};

/// The texts that are compiled and run together: one stage, or a vertex stage and a fragment stage.
#[derive(Debug, PartialEq)]
pub struct Shaders {
    pub stages: Vec<(Stage, String)>,
}

/// What a stage has to declare and to write.
struct Frame<'c> {
    stage: Stage,
    case: &'c Case,
    /// Whether the text is in GLSL ES 1.00 or in GLSL 1.20, which have no integers between stages.
    is_old: bool,
}

/// The shaders of a case, or why there are none.
pub fn shaders_of(case: &Case) -> Result<Vec<Shaders>, &'static str> {
    if case.is_pipeline {
        return Err("a pipeline of programs that are linked one by one");
    }
    let texts_of = |word: &str| -> Vec<&str> {
        let named = case.texts.iter().filter(|(found, _)| found == word);
        named.map(|(_, text)| text.as_str()).collect()
    };
    if let [both] = texts_of("both")[..] {
        let of = |stage| Shaders { stages: vec![(stage, specialised(both, stage, case))] };
        return Ok(vec![of(Stage::Vertex), of(Stage::Fragment)]);
    }
    const WORDS: [(&str, Stage); 3] =
        [("vertex", Stage::Vertex), ("fragment", Stage::Fragment), ("compute", Stage::Compute)];
    let mut stages = Vec::new();
    for (word, stage) in WORDS {
        match texts_of(word)[..] {
            [] => {}
            [text] => stages.push((stage, specialised(text, stage, case))),
            _ => return Err("a stage of several texts"),
        }
    }
    match stages.len() == case.texts.len() {
        true => Ok(vec![Shaders { stages }]),
        false => Err("a stage that WGSL does not have"),
    }
}

/// The version of a text, by its `#version` line.
fn is_old(text: &str) -> bool {
    let number = text.split("#version").nth(1).and_then(|rest| rest.split_whitespace().next());
    number.and_then(|number| number.parse().ok()).is_none_or(|number: u32| number < 130)
}

/// A text with its place holders filled.
fn specialised(text: &str, stage: Stage, case: &Case) -> String {
    let frame = Frame { stage, case, is_old: is_old(text) };
    let color = frame.color();
    let position = if stage == Stage::Vertex { "gl_Position" } else { color };
    let set_position = "gl_Position = dEQP_Position;";
    let inputs = frame.inputs(text, &[Role::Input, Role::Uniform]);
    let needs_color = text.contains("FRAG_COLOR}") || text.contains("dEQP_FragColor");
    let (outputs, written) = (frame.outputs(needs_color), frame.output());
    let declared = format!("{}{outputs}", frame.inputs(text, &[Role::Uniform]));
    let one_line = |text: &str| text.replace('\n', " ");
    let all = format!("{inputs}{outputs}");
    let places: [(&str, &str); 12] = [
        ("${DECLARATIONS}", &all),
        ("${DECLARATIONS:single-line}", &one_line(&all)),
        ("${VERTEX_DECLARATIONS}", &inputs),
        ("${FRAGMENT_DECLARATIONS}", &declared),
        ("${SETUP}", ""),
        ("${VERTEX_SETUP}", ""),
        ("${OUTPUT}", &written),
        ("${VERTEX_OUTPUT}", set_position),
        ("${FRAGMENT_OUTPUT}", &written),
        ("${FRAG_COLOR}", color),
        ("${POSITION_FRAG_COLOR}", position),
        ("${FRAG_PRECISION}", "highp"),
    ];
    // A `#version` must be in the first line. A text for OpenGL ES 2 without it is of version 1.00.
    let mut made = text.trim_start().to_owned();
    let has_place = !["#version", "__LINE__"].iter().any(|word| text.contains(word));
    if case.name.starts_with("data.gles2.") && has_place {
        made.insert_str(0, "#version 100\n");
    }
    for (place, content) in places {
        made = made.replace(place, content);
    }
    let extensions: Vec<&str> = frame.extensions().collect();
    for name in extensions.iter().rev() {
        let at = if made.starts_with("#version") { made.find('\n') } else { None };
        let at = at.map_or(0, |at| at + 1);
        made.insert_str(at, &format!("#extension {name} : require\n"));
    }
    made
}

/// One location of a stage's outputs: the numbers of a variable, or of a column of a matrix.
struct Slot<'c> {
    /// The word for four of its kind.
    four: &'static str,
    /// As it is read.
    from: String,
    value: &'c CaseValue,
    rows: u32,
}

impl<'c> Frame<'c> {
    fn of_role(&self, role: Role) -> impl Iterator<Item = &'c CaseValue> + use<'c> {
        self.case.values.iter().filter(move |value| value.role == role)
    }

    /// The name of the colour.
    fn color(&self) -> &'static str {
        if self.is_old { "gl_FragColor" } else { "dEQP_FragColor" }
    }

    fn extensions(&self) -> impl Iterator<Item = &'c str> {
        let word = match self.stage {
            Stage::Vertex => "vertex",
            Stage::Fragment => "fragment",
            Stage::Compute => "compute",
        };
        let extensions = self.case.extensions.iter();
        let asked = extensions.filter(move |(_, stages)| stages.iter().any(|stage| stage == word));
        asked.map(|(name, _)| name.as_str())
    }

    /// The variables of these roles that the text does not declare itself.
    fn inputs(&self, source: &str, roles: &[Role]) -> String {
        let declare = |value: &CaseValue| {
            format!("uniform {}{} {};\n", precision_of(&value.ty), value.ty, value.name)
        };
        let is_declared = |value: &CaseValue| {
            let end = format!(" {};", value.name);
            source.lines().any(|line| line.contains("uniform ") && line.contains(&end))
        };
        let is_open = |value: &&CaseValue| !value.name.contains(['.', '[']) && !is_declared(value);
        let values = roles.iter().flat_map(|role| self.of_role(*role)).filter(is_open);
        let mut text: String = values.map(declare).collect();
        if self.stage == Stage::Vertex {
            let word = if self.is_old { "attribute" } else { "in" };
            text += &format!("{word} highp vec4 dEQP_Position;\n");
        }
        text
    }

    fn slots(&self) -> Vec<Slot<'c>> {
        let mut slots = Vec::new();
        for value in self.of_role(Role::Output) {
            let Some((columns, rows)) = shape_of(&value.ty) else { continue };
            let four = match value.ty.chars().next() {
                Some('i') if !self.is_old => "ivec4",
                Some('u') if !self.is_old => "uvec4",
                _ => "vec4",
            };
            for column in 0..columns {
                let from = match columns {
                    1 => value.name.clone(),
                    _ => format!("{}[{column}]", value.name),
                };
                slots.push(Slot { four, from, value, rows });
            }
        }
        slots
    }

    /// The variables that the text computes, and the stage's outputs for them.
    fn outputs(&self, needs_color: bool) -> String {
        let mut text = String::new();
        for value in self.of_role(Role::Output) {
            text += &format!("{}{} {};\n", precision_of(&value.ty), value.ty, value.name);
        }
        let slots = self.slots();
        let is_fragment = self.stage == Stage::Fragment;
        if is_fragment && !self.is_old && (needs_color || slots.is_empty()) {
            text += "layout(location = 0) out highp vec4 dEQP_FragColor;\n";
        }
        for (at, slot) in slots.iter().enumerate() {
            text += &match (self.is_old, self.stage) {
                (true, Stage::Vertex) => format!("varying highp vec4 deqp_{at};\n"),
                (true, _) => String::new(),
                (false, Stage::Vertex) => {
                    format!("flat out highp {} deqp_{at};\n", slot.four)
                }
                (false, _) => {
                    format!("layout(location = {at}) out highp {} deqp_{at};\n", slot.four)
                }
            };
        }
        text
    }

    /// The statements at the end of the stage.
    fn output(&self) -> String {
        let slots = self.slots();
        let is_vertex = self.stage == Stage::Vertex;
        let mut text = if is_vertex { "gl_Position = dEQP_Position;" } else { "" }.to_owned();
        if slots.is_empty() && !is_vertex {
            text += &format!("{} = vec4(1.0);", self.color());
        }
        for (at, slot) in slots.iter().enumerate() {
            let to = match (self.is_old, is_vertex) {
                (true, false) => format!("gl_FragData[{at}]"),
                _ => format!("deqp_{at}"),
            };
            text += &format!(" {to} = {};", slot.expression());
        }
        text
    }
}

impl Slot<'_> {
    /// The numbers as four of their kind.
    fn expression(&self) -> String {
        let scalar = match self.four {
            "ivec4" => "int",
            "uvec4" => "uint",
            _ => "float",
        };
        let number = |at: u32| match self.rows {
            1 => format!("{scalar}({})", self.from),
            _ => format!("{scalar}({}[{at}])", self.from),
        };
        let zero = || format!("{scalar}(0)");
        let numbers: Vec<String> =
            (0..4).map(|at| if at < self.rows { number(at) } else { zero() }).collect();
        format!("{}({})", self.four, numbers.join(", "))
    }
}

/// The outputs' numbers at each location, in the order of [`CaseValue`]s: their variable, the first
/// number of it that the location has, and how many.
pub fn locations_of(case: &Case) -> Vec<(&CaseValue, usize, usize)> {
    let frame = Frame { stage: Stage::Fragment, case, is_old: false };
    let mut first = 0;
    let mut last: Option<&CaseValue> = None;
    let mut places = Vec::new();
    for slot in frame.slots() {
        if !last.is_some_and(|last| std::ptr::eq(last, slot.value)) {
            first = 0;
        }
        last = Some(slot.value);
        places.push((slot.value, first, slot.rows as usize));
        first += slot.rows as usize;
    }
    places
}

fn precision_of(ty: &str) -> &'static str {
    match ty.starts_with('b') {
        true => "",
        false => "highp ",
    }
}
