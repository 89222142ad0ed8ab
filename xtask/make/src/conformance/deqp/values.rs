//! Runs the WGSL outputs of a program on the evaluator, and compares what it computes with the values
//! of the case.

use std::collections::BTreeMap;

use lamplight::bundle::{BindingKind, Language, Member, Target};
use lamplight::compose::Composed;
use lamplight::eval::{Machine, Program, Resources, SlotKind};
use lamplight::link::CompiledUnit;
use lamplight::validate::{on_large_stack, validate_for_some};

use super::parse::{Case, CaseValue, Role};
use super::stage::locations_of;

/// How far a number may be from that of the case, as a part of it and at least. dEQP allows 0.05, as
/// drivers may compute with less than 32 bits.
const TOLERANCE: f64 = 0.005;

/// Why a case did not pass.
pub enum Stop {
    Wrong(String),
    NotRun(String),
}

impl Stop {
    fn not_run(message: impl Into<String>) -> Self {
        Self::NotRun(message.into())
    }
}

/// The results of a stage, by location.
type Slots = BTreeMap<u32, Vec<(SlotKind, u32)>>;

/// Runs the stages with each row of the values; gives the number of rows.
pub fn run(case: &Case, units: &[CompiledUnit]) -> Result<usize, Stop> {
    let rows = case.values.iter().map(|value| value.rows.len()).max().unwrap_or(0);
    let stages: Vec<StageRun> = units.iter().map(StageRun::new).collect::<Result<_, _>>()?;
    for row in 0..rows {
        let mut between = Slots::new();
        for stage in &stages {
            between = on_large_stack(|| stage.run(case, row, &between))?;
        }
        compare(case, row, &between).map_err(Stop::Wrong)?;
    }
    Ok(rows)
}

fn row_of(value: &CaseValue, row: usize) -> &[f64] {
    value.rows.get(row).or_else(|| value.rows.first()).map_or(&[], Vec::as_slice)
}

fn compare(case: &Case, row: usize, found: &Slots) -> Result<(), String> {
    for (location, (value, first, count)) in (0..).zip(locations_of(case)) {
        let expected = row_of(value, row).get(first..first + count).unwrap_or_default();
        let slots = found.get(&location).map_or(&[][..], Vec::as_slice);
        let found: Vec<f64> = slots.iter().take(count).map(|slot| number_of(*slot)).collect();
        let is_near = |(expected, found): (&f64, &f64)| {
            (expected - found).abs() <= TOLERANCE * (1.0 + expected.abs())
        };
        if found.len() != expected.len() || !expected.iter().zip(&found).all(is_near) {
            let name = &value.name;
            return Err(format!("`{name}` is {found:?} in row {row}, expected {expected:?}"));
        }
    }
    Ok(())
}

fn number_of((kind, word): (SlotKind, u32)) -> f64 {
    match kind {
        SlotKind::Float => f64::from(f32::from_bits(word)),
        SlotKind::Sint => f64::from(word.cast_signed()),
        SlotKind::Uint | SlotKind::Bool | SlotKind::Pointer | SlotKind::Handle => f64::from(word),
    }
}

/// A stage that can be run.
struct StageRun<'u> {
    unit: &'u CompiledUnit,
    entry: String,
    program: Program,
}

impl<'u> StageRun<'u> {
    fn new(unit: &'u CompiledUnit) -> Result<Self, Stop> {
        let wgsl = unit.unit.targets.get(Target::WGSL.name());
        let artifact = wgsl.ok_or_else(|| Stop::not_run("there is no output in WGSL"))?;
        let text = String::from_utf8_lossy(&artifact.bytes).into_owned();
        let composed = Composed::of_text(Language::Wesl, None, text);
        let validated = validate_for_some(&composed).map_err(|errors| {
            let message = errors.first().map(|error| error.message.clone());
            Stop::Wrong(format!("the output in WGSL is refused: {}", message.unwrap_or_default()))
        })?;
        let program = on_large_stack(|| Program::new(&validated.module, &validated.info))
            .map_err(|error| Stop::not_run(error.message))?;
        Ok(Self { unit, entry: artifact.native.entry_name.clone(), program })
    }

    /// The results for a row of values and what the stage before gives.
    fn run(&self, case: &Case, row: usize, from: &Slots) -> Result<Slots, Stop> {
        let no_entry = || Stop::not_run("the entry point is not found");
        let id = self.program.function(&self.entry).ok_or_else(no_entry)?;
        let function = self.program.signature(id).ok_or_else(no_entry)?;
        let mut taken = BTreeMap::new();
        let mut argument = |binding: &Option<naga::Binding>| {
            let location = location_of(binding)?;
            let at: &mut usize = taken.entry(location).or_default();
            *at += 1;
            from.get(&location)?.get(*at - 1).map(|(_, word)| *word)
        };
        let arguments: Vec<u32> =
            function.inputs.iter().map(|input| argument(input).unwrap_or(0)).collect();
        let stopped = |error: lamplight::eval::Error| Stop::not_run(error.message);
        let mut machine = Machine::<f32>::new(&self.program).map_err(stopped)?;
        machine.bind(self.resources(case, row)).map_err(stopped)?;
        let mut words = Vec::new();
        machine.call_words(id, &arguments, &mut words).map_err(stopped)?;
        let mut slots = Slots::new();
        for ((binding, kind), word) in function.outputs.iter().zip(&function.result).zip(words) {
            if let Some(location) = location_of(binding) {
                slots.entry(location).or_default().push((*kind, word));
            }
        }
        Ok(slots)
    }

    /// The uniforms that the stage reads.
    fn resources(&self, case: &Case, row: usize) -> Resources {
        let mut resources = Resources::default();
        for binding in &self.unit.unit.reflection.bindings {
            if binding.kind != BindingKind::Uniform {
                continue;
            }
            let mut bytes = vec![0; binding.size.unwrap_or(0) as usize];
            for value in case.values.iter().filter(|value| value.role != Role::Output) {
                if let Some((offset, member)) = place_of(&binding.members, &value.name) {
                    put_numbers(&mut bytes, offset, member, row_of(value, row));
                }
            }
            resources.buffers.insert((binding.group, binding.binding), bytes);
        }
        resources
    }
}

fn location_of(binding: &Option<naga::Binding>) -> Option<u32> {
    match binding {
        Some(naga::Binding::Location {
            location,
            interpolation: _,
            sampling: _,
            blend_src: _,
            per_primitive: _,
        }) => Some(*location),
        Some(naga::Binding::BuiltIn(_)) | None => None,
    }
}

/// Where a variable is in a buffer, such as `val[1].a`.
fn place_of<'m>(members: &'m [Member], path: &str) -> Option<(usize, &'m Member)> {
    let end = path.find(['.', '[']).unwrap_or(path.len());
    let (name, mut rest) = path.split_at(end);
    let member = members.iter().find(|member| member.name == name)?;
    let mut offset = member.offset as usize;
    if let Some((index, behind)) = rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
        offset += index.trim().parse::<usize>().ok()? * member.stride? as usize;
        rest = behind;
    }
    match rest.strip_prefix('.') {
        Some(inner) => {
            let (inside, member) = place_of(&member.members, inner)?;
            Some((offset + inside, member))
        }
        None => Some((offset, member)),
    }
}

fn put_numbers(bytes: &mut [u8], offset: usize, member: &Member, numbers: &[f64]) {
    // Columns with two rows are the elements of an array, padded.
    let padded = member.members.first().filter(|inner| inner.name == "value");
    let shape = padded.map_or(&member.shape, |inner| &inner.shape);
    let Some(shape) = shape else { return };
    let stride = padded.and(member.stride).or(shape.matrix_stride).unwrap_or(0);
    let rows = shape.rows.unwrap_or(1) as usize;
    for (at, number) in numbers.iter().enumerate() {
        let first = offset + (at / rows) * stride as usize + 4 * (at % rows);
        let word = match shape.scalar.as_deref() {
            Some("f32") => (*number as f32).to_bits(),
            Some("i32") => (*number as i32).cast_unsigned(),
            _ => *number as u32,
        };
        if let Some(place) = bytes.get_mut(first..first + 4) {
            place.copy_from_slice(&word.to_le_bytes());
        }
    }
}
