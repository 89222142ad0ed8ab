//! Mistakes: each message names types and rules of GLSL, and points to the place.

use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::tree::Stage;
use lamplight_glsl::{parse, translate};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("glsl::messages", each_message),
        Trial::test("glsl::refused", each_refusal),
        Trial::test("glsl::names_become_reserved", names_become_reserved),
        Trial::test("glsl::mistakes_are_reported_once", reported_once),
        Trial::test("glsl::parser_goes_on", parser_goes_on),
        Trial::test("glsl::rules_of_es", rules_of_es),
    ]
}

/// The content of `main`, or a whole text with `main`; the place, and the message.
const MISTAKES: &[(&str, &str, &str)] = &[
    ("float a = vec2(1.0);", "vec2(1.0)", "the initial value is `vec2` and should be `float`"),
    (
        "vec3 a = vec3(1.0) + vec2(1.0);",
        "vec3(1.0) + vec2(1.0)",
        "`+` does not take `vec3` and `vec2`",
    ),
    ("float a = b;", "b", "`b` is not declared"),
    ("float a = 1.0; float a = 2.0;", "a", "`a` is declared twice in this scope"),
    ("const float a = 1.0; a = 2.0;", "a", "`a` is a constant, and cannot be written to"),
    ("vec2 a; a.xx = vec2(1.0);", "a.xx", "a component is written twice"),
    ("vec2 a; float b = a.z;", "z", "`vec2` has no components `z`"),
    ("float a[2]; a[2] = 1.0;", "2", "the index is out of bounds"),
    ("if (1) discard;", "1", "a condition is `bool`, and this is `int`"),
    ("break;", "break;", "`break` belongs into a loop or a `switch`"),
    ("float a = sin(true);", "sin(true)", "`sin` does not take (bool)"),
    ("float a = 1.0 % 2.0;", "1.0 % 2.0", "`%` does not take `float` and `float`"),
    (
        "int a = 3; switch (a) { case 1: break; case 1: break; }",
        "case 1:",
        "this label stands twice in the `switch`",
    ),
    ("double a = 1.0lf;", "double", "`double` has no counterpart in WGSL"),
    ("vec3 a = vec3(1.0, 2.0);", "vec3(1.0, 2.0)", "`vec3` needs 3 numbers, and gets 2"),
    ("int gl_a = 1;", "gl_a", "names that begin with `gl_` are reserved"),
    (
        "vec4 a = gl_PointCoord.xyxy;",
        "gl_PointCoord",
        "`gl_PointCoord` is not in WGSL: WGSL has no word for it",
    ),
    ("return 1.0;", "return 1.0;", "the function returns no value"),
    ("1.0 = 2.0;", "1.0", "this cannot be written to"),
    ("float a = (1.0;", ";", "expected `)`, found `;`"),
    ("float input = 1.0;", "input", "`input` is a reserved word of GLSL"),
    ("vec3 filter = vec3(1.0);", "filter", "`filter` is a reserved word of GLSL"),
    ("float sample = 1.0;", "sample", "`sample` is a reserved word of GLSL"),
    ("struct S { float half; };", "half", "`half` is a reserved word of GLSL"),
    ("struct S { float a; int a; };", "a", "the member `a` is declared twice"),
    ("flat float a = 1.0;", "float", "a variable of a function has no such word"),
    ("highp highp float a = 1.0;", "highp", "`highp` stands twice"),
    ("const uniform float a;", "uniform", "`uniform` contradicts a word before it"),
    ("uint a = 4294967296u;", "4294967296u", "`4294967296` is not an integer of 32 bits"),
    ("float while = 1.0;", "while", "`while` is a reserved word of GLSL"),
    ("float a = 1f;", "f", "expected `;`, found `f`"),
    ("switch (1) { case 0: break; default: }", "default:", "a label has statements after it"),
    ("for (int i = 0; i < 3; i++) { float i = 1.0; }", "i", "`i` is declared twice in this scope"),
    ("for (int i = 0; i < 3; i++) { { float i = 1.0; } } i;", "i", "`i` is not declared"),
    ("while (bool go = true) { int go = 1; }", "go", "`go` is declared twice in this scope"),
];

/// Names that were free before a version of the language took them.
const FREE: &[(&str, &str)] =
    &[("#version 120", "filter"), ("#version 330", "sample"), ("#version 410", "resource")];

/// What a version of GLSL ES refuses and the other languages accept; the version, the text, the message.
const OF_ES: &[(&str, &str, &str)] = &[
    ("100", "void main() { int a = 5 % 2; }", "`%` is reserved in GLSL ES 1.00"),
    ("100", "void main() { int a = ~5; }", "`~` is reserved in GLSL ES 1.00"),
    ("100", "void main() { float packed = 1.0; }", "`packed` is a reserved word of GLSL"),
    ("300 es", "highp in vec4 a; void main() { }", "`in` stands before the words before it"),
    (
        "300 es",
        "float sin(float a) { return a; } void main() { }",
        "`sin` is a function of GLSL ES",
    ),
    ("300 es", "invariant in vec4 a; void main() { }", "`invariant` is for what a shader computes"),
];

fn rules_of_es() -> Result<(), Failed> {
    for (version, body, message) in OF_ES {
        for (version, is_refused) in [(*version, true), ("450", false)] {
            let text = format!("#version {version}\n{body}\n");
            let found = translate(&text, Stage::Fragment, SourceId(0), Default::default());
            let first = found.err().map(|problems| problems[0].message.clone());
            if first.as_deref() != is_refused.then_some(*message) {
                return Err(format!("{version}: {body}: {first:?}").into());
            }
        }
    }
    Ok(())
}

fn names_become_reserved() -> Result<(), Failed> {
    for (version, name) in FREE {
        let body = format!("void main() {{ float {name} = 1.0; }}");
        for (version, is_free) in [(*version, true), ("#version 450", false)] {
            let text = format!("{version}\n{body}\n");
            let found = translate(&text, Stage::Fragment, SourceId(0), Default::default());
            if found.is_ok() != is_free {
                return Err(format!("{version}: {name}: {:?}", found.err()).into());
            }
        }
    }
    Ok(())
}

fn each_message() -> Result<(), Failed> {
    for (body, place, message) in MISTAKES {
        let text = format!("#version 450\nvoid main() {{ {body} }}\n");
        let found = translate(&text, Stage::Fragment, SourceId(0), Default::default());
        let Err(problems) = found else { return Err(format!("accepted: {body}").into()) };
        let problem = &problems[0];
        let at = problem.labels.first().map_or("", |label| &text[label.span.range()]);
        if problem.message != *message || at != *place {
            return Err(format!("{body}: `{at}`: {}", problem.message).into());
        }
    }
    Ok(())
}

/// A declaration with a mistake is one error, however often its name is used.
fn reported_once() -> Result<(), Failed> {
    for declared in [
        "double a = 1.0lf;",
        "vec2 a = 1.0;",
        "unknown a = unknown(1.0);",
        "sampler2D a;",
        "const float a;",
    ] {
        let text = format!("#version 450\nvoid main() {{ {declared} a; float(a); a = a; }}\n");
        let found = translate(&text, Stage::Fragment, SourceId(0), Default::default());
        let messages: Vec<String> =
            found.err().into_iter().flatten().map(|problem| problem.message).collect();
        if messages.iter().any(|message| message.contains("`a` is not declared")) {
            return Err(format!("{declared}: {messages:?}").into());
        }
    }
    Ok(())
}

/// Whole texts of a stage that have no translation; the place, and the message.
const REFUSED: &[(Stage, &str, &str, &str)] = &[
    (
        Stage::Fragment,
        "layout(binding = 0) uniform texture2D a; layout(binding = 1) uniform texture2D b; \
         layout(binding = 2) uniform samplerShadow c; layout(binding = 3) uniform sampler d; \
         vec4 f(texture2D map) { return texture(sampler2D(map, d), vec2(0.0)); } \
         void main() { f(a); f(b); texture(sampler2DShadow(a, c), vec3(0.0)); }",
        "map",
        "`map` is given a texture that is compared with and one that is not: WGSL has two types for \
         these",
    ),
    (
        Stage::Fragment,
        "layout(binding = 0) uniform texture2D a; layout(binding = 1) uniform samplerShadow b; \
         layout(binding = 2) uniform sampler c; layout(location = 0) out vec4 o; void main() { \
         o.x = texture(sampler2DShadow(a, b), vec3(0.0)); \
         o = textureLod(sampler2D(a, c), vec2(0.0), 0.5); }",
        "textureLod(sampler2D(a, c), vec2(0.0), 0.5)",
        "a texture that is also compared with is sampled at a constant level that is whole, or by \
         derivatives, in WGSL",
    ),
    (
        Stage::Fragment,
        "in float f(vec3 a) { return a.x; } void main() { }",
        "in",
        "a result is not `in`",
    ),
    (
        Stage::Fragment,
        "layout() uniform B { vec4 a; }; void main() { }",
        ")",
        "a layout has at least one word",
    ),
    (
        Stage::Fragment,
        "uniform B { in vec4 a; }; void main() { }",
        "vec4",
        "a member has no storage of its own",
    ),
    (
        Stage::Fragment,
        "uniform B { layout(std140) vec4 a; }; void main() { }",
        "vec4",
        "a member has no packing of its own: the whole block has one",
    ),
    (
        Stage::Fragment,
        "uniform B { struct S { vec4 a; } s; }; void main() { }",
        "struct S { vec4 a; }",
        "a structure is not declared in a block",
    ),
    (
        Stage::Fragment,
        "uniform B { vec4 a; } B; void main() { }",
        "B",
        "there is a block `B` already",
    ),
    (
        Stage::Fragment,
        "float B(float a) { return a; } uniform B { vec4 a; } b; void main() { }",
        "B",
        "`B` is declared already",
    ),
    (
        Stage::Vertex,
        "invariant in vec4 a; void main() { gl_Position = a; }",
        "a",
        "`invariant` is for what a shader computes",
    ),
    (
        Stage::Fragment,
        "layout(binding = 0) uniform B { vec4 a; } x; layout(binding = 1) uniform B { vec4 b; } y; \
         void main() { }",
        "B",
        "there is a block `B` already",
    ),
    (
        Stage::Fragment,
        "layout(binding = 0) uniform B { vec4 a; }; layout(binding = 1) uniform D { vec4 a; }; \
         void main() { }",
        "a",
        "`a` is declared twice in this scope",
    ),
    (
        Stage::Compute,
        "layout(constant_id = 1) const int N = 2; const int M = N * 2; int t[M]; void main() { }",
        "M",
        "an array whose size is a specialisation constant has no counterpart in WGSL",
    ),
    (
        Stage::Compute,
        "layout(local_size_x_id = 1) in; shared float t[gl_WorkGroupSize.x]; void main() { }",
        "gl_WorkGroupSize.x",
        "an array whose size is a specialisation constant has no counterpart in WGSL",
    ),
    (
        Stage::Compute,
        "layout(constant_id = 1) const int a = 2; layout(constant_id = 1) const int b = 2; \
         void main() { }",
        "b",
        "a specialisation constant has the id 1 already",
    ),
    (
        Stage::Compute,
        "int a; void main() { memoryBarrierBuffer(); a = 1; barrier(); }",
        "memoryBarrierBuffer()",
        "`memoryBarrierBuffer` has a counterpart in WGSL only beside `barrier()`",
    ),
    (
        Stage::Compute,
        "coherent buffer B { int a; uint b; }; void main() { a = 1; atomicAdd(b, 1u); }",
        "B",
        "what is `coherent` or `volatile`, and both read and written, has no counterpart in WGSL, in \
         which only atomic functions see at once what other invocations write",
    ),
    (
        Stage::Compute,
        "layout(binding = 0, r32f) coherent uniform image2D a;
void main() { imageStore(a, ivec2(0), imageLoad(a, ivec2(1))); }",
        "a",
        "what is `coherent` or `volatile`, and both read and written, has no counterpart in WGSL, in \
         which only atomic functions see at once what other invocations write",
    ),
    (
        Stage::Compute,
        "shared volatile int a[2]; void main() { a[0] = a[1]; }",
        "a",
        "what is `coherent` or `volatile`, and both read and written, has no counterpart in WGSL, in \
         which only atomic functions see at once what other invocations write",
    ),
    (
        Stage::Compute,
        "buffer B { coherent int a; }; void main() { a = 1; }",
        "a",
        "a `coherent` or `volatile` member has no counterpart in WGSL",
    ),
    (
        Stage::Compute,
        "volatile buffer B { int a; }; void main() { a = 1; }",
        "B",
        "what is `coherent` or `volatile`, and both read and written, has no counterpart in WGSL, in \
         which only atomic functions see at once what other invocations write",
    ),
    (
        Stage::Fragment,
        "layout(early_fragment_tests) in; void main() { discard; }",
        "layout(early_fragment_tests) in;",
        "`early_fragment_tests` has no counterpart in WGSL beside `discard`, depths and writes to \
         memory",
    ),
    (
        Stage::Fragment,
        "layout(early_fragment_tests) in; buffer B { int a; }; void main() { a = 1; }",
        "layout(early_fragment_tests) in;",
        "`early_fragment_tests` has no counterpart in WGSL beside `discard`, depths and writes to \
         memory",
    ),
    (
        Stage::Fragment,
        "layout(pixel_center_integer) in vec4 gl_FragCoord; void main() { }",
        "pixel_center_integer",
        "`pixel_center_integer` is not known in a layout",
    ),
    (
        Stage::Fragment,
        "uniform mat2 a = inverse(mat2(2.0)); void main() { }",
        "inverse(mat2(2.0))",
        "the initial value of this uniform is not computed before the shader runs",
    ),
    (
        Stage::Vertex,
        "buffer B { int a; } b; void main() { b.a = 1; }",
        "b",
        "a vertex shader writes no buffer in WGSL",
    ),
];

fn each_refusal() -> Result<(), Failed> {
    for (stage, text, place, message) in REFUSED {
        let text = format!("#version 450\n{text}\n");
        let found = translate(&text, *stage, SourceId(0), Default::default());
        let Err(problems) = found else { return Err(format!("accepted: {text}").into()) };
        let problem = &problems[0];
        let at = problem.labels.first().map_or("", |label| &text[label.span.range()]);
        if problem.message != *message || at != *place {
            return Err(format!("{text}: `{at}`: {}", problem.message).into());
        }
    }
    Ok(())
}

/// After a mistake, the parser reads what follows it.
fn parser_goes_on() -> Result<(), Failed> {
    let text = "void a() { float x = ; float y = 1.0; }\nfloat (;\nvoid b() { }\nint c;\n";
    let parsed = parse::parse(text);
    if parsed.errors.len() != 2 || parsed.items.len() != 3 {
        return Err(format!("{:?}", parsed.errors).into());
    }
    Ok(())
}
