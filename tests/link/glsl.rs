//! Names of GLSL in the outputs of permutations.

use lamplight::bundle::{Language, Stage, Target};
use lamplight::compose::Composed;
use lamplight::link::{Linker, TextForms, compile};

use super::{Outcome, agree, all_linked, package, units};

/// A GLSL function that nothing calls does not ship, neither alone nor as the first of all.
pub fn unused_functions() -> Outcome {
    const MANIFEST: &str = "[program.one]\nglsl = { fragment = \"one.frag.glsl\" }\n\
        [program.one.axis]\nrows = { values = [false, true], default = true }\n";
    // The local variable makes the function look as if it were used.
    const TEXT: &str = "#version 450
layout(location = 0) out vec4 color;
#if ROWS
void unused() {
    float half_way = 0.5;
}
#endif
void main() {
    float unused = 0.5;
    color = vec4(unused);
}
";
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("one.frag.glsl"), TEXT)?;
    let (mut sources, packages, manifest) = package(folder.path(), "one", MANIFEST, "")?;
    let together = agree(&mut sources, &packages, &manifest, 1)?;
    assert_eq!(together.summary.programs[0].permutations, 2);
    all_linked(&together)
}

/// A constant and a variable of GLSL may have the name of a block's member, whichever is declared
/// first, and are not read from the block.
pub fn constants_like_members() -> Outcome {
    const MANIFEST: &str = "[program.one]\nglsl = { fragment = \"one.frag.glsl\" }\n\
        targets = [\"wgsl\"]\n[program.one.axis]\nfirst = { values = [false, true] }\n";
    const TEXT: &str = "#version 450
const int SIZE = 2;
#if FIRST
const float bias = 0.25;
const int rows = 2;
#endif
struct Light { float bias; };
layout(set = 0, binding = 0) uniform Shadow {
    vec4 tint;
    float bias;
    vec4 strength[2], tail;
    vec4 rows;
    vec4 ramp[SIZE];
} shadow;
#if !FIRST
const float bias = 0.25;
const int rows = 2;
#endif
float strength = 0.5;
layout(location = 0) out vec4 color;
float shaded(float x) { Light light = Light(bias); return x * light.bias + float(rows); }
float counted(int count) { return float(count); }
void main() { color = shadow.tint * shaded(bias) * strength * counted(SIZE); }
";
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("one.frag.glsl"), TEXT)?;
    let (mut sources, packages, manifest) = package(folder.path(), "one", MANIFEST, "")?;
    let together = agree(&mut sources, &packages, &manifest, 1)?;
    for ((_, _, key), unit) in units(&together) {
        let text = String::from_utf8_lossy(&unit.targets["wgsl"].bytes);
        let is_read = |member: &&&str| text.contains(&format!("shadow.{member}"));
        if let Some(member) = ["bias", "strength", "rows"].iter().find(is_read) {
            return Err(format!("[{key}] reads the member `{member}`:\n{text}").into());
        }
        // The length of an array is no member.
        if !text.contains("const SIZE:") {
            return Err(format!("[{key}] has no `SIZE`:\n{text}").into());
        }
    }
    all_linked(&together)
}

/// A text whose places no map knows turns the rule about derivatives off in WGSL as others do, and
/// warns of it.
pub fn derivatives_without_places() -> Outcome {
    const TEXT: &str = "#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) uniform sampler2D image;
void main() {
    color = vec4(0.0);
    if (uv.x > 0.5) color = texture(image, uv);
}
";
    let composed = Composed::of_text(Language::Glsl, Some(Stage::Fragment), TEXT.to_owned());
    let text = TextForms { composed: &composed, lean: &composed };
    let targets = [Target::WGSL];
    let made = compile(&text, "main", &targets, &Linker::new(&targets))
        .map_err(|problems| format!("{problems:?}"))?;
    let wgsl = String::from_utf8_lossy(&made.unit.targets["wgsl"].bytes).into_owned();
    assert!(wgsl.contains("diagnostic(off, derivative_uniformity);"), "{wgsl}");
    let codes: Vec<&str> = made.warnings.iter().map(|warning| warning.code.name).collect();
    assert_eq!(codes, ["non-uniform-derivative"]);
    Ok(())
}
