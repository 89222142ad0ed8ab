//! Attributes of Metal's language, which clang ignores where it does not know them.

use lamplight_tools::metal::attributes::{attribute_list, first_mistake};
use lamplight_tools::metal::token::msl_tokens;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    let mut tests = vec![Trial::test("attributes::lists", lists)];
    tests.extend(TEXTS.iter().map(|(name, text, wanted)| {
        Trial::test(format!("attributes::{name}"), || checked(text, *wanted))
    }));
    tests
}

/// A name, a text, and the mistake that it has.
const TEXTS: &[(&str, &str, Option<&str>)] = &[
    (
        "entry_point",
        "struct In { metal::float3 n [[user(loc0), center_perspective]]; };\n\
         struct Out { metal::float4 c [[color(0)]]; float d [[depth(any)]]; };\n\
         fragment Out main_(In in [[stage_in]], metal::float4 p [[position]]\n\
         , metal::texture2d<float> t [[texture(127)]], constant float& x [[buffer(30)]]) {}\n",
        None,
    ),
    (
        "unknown",
        "fragment void f(int a [[vertex_idd]]) {}\n",
        Some("1:25: error: there is no attribute `vertex_idd`"),
    ),
    (
        "beyond_the_table",
        "fragment void f(\n  metal::sampler s [[sampler(16)]]) {}\n",
        Some("2:22: error: the attribute `sampler` cannot be given `16`"),
    ),
    (
        "without_a_number",
        "struct Out { metal::float4 c [[color]]; };\n",
        Some("1:32: error: the attribute `color` cannot be given nothing"),
    ),
    (
        "wrong_word",
        "struct Out { float d [[depth(all)]]; };\n",
        Some("1:24: error: the attribute `depth` cannot be given `all`"),
    ),
    (
        "in_the_wrong_place",
        "struct In { uint i [[vertex_id]]; };\n",
        Some("1:22: error: the attribute `vertex_id` does not belong here"),
    ),
    (
        "not_closed",
        "fragment void f(int a [[buffer(0)) {}\n",
        Some("1:23: error: an attribute is not well formed"),
    ),
    ("in_a_comment", "// [[nonsense]]\n/* [[nonsense]] */ int a;\n", None),
    ("of_an_array", "int f(int a[2]) { return a[a[0]]; }\n", None),
];

fn checked(text: &str, wanted: Option<&str>) -> Outcome {
    let found = first_mistake(text);
    match found.as_deref() == wanted {
        true => Ok(()),
        false => Err(format!("found {found:?}, expected {wanted:?}").into()),
    }
}

/// A list gives the names and what is in their brackets, and where the text goes on.
fn lists() -> Outcome {
    let tokens = msl_tokens("[[user(loc0), flat]] x");
    let (list, next) = attribute_list(&tokens, 0).ok_or("there is a list")?;
    let found: Vec<(&str, Option<&str>)> = list.iter().map(|one| (one.name, one.given)).collect();
    if found != [("user", Some("loc0")), ("flat", None)] || tokens[next].text != "x" {
        return Err(format!("found {found:?}, then token {next}").into());
    }
    match attribute_list(&msl_tokens("[[flat]"), 0) {
        None => Ok(()),
        Some(_) => Err("a list that is not closed was read".into()),
    }
}
