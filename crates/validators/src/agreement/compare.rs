//! Compares a reading with a reflection.

use std::fmt::Debug;

use lamplight_bundle::{Binding, BindingSlot, Member, Shape, TextureShape};

use super::described::{Described, binding_words};
use super::reading::{ReadBinding, ReadMember, ReadType, Reading, same_kind};

/// Differences, each in words.
#[derive(Debug, Default)]
pub struct Differences(pub Vec<String>);

impl Differences {
    /// Notes a difference between what the output has and what the reflection has.
    pub fn same<T: PartialEq + Debug>(&mut self, what: &str, output: &T, reflected: &T) {
        if output != reflected {
            self.0
                .push(format!("{what} {output:?} in the output, {reflected:?} in the reflection"));
        }
    }

    /// The same for what the output may not say.
    pub fn same_known<T: PartialEq + Debug>(
        &mut self,
        what: &str,
        output: &Option<T>,
        reflected: &Option<T>,
    ) {
        if output.is_some() {
            self.same(what, output, reflected);
        }
    }

    /// Notes a difference that is more than two values.
    pub fn note(&mut self, words: String) {
        self.0.push(words);
    }
}

/// How a target binds.
pub struct SlotRules {
    /// How its hosts find what is bound: whether a binding of the reflection, at its slot, is one of
    /// the output.
    pub is_at: fn(&Binding, &BindingSlot, &ReadBinding) -> bool,
    /// Whether its writer leaves out what is only used for values that nothing uses.
    pub leaves_out: bool,
}

/// What differs between an output and what a bundle says of it.
pub fn compare_reading(
    reading: &Reading,
    described: Described<'_>,
    rules: &SlotRules,
) -> Vec<String> {
    let Reading { entry, stage, workgroup_size, bindings } = reading;
    let mut found = Differences::default();
    found.same_known("the entry point is", entry, &Some(described.native.entry_name.clone()));
    found.same_known("the stage is", stage, &Some(described.reflection.stage));
    if described.reflection.workgroup_size.is_some() || workgroup_size.is_some() {
        found.same_known(
            "the size of a workgroup is",
            workgroup_size,
            &described.reflection.workgroup_size,
        );
    }
    let mut seen = vec![false; bindings.len()];
    for binding in &described.reflection.bindings {
        let Some(slot) = described.slot(binding) else { continue };
        match bindings.iter().position(|one| (rules.is_at)(binding, slot, one)) {
            Some(at) => {
                seen[at] = true;
                compare_binding(&mut found, &bindings[at], binding);
            }
            None if rules.leaves_out => {}
            None => found.note(format!(
                "{} is at {} in the reflection, where the output has nothing",
                binding_words(binding),
                slot_words(slot)
            )),
        }
    }
    for (at, _) in seen.iter().enumerate().filter(|(_, seen)| !**seen) {
        found.note(format!(
            "the output binds {}, which the reflection does not list",
            read_words(&bindings[at])
        ));
    }
    found.0
}

fn slot_words(slot: &BindingSlot) -> String {
    let BindingSlot { group: _, binding: _, space, index, register, name } = slot;
    place_words(*space, *index, register.as_deref(), name.as_deref())
}

fn read_words(found: &ReadBinding) -> String {
    place_words(found.space, found.index, found.register.as_deref(), found.name.as_deref())
}

fn place_words(
    space: Option<u32>,
    index: Option<u32>,
    register: Option<&str>,
    name: Option<&str>,
) -> String {
    let parts = [
        name.map(|name| format!("`{name}`")),
        index.map(|index| format!("{}{index}", register.unwrap_or("number "))),
        space.map(|space| format!("space {space}")),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    if parts.is_empty() { "no place".to_owned() } else { parts.join(", ") }
}

/// Compares what is bound at one place.
pub fn compare_binding(found: &mut Differences, read: &ReadBinding, reflected: &Binding) {
    // The place was compared when it was found, and what an entry point writes to is not read.
    let Binding {
        group: _,
        binding: _,
        name: _,
        kind,
        ty: _,
        count,
        size,
        writable: _,
        shape,
        texture,
        members,
    } = reflected;
    let what = binding_words(reflected);
    if let Some(read) = read.kind.filter(|read| !same_kind(*read, *kind)) {
        found.same(&format!("the kind of {what} is"), &read, kind);
    }
    let is_buffer = kind.is_buffer();
    if read.kind.is_some() && read.register.is_none() {
        found.same(&format!("the number of bindings of {what} is"), &read.count, count);
    }
    if let (Some(dimension), Some(texture)) = (&read.dimension, texture) {
        let TextureShape { dimension: reflected, .. } = texture;
        found.same(&format!("the dimension of {what} is"), dimension, reflected);
    }
    let Some(ty) = read.ty.as_ref().filter(|_| is_buffer) else { return };
    compare_forms(found, ty, |found, ty| {
        if let Some(size) = size.filter(|size| !ty.size().is(*size)) {
            found.note(format!(
                "the size of {what} is {:?} in the output, {size} in the reflection",
                ty.size()
            ));
        }
        let ty = with_matrices(ty, shape.as_ref());
        compare_shapes(found, &what, ty.shape().as_ref(), shape.as_ref());
        compare_members(found, &what, ty.members(), members);
    });
}

/// Compares a buffer's type. Where its block has one member only, this may stand for a block that a
/// language needs around what the author binds; then that one's type is compared.
fn compare_forms(
    found: &mut Differences,
    ty: &ReadType,
    compare: impl Fn(&mut Differences, &ReadType),
) {
    let mut plain = Differences::default();
    compare(&mut plain, ty);
    let inner = match ty {
        ReadType::Struct { members, size: _ } => match members.as_slice() {
            [ReadMember { offset: None | Some(0), ty }] if !plain.0.is_empty() => Some(ty),
            _ => None,
        },
        _ => None,
    };
    found.0.extend(match inner {
        None => plain.0,
        Some(inner) => {
            let mut wrapped = Differences::default();
            compare(&mut wrapped, inner);
            wrapped.0
        }
    });
}

fn compare_shapes(
    found: &mut Differences,
    what: &str,
    read: Option<&Shape>,
    reflected: Option<&Shape>,
) {
    let (Some(read), Some(reflected)) = (read, reflected) else {
        if read.is_some() != reflected.is_some() {
            found
                .note(format!("{what} is {read:?} in the output, {reflected:?} in the reflection"));
        }
        return;
    };
    let Shape { scalar, rows, columns, matrix_stride, count } = reflected;
    found.same(&format!("the scalar type of {what} is"), &read.scalar, scalar);
    found.same(&format!("the number of components of {what} is"), &read.rows, rows);
    found.same(&format!("the number of columns of {what} is"), &read.columns, columns);
    let stride = format!("the matrix stride of {what} is");
    match read.columns {
        // Not every language says it.
        Some(_) => found.same_known(&stride, &read.matrix_stride, matrix_stride),
        None => found.same(&stride, &read.matrix_stride, matrix_stride),
    }
    found.same(&format!("the number of elements of {what} is"), &read.count, count);
}

fn compare_members(found: &mut Differences, what: &str, read: &[ReadMember], reflected: &[Member]) {
    // An array of arrays has no shape, so that the columns of its matrices are not joined.
    if reflected.is_empty() && join_columns(read).is_some() {
        return;
    }
    let read = joined_columns(read, reflected);
    if read.len() != reflected.len() {
        found.same(&format!("the number of members of {what} is"), &read.len(), &reflected.len());
        return;
    }
    for (index, (read, reflected)) in read.iter().zip(reflected).enumerate() {
        let Member { name, ty: _, offset, size, stride, shape, members } = reflected;
        let what = format!("member {index}, `{name}`, of {what}");
        found.same_known(&format!("the offset of {what} is"), &read.offset, &Some(*offset));
        if !read.ty.size().is(*size) {
            let read = read.ty.size();
            found.note(format!(
                "the size of {what} is {read:?} in the output, {size} in the reflection"
            ));
        }
        match read.ty {
            ReadType::Array { .. } => {
                found.same_known(&format!("the stride of {what} is"), &read.ty.stride(), stride)
            }
            _ => found.same(&format!("the stride of {what} is"), &None, stride),
        }
        compare_shapes(found, &what, read.ty.shape().as_ref(), shape.as_ref());
        compare_members(found, &what, read.ty.members(), members);
    }
}

/// The members with matrices in the place of their columns. In uniform buffers naga declares each
/// column of a matrix of two rows as a member of its own, for HLSL and SPIR-V, and wraps the columns
/// in a structure where the matrix is an array's element: so it has the stride of WGSL.
fn joined_columns(read: &[ReadMember], reflected: &[Member]) -> Vec<ReadMember> {
    let (mut joined, mut rest) = (Vec::new(), read);
    for reflected in reflected {
        let Some((first, after)) = rest.split_first() else { return joined };
        let wanted = reflected.shape.as_ref().and_then(|shape| match shape {
            Shape { rows: Some(2), columns: Some(columns), count: None, .. } => {
                Some(*columns as usize)
            }
            _ => None,
        });
        let columns = wanted.and_then(|wanted| rest.split_at_checked(wanted));
        match columns.and_then(|(columns, after)| Some((join_columns(columns)?, after))) {
            Some((matrix, after)) => {
                joined.push(ReadMember { offset: first.offset, ty: matrix });
                rest = after;
            }
            None => {
                let ty = with_matrices(&first.ty, reflected.shape.as_ref());
                joined.push(ReadMember { offset: first.offset, ty });
                rest = after;
            }
        }
    }
    joined.extend_from_slice(rest);
    joined
}

/// A matrix in the place of a structure of its columns, or an array of such matrices.
fn with_matrices(ty: &ReadType, reflected: Option<&Shape>) -> ReadType {
    let is_matrix = reflected.is_some_and(|shape| shape.columns.is_some());
    let is_alone = reflected.is_some_and(|shape| shape.count.is_none());
    match ty {
        ReadType::Struct { members, size: _ } if is_matrix && is_alone => {
            join_columns(members).unwrap_or_else(|| ty.clone())
        }
        ReadType::Array { element, count, stride } if is_matrix => match &**element {
            ReadType::Struct { members, size: _ } => match join_columns(members) {
                Some(matrix) => {
                    ReadType::Array { element: Box::new(matrix), count: *count, stride: *stride }
                }
                None => ty.clone(),
            },
            _ => ty.clone(),
        },
        _ => ty.clone(),
    }
}

/// The matrix of some columns, which are vectors of two at equal distances.
fn join_columns(columns: &[ReadMember]) -> Option<ReadType> {
    let [ReadMember { offset: Some(first), ty }, ReadMember { offset: Some(second), ty: _ }, ..] =
        columns
    else {
        return None;
    };
    let ReadType::Number { scalar, width, rows: Some(2), columns: None } = ty else { return None };
    let stride = second.checked_sub(*first)?;
    let is_next = |(index, column): (usize, &ReadMember)| {
        let distance = stride.checked_mul(u32::try_from(index).ok()?)?;
        (column.offset == Some(first.checked_add(distance)?) && column.ty == *ty).then_some(())
    };
    columns.iter().enumerate().map(is_next).collect::<Option<()>>()?;
    let count = u32::try_from(columns.len()).ok()?;
    Some(ReadType::Number {
        scalar: scalar.clone(),
        width: *width,
        rows: Some(2),
        columns: Some((count, Some(stride))),
    })
}
