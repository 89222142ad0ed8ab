//! Names and texts of others do not control the user's terminal when the command prints them.

use std::fs;

use libtest_mimic::Trial;

use super::{Outcome, run};

/// Escape sequences that clear a screen, in their 7-bit and 8-bit forms, and the character that
/// reverses the direction of text.
const EVIL: &str = "a\u{1b}[2J\u{9b}2J\u{202e}b";

type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 5] = [
        ("arguments", arguments),
        ("messages", messages),
        ("composed", composed),
        ("reports", reports),
        ("rules_for_make", rules_for_make),
    ];
    let test = |(name, case): Case| Trial::test(format!("hostile::printed_{name}"), case);
    cases.into_iter().map(test).collect()
}

/// Whether a terminal or a browser obeys a letter of these texts instead of showing it.
fn is_control(letter: char) -> bool {
    letter != '\n' && letter.is_control() || letter == '\u{202e}'
}

/// Fails if the command prints a control character, on either stream, in any form of diagnostics.
fn harmless(arguments: &[&str], file: &str) -> Outcome {
    for form in ["human", "short", "json"] {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("m.wesl"), file)?;
        let output = run(&folder, &[arguments, &["--diagnostics", form]].concat())?;
        for stream in [output.stdout, output.stderr] {
            let text = String::from_utf8(stream)?;
            if let Some(found) = text.chars().find(|letter| is_control(*letter)) {
                return Err(format!("{arguments:?} as {form} prints {found:?}: {text}").into());
            }
        }
    }
    Ok(())
}

fn arguments() -> Outcome {
    harmless(&["show", EVIL], "")?;
    harmless(&["explain", EVIL], "")?;
    harmless(&["compile", "m.wesl", "--target", EVIL], "")?;
    harmless(&["render", EVIL], "")?;
    harmless(&[EVIL], "")?;
    harmless(&["bundle", "list", EVIL], "")?;
    harmless(&["check", EVIL], "")
}

fn messages() -> Outcome {
    harmless(&["compose", "m.wesl"], &format!("import package::{EVIL};\n"))?;
    harmless(
        &["compile", "m.wesl", "--target", "wgsl"],
        &format!("fn f() {{ return \"{EVIL}\"; }}"),
    )
}

/// A composed text that goes to a pipe is not changed.
fn composed() -> Outcome {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("m.wesl"), format!("// {EVIL}\nfn f() {{}}\n"))?;
    let output = run(&folder, &["compose", "m.wesl"])?;
    let text = String::from_utf8(output.stdout)?;
    match text.contains(EVIL) {
        true => Ok(()),
        false => Err(format!("the comment {EVIL:?} should be as it was in: {text:?}").into()),
    }
}

/// A page, JSON, JUnit and a table of a failing case whose module, file and report folder have hostile names.
fn reports() -> Outcome {
    let folder = tempfile::tempdir()?;
    let name = format!("<script>alert(1)<\u{8}script>\"'&--]]>{EVIL}");
    let module = format!("/// {name}\nfn twice(x: f32) -> f32 {{ return x + x; }}\n");
    fs::write(folder.path().join(format!("{name}.wesl")), module)?;
    let case = "[[case]]\nfunction = \"twice\"\nformula = \"x\"\n[case.inputs]\nx = [1, 2]\n";
    fs::write(folder.path().join(format!("{name}.toml")), case)?;
    let report = format!("report {EVIL}");
    let output = run(&folder, &["check", ".", "--report", &report])?;
    if output.status.code() != Some(3) {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    for form in ["index.html", "junit.xml", "errors.md", "report.json"] {
        let text = fs::read_to_string(folder.path().join(&report).join(form))?;
        if let Some(found) = text.chars().find(|letter| is_control(*letter)) {
            return Err(format!("{form} has {found:?}").into());
        }
        let is_markup = form != "report.json";
        if is_markup && text.contains("<script>alert") {
            return Err(format!("{form} has the name as a tag").into());
        }
        if !is_markup {
            let json: serde_json::Value = serde_json::from_str(&text)?;
            let module = json["outcomes"][0]["module"].as_str().unwrap_or_default();
            assert_eq!(module, name, "{form} names another module");
        }
    }
    Ok(())
}

/// A file name with a line end cannot add a rule to what make reads.
fn rules_for_make() -> Outcome {
    let folder = tempfile::tempdir()?;
    let name = "a\nall: ; touch made\n.wesl";
    let shader = "@fragment fn main() -> @location(0) vec4f { return vec4f(1.0); }\n";
    fs::write(folder.path().join(name), shader)?;
    let arguments = ["compile", name, "--target", "wgsl", "-o", "out", "--depfile", "rule.d"];
    let output = run(&folder, &arguments)?;
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("has a line end, which a rule for make cannot hold"), "{stderr}");
    assert!(!folder.path().join("rule.d").exists(), "the rule was written");
    Ok(())
}
