//! What a reader says of a bundle, line by line. Every reader prints the same.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use lamplight_bundle::{
    Binding, Bundle, Constant, Error, Found, Language, LayoutBinding, Member, Native, Target,
};
use libtest_mimic::Failed;

/// What is asked: program, language (or `-`), entry point, key (with `+` for a blank) and target.
pub const QUERIES: &str = "\
lit - fs_main default spirv
lit wesl fs_main shadow=hard spirv
lit glsl fs_main shadow=hard glsl330
lit wesl fs_main taps=8,fog wgsl
lit wesl fs_main +taps+=+-4+,+shadow=hard,fog=false spirv
lit wesl vs_main taps=8 glsl330
write - write_all default spirv
lit - fs_main fog,shadow=hard spirv
lit - fs_main shadow=hard,taps=8 spirv
lit - fs_main fog=maybe spirv
lit - fs_main mist spirv
lit - fs_main fog,fog spirv
lit - fs_main exposure=2 spirv
lit - fs_main fog msl
lit - fs_mian fog spirv
lot - fs_main fog spirv
blank - main default spirv
";

/// The transcript of the bundle as a file and as a directory, and the first failure of each damaged
/// one.
pub fn whole(
    packed: &[u8],
    folder: &Path,
    files: &BTreeMap<String, Vec<u8>>,
) -> Result<String, Failed> {
    let file = transcript(&Bundle::from_bytes(packed.to_vec())?)?;
    if file != transcript(&Bundle::open(folder)?)? {
        return Err("the two forms do not say the same".into());
    }
    let mut said = file;
    for (name, bytes) in files.iter().filter(|(name, _)| name.starts_with("damaged/")) {
        let code = first_failure(bytes).ok_or_else(|| format!("{name} is read"))?;
        writeln!(said, "{name} {code}")?;
    }
    Ok(said)
}

/// The code of the first failure: on opening, or of the queries in order that do not fail for the
/// good bundle.
fn first_failure(bytes: &[u8]) -> Option<&'static str> {
    let bundle = match Bundle::from_bytes(bytes.to_vec()) {
        Ok(bundle) => bundle,
        Err(error) => return Some(code(&error)),
    };
    let found = QUERIES.lines().take(7).map(|query| ask(&bundle, query));
    found.filter_map(Result::err).map(|error| code(&error)).next()
}

fn code(error: &Error) -> &'static str {
    match error {
        Error::Corrupt { .. } => "corrupt",
        Error::Version { .. } => "format",
        Error::NotFound { .. } => "not_found",
        Error::BadKey { .. } => "bad_key",
        Error::Miss(_) => "miss",
        _ => "other",
    }
}

fn ask(bundle: &Bundle, query: &str) -> Result<Found, Error> {
    let words: Vec<&str> = query.split(' ').collect();
    let program = bundle.program(words[0])?;
    let shader = match words[1] {
        "wesl" => program.entry(Language::Wesl, words[2])?,
        "glsl" => program.entry(Language::Glsl, words[2])?,
        _ => program.shader(words[2])?,
    };
    let target = Target::find(words[4]).ok_or_else(|| Error::Io("no target".to_owned()))?;
    shader.get(&words[3].replace('+', " "), target)
}

fn transcript(bundle: &Bundle) -> Result<String, Failed> {
    let mut out = String::new();
    for query in QUERIES.lines() {
        writeln!(out, "> {query}")?;
        match ask(bundle, query) {
            Ok(found) => found_lines(&mut out, &found)?,
            Err(error @ Error::Miss(_)) => writeln!(out, "! miss {error}")?,
            Err(error) => writeln!(out, "! {}", code(&error))?,
        }
    }
    for (program, language) in [("lit", Language::Wesl), ("write", Language::Wesl)] {
        writeln!(out, "> layout {program} {}", language.name())?;
        for entry in bundle.program(program)?.layout(language) {
            layout_line(&mut out, entry)?;
        }
    }
    Ok(out)
}

fn found_lines(out: &mut String, found: &Found) -> Result<(), Failed> {
    let (stage, entry) = (found.reflection.stage.name(), &found.native.entry_name);
    writeln!(out, "{stage} {entry} {} {:016x}", found.bytes.len(), fnv(&found.bytes))?;
    for constant in &found.constants {
        constant_line(out, constant, &found.native)?;
    }
    for binding in &found.reflection.bindings {
        binding_line(out, binding)?;
        writeln!(out)?;
        let slots = found.native.slots.iter();
        for slot in
            slots.filter(|slot| (slot.group, slot.binding) == (binding.group, binding.binding))
        {
            let (index, name) = (slot.index.unwrap_or(0), slot.name.as_deref().unwrap_or("-"));
            writeln!(out, "  slot {} {index} {name}", slot.space.unwrap_or(0))?;
        }
        member_lines(out, &binding.members, "  ")?;
    }
    Ok(())
}

fn constant_line(out: &mut String, constant: &Constant, native: &Native) -> Result<(), Failed> {
    let Constant { name, ty, value, bits } = constant;
    let choice = native.choices.iter().find(|choice| choice.name == *name);
    let id = choice.and_then(|choice| choice.id).map_or(-1, i64::from);
    let symbol = choice.and_then(|choice| choice.symbol.as_deref()).unwrap_or("-");
    Ok(writeln!(out, "constant {name} {ty} {value} {bits:08x} {id} {symbol}")?)
}

fn binding_line(out: &mut String, binding: &Binding) -> Result<(), Failed> {
    let Binding { group, binding: number, name, size, count, texture, .. } = binding;
    let kind = serde_json::to_value(binding.kind)?;
    let kind = kind.as_str().unwrap_or_default();
    let (size, count) = (size.unwrap_or(0), count.unwrap_or(1));
    write!(out, "binding {group} {number} {kind} {name} {size} {count}")?;
    if let Some(texture) = texture {
        let texture = serde_json::to_value(texture)?;
        let word = |name: &str| texture[name].as_str().unwrap_or("-").to_owned();
        let words = ["dimension", "sample_type", "format", "access"].map(word);
        write!(out, " {}", words.join(" "))?;
    }
    Ok(())
}

fn layout_line(out: &mut String, entry: &LayoutBinding) -> Result<(), Failed> {
    binding_line(out, &entry.binding)?;
    let stages: Vec<&str> = entry.stages.iter().map(|stage| stage.name()).collect();
    writeln!(out, " {}", stages.join(","))?;
    for (axis, values) in &entry.when {
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        writeln!(out, "  when {axis} {}", values.join(" "))?;
    }
    Ok(())
}

fn member_lines(out: &mut String, members: &[Member], indent: &str) -> Result<(), Failed> {
    for member in members {
        let Member { name, ty: _, offset, size, stride, shape, members } = member;
        let shape = shape.clone().unwrap_or_default();
        let scalar = shape.scalar.as_deref().unwrap_or("-");
        let numbers = [shape.columns, shape.rows, shape.matrix_stride, shape.count, *stride];
        let numbers = numbers.map(|number| number.unwrap_or(0).to_string()).join(" ");
        writeln!(out, "{indent}member {name} {offset} {size} {scalar} {numbers}")?;
        member_lines(out, members, &format!("{indent}  "))?;
    }
    Ok(())
}

/// The 64-bit FNV-1a hash, which every language writes in three lines.
fn fnv(bytes: &[u8]) -> u64 {
    let fold = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, fold)
}
