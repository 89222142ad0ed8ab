//! The numeric harness: executors, kernels, cases.

use std::collections::BTreeMap;

use lamplight::harness::{executors, kernel};
use libtest_mimic::{Failed, Trial};

/// One trial for each property of the harness and each executor.
pub fn trials() -> Vec<Trial> {
    executors::ALL.iter().map(|executor| Trial::test(format!("harness::executor::{}", executor.name), move || runs(executor))).collect()
}

const SHAPES: &str = "
struct Inner { flag: bool, pair: vec2f }
struct Outer { inner: array<Inner, 2>, m: mat3x2f, i: i32 }
fn shapes(a: f32, o: Outer, u: vec3u) -> Outer {
    var r = o;
    r.inner[1].flag = !o.inner[1].flag;
    r.m[1].y = a * 2.0;
    r.i = o.i - i32(u.z);
    return r;
}";

fn runs(executor: &executors::Entry) -> Result<(), Failed> {
    let module = naga::front::wgsl::parse_str(SHAPES)?;
    let kernel = kernel::build(&module, "shapes", &BTreeMap::new()).map_err(|error| format!("{error:?}"))?;
    assert_eq!((kernel.input_words(), kernel.result_words()), (17, 13));
    let mut session = (executor.open)().map_err(|error| executor.missing(&error))?;
    let count = 70_000u32;
    let inputs: Vec<u32> = (0..count).flat_map(shapes_input).collect();
    let results = session.run(&kernel, &inputs).map_err(|error| format!("{error:?}"))?;
    for (i, found) in results.chunks(13).enumerate() {
        assert_eq!(found, shapes_expected(i as u32), "invocation {i} on {}", session.adapter());
    }
    assert_eq!(results.len(), count as usize * 13);
    Ok(())
}

fn shapes_input(i: u32) -> [u32; 17] {
    let f = |x: u32| ((i + x) as f32).to_bits();
    [f(0), 1, f(1), f(2), i & 1, f(3), f(4), f(5), f(6), f(7), f(8), f(9), f(10), i, 0, 0, 7]
}

fn shapes_expected(i: u32) -> [u32; 13] {
    let f = |x: u32| ((i + x) as f32).to_bits();
    let doubled = (i as f32 * 2.0).to_bits();
    [1, f(1), f(2), 1 - (i & 1), f(3), f(4), f(5), f(6), f(7), doubled, f(9), f(10), i.wrapping_sub(7)]
}
