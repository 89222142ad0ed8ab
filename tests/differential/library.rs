//! Composes the shader library with the `wesl` crate too. So users of that composer can use the
//! library.
//!
//! Conditions over enum axes are our addition to WESL. For the crate they are translated to one flag
//! for each value: `shadow == vsm` becomes `shadow_is_vsm`.

use lamplight::LIBRARY_FILES;
use lamplight::compose::Mangle;
use lamplight::permute::{Assignment, Axis, Program, Setting, Settings, cover};
use lamplight::project;
use lamplight::source::Files as _;
use libtest_mimic::{Failed, Trial};

use super::normal::{normal, normal_functions};
use super::peer::{Files, Flags, Peer, lamplight_with};

/// The number of permutations of one program, taken evenly from those that cover all pairs of
/// values.
const POINTS: usize = 48;

/// Programs that are not compared: `deferred` imports from `forward`, which asks for the module
/// `constants`, and the crate finds that of the root package alone.
const UNCOMPARED: [&str; 1] = ["deferred"];

pub fn tests() -> Vec<Trial> {
    let modules =
        LIBRARY_FILES.list(&["wesl"]).into_iter().filter(|path| !path.starts_with("programs/"));
    let modules = modules
        .map(|path| Trial::test(format!("differential::library::{path}"), move || module(&path)));
    let programs =
        project::library_manifest().map(|(_, manifest)| manifest.programs).unwrap_or_default();
    let programs = programs.into_iter().filter(|found| !UNCOMPARED.contains(&found.name.as_str()));
    let programs = programs.map(|found| {
        Trial::test(format!("differential::programs::{}", found.name), move || program(&found))
    });
    modules.chain(programs).collect()
}

fn text(path: &str) -> String {
    LIBRARY_FILES.read(path).ok().flatten().unwrap_or_default()
}

/// The whole library as a package.
fn package(name: &str) -> Files {
    LIBRARY_FILES
        .list(&["wesl"])
        .into_iter()
        .map(|path| ((name.to_owned(), path.clone()), text(&path)))
        .collect()
}

/// Composes a module as the root. All of its functions must have the same meaning in both texts.
fn module(path: &str) -> Result<(), Failed> {
    let files = package("");
    let functions: Vec<String> = text(path)
        .lines()
        .filter_map(|line| Some(line.strip_prefix("fn ")?.split_once('(')?.0.to_owned()))
        .collect();
    let ours = lamplight_with(&files, path, &Settings::default(), Mangle::Collisions)?;
    let theirs = Peer::keeping_root(&files).compose(path, &Flags::new())?;
    let (our_meaning, their_meaning) =
        (normal_functions(&ours, &functions)?, normal_functions(&theirs, &functions)?);
    if our_meaning == their_meaning {
        Ok(())
    } else {
        Err(format!("--- lamplight\n{our_meaning}\n--- wesl\n{their_meaning}").into())
    }
}

/// Composes a program as a user would: a file of their own that imports from the package
/// `lamplight`.
fn program(program: &Program) -> Result<(), Failed> {
    let Some(file) = &program.wesl else { return Ok(()) };
    let own = text(&file.path).replace("package::", "lamplight::");
    let mut files = package("lamplight");
    let root = ("".to_owned(), "main.wesl".to_owned());
    files.insert(root.clone(), own.clone());
    let mut translated = files.clone();
    let modules = translated.iter_mut().filter(|((_, path), _)| path.starts_with("programs/"));
    modules.for_each(|(_, text)| *text = booleans(text));
    translated.insert(root, booleans(&own));
    let points = cover::pairwise(&program.space).points;
    for point in points.iter().step_by(points.len().div_ceil(POINTS)) {
        let settings = program.space.settings(point);
        translated.insert(("constants".to_owned(), String::new()), constants(&settings));
        let ours = lamplight_with(&files, "main.wesl", &settings, Mangle::Collisions)?;
        let theirs = Peer::new(&translated).compose("main.wesl", &flags(program, point))?;
        let (our_meaning, their_meaning) = (normal(&ours)?, normal(&theirs)?);
        if our_meaning != their_meaning {
            return Err(format!(
                "{}\n--- lamplight\n{our_meaning}\n--- wesl\n{their_meaning}",
                program.space.key(point)
            )
            .into());
        }
    }
    Ok(())
}

/// The text, with each comparison in a condition translated to a flag.
fn booleans(text: &str) -> String {
    let mut output = String::new();
    for (index, part) in text.split("if(").enumerate() {
        if index == 0 {
            output += part;
            continue;
        }
        let end = end_of_condition(part);
        output += "if(";
        // `if (` with a blank is an `if` of the shader, not a condition of WESL.
        output += &comparisons(&part[..end]);
        output += &part[end..];
    }
    output
}

fn end_of_condition(text: &str) -> usize {
    let mut depth = 1;
    for (at, byte) in text.bytes().enumerate() {
        depth += i32::from(byte == b'(') - i32::from(byte == b')');
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

fn comparisons(condition: &str) -> String {
    let words: Vec<&str> = condition.split(' ').collect();
    let mut output: Vec<String> = Vec::new();
    let mut at = 0;
    while at < words.len() {
        match words.get(at + 1) {
            Some(operator) if ["==", "!="].contains(operator) => {
                let name = words[at].trim_start_matches(['(', '!']);
                let before = &words[at][..words[at].len() - name.len()];
                let value = words[at + 2].trim_end_matches(')');
                let not = if *operator == "!=" { "!" } else { "" };
                output.push(format!(
                    "{before}{not}{}{}",
                    flag(name, value),
                    &words[at + 2][value.len()..]
                ));
                at += 3;
            }
            _ => {
                output.push(words[at].to_owned());
                at += 1;
            }
        }
    }
    output.join(" ")
}

fn flag(axis: &str, value: &str) -> String {
    format!("{axis}_is_{value}")
}

/// The values of a program's flags. The crate has no value for a flag that no axis declares, so the
/// flags of all programs get the one that the manifest states.
fn flags(program: &Program, point: &Assignment) -> Flags {
    let mut flags = match program.space.undeclared {
        Some(is_on) => declared_anywhere().map(|name| (name, is_on)).collect(),
        None => Flags::new(),
    };
    for (index, axis) in program.space.axes().iter().enumerate() {
        let chosen = program.space.value(index, point);
        match chosen {
            Setting::Bool(on) => drop(flags.insert(axis.name.clone(), *on)),
            _ => flags.extend(
                axis.values
                    .iter()
                    .map(|value| (flag(&axis.name, &value.to_string()), value == chosen)),
            ),
        }
    }
    flags
}

/// The names of the flags of all programs, also of those that stand for the values of an axis.
fn declared_anywhere() -> impl Iterator<Item = String> {
    let programs = project::library_manifest().map(|(_, manifest)| manifest.programs);
    let names = |axis: &Axis| match axis.values.first() {
        Some(Setting::Bool(_)) => vec![axis.name.clone()],
        _ => axis.values.iter().map(|value| flag(&axis.name, &value.to_string())).collect(),
    };
    let programs = programs.unwrap_or_default().into_iter();
    programs.flat_map(move |program| {
        program.space.axes().iter().flat_map(names).collect::<Vec<String>>()
    })
}

fn constants(settings: &Settings) -> String {
    let numbers = settings.values.iter().filter(|(_, value)| matches!(value, Setting::Int(_)));
    numbers.map(|(name, value)| format!("const {name} = {value};\n")).collect()
}
