//! `shaderlib/pictures.toml` says what pictures need for each value of an axis. A value without a row
//! and a uniform without a number are errors that name it. Otherwise a picture would silently be
//! drawn with zeros.

use lamplight::bundle::{Binding, BindingKind, Member};
use lamplight::diagnostic::render::{Form, render};
use lamplight::picture::frame::pack_buffer;
use lamplight::picture::needs::NeedsTable;
use libtest_mimic::{Failed, Trial};

use super::library;

/// A mistake in `pictures.toml` (a text and what replaces it), and a part of the error.
const MISTAKES: &[(&str, &str, &str)] = &[
    ("evsm]", "evms]", "axis `shadow` has no value `evms`"),
    ("exp2 = { background = \"haze\" }", "", "no row for `fog=exp2`"),
    ("[program.forward.axis.fog]", "[program.forward.axis.mist]", "`forward` has no axis `mist`"),
    ("[program.depth_view]", "[program.depth_vie]", "there is no program `depth_vie`"),
    ("\"linear_radius\"", "\"cubic\"", "unknown variant `cubic`"),
    ("unlit = true", "unlit = true, lit = false", "unknown field `lit`"),
];

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("render/needs/rows_are_demanded", rows_are_demanded),
        Trial::test("render/needs/numbers_are_demanded", numbers_are_demanded),
    ]
}

/// Each mistake in the table gives its error.
fn rows_are_demanded() -> Result<(), Failed> {
    let right = std::fs::read_to_string("shaderlib/pictures.toml")?;
    for (from, to, expected) in MISTAKES {
        let wrong = right.replace(from, to);
        let mut texts = library().programs.texts();
        let id = texts.add("pictures.toml", wrong.as_str());
        let problems = NeedsTable::parse(&texts, id, library().programs.manifest()).err();
        let messages = problems.map(|problems| render(&texts, &problems, Form::Short));
        match messages {
            Some(messages) if wrong != right && messages.contains(expected) => {}
            other => {
                let what = format!("expected `{expected}`, found {other:?}");
                return Err(format!("`{from}` replaced by `{to}`: {what}").into());
            }
        }
    }
    Ok(())
}

/// A uniform without a number, or with too few components, is an error. Otherwise the numbers are in
/// their places, with zeros only as padding.
fn numbers_are_demanded() -> Result<(), Failed> {
    let member = |name: &str, offset| Member {
        name: name.to_owned(),
        ty: "vec3<f32>".to_owned(),
        offset,
        size: 12,
        stride: None,
        shape: None,
        members: Vec::new(),
    };
    let binding = Binding {
        group: 0,
        binding: 0,
        name: "haze".to_owned(),
        kind: BindingKind::Uniform,
        ty: "Haze".to_owned(),
        count: None,
        size: Some(32),
        writable: false,
        shape: None,
        texture: None,
        members: vec![member("color", 0), member("tint", 16)],
    };
    let numbers = |count: usize| {
        move |path: &str| (count > 0 || path == "haze.color").then(|| vec![1.0; count.max(3)])
    };
    let unknown =
        pack_buffer(&binding, &numbers(0)).err().ok_or("`haze.tint` without a number is 0")?;
    let enough = pack_buffer(&binding, &numbers(3)).map_err(|problem| problem.message)?;
    let short = pack_buffer(&binding, &|_| Some(vec![1.0; 2])).err();
    let short = short.ok_or("the third of three components is 0, without an error")?;
    let is_one = |at: usize| enough[at..at + 4] == 1.0_f32.to_le_bytes();
    let is_packed = is_one(8) && is_one(24) && enough[12..16] == [0; 4];
    match unknown.message.contains("haze.tint") && short.message.contains("2 of 3") && is_packed {
        true => Ok(()),
        false => {
            let errors = format!("`{}`, `{}`", unknown.message, short.message);
            let what = "expected errors with `haze.tint` and `2 of 3`, and ones at 8 and 24";
            Err(format!("{what}; found {errors} and the bytes {enough:?}").into())
        }
    }
}
