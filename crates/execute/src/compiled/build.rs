//! Builds one program from many MSL texts: compiles units of several texts on all cores, and links
//! them.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::Output;
use std::sync::OnceLock;
use std::{fs, io};

use rayon::prelude::*;

use super::interface::{Interface, InterfaceMember, InterfaceRole};
use lamplight_tools::halve_refused;
use lamplight_tools::metal::adapt::adapt_text;
use lamplight_tools::metal::{Clang, ClangMissing};

/// Bytes of texts in a unit. It is large enough that the headers cost little, and small enough that
/// all cores have work.
const UNIT: usize = 1 << 18;

/// How shaders are compiled: without contraction, so that each operation is rounded by itself, and
/// without undefined behaviour where Metal has none. Only functions of the headers are inlined, since
/// inlining those of shaders takes longer than it saves.
const FLAGS: &[&str] = &[
    "-c",
    "-O1",
    "-ffp-contract=off",
    "-fno-exceptions",
    "-finline-hint-functions",
    "-fno-math-errno",
    "-fno-rtti",
    "-fno-strict-aliasing",
    "-fwrapv",
];

/// A linked program.
#[derive(Debug)]
pub struct Built {
    pub clang: Clang,
    /// For each text its interface, or why it cannot be run.
    pub entries: Vec<Result<Interface, String>>,
}

impl Built {
    pub fn program(&self) -> PathBuf {
        self.clang.path("program")
    }
}

/// Compiles and links.
pub fn build_program(texts: &[&str]) -> Result<Built, ClangMissing> {
    let clang = Clang::open()?;
    let mut entries: Vec<_> = texts.iter().map(|text| Interface::read(text)).collect();
    let units = text_units(texts, &entries);
    // The first job is the runtime.
    let jobs: Vec<Option<&Vec<TextInterface<'_>>>> =
        [None].into_iter().chain(units.iter().map(Some)).collect();
    let compiled = jobs.par_iter().map(|job| match job {
        None => compile_runtime(&clang),
        Some(unit) => compile_unit(&clang, texts, unit),
    });
    let objects = compiled.collect::<Result<Vec<_>, ClangMissing>>()?;
    let mut names = Vec::new();
    for object in objects.into_iter().flatten() {
        match object {
            ObjectFile::Compiled(name) => names.push(name),
            ObjectFile::Refused(text, errors) => entries[text] = Err(errors),
        }
    }
    names.sort();
    link_objects(&clang, &entries, &names)?;
    Ok(Built { clang, entries })
}

/// The result of compiling a unit: its object file, or the errors of one of its texts.
enum ObjectFile {
    /// The file's name.
    Compiled(String),
    Refused(usize, String),
}

type Objects = Result<Vec<ObjectFile>, ClangMissing>;

/// A text that is compiled: its index, and its interface.
type TextInterface<'t> = (usize, &'t Interface);

fn text_units<'t>(
    texts: &[&str],
    entries: &'t [Result<Interface, String>],
) -> Vec<Vec<TextInterface<'t>>> {
    let (mut units, mut bytes) = (Vec::new(), UNIT);
    for (index, entry) in entries.iter().enumerate() {
        let Ok(interface) = entry else { continue };
        if bytes >= UNIT {
            units.push(Vec::new());
            bytes = 0;
        }
        bytes += texts[index].len();
        if let Some(unit) = units.last_mut() {
            unit.push((index, interface));
        }
    }
    units
}

/// Compiles a unit, and its halves if it is refused, until the texts at fault are found.
fn compile_unit(clang: &Clang, texts: &[&str], unit: &[TextInterface<'_>]) -> Objects {
    let compile = |unit: &[TextInterface<'_>]| {
        let first = unit.first().map_or(0, |(index, _)| *index);
        let name = format!("unit{first}-{}.o", unit.len());
        let arguments: Vec<&str> = FLAGS.iter().copied().chain(["-o", &name]).collect();
        let output = clang.compile(&unit_source(texts, unit), &arguments)?;
        Ok((ObjectFile::Compiled(name), output))
    };
    let together = |unit: &[TextInterface<'_>]| {
        let (object, output) = compile(unit)?;
        Ok(output.status.success().then(|| vec![object]))
    };
    let alone = |one: &TextInterface<'_>| {
        let (object, output) = compile(&[*one])?;
        match output.status.success() {
            true => Ok(vec![object]),
            false => Ok(vec![ObjectFile::Refused(one.0, output_text(&output))]),
        }
    };
    halve_refused(unit, &together, &alone)
}

fn output_text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).trim().to_owned()
}

/// Compiles the runtime, which reads requests and calls the shaders. It is the same for all
/// programs, so that a process compiles it once.
fn compile_runtime(clang: &Clang) -> Objects {
    static COMPILED: OnceLock<Vec<u8>> = OnceLock::new();
    let (name, path) = ("runtime.o", clang.path("runtime.o"));
    let unusable = |error: io::Error| ClangMissing { reason: format!("`{name}`: {error}") };
    if let Some(bytes) = COMPILED.get() {
        fs::write(path, bytes).map_err(unusable)?;
    } else {
        check_output(clang.call(&["-std=c++17", "-O1", "-c", "runtime.cpp", "-o", name])?)?;
        let bytes = fs::read(path).map_err(unusable)?;
        COMPILED.get_or_init(|| bytes);
    }
    Ok(vec![ObjectFile::Compiled(name.to_owned())])
}

fn check_output(output: Output) -> Result<(), ClangMissing> {
    if output.status.success() {
        Ok(())
    } else {
        Err(ClangMissing { reason: output_text(&output) })
    }
}

/// Links all, with the table of entry points.
fn link_objects(
    clang: &Clang,
    entries: &[Result<Interface, String>],
    objects: &[String],
) -> Result<(), ClangMissing> {
    let mut table = "#include \"runtime.h\"\nusing namespace __lamplight;\n".to_owned();
    for (index, _) in entries.iter().enumerate().filter(|(_, entry)| entry.is_ok()) {
        let _ = writeln!(table, "void run{index}(const bindings&, const given&, result&);");
    }
    table += "const entry __lamplight::entries[] = {\n";
    for (index, entry) in entries.iter().enumerate() {
        let function = if entry.is_ok() { format!("run{index}") } else { "nullptr".to_owned() };
        let _ = writeln!(table, "  {{{function}}},");
    }
    // C++ has no empty array.
    table += "  {nullptr}};\n";
    check_output(clang.compile(&table, &["-c", "-o", "table.o"])?)?;
    let mut arguments = vec!["-o", "program", "table.o"];
    arguments.extend(objects.iter().map(String::as_str));
    arguments.push("-lm");
    check_output(clang.call(&arguments)?)
}

/// Texts one after another, each in a namespace of its own and followed by the function that runs
/// it.
fn unit_source(texts: &[&str], unit: &[TextInterface<'_>]) -> String {
    let mut source = "#include \"glue.h\"\n".to_owned();
    for (index, interface) in unit {
        let text = adapt_text(texts[*index]);
        let _ = write!(
            source,
            "namespace {{ namespace text{index} {{\n#line 1 \"text\"\n{text}\n}} }}\n"
        );
        let _ = writeln!(source, "#line 1 \"glue\"");
        write_glue(&mut source, *index, interface);
    }
    source
}

/// Writes the C++ function that calls an entry point: it passes the arguments and stores the
/// results, according to their attributes.
fn write_glue(to: &mut String, index: usize, interface: &Interface) {
    let _ = writeln!(
        to,
        "void run{index}(const __lamplight::bindings& bound, const __lamplight::given& given,\n    \
         __lamplight::result& result) {{"
    );
    if let Some((name, members)) = &interface.input {
        let _ = writeln!(to, "  text{index}::{name} input = {{}};");
        members.iter().for_each(|member| write_taken(to, member));
    }
    let arguments: Vec<String> = interface.parameters.iter().map(argument_text).collect();
    let returned = if interface.output.is_empty() { "" } else { "const auto output = " };
    let (name, list) = (&interface.name, arguments.join(", "));
    let _ = writeln!(to, "  {returned}text{index}::{name}({list});");
    interface.output.iter().for_each(|member| write_given(to, member));
    *to += "}\n";
}

fn argument_text(part: &InterfaceMember) -> String {
    match part.role {
        InterfaceRole::StageIn => "input".to_owned(),
        InterfaceRole::Buffer(slot) => format!("__lamplight::buffer(bound, {slot})"),
        InterfaceRole::Texture(slot) => format!("__lamplight::texture_of(bound, {slot})"),
        InterfaceRole::Sampler(slot) => format!("__lamplight::sampler_of(bound, {slot})"),
        InterfaceRole::Position => "__lamplight::position(given)".to_owned(),
        InterfaceRole::FrontFacing => "given.front != 0".to_owned(),
        InterfaceRole::VertexIndex => "given.vertex_index".to_owned(),
        InterfaceRole::InstanceIndex => "given.instance_index".to_owned(),
        InterfaceRole::Location(_) | InterfaceRole::Depth => "{}".to_owned(),
    }
}

fn write_taken(to: &mut String, member: &InterfaceMember) {
    if let InterfaceRole::Location(location) = member.role {
        let name = &member.name;
        let _ = writeln!(to, "  __lamplight::take(input.{name}, given.locations[{location}]);");
    }
}

fn write_given(to: &mut String, member: &InterfaceMember) {
    let name = &member.name;
    let _ = match member.role {
        InterfaceRole::Location(location) => {
            writeln!(to, "  __lamplight::give(output.{name}, result.locations[{location}]);")
        }
        InterfaceRole::Position => {
            writeln!(to, "  __lamplight::give_position(output.{name}, result);")
        }
        InterfaceRole::Depth => writeln!(to, "  result.depth = output.{name};"),
        _ => Ok(()),
    };
}
