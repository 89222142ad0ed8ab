//! Texts of WESL with one mistake at each place: what the mistake does not stand in stays.

use lamplight_diagnostic::source::SourceId;
use lamplight_syntax::wesl::{self, Event, Module, Names};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("damaged::inserted", inserted),
        Trial::test("damaged::removed", removed),
        Trial::test("damaged::cut_off", cut_off),
        Trial::test("damaged::two_mistakes", two_mistakes),
    ]
}

const TEXT: &str = "\
import package::a::{b, c};

const FAR: f32 = max(1.0, 2.0);
@group(0) @binding(0) var<uniform> light: Light;

struct Light {
    place: vec3f,
    reach: array<f32, 4>,
}

@if(SOFT)
fn soft(x: f32) -> f32 {
    for (var i = 0; i < 4; i++) {
        let y = x * f32(i);
    }
    return x;
}
@else
fn soft(x: f32) -> f32 { return 0.0; }

@if(LAMPS) {
    const LAMPS = 4;

    fn lamps(x: array<f32, 4>) -> f32 {
        if x[0] > 1.0 {
            return x[1];
        } else {
            loop {
                continuing { break if x[2] > 1.0; }
            }
        }
        return max(x[3], 1.0);
    }
}

@compute @workgroup_size(1)
fn last() {
    let z = soft(FAR);
}
";

fn parse(text: &str) -> (Module, Names) {
    let mut names = Names::default();
    let module = wesl::parse_for_editor(SourceId(0), text.into(), &mut names);
    (module, names)
}

/// Each item by name and the bytes of its text.
fn items(text: &str) -> Vec<(String, std::ops::Range<usize>)> {
    let (module, names) = parse(text);
    let item = |item: &wesl::Item| {
        let range = item.range.start as usize..item.range.end as usize;
        (names.text(item.name).to_owned(), range)
    };
    module.items.iter().map(item).collect()
}

/// Fails unless the parts of a parsed text are where the text has them.
fn check(text: &str) -> Result<(), Failed> {
    let (module, names) = parse(text);
    for item in &module.items {
        let written = text.get(item.name_range.start as usize..item.name_range.end as usize);
        if written != Some(names.text(item.name)) {
            return Err(format!("{written:?} is no name of an item: {text}").into());
        }
        let has = |range: std::ops::Range<u32>| {
            range.start <= range.end && text.get(range.start as usize..range.end as usize).is_some()
        };
        let is_right = item.events.iter().enumerate().all(|(at, event)| match *event {
            Event::Cut { start, end } | Event::Definition { start, end } => has(start..end),
            Event::Use { reference, start, end, .. } => {
                has(start..end) && (reference as usize) < module.references.len()
            }
            Event::Node { start, end, next, .. } => {
                has(start..end) && next as usize > at && next as usize <= item.events.len()
            }
        });
        if !has(item.range.clone()) || !is_right {
            return Err(format!("an item has wrong places: {item:#?}\n{text}").into());
        }
    }
    Ok(())
}

/// The items that a mistake at a byte does not stand in, and that are not found.
fn lost(text: &str, at: usize) -> Vec<String> {
    let found: Vec<String> = items(text).into_iter().map(|(name, _)| name).collect();
    let head = TEXT.find("fn soft(x: f32) -> f32 { ").unwrap_or(0);
    let head = head..TEXT.find("    const LAMPS").unwrap_or(0);
    // Without the head of their block, its items may be statements.
    let is_headless = |name: &str| head.contains(&at) && name.eq_ignore_ascii_case("lamps");
    let all = items(TEXT).into_iter();
    let beside = all.filter(|(_, range)| !range.contains(&at) && range.end != at);
    let names = beside.map(|(name, _)| name);
    names.filter(|name| !found.contains(name) && !is_headless(name)).collect()
}

const MARKS: [&str; 12] = ["(", ")", "[", "]", "{", "}", "/*", "\"", "@", ";", "<", "@if("];

/// Between any two lines and before any word.
fn places() -> impl Iterator<Item = usize> {
    let bytes = TEXT.as_bytes();
    (1..bytes.len()).filter(move |at| !bytes[at - 1].is_ascii_alphanumeric() && bytes[*at] != b' ')
}

fn inserted() -> Result<(), Failed> {
    let mut missed = Vec::new();
    for mark in MARKS {
        for at in places() {
            let text = format!("{}{mark}{}", &TEXT[..at], &TEXT[at..]);
            check(&text)?;
            let lost = lost(&text, at);
            if !lost.is_empty() {
                missed.push((mark, TEXT[..at].matches('\n').count() + 1, lost));
            }
        }
    }
    // `@` before `const` or `var` makes an attribute of the word, as `@const` was one.
    expect_few(&missed, 4)
}

fn removed() -> Result<(), Failed> {
    let mut missed = Vec::new();
    for (at, _) in TEXT.char_indices().filter(|(_, letter)| "()[]{};@,:".contains(*letter)) {
        let text = format!("{}{}", &TEXT[..at], &TEXT[at + 1..]);
        check(&text)?;
        let lost = lost(&text, at);
        if !lost.is_empty() {
            missed.push((&TEXT[at..=at], TEXT[..at].matches('\n').count() + 1, lost));
        }
    }
    expect_few(&missed, 0)
}

/// A text that ends anywhere has the items before its end.
fn cut_off() -> Result<(), Failed> {
    for at in 0..TEXT.len() {
        check(&TEXT[..at])?;
        let found: Vec<String> = items(&TEXT[..at]).into_iter().map(|(name, _)| name).collect();
        let before = items(TEXT).into_iter().filter(|(_, range)| range.end <= at);
        let lost: Vec<String> =
            before.map(|(name, _)| name).filter(|name| !found.contains(name)).collect();
        expect_few(&lost, 0)?;
    }
    Ok(())
}

/// No two mistakes lead to wrong places.
fn two_mistakes() -> Result<(), Failed> {
    let all: Vec<usize> = places().collect();
    for (index, at) in all.iter().enumerate() {
        for (step, mark) in MARKS.iter().enumerate() {
            let other = all[(index + 7 * step + 3) % all.len()];
            let (first, second) = ((*at).min(other), (*at).max(other));
            let more = MARKS[(index + step) % MARKS.len()];
            let between = &TEXT[first..second];
            check(&format!("{}{mark}{between}{more}{}", &TEXT[..first], &TEXT[second..]))?;
        }
    }
    Ok(())
}

fn expect_few<T: std::fmt::Debug>(missed: &[T], most: usize) -> Result<(), Failed> {
    match missed.len() > most {
        true => Err(format!("{} are lost: {missed:#?}", missed.len()).into()),
        false => Ok(()),
    }
}
