//! The package for CMake: a program with an embedded bundle and its keys, in folders with blanks in
//! their names. An edited shader makes the bundle again, and nothing else does.

use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::{Failed, Trial};

use super::{LAMPLIGHT, Outcome, root, run};

const PROJECT: &str = "cmake_minimum_required(VERSION 3.10)
project(app C)
add_subdirectory(shaders)
add_executable(app main.c)
target_link_libraries(app PRIVATE lit)
";

const SHADERS: &str = "find_package(Lamplight REQUIRED)
lamplight_add_bundle(lit MANIFEST lamplight.toml TARGETS spirv wgsl EMBED)
";

const MAIN: &str = r#"#define LAMPLIGHT_IMPLEMENTATION
#define LAMPLIGHT_ZSTD_IMPLEMENTATION
#include "lamplight.h"
#include "lamplight_zstd.h"
#include "lit.h"
#include "lit_keys.h"

int main(void) {
    static lamplight bundle;
    lamplight_shader shader;
    int code = lamplight_open(&bundle, lit_bundle, sizeof lit_bundle);
    if (!code) code = lamplight_find(&bundle, "lit", "fs_main", "default", "spirv", &shader);
    printf("%s %d\n", code ? lamplight_error(&bundle) : shader.stage, LIT_LAMPS_BINDING);
    return code;
}
"#;

/// Ignored where there is no CMake; `cargo xtask test` installs it.
pub fn test() -> Trial {
    let is_missing = Command::new("cmake").arg("--version").output().is_err();
    Trial::test("clients::cmake", builds).with_ignored_flag(is_missing)
}

fn cmake(folder: &Path, arguments: &[&str]) -> Outcome {
    let mut command = Command::new("cmake");
    command.env("XDG_CACHE_HOME", folder.join("cache")).current_dir(folder);
    run(command.args(arguments))
}

fn builds() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let folder = scratch.path().join("a project");
    let shaders = folder.join("shaders");
    std::fs::create_dir_all(&shaders)?;
    for name in ["lamplight.toml", "lit.wesl"] {
        std::fs::copy(root().join("tests/clients").join(name), shaders.join(name))?;
    }
    for (name, text) in
        [("CMakeLists.txt", PROJECT), ("shaders/CMakeLists.txt", SHADERS), ("main.c", MAIN)]
    {
        std::fs::write(folder.join(name), text)?;
    }
    let prefix = format!("-DCMAKE_PREFIX_PATH={}", root().display());
    let program = format!("-DLAMPLIGHT_PROGRAM={LAMPLIGHT}");
    cmake(&folder, &["-G", "Unix Makefiles", "-B", "out", &prefix, &program])?;
    let first = built(&folder)?;
    if built(&folder)? != first {
        return Err("a build without an edit makes the bundle again".into());
    }
    let shader = shaders.join("lit.wesl");
    let text = std::fs::read_to_string(&shader)?;
    std::fs::write(&shader, text + "// An edit.\n")?;
    if built(&folder)? == first {
        return Err("a build after an edit does not make the bundle again".into());
    }
    Ok(())
}

/// Builds the program and runs it. Returns when its bundle was written.
fn built(folder: &Path) -> Result<std::time::SystemTime, Failed> {
    cmake(folder, &["--build", "out"])?;
    let out: PathBuf = folder.join("out");
    let said = Command::new(out.join("app")).output()?.stdout;
    let said = String::from_utf8_lossy(&said);
    // The number of the binding in `lit.wesl`.
    if said.trim() != "fragment 1" {
        return Err(format!("the program prints `{said}`").into());
    }
    Ok(std::fs::metadata(out.join("shaders/lit/lit.lamplight"))?.modified()?)
}
