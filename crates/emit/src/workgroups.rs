//! Layouts of memory that a workgroup shares, in SPIR-V. Only buffers have strides and offsets there
//! (VUID-StandaloneSpirv-None-10684), and naga writes them for every type. Types that no buffer has
//! lose them. For a type that a buffer has too, a second one is declared without them, its bare type,
//! and values that go from one to the other are taken apart and put together.

use std::collections::{BTreeMap, BTreeSet};

use super::spirv::{HEADER_WORDS, SpirvInstruction, first_word, instructions, op};

/// Storage classes.
const WORKGROUP: u32 = 4;
const BUFFERS: [u32; 3] = [2, 9, 12];

/// Decorations: the order of a matrix, strides and offsets.
const LAYOUT: [u32; 5] = [4, 5, 6, 7, 35];

/// The word of the header that says how many ids there are.
const BOUND: usize = 3;

/// The most parts of a value that is put together: an instruction has at most 65,535 words.
const MOST_PARTS: u32 = 65_532;

/// The types of the parts of arrays and structures.
type Parts = BTreeMap<u32, Vec<u32>>;

/// The module without layouts in what a workgroup shares.
///
/// # Errors
/// The length of an array is not known, or too large for its elements to be taken apart.
pub fn without_layouts(words: &[u32]) -> Result<Vec<u32>, String> {
    let types = Types::of(words);
    if types.workgroup.is_empty() {
        return Ok(words.to_vec());
    }
    let mut out = words.get(..HEADER_WORDS).ok_or("the module is too short")?.to_vec();
    let mut next = out[BOUND];
    let bare = types.in_both().into_iter().map(|ty| {
        next += 2;
        (ty, BareType { ty: next - 2, zero: next - 1 })
    });
    let bare = bare.collect();
    out[BOUND] = next;
    let mut writer = Writer { types, bare, values: BTreeMap::new(), places: BTreeMap::new(), out };
    for instruction in instructions(words) {
        writer.write(instruction)?;
    }
    Ok(writer.out)
}

#[derive(Default)]
struct Types {
    parts: Parts,
    /// Of the constants that may be one.
    lengths: BTreeMap<u32, u32>,
    /// The constant that is the length of an array.
    counts: BTreeMap<u32, u32>,
    /// The type that each pointer to a workgroup's memory leads to.
    pointees: BTreeMap<u32, u32>,
    buffers: BTreeSet<u32>,
    workgroup: BTreeSet<u32>,
}

impl Types {
    fn of(words: &[u32]) -> Self {
        let mut types = Self::default();
        for SpirvInstruction { op, words } in instructions(words) {
            match (op, words) {
                (op::TYPE_ARRAY, [_, id, element, count]) => {
                    types.parts.insert(*id, vec![*element]);
                    types.counts.insert(*id, *count);
                }
                (op::TYPE_RUNTIME_ARRAY, [_, id, element]) => {
                    types.parts.insert(*id, vec![*element]);
                }
                (op::TYPE_STRUCT, [_, id, members @ ..]) => {
                    types.parts.insert(*id, members.to_vec());
                }
                (op::CONSTANT, [_, _, id, value]) => {
                    types.lengths.insert(*id, *value);
                }
                (op::TYPE_POINTER, [_, id, WORKGROUP, pointee]) => {
                    types.pointees.insert(*id, *pointee);
                    reach(&types.parts, *pointee, &mut types.workgroup);
                }
                (op::TYPE_POINTER, [_, _, class, pointee]) if BUFFERS.contains(class) => {
                    reach(&types.parts, *pointee, &mut types.buffers);
                }
                _ => {}
            }
        }
        types
    }

    /// The types of a workgroup's memory that a buffer has too, or that have such a part.
    fn in_both(&self) -> Vec<u32> {
        let is_shared = |ty: &u32| {
            let mut all = BTreeSet::new();
            reach(&self.parts, *ty, &mut all);
            all.iter().any(|part| self.buffers.contains(part))
        };
        self.workgroup.iter().copied().filter(is_shared).collect()
    }

    /// The types of the parts of a value, in their order.
    fn parts_of(&self, ty: u32) -> Result<Vec<u32>, String> {
        let parts = self.parts.get(&ty).ok_or("a type has no parts")?;
        let Some(count) = self.counts.get(&ty) else { return Ok(parts.clone()) };
        let length = *self.lengths.get(count).ok_or("an array has no length")?;
        match length <= MOST_PARTS {
            true => Ok(vec![parts[0]; length as usize]),
            false => Err(format!(
                "an array of {length} elements is copied between a buffer and workgroup memory, and \
                 {MOST_PARTS} can be: copy its elements in a loop"
            )),
        }
    }
}

/// Adds an array or a structure, and all that is in it.
fn reach(parts: &Parts, ty: u32, found: &mut BTreeSet<u32>) {
    if let Some(inner) = parts.get(&ty)
        && found.insert(ty)
    {
        inner.iter().for_each(|part| reach(parts, *part, found));
    }
}

/// What a workgroup has in the place of a type that a buffer has.
#[derive(Clone, Copy)]
struct BareType {
    ty: u32,
    /// The constant that is all zeros.
    zero: u32,
}

struct Writer {
    types: Types,
    /// By the types with a layout.
    bare: BTreeMap<u32, BareType>,
    /// Constants that are all zeros, with their types.
    values: BTreeMap<u32, u32>,
    /// The types of what pointers to a workgroup's memory lead to, by the pointers.
    places: BTreeMap<u32, u32>,
    out: Vec<u32>,
}

impl Writer {
    fn write(
        &mut self,
        SpirvInstruction { op, words }: SpirvInstruction<'_>,
    ) -> Result<(), String> {
        if let [_, ty, id, ..] = words
            && [op::VARIABLE, op::ACCESS_CHAIN, op::FUNCTION_PARAMETER].contains(&op)
            && let Some(pointee) = self.types.pointees.get(ty)
        {
            self.places.insert(*id, *pointee);
        }
        match (op, words) {
            (op::DECORATE, [_, ty, kind, ..]) | (op::MEMBER_DECORATE, [_, ty, _, kind, ..])
                if self.is_of_workgroup_alone(*ty) && LAYOUT.contains(kind) => {}
            (op::TYPE_ARRAY | op::TYPE_STRUCT, [_, ty, ..]) if self.bare.contains_key(ty) => {
                self.out.extend_from_slice(words);
                self.declare_bare(*ty, words);
            }
            (op::TYPE_POINTER, [first, id, WORKGROUP, pointee]) => {
                self.out.extend([*first, *id, WORKGROUP, self.bare_type(*pointee)]);
            }
            (op::CONSTANT_NULL, [_, ty, id]) => {
                self.values.insert(*id, *ty);
                self.out.extend_from_slice(words);
            }
            (op::LOAD, [first, ty, id, place, rest @ ..]) if self.is_bare_place(*place) => {
                let loaded = self.fresh();
                self.out.extend([*first, self.bare_type(*ty), loaded, *place]);
                self.out.extend_from_slice(rest);
                self.copy(*ty, loaded, Some(*id), false)?;
            }
            (op::STORE, [first, place, value, rest @ ..]) if self.is_bare_place(*place) => {
                let ty = self.places[place];
                let stored = match self.values.contains_key(value) {
                    true => self.bare[&ty].zero,
                    false => self.copy(ty, *value, None, true)?,
                };
                self.out.extend([*first, *place, stored]);
                self.out.extend_from_slice(rest);
            }
            _ => self.out.extend_from_slice(words),
        }
        Ok(())
    }

    fn is_of_workgroup_alone(&self, ty: u32) -> bool {
        self.types.workgroup.contains(&ty) && !self.types.buffers.contains(&ty)
    }

    fn is_bare_place(&self, place: u32) -> bool {
        self.places.get(&place).is_some_and(|ty| self.bare.contains_key(ty))
    }

    fn bare_type(&self, ty: u32) -> u32 {
        self.bare.get(&ty).map_or(ty, |bare| bare.ty)
    }

    fn fresh(&mut self) -> u32 {
        self.out[BOUND] += 1;
        self.out[BOUND] - 1
    }

    fn declare_bare(&mut self, ty: u32, words: &[u32]) {
        let BareType { ty: bare, zero } = self.bare[&ty];
        let mut made = words.to_vec();
        made[1] = bare;
        for (part, wanted) in made[2..].iter_mut().zip(&self.types.parts[&ty]) {
            *part = self.bare.get(wanted).map_or(*wanted, |bare| bare.ty);
        }
        self.out.append(&mut made);
        self.out.extend([first_word(op::CONSTANT_NULL, 3), bare, zero]);
    }

    /// A value of a type as one of its bare type, or the other way.
    fn copy(
        &mut self,
        ty: u32,
        value: u32,
        into: Option<u32>,
        to_bare: bool,
    ) -> Result<u32, String> {
        let mut made = Vec::new();
        for (index, part) in self.types.parts_of(ty)?.into_iter().enumerate() {
            let (from, id) = (if to_bare { part } else { self.bare_type(part) }, self.fresh());
            let word = first_word(op::COMPOSITE_EXTRACT, 5);
            self.out.extend([word, from, id, value, index as u32]);
            made.push(match self.bare.contains_key(&part) {
                true => self.copy(part, id, None, to_bare)?,
                false => id,
            });
        }
        let id = match into {
            Some(id) => id,
            None => self.fresh(),
        };
        let (ty, length) = (if to_bare { self.bare_type(ty) } else { ty }, made.len() + 3);
        self.out.extend([first_word(op::COMPOSITE_CONSTRUCT, length), ty, id]);
        self.out.append(&mut made);
        Ok(id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use lamplight_validate::info_unchecked;
    use naga::back::spv::{Options, write_vec};

    /// Decorated types, and those that pointers to a workgroup's memory lead to.
    fn decorated_and_shared(words: &[u32]) -> (BTreeSet<u32>, BTreeSet<u32>) {
        let decorated = instructions(words).filter_map(|found| match (found.op, found.words) {
            (op::DECORATE, [_, ty, kind, ..]) | (op::MEMBER_DECORATE, [_, ty, _, kind, ..])
                if LAYOUT.contains(kind) =>
            {
                Some(*ty)
            }
            _ => None,
        });
        (decorated.collect(), Types::of(words).workgroup)
    }

    #[test]
    fn only_buffers_keep_layouts() {
        let module = naga::front::wgsl::parse_str(
            "struct S { a: f32, b: array<vec3f, 2> }
             var<workgroup> own: array<S, 3>;
             var<workgroup> both: array<vec4f, 4>;
             @group(0) @binding(0) var<storage, read_write> buffer: array<vec4f, 4>;
             @compute @workgroup_size(1) fn f() {
                 both = buffer;
                 own[1].b[1].y = both[2].x;
                 let all = both;
                 buffer = all;
             }",
        );
        let module = module.unwrap();
        let info = info_unchecked(&module).unwrap();
        let words = write_vec(&module, &info, &Options::default(), None).unwrap();
        let (decorated, shared) = decorated_and_shared(&words);
        assert!(!decorated.is_disjoint(&shared), "naga writes no layouts any more");
        let (decorated, shared) = decorated_and_shared(&without_layouts(&words).unwrap());
        assert!(decorated.is_disjoint(&shared), "{decorated:?} {shared:?}");
        assert!(!decorated.is_empty() && !shared.is_empty());
    }

    #[test]
    fn arrays_that_no_instruction_holds_are_refused() {
        for (length, is_refused) in [(65_532, false), (65_533, true)] {
            let module = naga::front::wgsl::parse_str(&format!(
                "var<workgroup> own: array<f32, {length}>;
                 @group(0) @binding(0) var<storage, read_write> buffer: array<f32, {length}>;
                 @compute @workgroup_size(1) fn f() {{ own = buffer; }}",
            ));
            let module = module.unwrap();
            let info = info_unchecked(&module).unwrap();
            let words = write_vec(&module, &info, &Options::default(), None).unwrap();
            assert_eq!(without_layouts(&words).is_err(), is_refused, "{length}");
        }
    }
}
