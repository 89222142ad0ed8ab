//! Members of structures that fill the gaps between others, for GLSL, whose older versions have no
//! other way to say where a member lies.

use std::collections::{BTreeMap, BTreeSet};

use naga::proc::TypeResolution;
use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    AddressSpace, Arena, Constant, EntryPoint, Expression, Function, FunctionArgument,
    FunctionResult, GlobalVariable, Handle, LocalVariable, Module, Override, Scalar, Span,
    SpecialTypes, StructMember, Type, TypeInner, UniqueArena, VectorSize,
};

use super::gaps::{Gap, Rules, collect_structs, ends_of, gaps_of};
use super::located;
use super::rebuild::rebuild;
use lamplight_validate::{change_operands, info_unchecked};

/// How the names of padding begin, for those who read an output.
pub const PADDING: &str = "lamplight_padding";

type TypeHandle = Handle<Type>;

/// The module in which padding fills every gap of uniform and storage buffers, and naga's analysis of
/// it; `None` where there are no gaps.
///
/// # Errors
/// A structure lies otherwise than GLSL can say.
pub fn with_padding(
    module: &Module,
    info: &ModuleInfo,
) -> Result<Option<(Module, ModuleInfo)>, String> {
    let gaps = all_gaps(module)?;
    if gaps.is_empty() {
        return Ok(None);
    }
    let types = PaddedTypes::of(module, &gaps)?;
    let made = padded_module(module, info, types)?;
    let info = info_unchecked(&made)
        .map_err(|error| format!("a module with padding is not valid: {error}"))?;
    Ok(Some((made, info)))
}

/// The structures that have gaps.
fn all_gaps(module: &Module) -> Result<BTreeMap<TypeHandle, Vec<Gap>>, String> {
    let laid_out = |is_wanted: fn(AddressSpace) -> bool| {
        let mut structs = BTreeSet::new();
        let all = module.global_variables.iter().filter(|(_, one)| is_wanted(one.space));
        all.for_each(|(_, variable)| collect_structs(module, variable.ty, &mut structs));
        structs
    };
    let uniform = laid_out(|space| space == AddressSpace::Uniform);
    let storage = laid_out(|space| matches!(space, AddressSpace::Storage { access: _ }));
    let mut found = BTreeMap::new();
    for ty in uniform.union(&storage) {
        let rules = if storage.contains(ty) { Rules::Plain } else { Rules::Std140 };
        let gaps = gaps_of(module, *ty, rules)?;
        if uniform.contains(ty) && !is_right_for_uniform(module, *ty, &gaps)? {
            let name = module.types[*ty].name.as_deref().unwrap_or_default();
            return Err(format!(
                "`{name}` needs other padding in a uniform block than in a storage buffer"
            ));
        }
        if !gaps.is_empty() {
            // An input or output of a stage cannot be padding.
            if let TypeInner::Struct { members, span: _ } = &module.types[*ty].inner
                && members.iter().any(|member| member.binding.is_some())
            {
                return Err(located::LOCATED.to_owned());
            }
            found.insert(*ty, gaps);
        }
    }
    Ok(found)
}

/// Whether padding in these gaps, which are all that `std140` has or more, lies in them with its rules
/// too: they leave room behind arrays and structures that others do not.
fn is_right_for_uniform(module: &Module, ty: TypeHandle, gaps: &[Gap]) -> Result<bool, String> {
    gaps_of(module, ty, Rules::Std140)?;
    let ends = ends_of(module, ty, Rules::Std140);
    Ok(gaps.iter().all(|gap| gap.before == 0 || ends.get(gap.before - 1) == Some(&gap.from)))
}

/// Where the members of a structure are among those with padding.
struct PaddedStruct {
    /// The new index of each old member.
    moved: Vec<u32>,
    /// The type of each padding, by its index.
    padding: BTreeMap<u32, TypeHandle>,
}

/// The types of a module with padding.
struct PaddedTypes {
    types: UniqueArena<Type>,
    /// The new handle of each old one.
    moved: Vec<TypeHandle>,
    /// By the old handle.
    structs: BTreeMap<TypeHandle, PaddedStruct>,
}

/// The types that padding consists of.
struct Fillings {
    /// Of 4 bytes.
    number: TypeHandle,
    /// Of 16 bytes, with their alignment.
    vector: TypeHandle,
    /// Of 64 bytes.
    matrix: TypeHandle,
}

impl PaddedTypes {
    fn of(module: &Module, gaps: &BTreeMap<TypeHandle, Vec<Gap>>) -> Result<Self, String> {
        let mut types = UniqueArena::new();
        let mut add = |inner| types.insert(Type { name: None, inner }, Span::UNDEFINED);
        // Types come before those that have them.
        let fillings = Fillings {
            number: add(TypeInner::Scalar(Scalar::F32)),
            vector: add(TypeInner::Vector { size: VectorSize::Quad, scalar: Scalar::F32 }),
            matrix: add(TypeInner::Matrix {
                columns: VectorSize::Quad,
                rows: VectorSize::Quad,
                scalar: Scalar::F32,
            }),
        };
        let mut padded = Self { types, moved: Vec::new(), structs: BTreeMap::new() };
        for (handle, ty) in module.types.iter() {
            let span = module.types.get_span(handle);
            let Type { name, inner } = ty.clone();
            let inner = match (inner, gaps.get(&handle)) {
                (TypeInner::Struct { members, span }, Some(gaps)) => {
                    let (members, filled) = padded.filled(&members, gaps, &fillings)?;
                    padded.structs.insert(handle, filled);
                    TypeInner::Struct { members, span }
                }
                (inner, _) => padded.moved_inner(inner),
            };
            let new = padded.types.insert(Type { name, inner }, span);
            padded.moved.push(new);
        }
        Ok(padded)
    }

    fn ty(&self, old: TypeHandle) -> TypeHandle {
        self.moved[old.index()]
    }

    fn moved_inner(&self, mut inner: TypeInner) -> TypeInner {
        match &mut inner {
            TypeInner::Pointer { base, space: _ }
            | TypeInner::Array { base, size: _, stride: _ }
            | TypeInner::BindingArray { base, size: _ } => *base = self.ty(*base),
            TypeInner::Struct { members, span: _ } => {
                members.iter_mut().for_each(|member| member.ty = self.ty(member.ty));
            }
            TypeInner::Scalar(_)
            | TypeInner::Vector { size: _, scalar: _ }
            | TypeInner::Matrix { columns: _, rows: _, scalar: _ }
            | TypeInner::CooperativeMatrix { columns: _, rows: _, scalar: _, role: _ }
            | TypeInner::Atomic(_)
            | TypeInner::ValuePointer { size: _, scalar: _, space: _ }
            | TypeInner::Image { dim: _, arrayed: _, class: _ }
            | TypeInner::Sampler { comparison: _ }
            | TypeInner::AccelerationStructure { vertex_return: _ }
            | TypeInner::RayQuery { vertex_return: _ } => {}
        }
        inner
    }

    /// The members of a structure, with padding in its gaps.
    fn filled(
        &self,
        members: &[StructMember],
        gaps: &[Gap],
        fillings: &Fillings,
    ) -> Result<(Vec<StructMember>, PaddedStruct), String> {
        let (mut all, mut moved) = (Vec::new(), Vec::new());
        let mut padding = BTreeMap::new();
        for index in 0..=members.len() {
            for gap in gaps.iter().filter(|gap| gap.before == index) {
                for (offset, ty) in fill(*gap, fillings)? {
                    padding.insert(all.len() as u32, ty);
                    let name = Some(PADDING.to_owned());
                    all.push(StructMember { name, ty, binding: None, offset });
                }
            }
            if let Some(StructMember { name, ty, binding, offset }) = members.get(index).cloned() {
                moved.push(all.len() as u32);
                all.push(StructMember { name, ty: self.ty(ty), binding, offset });
            }
        }
        Ok((all, PaddedStruct { moved, padding }))
    }
}

/// The places and the types of padding in a gap.
fn fill(gap: Gap, fillings: &Fillings) -> Result<Vec<(u32, TypeHandle)>, String> {
    /// A structure of four kilobytes that is nothing but padding is a mistake or an attack.
    const MOST: u32 = 4096;
    let Gap { before: _, from, to } = gap;
    if !from.is_multiple_of(4) || !to.is_multiple_of(4) || to - from > MOST {
        return Err(format!("no padding can fill the bytes {from} to {to} of a structure"));
    }
    let (mut at, mut found) = (from, Vec::new());
    while at < to {
        let (size, ty) = match to - at {
            64.. if at.is_multiple_of(16) => (64, fillings.matrix),
            16.. if at.is_multiple_of(16) => (16, fillings.vector),
            _ => (4, fillings.number),
        };
        found.push((at, ty));
        at += size;
    }
    Ok(found)
}

fn padded_module(module: &Module, info: &ModuleInfo, types: PaddedTypes) -> Result<Module, String> {
    let Module {
        types: _,
        special_types,
        mut constants,
        mut overrides,
        mut global_variables,
        global_expressions,
        mut functions,
        mut entry_points,
        diagnostic_filters,
        diagnostic_filter_leaf,
        doc_comments: _,
    } = module.clone();
    let (global_expressions, moved) = padded_constants(&global_expressions, module, &types)?;
    for (_, Constant { name: _, ty, init }) in constants.iter_mut() {
        (*ty, *init) = (types.ty(*ty), moved[init.index()]);
    }
    for (_, Override { name: _, id: _, ty, init }) in overrides.iter_mut() {
        *ty = types.ty(*ty);
        init.iter_mut().for_each(|init| *init = moved[init.index()]);
    }
    for (_, variable) in global_variables.iter_mut() {
        let GlobalVariable { name: _, space: _, binding: _, ty, init, memory_decorations: _ } =
            variable;
        *ty = types.ty(*ty);
        init.iter_mut().for_each(|init| *init = moved[init.index()]);
    }
    for (handle, function) in functions.iter_mut() {
        pad_function(function, module, &info[handle], &types);
    }
    for (index, point) in entry_points.iter_mut().enumerate() {
        let sizes = pad_entry_point(point, module, info.get_entry_point(index), &types);
        sizes.iter_mut().flatten().flatten().for_each(|size| *size = moved[size.index()]);
    }
    Ok(Module {
        special_types: moved_special(special_types, &types),
        types: types.types,
        constants,
        overrides,
        global_variables,
        global_expressions,
        functions,
        entry_points,
        diagnostic_filters,
        diagnostic_filter_leaf,
        doc_comments: None,
    })
}

/// Gives an entry point the types with padding. Returns the sizes of its workgroup, which name
/// constant expressions.
fn pad_entry_point<'p>(
    point: &'p mut EntryPoint,
    module: &Module,
    info: &FunctionInfo,
    types: &PaddedTypes,
) -> &'p mut Option<[Option<Handle<Expression>>; 3]> {
    let EntryPoint {
        name: _,
        stage: _,
        early_depth_test: _,
        workgroup_size: _,
        workgroup_size_overrides,
        function,
        mesh_info: _,
        task_payload: _,
        incoming_ray_payload: _,
    } = point;
    pad_function(function, module, info, types);
    workgroup_size_overrides
}

fn moved_special(special: SpecialTypes, types: &PaddedTypes) -> SpecialTypes {
    let SpecialTypes {
        ray_desc,
        ray_intersection,
        ray_vertex_return,
        external_texture_params,
        external_texture_transfer_function,
        predeclared_types,
    } = special;
    let moved = |ty: Option<TypeHandle>| ty.map(|ty| types.ty(ty));
    SpecialTypes {
        ray_desc: moved(ray_desc),
        ray_intersection: moved(ray_intersection),
        ray_vertex_return: moved(ray_vertex_return),
        external_texture_params: moved(external_texture_params),
        external_texture_transfer_function: moved(external_texture_transfer_function),
        predeclared_types: predeclared_types
            .into_iter()
            .map(|(one, ty)| (one, types.ty(ty)))
            .collect(),
    }
}

/// The constant expressions with padding, and the new handle of each.
fn padded_constants(
    old: &Arena<Expression>,
    module: &Module,
    types: &PaddedTypes,
) -> Result<(Arena<Expression>, Vec<Handle<Expression>>), String> {
    let (mut new, mut moved) = (Arena::new(), Vec::new());
    for (handle, expression) in old.iter() {
        let mut expression = expression.clone();
        // naga computes members of constants; those of overrides are no structures.
        if let Expression::AccessIndex { base, index: _ } = expression
            && matches!(old[base], Expression::Compose { ty, .. } | Expression::ZeroValue(ty)
                if matches!(module.types[ty].inner, TypeInner::Struct { members: _, span: _ }))
        {
            return Err("a constant takes a member of a structure that needs padding".to_owned());
        }
        change_operands(&mut expression, &mut |operand: &mut Handle<Expression>| {
            *operand = moved[operand.index()];
        });
        moved.push(types.append(expression, old.get_span(handle), &mut new));
    }
    Ok((new, moved))
}

impl PaddedTypes {
    /// Appends an expression whose operands are new ones and whose types are old ones.
    fn append(
        &self,
        mut expression: Expression,
        span: Span,
        to: &mut Arena<Expression>,
    ) -> Handle<Expression> {
        match &mut expression {
            Expression::Compose { ty, components } => {
                if let Some(filled) = self.structs.get(ty) {
                    let mut own = std::mem::take(components).into_iter();
                    let count = filled.moved.len() + filled.padding.len();
                    let all = (0..count as u32).map(|index| match filled.padding.get(&index) {
                        Some(ty) => Some(to.append(Expression::ZeroValue(*ty), span)),
                        None => own.next(),
                    });
                    *components = all.flatten().collect();
                }
                *ty = self.ty(*ty);
            }
            Expression::ZeroValue(ty)
            | Expression::AtomicResult { ty, comparison: _ }
            | Expression::WorkGroupUniformLoadResult { ty }
            | Expression::SubgroupOperationResult { ty } => *ty = self.ty(*ty),
            _ => {}
        }
        to.append(expression, span)
    }
}

/// Gives a function the types with padding.
fn pad_function(
    function: &mut Function,
    module: &Module,
    info: &FunctionInfo,
    types: &PaddedTypes,
) {
    for FunctionArgument { name: _, ty, binding: _ } in &mut function.arguments {
        *ty = types.ty(*ty);
    }
    if let Some(FunctionResult { ty, binding: _ }) = &mut function.result {
        *ty = types.ty(*ty);
    }
    for (_, LocalVariable { name: _, ty, init: _ }) in function.local_variables.iter_mut() {
        *ty = types.ty(*ty);
    }
    let members: BTreeMap<Handle<Expression>, u32> = function
        .expressions
        .iter()
        .filter_map(|(handle, expression)| {
            let Expression::AccessIndex { base, index } = expression else { return None };
            let filled = types.structs.get(&accessed(module, &info[*base].ty)?)?;
            Some((handle, *filled.moved.get(*index as usize)?))
        })
        .collect();
    rebuild(function, &mut |old, mut expression, span, to| {
        if let (Expression::AccessIndex { base: _, index }, Some(new)) =
            (&mut expression, members.get(&old))
        {
            *index = *new;
        }
        types.append(expression, span, to)
    });
}

/// The structure that a value is, or that it points to.
fn accessed(module: &Module, ty: &TypeResolution) -> Option<TypeHandle> {
    match ty.inner_with(&module.types) {
        TypeInner::Pointer { base, space: _ } => Some(*base),
        _ => ty.handle(),
    }
}

#[cfg(test)]
mod tests {
    use super::{located, with_padding};
    use lamplight_validate::{info_for_some, parse_wgsl};

    #[test]
    fn inputs_get_no_padding() {
        let input = "struct S { @align(64) @location(0) a: f32, @builtin(position) b: vec4f }
            @group(0) @binding(0) var<storage, read_write> all: S;
            @fragment fn main(input: S) { all = input; }";
        let module = parse_wgsl(input).unwrap();
        let made = with_padding(&module, &info_for_some(&module).unwrap());
        assert_eq!(made.map(|made| made.is_some()), Err(located::LOCATED.to_owned()));
    }
}
