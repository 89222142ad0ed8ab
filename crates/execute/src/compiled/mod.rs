//! Texts in MSL as one program of this machine, which [`metal`](lamplight_tools::metal)'s clang compiles.
//!
//! `texts -> interface (what entry points take) -> program (clang, linked) -> words`
//!
//! Units of several texts are compiled on all cores, and linked. The program runs them on request.

pub mod interface;
pub mod request;

use interface::{Interface, InterfaceMember, InterfaceRole};
use lamplight_tools::halve_refused;
use lamplight_tools::metal::adapt::adapt_text;
use lamplight_tools::metal::{Clang, ClangMissing};
use rayon::prelude::*;
use request::{
    FragmentInput, MetalResources, RequestWords, ShadedFragment, Transformed, VertexInput, words,
};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{Read as _, Write as _};
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::{fs, io};

/// Entry points, ready to run.
#[derive(Debug)]
pub struct CompiledProgram {
    built: Built,
    /// The process that runs them, once it was needed.
    child: Option<Child>,
}

impl CompiledProgram {
    /// Compiles one entry point of each text. A text that clang refuses, or whose entry point needs
    /// something that the CPU lacks, fails when it is run.
    ///
    /// # Errors
    /// clang is missing or cannot be run.
    pub fn build(texts: &[&str]) -> Result<Self, ClangMissing> {
        Ok(Self { built: build_program(texts)?, child: None })
    }

    /// What the entry point of a text takes and returns.
    ///
    /// # Errors
    /// Why the text cannot be run.
    pub fn interface(&self, text: usize) -> Result<&Interface, String> {
        match self.built.entries.get(text) {
            Some(entry) => entry.as_ref().map_err(Clone::clone),
            None => Err("there is no such text".to_owned()),
        }
    }

    /// Runs a vertex entry point for each vertex.
    ///
    /// # Errors
    /// Why the text cannot be run, or how it failed.
    pub fn vertices(
        &mut self,
        text: usize,
        bound: &MetalResources,
        vertices: &[VertexInput],
    ) -> Result<Vec<Transformed>, String> {
        let mut request = self.head(text, 0, bound)?;
        let (taken, given) = self.interface(text)?.locations();
        request.push(vertices.len() as u32);
        for vertex in vertices {
            request.extend([vertex.index, vertex.instance]);
            words::locations(&mut request, &vertex.locations, taken);
        }
        let answer = self.ask(&request, vertices.len(), given)?;
        Ok(answer.iter().map(|words| Transformed::from_words(words)).collect())
    }

    /// Runs a fragment entry point for the fragments of each quad: (0, 0), (1, 0), (0, 1), (1, 1).
    ///
    /// # Errors
    /// Why the text cannot be run, or how it failed.
    pub fn quads(
        &mut self,
        text: usize,
        bound: &MetalResources,
        quads: &[[FragmentInput; 4]],
    ) -> Result<Vec<[ShadedFragment; 4]>, String> {
        let mut request = self.head(text, 1, bound)?;
        let (taken, given) = self.interface(text)?.locations();
        request.push(quads.len() as u32);
        for fragment in quads.iter().flatten() {
            request.extend(fragment.position.map(f32::to_bits));
            request.push(u32::from(fragment.front));
            words::locations(&mut request, &fragment.locations, taken);
        }
        let answer = self.ask(&request, quads.len() * 4, given)?;
        let shaded: Vec<ShadedFragment> =
            answer.iter().map(|words| ShadedFragment::from_words(words)).collect();
        Ok(shaded.as_chunks::<4>().0.to_vec())
    }

    /// Runs a compute entry point for a grid of workgroups. Returns the bytes of all buffers
    /// afterwards, by their slots.
    ///
    /// # Errors
    /// Why the text cannot be run, or how it failed.
    pub fn dispatch(
        &mut self,
        text: usize,
        bound: &MetalResources,
        (size, groups): ([u32; 3], [u32; 3]),
    ) -> Result<BTreeMap<u32, Vec<u8>>, String> {
        let mut request = self.head(text, 2, bound)?;
        request.extend(size.into_iter().chain(groups));
        let words = |bytes: &Vec<u8>| bytes.len().div_ceil(4);
        let count = bound.buffers.values().map(words).sum();
        let answer = self.exchange(&request, count);
        let answer = answer.map_err(|error| self.ended(&error.to_string()))?;
        let mut rest = answer.as_slice();
        let mut read = |(slot, before): (&u32, &Vec<u8>)| {
            let (own, others) = rest.split_at(words(before));
            rest = others;
            let mut bytes: Vec<u8> = own.iter().flat_map(|word| word.to_ne_bytes()).collect();
            bytes.truncate(before.len());
            (*slot, bytes)
        };
        Ok(bound.buffers.iter().map(&mut read).collect())
    }

    /// The start of every request.
    fn head(
        &self,
        text: usize,
        stage: u32,
        bound: &MetalResources,
    ) -> Result<RequestWords, String> {
        let interface = self.interface(text)?;
        for parameter in &interface.parameters {
            let is_bound = match parameter.role {
                InterfaceRole::Buffer(slot) => bound.buffers.contains_key(&slot),
                InterfaceRole::Texture(slot) => bound.textures.contains_key(&slot),
                InterfaceRole::Sampler(slot) => bound.samplers.contains_key(&slot),
                _ => true,
            };
            if !is_bound {
                return Err(format!("nothing is bound for `{}`", parameter.name));
            }
        }
        let (taken, given) = interface.locations();
        let mut request = vec![text as u32, stage, taken, given];
        words::bound(&mut request, bound);
        Ok(request)
    }

    /// Sends a request, and waits for the words of each invocation: four words, then those of its
    /// locations.
    fn ask(
        &mut self,
        request: &[u32],
        count: usize,
        given: u32,
    ) -> Result<Vec<RequestWords>, String> {
        let size = 4 * (1 + given as usize);
        match self.exchange(request, count * size) {
            Ok(answer) => Ok(answer.chunks(size).map(<[u32]>::to_vec).collect()),
            Err(error) => Err(self.ended(&error.to_string())),
        }
    }

    fn exchange(&mut self, request: &[u32], count: usize) -> std::io::Result<RequestWords> {
        let child = match &mut self.child {
            Some(child) => child,
            none => none.insert(start_program(&self.built)?),
        };
        let (Some(stdin), Some(stdout)) = (&mut child.stdin, &mut child.stdout) else {
            return Err(std::io::ErrorKind::BrokenPipe.into());
        };
        let mut bytes = (request.len() as u32).to_ne_bytes().to_vec();
        bytes.extend(request.iter().flat_map(|word| word.to_ne_bytes()));
        stdin.write_all(&bytes)?;
        stdin.flush()?;
        let mut answer = vec![0; count * 4];
        stdout.read_exact(&mut answer)?;
        Ok(answer.as_chunks::<4>().0.iter().map(|bytes| u32::from_ne_bytes(*bytes)).collect())
    }

    /// Ends the process; returns a message with its status and what it wrote to stderr. The next
    /// request starts another process.
    fn ended(&mut self, error: &str) -> String {
        let Some(mut child) = self.child.take() else { return error.to_owned() };
        drop(child.stdin.take());
        let _ = child.kill();
        let output = child.wait_with_output();
        output.map_or(error.to_owned(), |output| {
            let words = String::from_utf8_lossy(&output.stderr).trim().to_owned();
            format!("the program ended ({}): {words}", output.status)
        })
    }
}

impl Drop for CompiledProgram {
    fn drop(&mut self) {
        if let Some(mut child) = self.child.take() {
            // The process ends when its input does, but a shader may still be running.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn start_program(built: &Built) -> std::io::Result<Child> {
    Command::new(built.program())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
}

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
struct Built {
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
fn build_program(texts: &[&str]) -> Result<Built, ClangMissing> {
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
            false => Ok(vec![ObjectFile::Refused(one.0, stderr_text(&output))]),
        }
    };
    halve_refused(unit, &together, &alone)
}

fn stderr_text(output: &Output) -> String {
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
        Err(ClangMissing { reason: stderr_text(&output) })
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
    for shared in interface.shared() {
        let InterfaceMember { name, ty, .. } = shared;
        let _ =
            writeln!(to, "namespace {{ namespace text{index} {{ {ty} lamplight_of_{name}; }} }}");
    }
    let _ = writeln!(
        to,
        "void run{index}(const __lamplight::bindings& bound, const __lamplight::given& given,\n    \
         __lamplight::result& result) {{"
    );
    if let Some((name, members)) = &interface.input {
        let _ = writeln!(to, "  text{index}::{name} input = {{}};");
        members.iter().for_each(|member| write_taken(to, member));
    }
    for InterfaceMember { name, .. } in interface.shared() {
        let _ = writeln!(to, "  __lamplight::spoil(given, text{index}::lamplight_of_{name});");
    }
    let argument = |part| argument_text(part, index);
    let arguments: Vec<String> = interface.parameters.iter().map(argument).collect();
    let returned = if interface.output.is_empty() { "" } else { "const auto output = " };
    let (name, list) = (&interface.name, arguments.join(", "));
    let _ = writeln!(to, "  {returned}text{index}::{name}({list});");
    interface.output.iter().for_each(|member| write_given(to, member));
    *to += "}\n";
}

fn argument_text(part: &InterfaceMember, index: usize) -> String {
    match part.role {
        InterfaceRole::Threadgroup => format!("text{index}::lamplight_of_{}", part.name),
        InterfaceRole::Invocation("index") => "given.invocation[3]".to_owned(),
        InterfaceRole::Invocation("size") => "__lamplight::size_of_group(given)".to_owned(),
        InterfaceRole::Invocation(of) => format!("__lamplight::{of}_of(given)"),
        InterfaceRole::StageIn => "input".to_owned(),
        InterfaceRole::Buffer(slot) => format!("__lamplight::buffer(bound, {slot})"),
        InterfaceRole::Texture(slot) => format!("__lamplight::texture_of(bound, {slot})"),
        InterfaceRole::Sampler(slot) => format!("__lamplight::sampler_of(bound, {slot})"),
        InterfaceRole::Position => "__lamplight::position(given)".to_owned(),
        InterfaceRole::FrontFacing => "given.front != 0".to_owned(),
        InterfaceRole::VertexIndex => "given.vertex_index".to_owned(),
        InterfaceRole::InstanceIndex => "given.instance_index".to_owned(),
        // A pixel has one sample, which a fragment covers.
        InterfaceRole::SampleIndex => "0u".to_owned(),
        InterfaceRole::SampleMask => "1u".to_owned(),
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
