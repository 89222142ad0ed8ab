//! What the reasons of blanks are, and what confirms them.

use std::collections::BTreeSet;
use std::process::Command;

use lamplight::bundle::Target;

use crate::conformance::deqp::output_of;
use xtask::CommandFailure;

/// Whose lack a reason is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The language of the target has no word for it.
    Language,
    /// A later version of the target's language has it.
    Version,
    /// The file does not say all that is needed.
    File,
    /// Ours: it could be written otherwise.
    Ours,
}

impl Kind {
    pub fn words(self) -> &'static str {
        match self {
            Self::Language => "the language",
            Self::Version => "the version",
            Self::File => "the file",
            Self::Ours => "ours",
        }
    }
}

/// A reason that is understood.
pub struct Known {
    /// A part of the reason.
    part: &'static str,
    pub kind: Kind,
    pub note: &'static str,
    /// What glslang refuses in the target's version.
    probe: Option<Probe>,
}

/// A text in GLSL, without its version, that glslang refuses in GLSL ES 3.00 and in GLSL 3.30, and accepts
/// in later versions, if there are any.
struct Probe {
    stage: &'static str,
    es: Option<u32>,
    desktop: Option<u32>,
    text: &'static str,
}

const fn fragment(es: Option<u32>, desktop: Option<u32>, text: &'static str) -> Option<Probe> {
    Some(Probe { stage: "frag", es, desktop, text })
}

const fn compute(text: &'static str) -> Option<Probe> {
    Some(Probe { stage: "comp", es: Some(310), desktop: Some(430), text })
}

const fn version(part: &'static str, note: &'static str, probe: Option<Probe>) -> Known {
    Known { part, kind: Kind::Version, note, probe }
}

/// The first that fits is taken.
const KNOWN: &[Known] = &[
    version(
        "lacks compute shaders",
        "OpenGL ES 3.10, OpenGL 4.30",
        compute("layout(local_size_x = 1) in; void main() {}"),
    ),
    version(
        "lacks storage buffers",
        "OpenGL ES 3.10, OpenGL 4.30",
        compute("layout(local_size_x = 1) in; buffer B { float a; }; void main() { a = 1.0; }"),
    ),
    version(
        "arrays whose size is not constant",
        "OpenGL ES 3.10, OpenGL 4.30",
        compute(
            "layout(local_size_x = 1) in; buffer B { float a[]; }; void main() { a[0] = 1.0; }",
        ),
    ),
    version(
        "lacks storage textures",
        "OpenGL ES 3.10; `glsl330` has them by an extension",
        compute(
            "layout(local_size_x = 1) in; layout(r32f) uniform readonly highp image2D i; \
             void main() { imageLoad(i, ivec2(0)); }",
        ),
    ),
    version(
        "lacks image size",
        "OpenGL ES 3.10, OpenGL 4.30",
        compute(
            "layout(local_size_x = 1) in; layout(r32f) uniform readonly highp image2D i; \
             void main() { imageSize(i); }",
        ),
    ),
    version(
        "lacks arrays of cube textures",
        "OpenGL ES 3.20",
        fragment(
            Some(320),
            Some(400),
            "precision highp float; uniform highp samplerCubeArray s; out vec4 c; \
             void main() { c = texture(s, vec4(1.0)); }",
        ),
    ),
    version(
        "lacks noperspective qualifier",
        "no version of OpenGL ES",
        fragment(
            None,
            Some(330),
            "precision highp float; noperspective in vec4 a; out vec4 c; void main() { c = a; }",
        ),
    ),
    version(
        "lacks sample qualifier",
        "OpenGL ES 3.20, OpenGL 4.00",
        fragment(
            Some(320),
            Some(400),
            "precision highp float; sample in vec4 a; out vec4 c; void main() { c = a; }",
        ),
    ),
    version(
        "array of arrays",
        "OpenGL ES 3.10, OpenGL 4.30",
        fragment(
            Some(310),
            Some(430),
            "precision highp float; uniform float a[2][2]; out vec4 c; \
             void main() { c = vec4(a[1][0]); }",
        ),
    ),
    call("`bitCount`", Some(400), "c = vec4(bitCount(1));"),
    call("`bitfieldExtract`", Some(400), "c = vec4(bitfieldExtract(7, 1, 1));"),
    call("`bitfieldInsert`", Some(400), "c = vec4(bitfieldInsert(7, 1, 1, 1));"),
    call("`bitfieldReverse`", Some(400), "c = vec4(bitfieldReverse(7));"),
    call("`findLSB`", Some(400), "c = vec4(findLSB(7));"),
    call("`findMSB`", Some(400), "c = vec4(findMSB(7));"),
    call("`frexp`", Some(400), "highp int e; c = vec4(frexp(2.0, e));"),
    call("`ldexp`", Some(400), "c = vec4(ldexp(2.0, 1));"),
    call("`packUnorm4x8`", Some(400), "c = vec4(packUnorm4x8(vec4(1.0)));"),
    desktop("`packHalf2x16`", 420, "c = vec4(packHalf2x16(vec2(1.0)));"),
    desktop("`unpackHalf2x16`", 420, "c = vec4(unpackHalf2x16(1u), 0.0, 0.0);"),
    desktop("`packSnorm2x16`", 420, "c = vec4(packSnorm2x16(vec2(1.0)));"),
    desktop("`packUnorm2x16`", 410, "c = vec4(packUnorm2x16(vec2(1.0)));"),
    version(
        "`textureGather`",
        "OpenGL ES 3.10, OpenGL 4.00",
        fragment(
            Some(310),
            Some(400),
            "precision highp float; uniform sampler2D s; out vec4 c; \
             void main() { c = textureGather(s, vec2(0.5)); }",
        ),
    ),
    version(
        "`textureQueryLevels`",
        "OpenGL 4.30, no version of OpenGL ES",
        fragment(
            None,
            Some(430),
            "precision highp float; uniform sampler2D s; out vec4 c; \
             void main() { c = vec4(textureQueryLevels(s)); }",
        ),
    ),
    version(
        "`textureSamples`",
        "OpenGL 4.50, no version of OpenGL ES",
        fragment(
            None,
            Some(450),
            "precision highp float; uniform highp sampler2DMS s; out vec4 c; \
             void main() { c = vec4(textureSamples(s)); }",
        ),
    ),
    version(
        "multisampled textures",
        "OpenGL ES 3.10",
        fragment(
            Some(310),
            Some(330),
            "precision highp float; uniform highp sampler2DMS s; out vec4 c; \
             void main() { c = texelFetch(s, ivec2(0), 0); }",
        ),
    ),
    call("`gl_SampleID`", Some(400), "c = vec4(gl_SampleID);"),
    call("`gl_SampleMask`", Some(400), "c = vec4(gl_SampleMaskIn[0]);"),
    version(
        "primitive index",
        "OpenGL ES 3.20; MSL 2.2, and MSL 2.0 is written",
        fragment(
            Some(320),
            Some(330),
            "precision highp float; out vec4 c; void main() { c = vec4(gl_PrimitiveID); }",
        ),
    ),
    version("attribute 'invariant'", "MSL 2.1, and MSL 2.0 is written", None),
    version("16bit norm formats", "an extension of both", None),
    version("comparison at a given level of an array of cubes", "an extension", None),
    Known {
        part: "`num_workgroups`",
        kind: Kind::Language,
        note: "HLSL has no number of workgroups",
        probe: None,
    },
    Known {
        part: "`First` sampling",
        kind: Kind::Language,
        note: "which vertex is the first is a state of OpenGL",
        probe: None,
    },
    Known {
        part: "texture external",
        kind: Kind::Language,
        note: "only WebGPU joins the planes of a video frame to one texture",
        probe: None,
    },
    Known {
        part: "an override has no value",
        kind: Kind::File,
        note: "the host gives it when it makes a pipeline; `--constant NAME=VALUE` gives it here",
        probe: None,
    },
    Known {
        part: "a matrix of two rows in a uniform block",
        kind: Kind::Ours,
        note: "its columns could be vectors of four",
        probe: None,
    },
    Known {
        part: "a structure with locations has gaps",
        kind: Kind::Ours,
        note: "naga writes no padding into such a structure",
        probe: None,
    },
    Known {
        part: "depth texture",
        kind: Kind::Ours,
        note: "naga declares each depth texture as one for comparisons",
        probe: None,
    },
    Known {
        part: "`textureLoad` from depth textures",
        kind: Kind::Ours,
        note: "naga declares each depth texture as one for comparisons",
        probe: None,
    },
];

/// A function or variable that fragments have since OpenGL ES 3.10 or 3.20.
const fn call(part: &'static str, desktop: Option<u32>, text: &'static str) -> Known {
    version(part, "OpenGL ES 3.10 or 3.20, OpenGL 4.00", fragment(Some(320), desktop, text))
}

/// A function that OpenGL ES 3.00 has.
const fn desktop(part: &'static str, version: u32, text: &'static str) -> Known {
    let probe = fragment(Some(300), Some(version), text);
    Known { part, kind: Kind::Version, note: "OpenGL 4.10 or 4.20", probe }
}

/// What is known of a reason.
pub fn known_reason(reason: &str) -> Option<&'static Known> {
    KNOWN.iter().find(|known| reason.contains(known.part))
}

/// What confirms a reason for some targets: another compiler, asked now, or the definition.
///
/// # Errors
/// A probe that the other compiler judges otherwise.
pub fn confirm(known: &Known, targets: &BTreeSet<Target>) -> Result<String, CommandFailure> {
    let Some(probe) = &known.probe else {
        return Ok(match known.kind {
            Kind::Language | Kind::Version => "the specification".to_owned(),
            Kind::File | Kind::Ours => "-".to_owned(),
        });
    };
    let lacking = [(Target::ESSL300, "300 es"), (Target::GLSL330, "330")];
    for (target, version) in lacking.into_iter().filter(|(target, _)| targets.contains(target)) {
        if accepts(probe, version)? {
            return Err(wrong(known, version, target));
        }
    }
    let having = [
        (Target::ESSL300, probe.es.map(|number| format!("{number} es"))),
        (Target::GLSL330, probe.desktop.map(|number| number.to_string())),
    ];
    for (target, version) in having {
        if let (true, Some(version)) = (targets.contains(&target), version)
            && !accepts(probe, &version)?
        {
            return Err(wrong(known, &version, target));
        }
    }
    Ok("glslang".to_owned())
}

fn wrong(known: &Known, version: &str, target: Target) -> CommandFailure {
    let target = target.name();
    CommandFailure::check(format!(
        "glslang judges version {version} otherwise than `{}` of `{target}` says",
        known.part
    ))
}

fn accepts(probe: &Probe, version: &str) -> Result<bool, CommandFailure> {
    let is_whole = probe.text.contains("void main()");
    let whole = match is_whole {
        true => probe.text.to_owned(),
        false => format!("precision highp float; out vec4 c; void main() {{ {} }}", probe.text),
    };
    let mut command = Command::new("glslangValidator");
    command.args(["--stdin", "-S", probe.stage]);
    let output = output_of(command, &format!("#version {version}\n{whole}\n"));
    let missing = || CommandFailure::environment("glslangValidator (glslang-tools) is missing");
    output.map(|output| output.status.success()).ok_or_else(missing)
}
