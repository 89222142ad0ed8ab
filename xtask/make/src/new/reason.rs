//! Why a function of the shader library may cost more than its formula without guards.

use super::{NewFiles, Repository, TaskKind, check_name};

pub const KIND: TaskKind = TaskKind {
    name: "reason",
    example: &["brdf::diffuse::wrap", "A negative width would divide by zero."],
    rest: "",
    make,
};

/// What begins the line above the function's plain text.
const REASON: &str = "/// Reason:";

fn make(repository: &Repository<'_>, path: &str, rest: &[&str]) -> Result<NewFiles, String> {
    let parts: Vec<&str> = path.split("::").collect();
    parts.iter().try_for_each(|part| check_name(part, '_'))?;
    let ([folder, module, name], [reason]) = (&parts[..], rest) else {
        return Err("name a function and say why: FOLDER::MODULE::NAME 'WHAT ITS GUARDS DO'".into());
    };
    let file = format!("tests/plain/{folder}/{module}.wesl");
    let text = repository.read(&file)?;
    let declaration = format!("fn {name}(");
    let start = match text.starts_with(&declaration) {
        true => 0,
        false => text
            .find(&format!("\n{declaration}"))
            .map(|at| at + 1)
            .ok_or_else(|| format!("`{file}` has no `{declaration}`"))?,
    };
    let (before, after) = text.split_at(start);
    let comment = before.lines().rev().take_while(|line| line.starts_with("///"));
    if comment.into_iter().any(|line| line.starts_with(REASON)) {
        return Err(format!("`{file}` has a reason for `{name}` already"));
    }
    let text = format!("{before}{REASON} {}\n{after}", reason.trim());
    let next = vec!["cargo xtask record plain::; read docs/costs.md".to_owned()];
    Ok(NewFiles { files: vec![(file, text)], next })
}
