//! Arrays of matrices of two rows in HLSL.
//!
//! Where such an array is in a structure or a block, naga declares its matrices as structures of
//! columns, and casts them to matrices and back. fxc and dxc take that, glslang does not. All of
//! them take functions that do the same.

use std::collections::BTreeSet;

use naga::valid::ModuleInfo;
use naga::{Expression, Handle, Module, Span, TypeInner, VectorSize};

/// The prefix of the names of the structures of columns. In HLSL no author's name begins with it.
pub const STRUCTURE: &str = "__mat";

/// Kinds of numbers, and the bits that the structure's name has.
const SCALARS: [(&str, &str); 3] = [("float", "32"), ("half", "16"), ("double", "64")];

/// Why a program is refused.
pub const TAKEN: &str = "an array of matrices of two rows is taken from a structure that is no \
     variable: keep the structure in a `var`, or use vectors";

/// What is cast: a matrix, or an array of them.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct CastShape {
    scalar: &'static str,
    bits: &'static str,
    columns: usize,
    /// The outermost first.
    sizes: Vec<usize>,
    /// Whether the cast is from columns to matrices, rather than from matrices to columns.
    is_read: bool,
}

/// The text with functions in the place of casts.
pub fn without_casts(text: &str) -> String {
    if !text.contains(STRUCTURE) {
        return text.to_owned();
    }
    let mut shapes = BTreeSet::new();
    let mut line = |line: &str| rewrite_write(&rewrite_read(line, &mut shapes), &mut shapes);
    let changed: String = text.split_inclusive('\n').map(&mut line).collect();
    shapes.iter().fold(changed, |text, shape| shape.declared_in(text))
}

/// Replaces casts such as `((float3x2[4])a)` by calls.
fn rewrite_read(line: &str, shapes: &mut BTreeSet<CastShape>) -> String {
    let mut changed = String::with_capacity(line.len());
    let mut parts = line.split("((");
    changed.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let shape =
            part.split_once(')').and_then(|(ty, rest)| Some((CastShape::of_matrix(ty)?, rest)));
        match shape {
            Some((shape, rest)) => {
                changed.push_str(&shape.function());
                changed.push('(');
                changed.push_str(rest);
                shapes.insert(shape);
            }
            None => {
                changed.push_str("((");
                changed.push_str(part);
            }
        }
    }
    changed
}

/// Replaces the cast in a line such as `a = (__mat3x2_f32[4])b;` by a call.
fn rewrite_write(line: &str, shapes: &mut BTreeSet<CastShape>) -> String {
    let changed = line.split_once(" = (").and_then(|(before, cast)| {
        let (ty, value) = cast.strip_suffix(";\n")?.split_once(')')?;
        let shape = CastShape::of_columns(ty)?;
        let changed = format!("{before} = {}({value});\n", shape.function());
        shapes.insert(shape);
        Some(changed)
    });
    changed.unwrap_or_else(|| line.to_owned())
}

impl CastShape {
    /// Reads `float3x2[4]`.
    fn of_matrix(ty: &str) -> Option<Self> {
        let (scalar, bits) = SCALARS.iter().find(|(scalar, _)| ty.starts_with(scalar))?;
        let (columns, sizes) = ty.strip_prefix(scalar)?.split_once("x2")?;
        Self::read(scalar, bits, columns, sizes, true)
    }

    /// Reads `__mat3x2_f32[4]`.
    fn of_columns(ty: &str) -> Option<Self> {
        let (columns, rest) = ty.strip_prefix(STRUCTURE)?.split_once("x2_f")?;
        let (scalar, bits) = SCALARS.iter().find(|(_, bits)| rest.starts_with(bits))?;
        Self::read(scalar, bits, columns, rest.strip_prefix(bits)?, false)
    }

    fn read(
        scalar: &'static str,
        bits: &'static str,
        columns: &str,
        sizes: &str,
        is_read: bool,
    ) -> Option<Self> {
        let sizes = match sizes {
            "" => Vec::new(),
            sizes => {
                let sizes = sizes.strip_prefix('[')?.strip_suffix(']')?.split("][");
                sizes.map(|size| size.parse().ok()).collect::<Option<_>>()?
            }
        };
        Some(Self { scalar, bits, columns: columns.parse().ok()?, sizes, is_read })
    }

    fn columns(&self) -> String {
        format!("{STRUCTURE}{}x2_f{}", self.columns, self.bits)
    }

    fn matrix(&self) -> String {
        format!("{}{}x2", self.scalar, self.columns)
    }

    /// The name of the function. It begins with `naga_`, as no author's name does in the output.
    fn function(&self) -> String {
        let way = if self.is_read { "from" } else { "to" };
        let sizes: String = self.sizes.iter().map(|size| format!("_{size}")).collect();
        format!("naga_{way}_mat{}x2_f{}{sizes}", self.columns, self.bits)
    }

    /// The text with the function declared behind those that naga declares for these columns.
    fn declared_in(&self, text: String) -> String {
        let last = format!("void __set_el_of_mat{}x2_f{}(", self.columns, self.bits);
        let end = text.find(&last).and_then(|at| Some(at + text[at..].find("\n}\n")? + 3));
        match end {
            Some(end) => format!("{}{}{}", &text[..end], self.declaration(), &text[end..]),
            None => text,
        }
    }

    fn declaration(&self) -> String {
        let (given, made) = match self.is_read {
            true => (self.columns(), self.matrix()),
            false => (self.matrix(), self.columns()),
        };
        let sizes: String = self.sizes.iter().map(|size| format!("[{size}]")).collect();
        let function = self.function();
        // Functions of HLSL can return an array only if its type has a name.
        let (typedef, result) = match self.sizes.is_empty() {
            true => (String::new(), made.clone()),
            false => {
                (format!("typedef {made} ret_{function}{sizes};\n"), format!("ret_{function}"))
            }
        };
        let loops = self.sizes.iter().enumerate().map(|(at, size)| {
            let counter = format!("at_{at}_0");
            format!("for (uint {counter} = 0u; {counter} < {size}u; {counter}++) ")
        });
        let place: String = (0..self.sizes.len()).map(|at| format!("[at_{at}_0]")).collect();
        let (loops, copied) = (loops.collect::<String>(), self.copied(&place));
        format!(
            "{typedef}{result} {function}({given} from_0{sizes}) {{\n    {made} to_0{sizes};\n    \
             {loops}{{ {copied} }}\n    return to_0;\n}}\n"
        )
    }

    /// Statements that copy one matrix.
    fn copied(&self, place: &str) -> String {
        let column = |column: usize| match self.is_read {
            true => format!("to_0{place}[{column}] = from_0{place}._{column};"),
            false => format!("to_0{place}._{column} = from_0{place}[{column}];"),
        };
        (0..self.columns).map(column).collect::<Vec<String>>().join(" ")
    }
}

/// The places where an array of matrices of two rows is taken from a structure that is a value and
/// not a variable. For these, naga writes columns where matrices are needed.
pub fn taken_from_values<'m>(
    module: &'m Module,
    info: &'m ModuleInfo,
) -> impl Iterator<Item = Span> + 'm {
    let functions = module.functions.iter().map(|(handle, one)| (one, &info[handle]));
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (&point.function, info.get_entry_point(index)));
    functions.chain(points).flat_map(move |(function, info)| {
        let taken = move |(_, one): &(Handle<Expression>, &Expression)| match one {
            Expression::AccessIndex { base, index } => {
                has_columns(module, info[*base].ty.inner_with(&module.types), *index)
            }
            _ => false,
        };
        let found = function.expressions.iter().filter(taken);
        found.map(|(handle, _)| function.expressions.get_span(handle))
    })
}

/// Whether a member is an array of matrices of two rows.
fn has_columns(module: &Module, structure: &TypeInner, member: u32) -> bool {
    let TypeInner::Struct { members, span: _ } = structure else { return false };
    let mut ty = members.get(member as usize).map(|member| &module.types[member.ty].inner);
    let mut is_array = false;
    while let Some(TypeInner::Array { base, size: _, stride: _ }) = ty {
        (is_array, ty) = (true, Some(&module.types[*base].inner));
    }
    is_array
        && matches!(ty, Some(TypeInner::Matrix { rows: VectorSize::Bi, columns: _, scalar: _ }))
}
