//! A place where functions and frames run.

use super::{Kind, Made, Repository, check_name, refuse_rest};

pub const KIND: Kind = Kind { name: "executor", example: &["dx12"], rest: "", make };

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<Made, String> {
    refuse_rest(rest)?;
    check_name(name, '_')?;
    let file = format!("src/execute/executors/{name}.rs");
    repository.refuse_existing(&file)?;
    let next = vec![
        format!("{file}: `open`, which returns a `Session` (trial harness::executor::{name})"),
        format!("{file}: `samples`, where it draws frames (the same trial)"),
        format!(
            "{file}: `needs`, each package listed in xtask/src/machine.rs too (trial house::needs_of_executors)"
        ),
    ];
    Ok(Made { files: vec![(file, TEXT.replace("NAME", name))], next })
}

const TEXT: &str = r#"//! NAME.

use super::{Entry, Unavailable};

pub const EXECUTOR: Entry = Entry {
    name: "NAME",
    about: "",
    needs: &[],
    before_threads: None,
    samples: None,
    open: || Err(Unavailable { reason: "nothing opens it yet".to_owned() }),
    shipping: None,
};
"#;
