//! Inputs, outputs, bindings and sizes of translated texts, as naga reads them.

use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::tree::Stage;
use lamplight_glsl::wgsl::{Fact, Facts};
use lamplight_glsl::{translate, wgsl};
use libtest_mimic::{Failed, Trial};
use naga::{AddressSpace, Binding, Module, Sampling, StorageAccess, TypeInner};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("glsl::interface/colors", colors),
        Trial::test("glsl::interface/locations", locations),
        Trial::test("glsl::interface/interpolation", interpolation),
        Trial::test("glsl::interface/bindings", bindings),
        Trial::test("glsl::interface/initial_values", initial_values),
        Trial::test("glsl::interface/workgroup_size", workgroup_size),
        Trial::test("glsl::interface/barriers", barriers),
        Trial::test("glsl::interface/vertex_buffers", vertex_buffers),
        Trial::test("glsl::interface/discards_end_loops", discards_end_loops),
        Trial::test("glsl::many_functions", many_functions),
    ]
}

/// A translation that naga's validator accepts.
fn read(stage: Stage, text: &str) -> Result<(Module, String, Facts), Failed> {
    let text = format!("#version 450\n{text}\n");
    let options = wgsl::Options::default();
    let written = translate(&text, stage, SourceId(0), options)
        .map_err(|problems| format!("{text}: {}", problems[0].message))?;
    let module = naga::front::wgsl::parse_str(&written.text)
        .map_err(|error| error.emit_to_string(&written.text))?;
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::all());
    validator.validate(&module).map_err(|error| error.emit_to_string(&written.text))?;
    Ok((module, written.text, written.facts))
}

fn same<T: PartialEq + std::fmt::Debug>(found: T, wanted: T) -> Result<(), Failed> {
    if found == wanted {
        return Ok(());
    }
    Err(format!("{found:?}, and should be {wanted:?}").into())
}

/// The bindings of arguments, or of the members of the result.
fn inputs(module: &Module) -> Vec<Binding> {
    let arguments = &module.entry_points[0].function.arguments;
    arguments.iter().filter_map(|argument| argument.binding.clone()).collect()
}

fn outputs(module: &Module) -> Vec<Binding> {
    let Some(result) = &module.entry_points[0].function.result else { return Vec::new() };
    match &module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => {
            members.iter().filter_map(|member| member.binding.clone()).collect()
        }
        _ => result.binding.clone().into_iter().collect(),
    }
}

fn locations_of(bindings: &[Binding]) -> Vec<u32> {
    let location = |binding: &Binding| match binding {
        Binding::Location { location, .. } => Some(*location),
        Binding::BuiltIn(_) => None,
    };
    bindings.iter().filter_map(location).collect()
}

fn colors() -> Result<(), Failed> {
    let text = "void main() { for (int i = 0; i < 3; i++) gl_FragData[i] = vec4(i); }";
    let (module, ..) = read(Stage::Fragment, text)?;
    same(locations_of(&outputs(&module)), (0..8).collect())?;
    let text = "void main() { gl_FragData[0] = vec4(1.0); gl_FragData[2] = vec4(2.0); }";
    let (module, ..) = read(Stage::Fragment, text)?;
    same(locations_of(&outputs(&module)), vec![0, 2])
}

/// A matrix takes a location for each column, and what has none gets the next free ones.
fn locations() -> Result<(), Failed> {
    let text = "layout(location = 0) in mat4 model; in vec3 place; \
                void main() { gl_Position = model * vec4(place, 1.0); }";
    let (module, ..) = read(Stage::Vertex, text)?;
    same(locations_of(&inputs(&module)), vec![0, 1, 2, 3, 4])
}

fn interpolation() -> Result<(), Failed> {
    let text = "layout(location = 0) in Block { centroid vec2 a; sample vec2 b; vec2 c; } block; \
                layout(location = 3) out vec4 color; \
                void main() { color = vec4(block.a + block.b, block.c); }";
    let (module, ..) = read(Stage::Fragment, text)?;
    let sampling = |binding: &Binding| match binding {
        Binding::Location { sampling, .. } => *sampling,
        Binding::BuiltIn(_) => None,
    };
    let found: Vec<Option<Sampling>> = inputs(&module).iter().map(sampling).collect();
    let wanted = [Sampling::Centroid, Sampling::Sample, Sampling::Center].map(Some);
    same(found, wanted.to_vec())?;
    let text = "out gl_PerVertex { invariant vec4 gl_Position; }; \
                void main() { gl_Position = vec4(1.0); }";
    let (module, ..) = read(Stage::Vertex, text)?;
    let position = naga::BuiltIn::Position { invariant: true };
    same(outputs(&module), vec![Binding::BuiltIn(position)])
}

/// Elements have the numbers after the first, unless another variable has them.
fn bindings() -> Result<(), Failed> {
    let text = "layout(binding = 4) uniform sampler2D a[3]; \
                layout(binding = 5) uniform sampler2D b; \
                layout(binding = 5) uniform Block { vec4 c; }; \
                layout(location = 0) out vec4 color; \
                void main() { color = c + texture(a[1], c.xy) + texture(b, c.xy); }";
    let (_, _, facts) = read(Stage::Fragment, text)?;
    let number = |name: &str| {
        facts.names.resources.iter().find(|found| found.name == name).map(|found| found.binding)
    };
    same(["a[0]", "a[2]", "b"].map(number), [Some(4), Some(6), Some(5)])?;
    let moved = |(fact, _): &(Fact, _)| match fact {
        Fact::Binding(name, wanted, found) => Some((name.clone(), *wanted, *found)),
        _ => None,
    };
    let moved: Vec<(String, u32, u32)> = facts.list.iter().filter_map(moved).collect();
    let names: Vec<(&str, u32)> = moved.iter().map(|(name, from, _)| (&**name, *from)).collect();
    same(names, vec![("a[1]", 5), ("block", 5)])?;
    for (name, _, found) in &moved {
        let has_it = |resource: &&wgsl::Resource| resource.binding == *found;
        if facts.names.resources.iter().filter(has_it).count() != 1 {
            return Err(format!("`{name}` shares the binding {found}").into());
        }
    }
    Ok(())
}

/// What a uniform begins with is noted, or the text is refused.
fn initial_values() -> Result<(), Failed> {
    let text = "uniform vec2 a = vec2(1.0, 2.0) * 2.0; layout(location = 0) out vec4 color; \
                void main() { color = a.xyxy; }";
    let (_, _, facts) = read(Stage::Fragment, text)?;
    let list: Vec<Fact> = facts.list.into_iter().map(|(fact, _)| fact).collect();
    same(list, vec![Fact::Initial("a".to_owned(), vec![2.0, 4.0])])
}

/// The size by an id is an override of that id, and `gl_WorkGroupSize` names it.
fn workgroup_size() -> Result<(), Failed> {
    let text = "layout(local_size_x = 8, local_size_x_id = 18, local_size_y = 2) in; \
                buffer B { uint a; }; void main() { a = gl_WorkGroupSize.x; }";
    let (module, ..) = read(Stage::Compute, text)?;
    let entry = &module.entry_points[0];
    let Some([Some(_), ..]) = entry.workgroup_size_overrides else {
        return Err("the size is no override".into());
    };
    let ids: Vec<Option<u16>> = module.overrides.iter().map(|(_, found)| found.id).collect();
    same(ids, vec![Some(18)])?;
    let named = entry
        .function
        .expressions
        .iter()
        .any(|(_, expression)| matches!(expression, naga::Expression::Override(_)));
    same(named, true)
}

/// A barrier is for all memory, and memory barriers beside it are no more of them.
fn barriers() -> Result<(), Failed> {
    let text = "buffer B { uint a[2]; }; layout(r32ui) uniform uimage2D image; \
                void main() { memoryBarrierBuffer(); memoryBarrierImage(); barrier(); \
                groupMemoryBarrier(); a[0] = imageLoad(image, ivec2(0)).x; \
                imageStore(image, ivec2(1), uvec4(a[1])); }";
    let (_, text, _) = read(Stage::Compute, text)?;
    let count = |name: &str| text.matches(name).count();
    same(["storageBarrier()", "textureBarrier()", "workgroupBarrier()"].map(count), [1; 3])
}

fn vertex_buffers() -> Result<(), Failed> {
    let text = "layout(binding = 0) buffer B { vec4 a[]; }; \
                void main() { gl_Position = a[gl_VertexIndex]; }";
    let (module, ..) = read(Stage::Vertex, text)?;
    let spaces: Vec<AddressSpace> =
        module.global_variables.iter().map(|(_, variable)| variable.space).collect();
    let wanted = AddressSpace::Storage { access: StorageAccess::LOAD };
    match spaces.contains(&wanted) {
        true => Ok(()),
        false => Err(format!("{spaces:?}").into()),
    }
}

/// WGSL goes on after `discard`: each loop asks first whether a function met one.
fn discards_end_loops() -> Result<(), Failed> {
    let text = "layout(location = 0) out vec4 color; void end() { discard; } \
                void main() { int i = 0; while (true) { if (i++ > 3) end(); } color = vec4(1.0); }";
    let (_, text, _) = read(Stage::Fragment, text)?;
    let body = text.split("while true {").nth(1).unwrap_or_default().trim_start();
    if body.starts_with("if discarded {") && text.contains("discarded = true;") {
        return Ok(());
    }
    Err(text.into())
}

/// Many functions that call each other take no more than linear time, at any order.
fn many_functions() -> Result<(), Failed> {
    let count = 6000;
    let mut text = "float f0() { return 1.0; }\n".to_owned();
    for index in 1..count {
        text.push_str(&format!("float f{index}() {{ return f{}() + f0(); }}\n", index - 1));
    }
    text.push_str(&format!("void main() {{ float a = f{}(); }}\n", count - 1));
    let start = std::time::Instant::now();
    let parsed = translate(&text, Stage::Fragment, SourceId(0), Default::default());
    parsed.map_err(|problems| problems[0].message.clone())?;
    if start.elapsed().as_secs() > 20 {
        return Err(format!("{:?}", start.elapsed()).into());
    }
    Ok(())
}
