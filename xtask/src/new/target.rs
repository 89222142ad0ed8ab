//! An output language.

use super::{Kind, Made, Repository, check_name};

pub const KIND: Kind = Kind { name: "target", example: "glsl460", make };

fn make(repository: &Repository<'_>, name: &str) -> Result<Made, String> {
    check_name(name, '_')?;
    let file = format!("src/emit/targets/{name}.rs");
    repository.refuse_existing(&file)?;
    let next = vec![
        format!(
            "{file}: `about`, `extension`, `judge`, `clip`, and `write` with naga's writer (trial emit)"
        ),
        "docs/guide/targets.md: a column of its conventions and of its clip spaces, and its judge \
         (trials guide lists are whole, conventions::guide)"
            .to_owned(),
        "src/judge/: where no judge that is there takes it, a file for its own (trials judges)"
            .to_owned(),
        "INSTA_UPDATE=always cargo xtask test emit; read the outputs".to_owned(),
    ];
    let text = TEXT.replace("NAME", name).replace("CONSTANT", &name.to_uppercase());
    Ok(Made { files: vec![(file, text)], next })
}

const TEXT: &str = r#"//! NAME.

use crate::bundle::Target;
use crate::emit::{Emitted, Entry, Judge, Source, clip};

/// The target, for the table of all.
pub const TARGET: Entry = Entry {
    target: Target::CONSTANT,
    extension: "NAME",
    binary: false,
    about: "",
    judge: Judge::NagaAndTint,
    clip: &clip::SHARED,
    write,
};

fn write(_: &Source<'_>) -> Result<Emitted, String> {
    Err("nothing writes `NAME` yet".to_owned())
}
"#;
