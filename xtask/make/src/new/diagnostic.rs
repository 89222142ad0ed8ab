//! A kind of diagnostic.

use super::{NewFiles, Repository, TaskKind, check_name, refuse_rest};

pub const KIND: TaskKind =
    TaskKind { name: "diagnostic", example: &["unknown-swizzle"], rest: "", make };

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<NewFiles, String> {
    refuse_rest(rest)?;
    check_name(name, '-')?;
    let file = format!("crates/diagnostic/src/codes/{name}.md");
    repository.refuse_existing(&file)?;
    let constant = name.replace('-', "_").to_uppercase();
    let next = vec![
        format!(
            "{file}: a title, `Page: ` with a page of crates/diagnostic/src/guide.rs, and when it happens and how to mend it (tests diagnostics, guide)"
        ),
        format!("`Diagnostic::error(codes::{constant}, message).at(span, words)` where it happens"),
        format!(
            "a case in tests/diagnostics/ that shows `[{name}]` (test diagnostics every code has a case)"
        ),
        "cargo xtask record guide; read the difference".to_owned(),
    ];
    Ok(NewFiles { files: vec![(file, "#\n\nPage: \n".to_owned())], next })
}
