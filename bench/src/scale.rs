//! Memory: 100,000 permutations, no two alike, are written as they are made.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use lamplight::bundle::DirectoryWriter;
use lamplight::generate::{Request, Tools, generate};
use lamplight::project;
use lamplight::source::SourceSet;

use crate::Outcome;

const AXES: [&str; 5] = ["a", "b", "c", "d", "e"];
const VALUES: usize = 10;

/// Prints the most memory that this process ever had.
pub fn run() -> Outcome {
    let folder = std::env::temp_dir().join(format!("lamplight-bench-scale-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    write(&folder)?;
    let start = Instant::now();
    let permutations = generated(&folder)?;
    println!(
        "scale: {permutations} permutations in {:.1} s, at most {:.0} MB",
        start.elapsed().as_secs_f64(),
        peak()? / 1e6
    );
    Ok(std::fs::remove_dir_all(&folder)?)
}

fn write(folder: &Path) -> Outcome {
    let values: Vec<String> = (1..=VALUES).map(|value| value.to_string()).collect();
    let mut manifest = String::from(
        "[program.large]\nwesl = \"large.wesl\"\ntargets = [\"spirv\", \"wgsl\"]\n\n[program.large.axis]\n",
    );
    for axis in AXES {
        writeln!(manifest, "{axis} = {{ values = [{}], default = 1 }}", values.join(", "))?;
    }
    let imports = AXES.map(|axis| format!("import constants::{axis};\n")).join("");
    let body = AXES
        .map(|axis| format!("    sum = sum * 0.5 + vec4<f32>(f32({axis}), sum.xyz);\n"))
        .join("");
    let root = format!(
        "{imports}\n@fragment\nfn fs_main(@location(0) color: vec4<f32>) -> @location(0) vec4<f32> {{\n    var sum = color;\n{}    return sum;\n}}\n",
        body.repeat(8)
    );
    std::fs::write(folder.join("lamplight.toml"), manifest)?;
    Ok(std::fs::write(folder.join("large.wesl"), root)?)
}

fn generated(folder: &Path) -> Result<usize, Box<dyn std::error::Error>> {
    let mut sources = SourceSet::default();
    let opened = project::declared(&folder.join("lamplight.toml"), &mut sources);
    let (manifest, packages) = opened.map_err(|problems| format!("{problems:?}"))?;
    let writer = DirectoryWriter::create(folder.join("bundle"))?;
    let tools =
        Tools { sink: &writer, cache: None, tool: "test", optimiser: None, progress: &|_| {} };
    let generated = generate(&mut sources, &packages, &manifest, &Request::default(), &tools);
    let generated = generated.map_err(|problems| format!("{problems:?}"))?;
    writer.finish(&generated.contents)?;
    Ok(generated.summary.permutations())
}

/// The kernel's peak memory of this process, in bytes.
pub fn peak() -> Result<f64, Box<dyn std::error::Error>> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .ok_or("the kernel does not say")?;
    Ok(line.trim().trim_end_matches(" kB").parse::<f64>()? * 1024.0)
}
