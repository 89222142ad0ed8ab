//! Laws that hold for every space.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::SourceSet;
use lamplight_permute::axis::ValueSet;
use lamplight_permute::cover::{ValuePair, covering_space, pairwise};
use lamplight_permute::space::{ConstraintFormula, Slice, SliceLists};
use lamplight_permute::{
    Lock, Quoted, ReadTree, Setting, Settings, Space, key, lock, manifest, report,
};
use libtest_mimic::{Failed, Trial};

use lamplight_testing::random::Random;

use super::key_laws::{grown, keys_round_trip, keys_survive_growth, loader_and_tools_read_alike};
use super::outlines;
use super::random::{NOWHERE, axis, constraint, is_valid, is_wanted, ordinals, product, space};

type Law = fn() -> Result<(), Failed>;

const LAWS: &[(&str, Law)] = &[
    ("enumeration_is_brute_force", enumeration_is_brute_force),
    ("counts_without_an_axis", counts_without_an_axis),
    ("keys_round_trip", keys_round_trip),
    ("keys_survive_growth", keys_survive_growth),
    ("loader_and_tools_read_alike", loader_and_tools_read_alike),
    ("pairwise_covers_what_is_feasible", pairwise_covers_what_is_feasible),
    ("covering_space_keeps_features", covering_space_keeps_features),
    ("huge_space_answers_at_once", huge_space_answers_at_once),
    ("entangled_space_is_refused", entangled_space_is_refused),
    ("lock_is_stable", lock_is_stable),
    ("outlines_of_spaces", outlines::of_spaces),
    ("outlines_of_manifests", outlines::of_manifests),
    ("read_tree_finds_what_composes_alike", read_tree_finds_what_composes_alike),
    ("read_tree_refuses_contradictions", read_tree_refuses_contradictions),
    ("hostile_constraints_end", hostile_constraints_end),
    ("hostile_manifests_end", hostile_manifests_end),
    ("thousands_of_keys_are_quick", thousands_of_keys_are_quick),
    ("report_is_data", report_is_data),
];

pub fn tests() -> Vec<Trial> {
    LAWS.iter().map(|(name, law)| Trial::test(format!("permute::laws::{name}"), law)).collect()
}

pub fn ensure(holds: bool, what: impl Into<String>) -> Result<(), Failed> {
    if holds { Ok(()) } else { Err(what.into().into()) }
}

pub fn random_spaces(count: u64) -> impl Iterator<Item = Space> {
    (0..count).map(|seed| space(&mut Random(seed)))
}

/// Counts and lists of points are those of a search through the full product.
fn enumeration_is_brute_force() -> Result<(), Failed> {
    for (seed, space) in random_spaces(400).enumerate() {
        let all = product(&space);
        let wanted: Vec<Vec<u8>> =
            all.iter().filter(|point| is_wanted(&space, point)).cloned().collect();
        let valid = all.iter().filter(|point| is_valid(&space, point)).count();
        let count = |what: &str, found: u128, expected: usize| {
            let text = format!("seed {seed}: {what} is {found}, expected {expected}");
            ensure(found == expected as u128, text)
        };
        count("the full count", space.full_count(), all.len())?;
        count("the count of valid points", space.valid_count(), valid)?;
        count("the count of wanted points", space.count(), wanted.len())?;
        ensure(ordinals(&space.enumerate()) == wanted, format!("seed {seed}: other points"))?;
    }
    Ok(())
}

/// The count without an axis is that of the distinct points without it.
fn counts_without_an_axis() -> Result<(), Failed> {
    for (seed, space) in random_spaces(100).enumerate() {
        for axis in 0..space.axes().len() {
            let without = |mut point: Vec<u8>| {
                point.remove(axis);
                point
            };
            let expected: BTreeSet<Vec<u8>> =
                ordinals(&space.enumerate()).into_iter().map(without).collect();
            ensure(
                space.count_without(axis) == Ok(expected.len() as u128),
                format!("seed {seed}: wrong count without axis {axis}"),
            )?;
        }
    }
    Ok(())
}

pub fn read(space: &Space, text: &str) -> Option<lamplight_permute::Assignment> {
    let mut sources = SourceSet::default();
    let id = sources.add("key", text);
    key::parse(space, &Quoted::whole(&sources, id)).ok()
}

/// A covering set composes with the features that the program has at every other point.
fn covering_space_keeps_features() -> Result<(), Failed> {
    let text = "[features]\nshiny = true\n[program.p]\nwesl = \"p.wesl\"\n\
        [program.p.axis]\na = { values = [false, true] }\n";
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.toml", text);
    let manifest = manifest::parse(&sources, id);
    let manifest = manifest.map_err(|found| render(&sources, &found, Form::Human))?;
    let program = &manifest.programs[0];
    let features = covering_space(program).features;
    if features.is_empty() || features != program.space.features {
        return Err(format!("expected {:?}, found {features:?}", program.space.features).into());
    }
    Ok(())
}

/// The pairwise cover has only valid points, has every pair of values that a valid point has, and
/// lists every other pair as infeasible.
fn pairwise_covers_what_is_feasible() -> Result<(), Failed> {
    for (seed, space) in random_spaces(150).enumerate() {
        let valid: Vec<Vec<u8>> =
            product(&space).into_iter().filter(|point| is_valid(&space, point)).collect();
        let cover = pairwise(&space);
        let points = ordinals(&cover.points);
        ensure(
            points.iter().all(|point| is_valid(&space, point)),
            format!("seed {seed}: the cover has an invalid point"),
        )?;
        ensure(pairs(&points) == pairs(&valid), format!("seed {seed}: the cover lacks a pair"))?;
        let infeasible: BTreeSet<ValuePair> =
            pairs(&product(&space)).difference(&pairs(&valid)).copied().collect();
        ensure(
            infeasible == cover.infeasible.iter().copied().collect(),
            format!("seed {seed}: the infeasible pairs are others"),
        )?;
    }
    let small = |axes| {
        Space::new(axes, Vec::new(), SliceLists::default())
            .map(|space| pairwise(&space).points.len())
    };
    ensure(
        small(Vec::new()) == Ok(1) && small(vec![axis("a".to_owned(), 3)]) == Ok(3),
        "a space without axes needs 1 point, and one axis of 3 values needs 3",
    )
}

fn pairs(points: &[Vec<u8>]) -> BTreeSet<ValuePair> {
    let mut pairs = BTreeSet::new();
    for point in points {
        for second in 0..point.len() {
            pairs.extend((0..second).map(|first| ValuePair {
                first: (first, point[first].into()),
                second: (second, point[second].into()),
            }));
        }
    }
    pairs
}

/// A product of 10^12 points is counted and listed within a second. Twelve axes of ten values are
/// constrained so that each follows from the previous one, with two choices at most.
fn huge_space_answers_at_once() -> Result<(), Failed> {
    let started = Instant::now();
    let axes: Vec<_> = (0..12).map(|index| axis(format!("a{index:02}"), 10)).collect();
    let is = |axis: usize, value: usize| ConstraintFormula::Is(axis, ValueSet::single(value));
    let mut constraints = Vec::new();
    for axis in 1..12 {
        for value in 0..10 {
            let next = ConstraintFormula::Is(
                axis,
                [value, (value + 1) % 10]
                    .into_iter()
                    .filter(|next| axis % 4 != 3 || *next == value)
                    .collect(),
            );
            constraints.push(constraint(ConstraintFormula::Any(vec![
                ConstraintFormula::Not(Box::new(is(axis - 1, value))),
                next,
            ])));
        }
    }
    let space = Space::new(axes, constraints, SliceLists::default()).map_err(|_| "too complex")?;
    ensure(space.full_count() == 1_000_000_000_000, "the product should have 10^12 points")?;
    ensure(space.count() == 10 << 8, format!("{} points, expected 2560", space.count()))?;
    ensure(space.enumerate().len() as u128 == space.count(), "not all points are listed")?;
    let took = started.elapsed();
    ensure(took < Duration::from_secs(1), format!("took {took:?}, expected less than 1 s"))
}

/// A space with random clauses over many axes is refused in bounded time. Its decision diagram is
/// large for every order of the axes.
fn entangled_space_is_refused() -> Result<(), Failed> {
    let mut random = Random(7);
    let axes: Vec<_> = (0..100).map(|index| axis(format!("a{index:03}"), 2)).collect();
    let literal = |random: &mut Random| {
        ConstraintFormula::Is(random.below(100), ValueSet::single(random.below(2)))
    };
    let clause = |random: &mut Random| {
        constraint(ConstraintFormula::Any((0..3).map(|_| literal(random)).collect()))
    };
    let constraints = (0..350).map(|_| clause(&mut random)).collect();
    let started = Instant::now();
    let outcome = Space::new(axes, constraints, SliceLists::default());
    ensure(outcome.is_err(), "100 variables in 350 random clauses were counted")?;
    ensure(started.elapsed() < Duration::from_secs(20), format!("took {:?}", started.elapsed()))
}

/// The lock file of a space that grows only gets more lines. The numbers of keys stay, are distinct,
/// and give their points back.
fn lock_is_stable() -> Result<(), Failed> {
    let [small, large] = grown()?;
    let before = Lock::default().extended("p", &small);
    let after = before.extended("p", &large);
    ensure(after.to_string().starts_with(&before.to_string()), "an older line was changed")?;
    for point in small.enumerate() {
        let later = read(&large, small.key(&point).as_str()).ok_or("a key is lost")?;
        let dense = before.dense("p", &small, &point);
        ensure(
            dense.is_some() && dense == after.dense("p", &large, &later),
            format!("`{}` got another number", small.key(&point)),
        )?;
    }
    let numbers: BTreeSet<_> =
        large.enumerate().iter().map(|point| after.dense("p", &large, point)).collect();
    ensure(
        numbers.len() as u128 == large.count() && !numbers.contains(&None),
        "two points have the same number, or one has none",
    )?;
    for point in large.enumerate() {
        let dense = after.dense("p", &large, &point).ok_or("no number")?;
        ensure(
            after.point("p", &large, dense) == Some(point),
            format!("the number {dense} does not give its point back"),
        )?;
    }
    ensure(
        (0..2000).filter(|dense| after.point("p", &large, *dense).is_some()).count() as u128
            == large.count(),
        "a number that no point has gives a point",
    )?;
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.lock", after.to_string());
    ensure(lock::parse(&sources, id) == Ok(after.clone()), "the written lock is read as another")?;
    ensure(after.extended("p", &small) == after, "a smaller space changed the lock")
}

/// The reads of a composition that asks for a second axis only after some values of the first.
fn compose(settings: &Settings) -> Vec<(String, Setting)> {
    let ask = |name: &str| (name.to_owned(), settings.values[name].clone());
    let shadow = ask("shadow");
    let mut reads = vec![shadow.clone()];
    if shadow.1 != Setting::Name("none".to_owned()) {
        reads.push(ask("max_lights"));
    }
    reads
}

/// The tree of reads finds the earlier composition for settings that would be read alike, so that
/// only distinct reads are composed.
fn read_tree_finds_what_composes_alike() -> Result<(), Failed> {
    let [_, large] = grown()?;
    let mut tree: ReadTree<Vec<(String, Setting)>> = ReadTree::default();
    let mut composed = 0;
    for settings in large.enumerate().iter().map(|point| large.settings(point)) {
        match tree.get(&settings) {
            Some(known) => ensure(*known == compose(&settings), "the tree found other reads")?,
            None => {
                composed += 1;
                tree.insert(&compose(&settings), compose(&settings))
                    .map_err(|_| "the tree refuses reads that do not contradict it")?;
            }
        }
    }
    ensure(
        composed == 1 + 3 * 4 && tree.leaves().count() == composed,
        format!("{composed} compositions, {} leaves, expected 13", tree.leaves().count()),
    )
}

/// The tree refuses reads that no composer could make, given the earlier ones.
fn read_tree_refuses_contradictions() -> Result<(), Failed> {
    let read = |name: &str, value: bool| (name.to_owned(), Setting::Bool(value));
    let mut tree = ReadTree::default();
    ensure(tree.get(&Settings::default()).is_none(), "an empty tree found something")?;
    ensure(tree.insert(&[read("a", true), read("b", true)], 1).is_ok(), "the first was refused")?;
    ensure(tree.insert(&[read("b", true)], 2).is_err(), "another first read was accepted")?;
    ensure(tree.insert(&[read("a", true)], 3).is_err(), "reads that end too early were accepted")?;
    ensure(
        tree.insert(&[read("a", true), read("b", true), read("c", true)], 4).is_err(),
        "reads that go on after the end were accepted",
    )?;
    ensure(tree.insert(&[read("a", false)], 5).is_ok(), "another value was refused")?;
    ensure(tree.leaves().copied().eq([1, 5]), "the leaves should be 1 and 5, in order")
}

/// Deep, long and garbled constraints give a space, or diagnostics with places within the text, and
/// never a crash.
fn hostile_constraints_end() -> Result<(), Failed> {
    let mut texts = vec![
        "(".repeat(100_000),
        "!".repeat(100_000),
        "b=>".repeat(100_000),
        vec!["b"; 100_000].join("&&"),
        "b == ".to_owned(),
    ];
    let mut random = Random(1);
    const PIECES: &[&str] = &[
        "b", "e", "n", "x", "1", "-3", "==", "!=", "<=", "=>", "&&", "||", "!", "(", ")", "in",
        "[", "]", ",", " ", "é", "\\u00e9", "\\n",
    ];
    texts.extend((0..500).map(|_| {
        (0..random.below(12))
            .map(|_| PIECES[random.below(PIECES.len())])
            .collect::<Vec<_>>()
            .join(" ")
    }));
    for text in texts {
        let mut sources = SourceSet::default();
        let axes = "b = { values = [false, true] }\ne = { values = [\"x\", \"y\"] }\nn = { values = [1, 2] }";
        let text = format!(
            "[program.p]\nwesl = \"p\"\n[program.p.axis]\n{axes}\n[[program.p.constraint]]\nrequire = \"{text}\"\n"
        );
        let id = sources.add("lamplight.toml", text);
        if let Err(problems) = manifest::parse(&sources, id) {
            let spans =
                problems.iter().flat_map(|problem| &problem.labels).map(|label| label.span.range());
            ensure(
                spans.into_iter().all(|range| sources.get(id).text.get(range).is_some()),
                format!("a diagnostic's place is not in the text: {problems:?}"),
            )?;
        }
    }
    Ok(())
}

/// Garbled manifests give a manifest, or diagnostics with places within the text, and never a crash.
fn hostile_manifests_end() -> Result<(), Failed> {
    const TEXT: &str = "[program.p]\nwesl = \"p\"\nonly = [{ e = [\"x\", \"y\"], b = \"*\" }]\nexclude = [{ n = 2 }]\ninclude = [\"b,e=y\"]\n\
        axis.b = { values = [false, true] }\naxis.e = { values = [\"x\", \"y\"], default = \"y\", mode = \"spec\" }\naxis.n = { values = [1, 2] }\n\
        [[program.p.constraint]]\nrequire = \"\"\"\\\n  b => n >= 1 && \\u0065 in [x, y]\"\"\"\ndoc = 'd\u{e9}'\n";
    let mut random = Random(3);
    for _ in 0..3000 {
        let mut bytes = TEXT.as_bytes().to_vec();
        for _ in 0..1 + random.below(3) {
            let (at, other) = (random.below(bytes.len()), random.below(TEXT.len()));
            match random.below(3) {
                0 => bytes[at] = TEXT.as_bytes()[other],
                1 => drop(bytes.remove(at)),
                _ => bytes.insert(at, TEXT.as_bytes()[other]),
            }
        }
        let mut sources = SourceSet::default();
        let id = sources.add("lamplight.toml", String::from_utf8_lossy(&bytes).into_owned());
        if let Err(problems) = manifest::parse(&sources, id) {
            let mut spans =
                problems.iter().flat_map(|problem| &problem.labels).map(|label| label.span.range());
            ensure(
                spans.all(|range| sources.get(id).text.get(range).is_some()),
                format!("a diagnostic's place is not in the text: {problems:?}"),
            )?;
        }
    }
    Ok(())
}

/// Five thousand keys over twenty axes of four values are listed, counted and reported in bounded
/// time.
fn thousands_of_keys_are_quick() -> Result<(), Failed> {
    let started = Instant::now();
    let axes: Vec<_> = (0..20).map(|index| axis(format!("a{index:02}"), 4)).collect();
    let plain =
        Space::new(axes.clone(), Vec::new(), SliceLists::default()).map_err(|_| "too complex")?;
    let mut random = Random(5);
    let mut key = || {
        (0..20).map(|axis| format!("a{axis:02}=v{}", random.below(4))).collect::<Vec<_>>().join(",")
    };
    let include = (0..5000)
        .map(|_| read(&plain, &key()))
        .collect::<Option<Vec<_>>>()
        .ok_or("a key of the space was refused")?;
    let nothing = Slice { values: vec![ValueSet::EMPTY; 20], span: NOWHERE };
    let lists =
        SliceLists { only: vec![nothing], include: include.clone(), ..SliceLists::default() };
    let space = Space::new(axes, Vec::new(), lists).map_err(|_| "too complex")?;
    let distinct: BTreeSet<_> = include.into_iter().collect();
    ensure(space.enumerate().into_iter().eq(distinct), "the listed points are not the keys'")?;
    ensure(
        report::report("p", &space).axes.iter().all(|axis| axis.without.is_some()),
        "an axis has no count without it",
    )?;
    ensure(started.elapsed() < Duration::from_secs(30), format!("took {:?}", started.elapsed()))
}

/// The report of a space can be written as JSON with its numbers.
fn report_is_data() -> Result<(), Failed> {
    let [_, large] = grown()?;
    let report = serde_json::to_value(report::report("p", &large))?;
    ensure(
        report["wanted"] == 64 && report["axes"][0]["factor"] == 2.0 && report["stages"].is_null(),
        format!("expected 64 wanted points, a factor of 2 and no stages: {report}"),
    )
}
