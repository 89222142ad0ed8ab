//! The guide and the crate agree where they name each other: titles, links, lists of keys, limits.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

use lamplight::check::{formula, laws, tolerance};
use lamplight::diagnostic::guide;
use libtest_mimic::{Failed, Trial};

use super::{folder, generated, pages, stem, title};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("guide contents list every page", contents),
        Trial::test("guide links lead somewhere", links),
        Trial::test("guide every code has a page", codes),
        Trial::test("guide every command names a page", commands),
        Trial::test("guide errors on a terminal name a page", errors),
        Trial::test("guide lists are whole", lists),
        Trial::test("guide limits are those of the crate", limits),
    ]
}

/// The pages by file name, with their texts.
fn texts() -> Result<BTreeMap<String, String>, Failed> {
    let read =
        |path: &std::path::PathBuf| Ok((format!("{}.md", stem(path)), fs::read_to_string(path)?));
    pages().iter().map(read).collect()
}

/// `SUMMARY.md` names each page once, by its title.
fn contents() -> Result<(), Failed> {
    let summary = fs::read_to_string(folder().join("SUMMARY.md"))?;
    let listed: Vec<(String, String)> = targets(&summary);
    for (file, text) in texts()? {
        let of_page: Vec<&(String, String)> =
            listed.iter().filter(|(_, target)| *target == file).collect();
        let expected = title(&text)?;
        match of_page[..] {
            [(label, _)] if label == expected => {}
            _ => return Err(format!("{file}: `{expected}` is listed as {of_page:?}").into()),
        }
    }
    Ok(())
}

/// Relative links lead to pages and headings that exist.
fn links() -> Result<(), Failed> {
    let texts = texts()?;
    let mut broken = Vec::new();
    for (file, text) in &texts {
        for (_, target) in targets(text) {
            if target.contains("://") {
                continue;
            }
            let (page, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let page = if page.is_empty() { file } else { page };
            let exists = match texts.get(page) {
                Some(text) => anchor.is_empty() || anchors(text).contains(anchor),
                None => anchor.is_empty() && folder().join(page).is_file(),
            };
            if !exists {
                broken.push(format!("{file}: the link `{target}` leads nowhere"));
            }
        }
    }
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n").into()) }
}

/// The label and the target of each Markdown link outside of code.
fn targets(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut in_code = false;
    for line in text.lines() {
        in_code ^= line.starts_with("```");
        let mut rest = if in_code { "" } else { line };
        while let Some((before, after)) = rest.split_once("](") {
            let label = before.rsplit('[').next().unwrap_or_default();
            let Some((target, after)) = after.split_once(')') else { break };
            found.push((label.to_owned(), target.to_owned()));
            rest = after;
        }
    }
    found
}

/// The anchors of a page's headings, as mdBook and forges form them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let name = line.trim_start_matches('#').trim().to_lowercase();
            let kept = name.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.collect::<String>().replace(' ', "-")
        })
        .collect()
}

/// Every code names a page, every page has the title that the crate's table says, and `explain`
/// prints it.
fn codes() -> Result<(), Failed> {
    let homeless = generated::homeless();
    if !homeless.is_empty() {
        let message = format!(
            "the files of {homeless:?} in crates/diagnostic/src/codes/ name no page: write `Page: NAME` \
             below the title, with a page of crates/diagnostic/src/guide.rs"
        );
        return Err(message.into());
    }
    for page in guide::PAGES {
        let text = fs::read_to_string(folder().join(page.file))?;
        if title(&text)? != page.title {
            return Err(format!("{} is not called `{}`", page.file, page.title).into());
        }
    }
    let explanation = lamplight(&["explain", "unknown-axis"])?;
    let ending = "\nGuide: Axes, constraints and the manifest\n";
    match explanation.ends_with(ending) {
        true => Ok(()),
        false => Err(format!("`explain` should end with{ending}found:\n{explanation}").into()),
    }
}

/// Each command's help ends with the title of a page.
fn commands() -> Result<(), Failed> {
    let texts = texts()?;
    let titles: Vec<&str> = texts.values().map(|text| title(text)).collect::<Result<_, _>>()?;
    let help = lamplight(&["--help"])?;
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names: Vec<&str> = listed
        .take_while(|line| !line.is_empty())
        // A line that is indented further continues the one above.
        .filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    for name in names {
        let help = lamplight(&[name, "--help"])?;
        let named = help.lines().rev().find_map(|line| line.strip_prefix("Guide: "));
        if !named.is_some_and(|named| titles.contains(&named)) {
            let what = "which is not the title of a page";
            return Err(format!("`lamplight {name} --help` names {named:?}, {what}").into());
        }
    }
    Ok(())
}

/// On a terminal, an error names the page of the guide to read. Through a pipe it does not, since a
/// program reads it.
fn errors() -> Result<(), Failed> {
    let line = "more: lamplight explain unreadable; guide: A package of your own";
    let arguments = ["compose", "missing.wesl"];
    let piped = run(Path::new("."), &arguments)?;
    if String::from_utf8_lossy(&piped.stderr).contains("guide:") {
        return Err("an error through a pipe names the guide".into());
    }
    // `script` gives its command a terminal.
    let command = [&[env!("CARGO_BIN_EXE_lamplight")], &arguments[..]].concat().join(" ");
    let output = Command::new("script").args(["-qec", &command, "/dev/null"]).output()?;
    let stdout = String::from_utf8_lossy(&output.stdout);
    match stdout.lines().any(|stdout| stdout == line) {
        true => Ok(()),
        false => Err(format!("on a terminal, expected the line `{line}` in:\n{stdout}").into()),
    }
}

/// Every name of the crate's own lists is in the page that explains it: functions of formulas, laws,
/// tolerances, targets, keys of files, columns.
fn lists() -> Result<(), Failed> {
    let names = |names: &[&'static str]| names.iter().map(|name| (*name).to_owned()).collect();
    let functions: Vec<&str> = formula::FUNCTIONS.iter().map(|function| function.name).collect();
    let laws: Vec<&str> = laws::KINDS.iter().map(|kind| kind.name).collect();
    let terms: Vec<&str> = tolerance::TERMS.iter().map(|kind| kind.name).collect();
    let targets: Vec<&str> =
        lamplight::bundle::Target::ALL.iter().map(|target| target.name()).collect();
    let known: [(&str, Vec<String>); 11] = [
        ("cases.md", names(&functions)),
        ("cases.md", names(&laws)),
        ("cases.md", names(&terms)),
        ("targets.md", names(&targets)),
        ("manifest.md", noted("m.toml", "[program.a]\nx = 1", "variants --manifest m.toml")?),
        ("manifest.md", noted("m.toml", AXIS, "variants --manifest m.toml")?),
        ("manifest.md", noted("m.toml", CONSTRAINT, "variants --manifest m.toml")?),
        ("manifest.md", noted("m.toml", MODE, "variants --manifest m.toml")?),
        ("cases.md", noted("m.toml", "[[case]]\nfunction = \"f\"\nx = 1", "check m.toml")?),
        ("cases.md", noted("m.toml", DOMAIN, "check m.toml")?),
        ("report.md", columns()?),
    ];
    let mut missing = Vec::new();
    for (page, names) in known {
        let text = fs::read_to_string(folder().join(page))?;
        if names.is_empty() {
            return Err(format!("{page}: a list of names that it should have is empty").into());
        }
        let lacks = |name: &&String| !text.contains(&format!("`{name}`"));
        missing.extend(names.iter().filter(lacks).map(|name| format!("{page} lacks `{name}`")));
    }
    if missing.is_empty() { Ok(()) } else { Err(missing.join("\n").into()) }
}

/// The table in the page of limits is the crate's own, line by line. `UPDATE_EXPECT=1` writes it.
fn limits() -> Result<(), Failed> {
    let rows = lamplight::limits::ALL.iter().map(|limit| {
        let value = limit.written();
        format!("| {} | {value} | {} | {} |", limit.what, limit.protects, limit.error)
    });
    let wanted: Vec<String> = rows.collect();
    let page = folder().join("limits.md");
    let text = fs::read_to_string(&page)?;
    let found: Vec<&str> = text.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    match wanted == found {
        true => Ok(()),
        false if std::env::var_os("UPDATE_EXPECT").is_some() => {
            Ok(fs::write(&page, text.replace(&found.join("\n"), &wanted.join("\n")))?)
        }
        false => Err(format!("the table in limits.md should be:\n{}", wanted.join("\n")).into()),
    }
}

const AXIS: &str = "[program.a]\nwesl = \"a.wesl\"\n[program.a.axis]\nb = { x = 1, values = [1] }";
const MODE: &str =
    "[program.a]\nwesl = \"a.wesl\"\n[program.a.axis]\nb = { mode = \"x\", values = [1] }";
const CONSTRAINT: &str = "[program.a]\nwesl = \"a.wesl\"\n[[program.a.constraint]]\nx = 1";
const DOMAIN: &str = "[[case]]\nfunction = \"f\"\ninputs = { x = [{ nonsense = 1 }] }";

/// The names that the note of an error lists.
fn noted(file: &str, text: &str, line: &str) -> Result<Vec<String>, Failed> {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join(file), text)?;
    fs::write(folder.path().join("m.wesl"), "fn f() {}\n")?;
    let arguments = line.split_whitespace().chain(["--diagnostics", "json"]);
    let output = run(folder.path(), &arguments.collect::<Vec<_>>())?;
    let stderr = String::from_utf8(output.stderr)?;
    const HEADS: [&str; 4] = ["known keys: ", "known are ", "domains are ", "modes: "];
    for line in stderr.lines() {
        let error: serde_json::Value = serde_json::from_str(line)?;
        let notes =
            error["notes"].as_array().into_iter().flatten().filter_map(|note| note.as_str());
        for note in notes {
            if let Some(list) = HEADS.iter().find_map(|head| note.strip_prefix(head)) {
                return Ok(list.split(", ").map(str::to_owned).collect());
            }
        }
    }
    Err(format!("no note of `{line}` has a list of names: {stderr}").into())
}

/// The columns of the table that `check` prints.
fn columns() -> Result<Vec<String>, Failed> {
    let table = lamplight(&["check", "lighting::spot"])?;
    let head = table.lines().next().unwrap_or_default();
    Ok(head.split("  ").map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned).collect())
}

fn lamplight(arguments: &[&str]) -> Result<String, Failed> {
    Ok(String::from_utf8(run(Path::new("."), arguments)?.stdout)?)
}

fn run(folder: &Path, arguments: &[&str]) -> Result<std::process::Output, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    Ok(command.current_dir(folder).args(arguments).output()?)
}
