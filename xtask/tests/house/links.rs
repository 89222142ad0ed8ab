//! Relative links of the pages for people lead to files.

use std::path::Path;

use libtest_mimic::Failed;

use crate::{ROOT, git};

/// The pages: those in the root, and in `docs/` itself. The guide and the catalogue have tests of
/// their own.
fn is_page(path: &str) -> bool {
    let name = path.strip_prefix("docs/").unwrap_or(path);
    name.ends_with(".md") && !name.contains('/')
}

/// Each link to a file of the repository leads to one.
pub fn lead_somewhere() -> Result<(), Failed> {
    let files = git(&["ls-files", "-z", "--cached", "--others", "--exclude-standard"])?;
    let (mut problems, mut count) = (Vec::new(), 0);
    for page in files.iter().filter(|path| is_page(path)) {
        let page_path = Path::new(ROOT).join(page);
        let Ok(text) = std::fs::read_to_string(&page_path) else { continue };
        let folder = page_path.parent().unwrap_or(Path::new(ROOT));
        for target in targets(&text) {
            let file = target.split('#').next().unwrap_or_default();
            count += 1;
            if !file.is_empty() && !folder.join(file).exists() {
                problems.push(format!("{page} links {target}, which does not exist"));
            }
        }
    }
    match problems.is_empty() {
        true if count > 20 => Ok(()),
        true => Err(format!("only {count} links were found").into()),
        false => Err(problems.join("\n").into()),
    }
}

/// What links lead to, but for addresses.
fn targets(text: &str) -> impl Iterator<Item = &str> {
    let after = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    after.map(|(target, _)| target).filter(|target| !target.contains("://"))
}
