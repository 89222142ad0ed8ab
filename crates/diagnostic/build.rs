//! Writes one `Code` constant for each Markdown file of `src/codes/`.

#![allow(clippy::print_stdout)]

use std::fmt::Write as _;
use std::{fs, io};

use lamplight_build::{files, package_folder, stem, write_table};

fn main() -> io::Result<()> {
    write_table("codes.rs", &codes()?)
}

/// The first line of a file is the title, `Page: NAME` is the page of the guide, the rest explains.
fn codes() -> io::Result<String> {
    let (mut table, mut names) = (String::new(), String::new());
    for path in files(&package_folder()?.join("src/codes"), "md")? {
        println!("cargo::rerun-if-changed={}", path.display());
        let name = stem(&path);
        let text = fs::read_to_string(&path)?;
        let (title, explanation) = text.split_once('\n').unwrap_or((&text, ""));
        let constant = name.replace('-', "_").to_uppercase();
        let title = title.trim_start_matches('#').trim();
        let (page, explanation) = explanation
            .trim_start()
            .strip_prefix("Page: ")
            .and_then(|rest| rest.split_once('\n'))
            .unwrap_or(("", explanation));
        let (page, explanation) = (page.trim(), explanation.trim());
        let _ = writeln!(
            table,
            "/// {title}\npub const {constant}: &Code = &Code {{ name: {name:?}, title: {title:?}, explanation: {explanation:?}, page: {page:?} }};"
        );
        let _ = write!(names, "{constant}, ");
    }
    let _ = writeln!(table, "/// Every code, by name.\npub const ALL: &[&Code] = &[{names}];");
    Ok(table)
}
