//! Members of structures in WGSL, with the attributes that put those behind them into their places.

use std::collections::{BTreeMap, BTreeSet};

use naga::{AddressSpace, Handle, Module, Type, TypeInner};

use super::gaps::{Gap, Rules, alignment_of, collect_structs, ends_of, gaps_of, is_endless_struct};

/// The text that naga wrote of a module, with `@size` where a member is followed by a gap, and with
/// `@align` where only this gives a structure its size.
///
/// # Errors
/// A member lies where its type cannot, or the text does not have the structures of the module.
pub fn with_sizes(text: String, module: &Module) -> Result<String, String> {
    let attributes = attributes_of(module)?;
    if attributes.is_empty() {
        return Ok(text);
    }
    let mut structs = module
        .types
        .iter()
        .filter(|(handle, ty)| {
            matches!(ty.inner, TypeInner::Struct { members: _, span: _ })
                && !is_predeclared(module, *handle)
        })
        .map(|(handle, _)| handle);
    let mut to = String::with_capacity(text.len() + 64);
    let mut within: Option<(Handle<Type>, usize)> = None;
    for line in text.split_inclusive('\n') {
        if line.starts_with("struct ") {
            within = structs.next().map(|ty| (ty, 0));
        } else if line.starts_with('}') {
            within = None;
        } else if let Some((ty, member)) = &mut within {
            let indent = line.len() - line.trim_start().len();
            to += &line[..indent];
            to += attributes.get(&(*ty, *member)).map_or("", String::as_str);
            to += &line[indent..];
            *member += 1;
            continue;
        }
        to += line;
    }
    match structs.next() {
        None => Ok(to),
        Some(_) => Err("a structure was not written".to_owned()),
    }
}

/// The attributes of members, by structure and index.
fn attributes_of(module: &Module) -> Result<BTreeMap<(Handle<Type>, usize), String>, String> {
    let mut structs = BTreeSet::new();
    for (_, variable) in module.global_variables.iter() {
        if matches!(
            variable.space,
            AddressSpace::Uniform | AddressSpace::Immediate | AddressSpace::Storage { access: _ }
        ) {
            collect_structs(module, variable.ty, &mut structs);
        }
    }
    let mut found = BTreeMap::new();
    for ty in structs {
        let TypeInner::Struct { members, span } = &module.types[ty].inner else { continue };
        if let Some(alignment) = endless_alignment(module, ty, *span) {
            found.insert((ty, 0), format!("@align({alignment}) "));
        }
        for Gap { before, from: _, to } in gaps_of(module, ty, Rules::Plain)? {
            let (index, member) = before
                .checked_sub(1)
                .and_then(|index| Some((index, members.get(index)?)))
                .ok_or("a structure begins with a gap")?;
            *found.entry((ty, index)).or_default() += &format!("@size({}) ", to - member.offset);
        }
    }
    Ok(found)
}

/// The alignment of a structure that ends with an array without a length, if its types have a smaller
/// one. Nothing can be behind the array, so the alignment alone decides the size.
fn endless_alignment(module: &Module, ty: Handle<Type>, span: u32) -> Option<u32> {
    let end = ends_of(module, ty, Rules::Plain).last().copied()?;
    let is_right = |alignment: &u32| end.next_multiple_of(*alignment) == span;
    let natural = alignment_of(module, ty, Rules::Plain);
    let is_needed = is_endless_struct(module, ty) && natural.round_up(end) != span;
    (3..12).map(|power| 1 << power).find(is_right).filter(|_| is_needed)
}

/// Whether naga leaves a structure out, since the language has it.
fn is_predeclared(module: &Module, ty: Handle<Type>) -> bool {
    let types = &module.special_types;
    let external = [types.external_texture_params, types.external_texture_transfer_function];
    types.predeclared_types.values().any(|one| *one == ty) || external.contains(&Some(ty))
}
