//! Compute entry points that the evaluator refuses, with the place, and bounds of its work.

use super::program;
use lamplight_eval::{Machine, Resources};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("eval/dispatch/refusals", refusals),
        Trial::test("eval/dispatch/groups_begin_with_zeros", groups_begin_with_zeros),
    ]
}

/// The body of an entry point, what it is given, the code, and the text at its place.
const REFUSED: &[(&str, &str, &str, &str)] = &[
    (
        "@builtin(local_invocation_index) at: u32",
        "if at < 3u { workgroupBarrier(); }",
        "eval-barrier",
        "workgroupBarrier",
    ),
    (
        "@builtin(local_invocation_index) at: u32",
        "if at < 1u { workgroupBarrier(); } else { storageBarrier(); }",
        "eval-barrier",
        "workgroupBarrier",
    ),
    (
        "@builtin(local_invocation_index) at: u32",
        "if at == 2u { return; } workgroupBarrier();",
        "eval-barrier",
        "workgroupBarrier",
    ),
    ("@builtin(subgroup_size) size: u32", "held = size;", "eval-unsupported", ""),
    ("", "loop { held += 1u; if held == 0u { break; } }", "eval-loop-limit", ""),
];

fn refusals() -> Result<(), Failed> {
    for (inputs, body, code, place) in REFUSED {
        let text = format!(
            "var<workgroup> held: u32;\n@compute @workgroup_size(4) fn main({inputs}) {{ {body} }}"
        );
        let program = program(&text)?;
        let main = program.function("main").ok_or("main")?;
        let mut machine = Machine::<f32>::new(&program)?;
        let error = machine.dispatch(main, [1, 1, 1]).err().ok_or(*body)?;
        let range = error.span.to_range();
        let found = range.and_then(|range| text.get(range)).unwrap_or_default();
        if error.code.name != *code || !found.contains(place) {
            return Err(format!("{body}: {error:?} at `{found}`").into());
        }
    }
    Ok(())
}

/// Each workgroup begins with zeros in its memory, and each call of a function alone too.
fn groups_begin_with_zeros() -> Result<(), Failed> {
    let text = "var<workgroup> sum: atomic<u32>;
        @group(0) @binding(0) var<storage, read_write> sums: array<u32, 3>;
        fn grow() -> u32 { return atomicAdd(&sum, 5u) + 5u; }
        @compute @workgroup_size(2) fn main(@builtin(workgroup_id) group: vec3u) {
            grow();
            workgroupBarrier();
            sums[group.x] = atomicLoad(&sum);
        }";
    let program = program(text)?;
    let (main, grow) = (program.function("main"), program.function("grow"));
    let (main, grow) = (main.ok_or("main")?, grow.ok_or("grow")?);
    let mut machine = Machine::<f32>::new(&program)?;
    let buffers = [((0, 0), vec![0; 12])].into();
    machine.bind(Resources { buffers, ..Resources::default() })?;
    machine.dispatch(main, [3, 1, 1])?;
    let words: Vec<u8> = [10u32; 3].iter().flat_map(|sum| sum.to_le_bytes()).collect();
    assert_eq!(machine.buffer(0, 0), Some(words));
    let mut result = Vec::new();
    for _ in 0..2 {
        machine.call_words(grow, &[], &mut result)?;
        assert_eq!(result, [5]);
    }
    Ok(())
}
