//! `cargo xtask site`: builds the toolchain as WebAssembly, and the site around it.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use xtask::process::{cargo_command, finish, root};
use xtask::{CommandFailure, CommandResult, machine};

/// The groups of tests that run the npm package in Node, or the site in a browser.
pub const GROUPS: [&str; 2] = ["toolchain", "site"];

const TARGET: &str = "wasm32-unknown-unknown";

/// The size of the stack, since naga recurses along expressions. The limits leave most of it
/// unused.
const STACK: &str = "-C link-arg=-zstack-size=8388608";

/// What is tested is built once and used for two minutes. That is long enough to optimise naga, but
/// not to optimise the crate.
const QUICK: [&str; 2] = ["profile.dev.incremental=false", "profile.dev.package.naga.opt-level=1"];

/// How much work goes into the size and speed of the WebAssembly.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum SiteBuild {
    /// As it is published: small and fast.
    Small,
    /// As it is tested: the same code with less optimisation, which is built faster.
    Quick,
}

impl SiteBuild {
    fn profile(self) -> &'static str {
        match self {
            Self::Small => "web",
            Self::Quick => "dev",
        }
    }

    fn folder(self) -> &'static str {
        match self {
            Self::Small => "web",
            Self::Quick => "debug",
        }
    }

    /// The command as it is run. The build of the tests takes longer than the quick one, so it goes
    /// first.
    fn prioritised(self, command: Command) -> Command {
        match self {
            Self::Small => command,
            Self::Quick => machine::with_lowest_priority(command),
        }
    }
}

/// Makes the npm package in `target/toolchain/`, then the site in `target/site/`, with the gallery.
pub fn run(arguments: &[String]) -> CommandResult {
    let (mut build, mut only) = (SiteBuild::Small, false);
    for argument in arguments {
        match argument.as_str() {
            "--quick" => build = SiteBuild::Quick,
            "--toolchain" => only = true,
            _ => {
                return Err(CommandFailure::usage(
                    "usage: cargo xtask site [--toolchain] [--quick]",
                ));
            }
        }
    }
    toolchain(build)?;
    if only {
        return Ok(());
    }
    match build {
        SiteBuild::Quick => pages(),
        SiteBuild::Small => build_pages(Some(GALLERY)).and_then(|()| draw_gallery()),
    }
}

/// The page of the large pictures, from the site's folder.
const GALLERY: &str = "gallery/index.html";

/// Draws the gallery's large pictures into the site, with the software driver where there is no GPU.
fn draw_gallery() -> CommandResult {
    machine::prepare(&Some(vec!["mesa-vulkan-drivers"]))?;
    let mut draw = cargo_command();
    draw.args(["run", "--quiet", "--release", "--package", "lamplight", "--"]);
    draw.args(["render", "--all", "--force", "--out", "target/site/gallery"]);
    finish(&mut draw, "lamplight render --all")
}

/// Builds the site in `target/site/`, around the npm package that was built before, without large
/// pictures.
pub fn pages() -> CommandResult {
    build_pages(None)
}

/// Builds the site. Its page of the gallery links the large pictures if there are any.
fn build_pages(gallery: Option<&str>) -> CommandResult {
    let folder = root().join("site");
    if !machine::program("npm") {
        machine::install(&["npm"])?;
    }
    let npm = |arguments: &[&str]| {
        let mut command = Command::new("npm");
        command.args(arguments).current_dir(&folder).stdout(Stdio::null());
        command.env_remove("VITE_LARGE_PICTURES");
        command.envs(gallery.map(|page| ("VITE_LARGE_PICTURES", page)));
        finish(&mut command, &format!("npm {}", arguments.join(" ")))
    };
    npm(&["ci", "--no-audit", "--no-fund", "--loglevel=error"])?;
    npm(&["run", "build"])
}

/// Builds the npm package `@lamplight/toolchain` in `target/toolchain/`.
pub fn toolchain(build: SiteBuild) -> Result<PathBuf, CommandFailure> {
    let below = root().join("target/wasm");
    webassembly(build, &below)?;
    let module = below.join(TARGET).join(build.folder()).join("lamplight_toolchain.wasm");
    let package = root().join("target/toolchain");
    std::fs::create_dir_all(&package).map_err(|error| unwritten(&package, &error))?;
    let mut bind = cargo_command();
    bind.args(["run", "--quiet", "--package", "lamplight-bind", "--target-dir"]).arg(&below);
    bind.args(["--config", "profile.dev.incremental=false"]);
    bind.arg("--").arg(&module).arg(&package);
    finish(&mut build.prioritised(bind), "lamplight-bind")?;
    let sources = root().join("site/toolchain/js");
    for name in ["index.js", "index.d.ts", "package.json", "README.md"] {
        let to = package.join(name);
        std::fs::copy(sources.join(name), &to).map_err(|error| unwritten(&to, &error))?;
    }
    if build == SiteBuild::Small {
        sizes(&package.join("toolchain_bg.wasm"))?;
    }
    Ok(package)
}

/// Compiles to WebAssembly, with the target of rustup or with Debian's packages for it.
fn webassembly(build: SiteBuild, below: &Path) -> CommandResult {
    let mut command = cargo_for_webassembly()?;
    command.args(["build", "--package", "lamplight-toolchain", "--profile", build.profile()]);
    command.args(["--target", TARGET, "--target-dir"]).arg(below);
    if build == SiteBuild::Quick {
        command.args(QUICK.iter().flat_map(|setting| ["--config", *setting]));
    }
    command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", STACK);
    finish(&mut build.prioritised(command), "cargo build --package lamplight-toolchain")
}

/// Whether the toolchain compiles to WebAssembly, without making anything.
pub fn check_webassembly() -> CommandResult {
    let mut command = cargo_for_webassembly()?;
    command.args(["check", "--package", "lamplight-toolchain", "--target", TARGET]);
    command.arg("--target-dir").arg(root().join("target/wasm"));
    finish(&mut command, "cargo check --package lamplight-toolchain")
}

/// Cargo of a compiler that has the target.
fn cargo_for_webassembly() -> Result<Command, CommandFailure> {
    if has_target() || added_target() { Ok(cargo_command()) } else { debian() }
}

/// Whether the compiler in use has the standard library of the target.
fn has_target() -> bool {
    let arguments = ["--print", "target-libdir", "--target", TARGET];
    let found = Command::new("rustc").args(arguments).current_dir(root()).output();
    found.is_ok_and(|found| Path::new(String::from_utf8_lossy(&found.stdout).trim()).is_dir())
}

fn added_target() -> bool {
    let mut add = Command::new("rustup");
    add.args(["target", "add", TARGET]).current_dir(root()).stderr(Stdio::null());
    machine::program("rustup") && add.status().is_ok_and(|status| status.success()) && has_target()
}

/// Debian's own compiler, which builds the standard library from its sources.
fn debian() -> Result<Command, CommandFailure> {
    const LINKER: &str = "/usr/bin/wasm-ld-22";
    if !Path::new(LINKER).exists() || !Path::new("/usr/lib/rustlib/src/rust/library").is_dir() {
        machine::install(&["rustc-web", "cargo-web", "rust-web-src", "lld-22"])?;
    }
    let mut command = Command::new("/usr/bin/cargo");
    command.args(["-Zbuild-std=std,panic_abort"]).current_dir(root());
    command.env("RUSTC", "/usr/bin/rustc").env("RUSTC_BOOTSTRAP", "1");
    command.env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO");
    command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", LINKER);
    Ok(command)
}

fn unwritten(path: &Path, error: &std::io::Error) -> CommandFailure {
    CommandFailure::environment(format!("cannot write `{}`: {error}", path.display()))
}

/// The largest size of the toolchain after compression, in bytes.
const LARGEST: usize = 3 << 20;

/// Prints how large the toolchain is, and how large as a server sends it.
fn sizes(module: &Path) -> CommandResult {
    let script = "const { gzipSync, brotliCompressSync } = require('zlib'); \
        const bytes = require('fs').readFileSync(process.argv[1]); \
        console.log(bytes.length, gzipSync(bytes, { level: 9 }).length, \
            brotliCompressSync(bytes, { params: { [require('zlib').constants.BROTLI_PARAM_QUALITY]: 9 } }).length)";
    let output = Command::new("node").args(["-e", script]).arg(module).output();
    let output = output.map_err(|error| CommandFailure::environment(format!("node: {error}")))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let sizes: Vec<usize> = text.split_whitespace().filter_map(|size| size.parse().ok()).collect();
    let [raw, gzip, brotli] = sizes[..] else {
        return Err(CommandFailure::environment("node could not compress the toolchain"));
    };
    println!("toolchain: {raw} bytes, {gzip} with gzip, {brotli} with brotli");
    if gzip > LARGEST {
        return Err(CommandFailure::check(format!("more than {LARGEST} bytes, compressed")));
    }
    Ok(())
}
