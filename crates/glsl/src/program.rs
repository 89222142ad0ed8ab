//! Numbers for what the shaders of a program leave open: locations and bindings.
//!
//! They are counted over the sources of both stages, the vertex stage first, with all branches of
//! all conditions. So they depend on the sources alone: every permutation has the same numbers, and
//! what goes from one stage to the next has one location in both. What has a number in one place of
//! the sources keeps it.
//!
//! A number is added to the end of a composed text as a line of the preprocessor, which other
//! compilers pass over.

mod scan;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use scan::{Declared, DeclaredKind, Loose, Scanned};

/// How the lines begin.
const LINE: &str = "#pragma lamplight_number ";

/// The word of a member of the block of loose uniforms, whose lines are in the order of the members.
const MEMBER: &str = "member";

/// The size of a member whose length depends on the permutation.
const OPEN: &str = "open";

/// What a number is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NumberOf {
    /// The location of an input.
    Input,
    /// The location of an output.
    Output,
    /// The binding of a resource.
    Binding,
    /// The binding of the sampler that a combined texture gets.
    Sampler,
    /// The binding of the block of the uniforms that are in no block. It has no name.
    Uniforms,
}

const WORDS: [(NumberOf, &str); 5] = [
    (NumberOf::Input, "in"),
    (NumberOf::Output, "out"),
    (NumberOf::Binding, "binding"),
    (NumberOf::Sampler, "sampler"),
    (NumberOf::Uniforms, "uniforms"),
];

/// The lines for the texts of a vertex and of a fragment stage, each given as the texts of its files:
/// the root first. A stage that leaves nothing open has none.
pub fn number_program(vertex: &[&str], fragment: &[&str]) -> [String; 2] {
    let stages = [vertex, fragment].map(Scanned::of);
    let mut lines = [String::new(), String::new()];
    let [vertex, fragment] = &stages;
    let outer = [(0, vertex, DeclaredKind::Input), (1, fragment, DeclaredKind::Output)];
    for (stage, scanned, kind) in outer {
        let names: Vec<_> = scanned.of_kind(kind).collect();
        let numbers = locations(&names);
        add_locations(&mut lines[stage], kind, &names, &numbers);
    }
    let sent: Vec<_> = vertex.of_kind(DeclaredKind::Output).collect();
    let taken: Vec<_> = fragment.of_kind(DeclaredKind::Input).collect();
    let numbers = locations(&[&sent[..], &taken[..]].concat());
    add_locations(&mut lines[0], DeclaredKind::Output, &sent, &numbers);
    add_locations(&mut lines[1], DeclaredKind::Input, &taken, &numbers);
    add_bindings(&mut lines, &stages);
    lines
}

/// Whether a text has numbers of its program.
pub fn is_numbered(text: &str) -> bool {
    text.lines().next_back().is_some_and(|line| line.starts_with(LINE))
}

/// The first location of each name.
fn locations<'t>(names: &[&Declared<'t>]) -> BTreeMap<&'t str, u32> {
    let mut used = BTreeSet::new();
    let mut found = BTreeMap::new();
    for declared in names {
        let Some(first) = declared.number else { continue };
        used.extend(first..first.saturating_add(declared.count));
        found.entry(declared.name).or_insert(first);
    }
    let mut next = 0;
    for declared in names {
        if found.contains_key(declared.name) {
            continue;
        }
        let count = largest(names, declared.name);
        while (next..next + count).any(|location| used.contains(&location)) {
            next += 1;
        }
        found.insert(declared.name, next);
        next += count;
    }
    found
}

/// How many numbers a name takes where it takes most.
fn largest(names: &[&Declared<'_>], name: &str) -> u32 {
    let same = names.iter().filter(|declared| declared.name == name);
    same.map(|declared| declared.count).max().unwrap_or(1)
}

fn add_locations(
    lines: &mut String,
    kind: DeclaredKind,
    names: &[&Declared<'_>],
    numbers: &BTreeMap<&str, u32>,
) {
    let of = if kind == DeclaredKind::Input { NumberOf::Input } else { NumberOf::Output };
    let mut known = BTreeSet::new();
    for declared in names.iter().filter(|declared| declared.number.is_none()) {
        if let Some(number) = numbers.get(declared.name)
            && known.insert(declared.name)
        {
            add_line(lines, of, declared.name, *number);
        }
    }
}

fn add_line(lines: &mut String, of: NumberOf, name: &str, number: u32) {
    let word = WORDS.iter().find(|(known, _)| *known == of).map_or("", |(_, word)| word);
    // Writing to a string does not fail.
    let _ = writeln!(lines, "{LINE}{word} {name} {number}");
}

/// Bindings that are in use, by group.
#[derive(Default)]
struct UsedBindings(BTreeSet<(u32, u32)>);

impl UsedBindings {
    /// The first of so many bindings that are free in a group.
    fn take(&mut self, group: u32, count: u32) -> u32 {
        let is_free = |first: u32| (first..first + count).all(|at| !self.0.contains(&(group, at)));
        let first = (0..1 << 16).find(|first| is_free(*first)).unwrap_or(0);
        self.keep(group, first, count);
        first
    }

    fn keep(&mut self, group: u32, first: u32, count: u32) {
        self.0.extend((first..first.saturating_add(count)).map(|at| (group, at)));
    }
}

/// Numbers the resources of both stages, then the samplers of combined textures, then the blocks of
/// loose uniforms. A resource of one name is the same in both.
fn add_bindings(lines: &mut [String; 2], stages: &[Scanned<'_>; 2]) {
    let all: Vec<&Declared<'_>> =
        stages.iter().flat_map(|stage| stage.of_kind(DeclaredKind::Resource)).collect();
    let mut used = UsedBindings::default();
    let (mut bindings, mut samplers) = (BTreeMap::new(), BTreeMap::new());
    for declared in &all {
        if let Some(first) = declared.number {
            used.keep(declared.group, first, declared.count);
            bindings.entry(declared.name).or_insert(first);
        }
    }
    for declared in &all {
        let count = largest(&all, declared.name);
        bindings.entry(declared.name).or_insert_with(|| used.take(declared.group, count));
    }
    for declared in all.iter().filter(|declared| declared.samplers > 0) {
        let count = declared.samplers;
        samplers.entry(declared.name).or_insert_with(|| used.take(declared.group, count));
    }
    let members = uniform_members(stages);
    let shared = members.as_ref().map(|_| used.take(0, 1));
    for (lines, stage) in lines.iter_mut().zip(stages) {
        let mut known = BTreeSet::new();
        for declared in stage.of_kind(DeclaredKind::Resource) {
            if !known.insert(declared.name) {
                continue;
            }
            if declared.number.is_none() {
                add_line(lines, NumberOf::Binding, declared.name, bindings[declared.name]);
            }
            if let Some(first) = samplers.get(declared.name) {
                add_line(lines, NumberOf::Sampler, declared.name, *first);
            }
        }
        if !stage.loose.is_empty() {
            let binding = shared.unwrap_or_else(|| used.take(0, 1));
            add_line(lines, NumberOf::Uniforms, "-", binding);
            members.iter().flatten().for_each(|member| add_member(lines, member));
        }
    }
}

fn add_member(lines: &mut String, member: &Loose<'_>) {
    let Loose { name, ty, lengths, size, open, is_known: _ } = member;
    let size = if *open { OPEN.to_owned() } else { size.to_string() };
    let lengths: String = lengths.iter().map(|length| format!(" {length}")).collect();
    let _ = writeln!(lines, "{LINE}{MEMBER} {name} {size} {ty}{lengths}");
}

/// The members of the block of loose uniforms, in the order of both stages. An array whose length
/// depends on the permutation is the last one, so that it moves no other; where there are two of
/// these, or a name has several sizes or a type that is not found, each stage has a block of its own.
fn uniform_members<'t>(stages: &[Scanned<'t>; 2]) -> Option<Vec<Loose<'t>>> {
    let mut found: Vec<Loose<'t>> = Vec::new();
    for one in stages.iter().flat_map(|stage| &stage.loose) {
        match found.iter().find(|other| other.name == one.name) {
            None => found.push(one.clone()),
            Some(other) if (other.size, other.open) == (one.size, one.open) => {}
            Some(_) => return None,
        }
    }
    found.sort_by_key(|one| one.open);
    let opens = found.iter().filter(|one| one.open).count();
    let is_known = found.iter().all(|one| one.is_known);
    (!found.is_empty() && opens <= 1 && is_known).then_some(found)
}

/// A member of the block of loose uniforms.
#[derive(Debug, Clone)]
pub(crate) struct UniformMember {
    pub(crate) name: String,
    /// Its size by the rules of `std140`.
    pub(crate) size: u32,
    /// Its type without the lengths of arrays.
    pub(crate) ty: String,
    pub(crate) lengths: Vec<u32>,
    /// Whether the length depends on the permutation. Then it is the last member.
    pub(crate) open: bool,
}

/// The numbers in a text.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    numbers: BTreeMap<(NumberOf, String), u32>,
    /// The members of the block of loose uniforms, if the program has one for both stages.
    pub(crate) members: Vec<UniformMember>,
}

impl Numbers {
    pub(crate) fn of(text: &str) -> Self {
        let mut found = Self::default();
        for line in text.lines().rev().map_while(|line| line.strip_prefix(LINE)) {
            let words: Vec<&str> = line.split(' ').collect();
            if words[0] == MEMBER {
                found.members.extend(read_member(&words));
            } else if let Some((key, number)) = read_number(&words) {
                found.numbers.insert(key, number);
            }
        }
        found.members.reverse();
        found
    }

    /// A number, if the program has one for this.
    pub(crate) fn get(&self, of: NumberOf, name: &str) -> Option<u32> {
        self.numbers.get(&(of, name.to_owned())).copied()
    }

    /// The binding of the block of loose uniforms.
    pub(crate) fn uniforms(&self) -> Option<u32> {
        self.get(NumberOf::Uniforms, "-")
    }
}

fn read_number(words: &[&str]) -> Option<((NumberOf, String), u32)> {
    let [word, name, number] = words else { return None };
    let (of, _) = WORDS.iter().find(|(_, known)| known == word)?;
    Some(((*of, (*name).to_owned()), number.parse().ok()?))
}

fn read_member(words: &[&str]) -> Option<UniformMember> {
    let [_, name, size, ty, lengths @ ..] = words else { return None };
    let lengths = lengths.iter().map(|length| length.parse().ok()).collect::<Option<_>>()?;
    let (name, ty, open) = ((*name).to_owned(), (*ty).to_owned(), *size == OPEN);
    let size = if open { 0 } else { size.parse().ok()? };
    Some(UniformMember { name, size, ty, lengths, open })
}

#[cfg(test)]
mod tests {
    use super::{LINE, number_program};

    fn lines(vertex: &str, fragment: &str) -> [Vec<String>; 2] {
        number_program(&[vertex], &[fragment]).map(|text| {
            text.lines().map(|line| line.strip_prefix(LINE).unwrap_or("?").to_owned()).collect()
        })
    }

    #[test]
    fn locations_by_name() {
        let [vertex, fragment] = lines(
            "in vec3 at; in mat4 model; in vec2 uv_in;\nout vec2 uv; out vec3 normal;",
            "in vec3 normal; in float more; in vec2 uv;\nout vec4 colour;",
        );
        assert_eq!(vertex, ["in at 0", "in model 1", "in uv_in 5", "out uv 0", "out normal 1"]);
        assert_eq!(fragment, ["out colour 0", "in normal 1", "in more 2", "in uv 0"]);
    }

    #[test]
    fn all_branches_count() {
        let [vertex, fragment] = lines(
            "#ifdef A\nout vec4 a;\n#endif\nout vec4 b;",
            "in vec4 b;\n#if X > 1\nin vec4 a;\n#else\nin vec4 c;\n#endif",
        );
        assert_eq!(vertex, ["out a 0", "out b 1"]);
        assert_eq!(fragment, ["in b 1", "in a 0", "in c 2"]);
    }

    #[test]
    fn given_numbers_stay() {
        let [vertex, fragment] = lines(
            "layout(location = 1) out vec4 a; out mat3 b; out vec4 c;",
            "layout(location=1) in vec4 a; in mat3 b; in vec4 c;",
        );
        assert_eq!(vertex, ["out b 2", "out c 5"]);
        assert_eq!(fragment, ["in b 2", "in c 5"]);
    }

    #[test]
    fn blocks_and_arrays() {
        let [vertex, fragment] = lines(
            "#define COUNT 3\nconst int MORE = 2;\nstruct S { vec2 a; mat2 b; };\n\
             out Sent { vec3 at; vec2 uv[COUNT]; } sent; out S s[MORE]; out vec4 last;",
            "in Sent { vec3 at; vec2 uv[3]; } taken; in vec4 last;",
        );
        assert_eq!(vertex, ["out Sent 0", "out s 4", "out last 10"]);
        assert_eq!(fragment, ["in Sent 0", "in last 10"]);
    }

    #[test]
    fn bindings_are_shared() {
        let [vertex, fragment] = lines(
            "uniform mat4 model; uniform sampler2D height; layout(std140) uniform Camera { mat4 v; };",
            "struct Material { sampler2D diffuse; sampler2D specular; float shininess; };\n\
             uniform sampler2D height; uniform Material material; uniform vec3 lamp;\n\
             layout(binding = 0) uniform Scene { vec4 a; };",
        );
        let block = [
            "uniforms - 8",
            "member model 64 mat4",
            "member material 16 Material",
            "member lamp 12 vec3",
        ];
        let height = ["binding height 1", "sampler height 5"];
        assert_eq!(vertex, [&height[..], &["binding Camera 2"], &block].concat());
        let material = ["binding material 3", "sampler material 6"];
        assert_eq!(fragment, [&height[..], &material, &block].concat());
    }

    /// What a permutation decides stands last, and sizes are those of all branches.
    #[test]
    fn uniforms_of_both_stages_are_one_block() {
        let [vertex, fragment] = lines(
            "#define BONES 4\n#ifndef LAMPS\n#define LAMPS 2\n#endif\n\
             uniform mat3x4 bones[BONES]; uniform float k = 2.0, weights[2];\n\
             #if LAMPS > 1\nuniform vec3 lamps[LAMPS];\n#endif",
            "struct Fog {\n vec3 tint;\n#ifdef DENSE\n mat2 more;\n#endif\n float at; };\n\
             uniform Fog fog[2]; uniform bool is_lit; uniform float k;",
        );
        let expected = [
            "uniforms - 0",
            "member bones 192 mat3x4 4",
            "member k 4 float",
            "member weights 32 float 2",
            "member fog 128 Fog 2",
            "member is_lit 4 bool",
            "member lamps open vec3 2",
        ];
        assert_eq!(vertex, expected);
        assert_eq!(fragment, expected);
    }

    #[test]
    fn other_uniforms_are_a_block_in_each_stage() {
        let bindings = |vertex, fragment| lines(vertex, fragment).map(|lines| lines.join(", "));
        let own = ["uniforms - 0", "uniforms - 1"].map(str::to_owned);
        assert_eq!(bindings("uniform vec3 a;", "uniform vec4 a;"), own);
        assert_eq!(bindings("uniform vec3 a[M];", "uniform vec4 b[N];"), own);
        assert_eq!(bindings("uniform HIGHP vec3 a;", "uniform vec4 b;"), own);
    }

    #[test]
    fn numbers_that_are_not_read() {
        let [vertex, fragment] = lines(
            "const int FIRST = 2; layout(location = FIRST + 1) out vec4 a; out vec4 b;\n\
             layout(push_constant) uniform Push { vec4 c; };",
            "layout(location = 3) in vec4 a; in vec4 b;",
        );
        assert_eq!(vertex, ["out b 0", "binding Push 0"]);
        assert_eq!(fragment, ["in b 0"]);
    }

    #[test]
    fn functions_have_no_numbers() {
        let [vertex, fragment] = lines(
            "layout(location = 0) in vec3 at; void f(in vec3 a, out vec3 b) { b = a; }\nvoid main() {}",
            "void main() { for (int i = 0; i < 3; i++) { vec4 a; } }",
        );
        assert!(vertex.is_empty() && fragment.is_empty(), "{vertex:?} {fragment:?}");
    }
}
