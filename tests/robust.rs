//! Failures while a bundle is written: the run is killed, two runs write at once, there is no place
//! or no room, or the bundle is damaged. An older bundle stays whole. The exit code tells wrong input
//! from a wrong environment.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use lamplight::bundle::Bundle;
use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");
/// The number of runs that must have been killed.
const KILLS: u32 = 50;

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 6] = [
        ("killed_at_any_point", killed),
        ("two_runs_at_once", at_once),
        ("no_place_to_write", no_place),
        ("no_room_to_write", no_room),
        ("damaged_bundles", damaged),
        ("wrong_versions", versions),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("robust::{name}"), case)).collect()
}

const MANIFEST: &str = r#"
[program.small]
wesl = "small.wesl"
targets = ["wgsl", "glsl330"]
[program.small.axis]
color = { values = ["red", "green", "blue", "grey"] }
count = { values = [1, 2, 3, 4] }
"#;

/// A package of sixteen permutations. A number in the shader changes all outputs.
struct Package {
    folder: TempDir,
}

impl Package {
    fn new() -> Result<Self, Failed> {
        let package = Self { folder: tempfile::tempdir()? };
        std::fs::write(package.folder.path().join("lamplight.toml"), MANIFEST)?;
        package.change(0)?;
        Ok(package)
    }

    fn change(&self, number: u32) -> Outcome {
        let text = format!(
            "@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {{
                var sum = {number}.0;
                for (var i = 0; i < constants::count; i++) {{ sum += x * f32(i); }}
                @if(color == red) {{ return vec4f(sum, 0.0, 0.0, 1.0); }}
                @elif(color == green) {{ return vec4f(0.0, sum, 0.0, 1.0); }}
                @elif(color == blue) {{ return vec4f(0.0, 0.0, sum, 1.0); }}
                @else {{ return vec4f(sum); }}
            }}"
        );
        Ok(std::fs::write(self.folder.path().join("small.wesl"), text)?)
    }

    fn bundle(&self) -> PathBuf {
        self.folder.path().join("bundle")
    }

    fn command(&self, out: &Path) -> Command {
        let mut command = Command::new(LAMPLIGHT);
        command
            .args(["gen", "--manifest"])
            .arg(self.folder.path().join("lamplight.toml"))
            .arg("-o")
            .arg(out);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// How many blobs the bundle names.
    fn blobs(&self) -> Result<usize, Failed> {
        Ok(lamplight::bundle::blob_files(self.bundle())?.len())
    }

    fn generate(&self) -> Outcome {
        let output = self.command(&self.bundle()).output()?;
        if output.status.success() { Ok(()) } else { Err(code_and_stderr(&output).into()) }
    }

    /// Fails unless the bundle can be opened, has every permutation, and all checksums are right.
    fn check(&self) -> Outcome {
        let bundle = Bundle::open(self.bundle())?;
        bundle.verify()?;
        let keys = bundle.program("small")?.shader("fs_main")?.keys()?.len();
        match keys {
            16 => Ok(()),
            _ => Err(format!("the bundle has {keys} permutations, expected 16").into()),
        }
    }
}

fn code_and_stderr(output: &Output) -> String {
    format!("{:?}: {}", output.status.code(), String::from_utf8_lossy(&output.stderr))
}

/// Fails, with the place of the call, unless a command ended with a code and a message, and did not
/// panic.
#[track_caller]
fn fails(output: &Output, code: i32, words: &str) -> Outcome {
    let place = std::panic::Location::caller();
    let error = String::from_utf8_lossy(&output.stderr);
    let is_as_expected =
        output.status.code() == Some(code) && error.contains(words) && !error.contains("panicked");
    if is_as_expected {
        Ok(())
    } else {
        let expected = format!("expected exit code {code} and `{words}`");
        Err(format!("{place}: {expected}, found {}", code_and_stderr(output)).into())
    }
}

/// Runs are killed at random times. After each, the bundle is whole: the older or the newer one.
fn killed() -> Outcome {
    let package = Package::new()?;
    let start = Instant::now();
    for round in 1..=4 {
        package.change(11 * KILLS + round)?;
        package.generate()?;
    }
    let mut whole = start.elapsed() / 4;
    let mut state = 0x9e37_79b9_u32;
    let (mut died, mut round) = (0, 0);
    // Some runs end before they are killed. These do not count.
    while died < KILLS && round < 10 * KILLS {
        round += 1;
        package.change(round)?;
        let mut child = package.command(&package.bundle()).spawn()?;
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        // The kill comes at a random time within a run, from a tenth to nine tenths of it.
        std::thread::sleep(whole.mul_f64(0.1 + 0.8 * f64::from(state) / f64::from(u32::MAX)));
        child.kill()?;
        // Other tests come and go, so how long a run takes changes.
        match child.wait()?.success() {
            true => whole = whole.mul_f64(0.9),
            false => {
                whole = whole.mul_f64(1.03);
                died += 1;
            }
        }
        package.check().map_err(|failed| format!("round {round}: {failed:?}"))?;
    }
    package.generate()?;
    package.check()?;
    // After two more runs, no temporary files of the killed runs are left, and no blobs that neither
    // of the last two bundles names.
    let blobs = || Ok::<_, Failed>(std::fs::read_dir(package.bundle().join("blobs"))?.count());
    package.change(round + 1)?;
    package.generate()?;
    let unnamed = blobs()?.saturating_sub(2 * package.blobs()?);
    let left = std::fs::read_dir(package.bundle())?.filter_map(Result::ok);
    let is_scratch = |name: &str| name.starts_with(".lamplight-") && name.len() == 27;
    let left =
        left.filter(|entry| is_scratch(&entry.file_name().to_string_lossy())).count() + unnamed;
    println!("{died} of {round} runs of {whole:.0?} killed");
    match (died, left) {
        (KILLS, 0) => Ok(()),
        (KILLS, _) => Err(format!("{left} files of killed runs are left").into()),
        _ => Err(format!("{died} of {round} runs were killed, expected {KILLS}").into()),
    }
}

/// Two runs over different sources write to one folder at once. Each waits until the other has
/// finished writing, and the bundle is whole.
fn at_once() -> Outcome {
    let packages = [Package::new()?, Package::new()?];
    let bundle = packages[0].bundle();
    for round in 0..8 {
        let mut children = Vec::new();
        for (index, package) in packages.iter().enumerate() {
            package.change(round * 2 + index as u32)?;
            children.push(package.command(&bundle).spawn()?);
        }
        for child in children {
            let output = child.wait_with_output()?;
            if !output.status.success() {
                return Err(code_and_stderr(&output).into());
            }
        }
        packages[0].check().map_err(|failed| format!("round {round}: {failed:?}"))?;
    }
    Ok(())
}

/// A bundle that cannot be written to its place is an error, and a file in the place is kept.
fn no_place() -> Outcome {
    let package = Package::new()?;
    let file = package.folder.path().join("file");
    std::fs::write(&file, "in the way")?;
    fails(&package.command(&file).output()?, 1, "cannot write")?;
    fails(&package.command(&file.join("below")).output()?, 1, "cannot write")?;
    // Nobody may write to /proc, not even the superuser.
    fails(&package.command(Path::new("/proc/lamplight")).output()?, 4, "cannot write")?;
    fails(&package.command(Path::new("/proc/bundle.lamplight")).output()?, 4, "cannot write")?;
    let kept = std::fs::read_to_string(&file)?;
    match kept.as_str() {
        "in the way" => Ok(()),
        _ => Err(format!("the file in the bundle's place was overwritten: {kept:?}").into()),
    }
}

/// A full disk, for which a limit on file sizes stands, is an error that leaves the older bundle
/// whole.
fn no_room() -> Outcome {
    let package = Package::new()?;
    package.generate()?;
    package.change(7)?;
    let command = package.command(&package.bundle());
    let words: Vec<String> =
        command.get_args().map(|word| word.to_string_lossy().into_owned()).collect();
    for blocks in [0, 1, 4] {
        let output = Command::new("sh")
            .args([
                "-c",
                &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\""),
                "sh",
                LAMPLIGHT,
            ])
            .args(&words)
            .output()?;
        fails(&output, 4, "cannot write")
            .map_err(|failed| format!("{blocks} blocks: {failed:?}"))?;
        package.check()?;
    }
    package.generate()?;
    package.check()
}

/// Commands that read a damaged bundle say so.
fn damaged() -> Outcome {
    let package = Package::new()?;
    let file = package.folder.path().join("small.lamplight");
    let made = package.command(&file).output()?;
    if !made.status.success() {
        return Err(code_and_stderr(&made).into());
    }
    let whole = std::fs::read(&file)?;
    for length in [0, 7, 100, 300, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&file, &whole[..length])?;
        fails(&inspect("list", &file)?, 1, "damaged")?;
    }
    std::fs::write(&file, "not a bundle at all, but long enough to have a header".repeat(10))?;
    fails(&inspect("list", &file)?, 1, "not a Lamplight bundle")?;
    fails(&inspect("list", &package.folder.path().join("nowhere"))?, 1, "cannot be read")?;
    let mut flipped = whole.clone();
    *flipped.last_mut().ok_or("empty")? ^= 1;
    std::fs::write(&file, flipped)?;
    fails(&inspect("verify", &file)?, 3, "damaged")?;
    std::fs::write(&file, whole)?;
    let output = inspect("verify", &file)?;
    if output.status.success() { Ok(()) } else { Err(code_and_stderr(&output).into()) }
}

/// A bundle of another version is refused, and the next run replaces it.
fn versions() -> Outcome {
    let package = Package::new()?;
    package.generate()?;
    let manifest = package.bundle().join("manifest.json");
    let text = std::fs::read_to_string(&manifest)?;
    std::fs::write(&manifest, text.replacen("\"version\": 3", "\"version\": 99", 1))?;
    let index = package.bundle().join("index.bin");
    let mut bytes = std::fs::read(&index)?;
    bytes[8] = 99;
    std::fs::write(&index, bytes)?;
    fails(&inspect("list", &package.bundle())?, 1, "version 99")?;
    // The next run would lose what a newer version wrote, so it needs `--force`.
    fails(&package.command(&package.bundle()).output()?, 1, "newer than version 3")?;
    let forced = package.command(&package.bundle()).arg("--force").output()?;
    if !forced.status.success() {
        return Err(code_and_stderr(&forced).into());
    }
    package.check()
}

fn inspect(command: &str, bundle: &Path) -> Result<Output, Failed> {
    let start = Instant::now();
    let output = Command::new(LAMPLIGHT).args(["bundle", command]).arg(bundle).output()?;
    if start.elapsed() < Duration::from_secs(10) {
        Ok(output)
    } else {
        Err(format!("`bundle {command}` took {:?}, at most 10 s", start.elapsed()).into())
    }
}
