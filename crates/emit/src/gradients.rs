//! Gradients of textures with three dimensions and of cubes, in Metal. naga calls all gradients
//! `gradient2d`.

const GRADIENT: &str = "metal::gradient2d(";

/// Metal's gradient for each kind of texture. Those of two dimensions are right already.
const KINDS: [(&str, &str); 6] = [
    ("metal::texture3d<", "metal::gradient3d("),
    ("metal::texturecube<", "metal::gradientcube("),
    ("metal::texturecube_array<", "metal::gradientcube("),
    ("metal::depthcube<", "metal::gradientcube("),
    ("metal::depthcube_array<", "metal::gradientcube("),
    ("metal::texture1d<", "metal::gradient2d("),
];

/// The text with the gradients of its textures.
pub fn with_dimensions(text: &str) -> String {
    if !text.contains(GRADIENT) {
        return text.to_owned();
    }
    let mut changed = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let gradient = line.contains(GRADIENT).then(|| gradient_of(&changed, line)).flatten();
        match gradient {
            Some(gradient) => changed += &line.replace(GRADIENT, gradient),
            None => changed += line,
        }
    }
    changed
}

/// The gradient for the texture that a line samples. Its parameter is the last one of that name
/// before. naga writes each sample in a line of its own.
fn gradient_of(before: &str, line: &str) -> Option<&'static str> {
    let (texture, _) = line.split_once(".sample")?;
    let start = texture.rfind(|c: char| c != '_' && !c.is_alphanumeric()).map_or(0, |at| at + 1);
    let texture = texture.get(start..)?;
    let declared = |line: &&str| {
        let mut words = line.split([' ', ',', ')', '(']).filter(|word| !word.is_empty());
        line.contains("metal::") && words.any(|word| word == texture)
    };
    // The parameters of a function of the author are in one line, those of a stage in several.
    let line = before.lines().rev().find(declared)?;
    let at = line.match_indices(texture).map(|(at, _)| at).find(|at| {
        let next = line[at + texture.len()..].chars().next();
        line[..*at].ends_with("> ") && next.is_none_or(|c| c != '_' && !c.is_alphanumeric())
    })?;
    let ty = line[..at].rfind("metal::t").max(line[..at].rfind("metal::d"))?;
    let kinds = KINDS.iter().find(|(kind, _)| line[ty..].starts_with(kind));
    kinds.map(|(_, gradient)| *gradient)
}
