//! Generates random module trees: packages, every form of import, conditions wherever WESL allows
//! them, and colliding and shadowed names. A seed always gives the same tree.

mod imports;
mod random;
mod writer;

use std::collections::BTreeSet;

use super::peer::{Files, Flags};

use self::random::TreeRandom as _;
use crate::random::Random;

use imports::Imports;
use writer::Writer;

/// A tree that should have the same meaning for both composers.
pub struct Tree {
    pub files: Files,
    /// Path of the root module.
    pub root: &'static str,
    /// The permutations to compose, each as its flags.
    pub flags: Vec<Flags>,
}

const FLAGS: [&str; 5] = ["cold", "dim", "even", "fast", "grey"];
const NAMES: [&str; 14] = [
    "alpha", "beta", "gamma", "delta", "scale", "bias", "gain", "blend", "Shape", "Tap", "Real",
    "seed", "tone", "warp",
];
const MODULES: [(&str, &str); 10] = [
    ("", "a.wesl"),
    ("", "a/b.wesl"),
    ("", "a/b/c.wesl"),
    ("", "a/d.wesl"),
    ("", "e.wgsl"),
    ("", "f/g/h.wesl"),
    ("left", "a.wesl"),
    ("left", "f/g.wesl"),
    ("left", "f/h.wesl"),
    ("right", "a/b.wesl"),
];
const ROOT: &str = "main.wesl";

/// The tree of a seed.
pub fn tree(seed: u64) -> Tree {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d);
    let modules = 1 + random.below(MODULES.len());
    let items = items(&mut random, modules);
    let mut bodies: Vec<Vec<String>> = vec![Vec::new(); modules + 1];
    let mut imports: Vec<Imports> =
        (0..=modules).map(|module| Imports::new(module, &items)).collect();
    for index in 0..items.len() {
        let mut writer = Writer {
            random: &mut random,
            items: &items[..index],
            imports: &mut imports[items[index].module],
            hidden: Vec::new(),
        };
        let text = writer.item(&items[index]);
        bodies[items[index].module].push(text);
    }
    let entries = 1 + random.below(3);
    for entry in 0..entries {
        let mut writer = Writer {
            random: &mut random,
            items: &items,
            imports: &mut imports[0],
            hidden: Vec::new(),
        };
        let text = writer.entry(entry);
        bodies[0].push(text);
    }
    let mut files = Files::new();
    for (module, (mut body, imports)) in bodies.into_iter().zip(&imports).enumerate() {
        random.shuffle(&mut body);
        files.insert(file(module), imports.text(&mut random) + &body.join("\n"));
    }
    let flags = (0..3)
        .map(|_| FLAGS.iter().map(|flag| ((*flag).to_owned(), random.chance(50))).collect())
        .collect();
    Tree { files, root: ROOT, flags }
}

/// Package and path of a module. Number 0 is the root.
fn file(module: usize) -> (String, String) {
    let (package, path) = if module == 0 { ("", ROOT) } else { MODULES[module - 1] };
    (package.to_owned(), path.to_owned())
}

fn segments(module: usize) -> Vec<String> {
    let (_, path) = file(module);
    path.trim_end_matches(".wesl").trim_end_matches(".wgsl").split('/').map(str::to_owned).collect()
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// `const NAME: f32`.
    Real,
    /// `const NAME = 4`.
    Count,
    /// A function of `arity` numbers. If `shape` is set, a structure (that item) is its last
    /// parameter.
    Function { arity: usize, shape: Option<usize> },
    /// Has a member `b: f32`.
    Structure,
    /// Stands for `f32`.
    Alias,
    /// `var<private> NAME: f32`.
    Private,
    /// `override NAME: f32`.
    Override,
}

struct Item {
    module: usize,
    name: &'static str,
    kind: Kind,
    /// The item exists, and may be used, only if this condition holds.
    guard: Option<String>,
    id: usize,
}

/// Random items. Each may use the items before it, in whatever module they are, so modules import
/// each other in cycles.
fn items(random: &mut Random, modules: usize) -> Vec<Item> {
    let mut taken: BTreeSet<(usize, &str)> = BTreeSet::new();
    let mut items: Vec<Item> = Vec::new();
    for id in 0..6 + random.below(22) {
        let (module, name) = (random.below(modules + 1), NAMES[random.below(NAMES.len())]);
        if !taken.insert((module, name)) {
            continue;
        }
        let visible = |item: &Item| {
            item.kind == Kind::Structure && item.guard.is_none() && reaches(module, item.module)
        };
        let shape = items.iter().position(visible).filter(|_| random.chance(30));
        let kind = match random.below(14) {
            0 | 1 => Kind::Real,
            2 => Kind::Count,
            3 | 4 => Kind::Structure,
            5 => Kind::Alias,
            6 => Kind::Private,
            7 => Kind::Override,
            _ => Kind::Function { arity: random.below(3), shape },
        };
        let guard = random.chance(20).then(|| random.condition());
        items.push(Item { module, name, kind, guard, id });
    }
    items
}

/// Whether a module may import another. The root's package may import all packages, and any other
/// package only itself.
fn reaches(from: usize, to: usize) -> bool {
    let (from, to) = (file(from).0, file(to).0);
    from == to || from.is_empty()
}
