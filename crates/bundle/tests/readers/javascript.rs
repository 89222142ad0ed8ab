//! The reader in JavaScript, in node: on the set, as a file, as a directory over HTTP, and by range
//! requests.

use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::Trial;

use super::{Outcome, c, set_folder};

/// The most bytes of the reader, which is `index.js` with what it loads, and of all modules, with the
/// adapters for WebGPU and WebGL 2. Compressed, but not minified.
const MOST_COMPRESSED: [u64; 2] = [13_000, 15_500];

pub fn tests() -> Vec<Trial> {
    let mut tests: Vec<Trial> = ["file", "directory", "range"]
        .into_iter()
        .map(|form| {
            let name = format!("readers::javascript::says_what_the_loader_says::{form}");
            Trial::test(name, move || says_the_same(form))
        })
        .collect();
    tests.push(Trial::test("readers::javascript::describes", describes));
    tests.push(Trial::test("readers::javascript::is_small", is_small));
    tests
}

pub fn package() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../packages/bundle")
}

fn says_the_same(form: &str) -> Outcome {
    let set = set_folder();
    let expected = std::fs::read_to_string(set.join("expected.txt"))?;
    let script = package().join("test/transcript.mjs");
    let mut command = Command::new("node");
    command.arg(script).arg(&set).arg(form).args(c::damaged_names(&expected));
    c::same_lines(&expected, &c::output(&mut command)?)
}

/// Blocks, layouts and stages are those that the script states.
fn describes() -> Outcome {
    let script = package().join("test/describe.mjs");
    c::output(Command::new("node").arg(script).arg(set_folder())).map(drop)
}

fn is_small() -> Outcome {
    const MEASURE: &str = "
        import { readdirSync, readFileSync } from 'node:fs';
        import { gzipSync } from 'node:zlib';
        const [folder] = process.argv.slice(1);
        const all = readdirSync(folder).filter((name) => name.endsWith('.js'));
        const size = (names) =>
            gzipSync(names.map((name) => readFileSync(`${folder}/${name}`, 'utf8')).join('')).length;
        console.log(size(all.filter((name) => !name.startsWith('webg'))), size(all));";
    let mut command = Command::new("node");
    command.args(["--input-type=module", "--eval", MEASURE]).arg(package().join("src"));
    let printed = c::output(&mut command)?;
    println!("@lamplight/bundle, compressed, without and with the adapters: {printed}");
    let sizes: Vec<u64> = printed.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let is_small = sizes.len() == 2 && sizes.iter().zip(MOST_COMPRESSED).all(|(a, b)| *a <= b);
    if is_small { Ok(()) } else { Err(format!("{printed} bytes").into()) }
}
