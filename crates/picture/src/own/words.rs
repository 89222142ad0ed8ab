//! The words of a name, which say what the author means by it.

/// Names that people write as one word, with their parts.
const COMPOUNDS: &[(&str, &[&str])] = &[
    ("basecolor", &["base", "color"]),
    ("cameraposition", &["camera", "position"]),
    ("campos", &["cam", "pos"]),
    ("eyepos", &["eye", "pos"]),
    ("fragcoord", &["frag", "coord"]),
    ("fragpos", &["frag", "pos"]),
    ("lightcolor", &["light", "color"]),
    ("lightdir", &["light", "dir"]),
    ("lightpos", &["light", "pos"]),
    ("modelview", &["model", "view"]),
    ("modelviewproj", &["model", "view", "proj"]),
    ("modelviewprojection", &["model", "view", "projection"]),
    ("mv", &["model", "view"]),
    ("mvp", &["model", "view", "projection"]),
    ("objectcolor", &["object", "color"]),
    ("projview", &["view", "proj"]),
    ("pv", &["view", "projection"]),
    ("pvm", &["model", "view", "projection"]),
    ("sundir", &["sun", "dir"]),
    ("texcoord", &["tex", "coord"]),
    ("texcoords", &["tex", "coords"]),
    ("viewdir", &["view", "dir"]),
    ("viewpos", &["view", "pos"]),
    ("viewproj", &["view", "proj"]),
    ("viewprojection", &["view", "projection"]),
    ("vp", &["view", "projection"]),
    ("worldpos", &["world", "pos"]),
    ("wvp", &["model", "view", "projection"]),
];

/// Words before a name that say only what kind of variable it is.
const PREFIXES: &[&str] =
    &["a", "attr", "frag", "fs", "g", "i", "in", "m", "u", "uniform", "v", "vary", "vert", "vs"];

/// The words of a name, in lower case and without numbers: `vWorldPos2` has `world` and `pos`.
pub fn name_words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for part in name.split(|letter: char| !letter.is_alphabetic()) {
        for word in cased_words(part) {
            match COMPOUNDS.iter().find(|(compound, _)| *compound == word) {
                Some((_, parts)) => words.extend(parts.iter().map(|part| (*part).to_owned())),
                None => words.push(word),
            }
        }
    }
    if words.len() > 1 && PREFIXES.contains(&words[0].as_str()) {
        words.remove(0);
    }
    words
}

/// The words of a text whose words begin with capital letters: `vUv` has `v` and `uv`, `MVPMatrix`
/// has `mvp` and `matrix`.
fn cased_words(part: &str) -> Vec<String> {
    let letters: Vec<char> = part.chars().collect();
    let begins = |index: usize| {
        let (before, here) = (letters[index - 1], letters[index]);
        let next_is_small = letters.get(index + 1).is_some_and(|next| next.is_lowercase());
        here.is_uppercase() && (before.is_lowercase() || next_is_small)
    };
    let mut words: Vec<String> = Vec::new();
    for (index, letter) in letters.iter().enumerate() {
        if index == 0 || begins(index) {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut() {
            word.extend(letter.to_lowercase());
        }
    }
    words
}

/// Whether a name has one of these words.
pub fn has_word(words: &[String], wanted: &[&str]) -> bool {
    words.iter().any(|word| wanted.contains(&word.as_str()))
}

#[cfg(test)]
mod tests {
    use super::name_words;

    #[test]
    fn words_of_names() {
        for (name, expected) in [
            ("vWorldPos2", "world pos"),
            ("u_light_dir", "light dir"),
            ("iTime", "time"),
            ("uMVPMatrix", "model view projection matrix"),
            ("modelViewProjectionMatrix", "model view projection matrix"),
            ("TexCoords", "tex coords"),
            ("aPos", "pos"),
            ("n", "n"),
            ("clip_from_world", "clip from world"),
            ("lights[2].colour", "lights colour"),
            ("fragUV", "uv"),
            ("", ""),
        ] {
            assert_eq!(name_words(name).join(" "), expected, "{name}");
        }
    }
}
