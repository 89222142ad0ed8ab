//! Reads HLSL: registers, the heaps of samplers, and constant buffers by [`super::hlsl_packing`].
//!
//! Buffers of bytes have no layout in the text: offsets in them are in the functions.

use lamplight_bundle::{
    Binding, BindingKind, BindingSlot, HeapSampler, SamplerHeap, Semantic, Stage,
};

use super::compare::{Differences, SlotRules, compare_reading};
use super::described::Described;
use super::hlsl_packing::{HlslMember, HlslStructs};
use super::reading::{ReadBinding, Reading};
use super::text::{Statement, has_function, member_tokens, number_of, read_statements};

/// What differs between a text and what a bundle says of it.
pub fn hlsl_differences(text: &str, described: Described<'_>) -> Result<Vec<String>, String> {
    let statements = read_statements(text);
    let structs = HlslStructs::of(&statements);
    let bound = statements.iter().filter_map(|one| read_bound(one, &structs).transpose());
    let bound = bound.collect::<Result<Vec<_>, String>>()?;
    let mut found = Differences::default();
    let entry = &described.native.entry_name;
    if !has_function(&statements, entry) {
        found.note(format!(
            "the entry point is {entry:?} in the reflection, which the output lacks"
        ));
    }
    compare_heaps(&mut found, &statements, &bound, described);
    for Semantic { location: _, name, index } in &described.native.semantics {
        let semantic = format!("{name}{index}");
        if !text.contains(&format!(" : {semantic}")) {
            found.note(format!(
                "the output has no semantic `{semantic}`, which the reflection lists"
            ));
        }
    }
    let is_own = |one: &ReadBinding| !is_of_heap(one);
    let workgroup_size = statements.iter().find_map(read_size);
    let reading = Reading {
        entry: None,
        stage: workgroup_size.map(|_| Stage::Compute),
        workgroup_size,
        bindings: bound.into_iter().filter(is_own).collect(),
    };
    let is_at = |_: &Binding, slot: &BindingSlot, found: &ReadBinding| {
        (slot.space, slot.index, &slot.register) == (found.space, found.index, &found.register)
    };
    found.0.extend(compare_reading(&reading, described, &SlotRules { is_at, leaves_out: false }));
    Ok(found.0)
}

/// `[numthreads(8, 4, 1)]`
fn read_size(statement: &Statement<'_>) -> Option<[u32; 3]> {
    let at = statement.head.iter().position(|token| *token == "numthreads")?;
    let [_, "(", x, ",", y, ",", z, ")", ..] = &statement.head[at..] else { return None };
    Some([number_of(x)?, number_of(y)?, number_of(z)?])
}

/// What a declaration with a register binds.
fn read_bound(
    statement: &Statement<'_>,
    structs: &HlslStructs<'_>,
) -> Result<Option<ReadBinding>, String> {
    let head = &statement.head;
    let Some(at) = head.iter().position(|token| *token == "register") else { return Ok(None) };
    let place: Vec<&str> =
        head[at..].iter().filter(|token| !["(", ")", ","].contains(*token)).copied().collect();
    let [_, register, space @ ..] = place.as_slice() else { return Ok(None) };
    let Some(class) = register.get(..1) else { return Ok(None) };
    let space = match space {
        [space] => space.strip_prefix("space").and_then(number_of),
        _ => Some(0),
    };
    let held = statement.body.as_ref().and_then(|body| {
        let mut members = member_tokens(body);
        HlslMember::read(members.next()?)
    });
    let ty = held.map(|held| structs.layout(&held)).transpose()?;
    Ok(Some(ReadBinding {
        space,
        index: register.get(1..).and_then(number_of),
        register: Some(class.to_owned()),
        name: read_name(&head[..at]).map(str::to_owned),
        kind: read_kind(class, head[0]),
        count: None,
        ty,
        dimension: read_dimension(head[0]),
    }))
}

/// The last word before the colon, but for the length of an array.
fn read_name<'t>(head: &[&'t str]) -> Option<&'t str> {
    let mut words = head.iter().rev().skip_while(|token| *token == &":");
    let last = *words.next()?;
    match last {
        "]" => head[..head.iter().position(|token| *token == "[")?].last().copied(),
        name => Some(name),
    }
}

fn read_kind(class: &str, ty: &str) -> Option<BindingKind> {
    let is_buffer = ty.ends_with("Buffer");
    Some(match class {
        "b" => BindingKind::Uniform,
        "s" => BindingKind::Sampler,
        "t" | "u" if is_buffer => BindingKind::Storage,
        "t" => BindingKind::Texture,
        "u" => BindingKind::StorageTexture,
        _ => return None,
    })
}

/// `Texture2DMSArray` -> `2d_array`
fn read_dimension(ty: &str) -> Option<String> {
    let rest = ty.strip_prefix("RW").unwrap_or(ty).strip_prefix("Texture")?;
    let (rest, array) = match rest.strip_suffix("Array") {
        Some(rest) => (rest, "_array"),
        None => (rest, ""),
    };
    let name = rest.strip_suffix("MS").unwrap_or(rest).to_lowercase();
    Some(name + array)
}

/// Whether it belongs to naga's heaps of samplers, which are no bindings of the author.
fn is_of_heap(bound: &ReadBinding) -> bool {
    let name = bound.name.as_deref().unwrap_or_default();
    let is_array = name.starts_with("nagaGroup") && name.ends_with("SamplerIndexArray");
    is_array || ["nagaSamplerHeap", "nagaComparisonSamplerHeap"].contains(&name)
}

/// A sampler of a heap: the heap's name, the place of the buffer of indices, and the element.
type HeapPlace = (String, Option<u32>, Option<u32>, Option<u32>);

fn compare_heaps(
    found: &mut Differences,
    statements: &[Statement<'_>],
    bound: &[ReadBinding],
    described: Described<'_>,
) {
    let mut read: Vec<HeapPlace> =
        statements.iter().filter_map(|one| read_heap_sampler(one, bound)).collect();
    read.sort();
    let mut reflected: Vec<HeapPlace> = Vec::new();
    for SamplerHeap { name, register, space, size, comparison: _, samplers } in
        &described.native.sampler_heaps
    {
        let place = |sampler: &HeapSampler| {
            let HeapSampler { group: _, binding: _, buffer_register, buffer_space, element } =
                sampler;
            (name.clone(), Some(*buffer_register), Some(*buffer_space), Some(*element))
        };
        reflected.extend(samplers.iter().map(place));
        let heap = bound.iter().find(|one| one.name.as_deref() == Some(name));
        let read_place = heap.map(|heap| (heap.index, heap.space));
        found.same(
            &format!("the place of `{name}` is"),
            &read_place,
            &Some((Some(*register), Some(*space))),
        );
        let read_size = statements.iter().find_map(|one| declared_size(one, name));
        found.same(&format!("the size of `{name}` is"), &read_size, &Some(*size));
    }
    reflected.sort();
    found.same("the samplers of heaps are", &read, &reflected);
}

fn declared_size(statement: &Statement<'_>, name: &str) -> Option<u32> {
    match statement.head.as_slice() {
        [_, found, "[", size, "]", ":", ..] if *found == name => number_of(size),
        _ => None,
    }
}

/// `static const SamplerState s = nagaSamplerHeap[nagaGroup0SamplerIndexArray[2]]`
fn read_heap_sampler(statement: &Statement<'_>, bound: &[ReadBinding]) -> Option<HeapPlace> {
    let at = statement.head.iter().position(|token| *token == "=")?;
    let [_, heap, "[", buffer, "[", element, "]", "]", ..] = &statement.head[at..] else {
        return None;
    };
    let buffer = bound.iter().find(|one| one.name.as_deref() == Some(buffer))?;
    Some(((*heap).to_owned(), buffer.index, buffer.space, number_of(element)))
}
