//! What the machine must have, and how to get it on Debian and Ubuntu.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::{CommandFailure, CommandResult};

/// Something that the tests need: the Debian package that has it, and how to see whether it is
/// there.
struct Need {
    package: &'static str,
    what: &'static str,
    found: fn() -> bool,
}

const NEEDS: &[Need] = &[
    Need { package: "libvulkan1", what: "the Vulkan loader", found: || library("libvulkan.so.1") },
    Need {
        package: "mesa-vulkan-drivers",
        what: "the software Vulkan driver (lavapipe)",
        found: lavapipe,
    },
    Need { package: "libegl1", what: "EGL", found: || library("libEGL.so.1") },
    Need { package: "libgles2", what: "the GL ES loader", found: || library("libGLESv2.so.2") },
    Need {
        package: "libgl1-mesa-dri",
        what: "the software GL driver (llvmpipe)",
        found: || installed("libgl1-mesa-dri"),
    },
    Need {
        package: "chromium",
        what: "Chromium with its SwiftShader",
        found: || Path::new("/usr/lib/chromium/vk_swiftshader_icd.json").exists(),
    },
    Need { package: "nodejs", what: "node, for the typed keys", found: || program("node") },
    Need { package: "gcc", what: "cc, for clients in C", found: || program("cc") },
    Need { package: "g++", what: "g++, for readers in C++", found: || program("g++") },
    Need { package: "cmake", what: "CMake, for its package", found: || program("cmake") },
    Need { package: "make", what: "make, for projects of CMake", found: || program("make") },
    Need {
        package: "libegl-dev",
        what: "the headers of EGL",
        found: || Path::new("/usr/include/EGL/egl.h").exists(),
    },
    Need {
        package: "libgl-dev",
        what: "the headers of OpenGL",
        found: || Path::new("/usr/include/GL/glcorearb.h").exists(),
    },
    Need {
        package: "libopengl-dev",
        what: "the library of OpenGL to link with",
        found: || Path::new("/usr/lib/x86_64-linux-gnu/libOpenGL.so").exists(),
    },
    Need {
        package: "libgles-dev",
        what: "the headers of OpenGL ES",
        found: || Path::new("/usr/include/GLES3/gl3.h").exists(),
    },
    Need {
        package: "libvulkan-dev",
        what: "the headers of Vulkan",
        found: || Path::new("/usr/include/vulkan/vulkan.h").exists(),
    },
    Need { package: "spirv-tools", what: "spirv-val", found: || program("spirv-val") },
    Need {
        package: "glslang-tools",
        what: "glslangValidator",
        found: || program("glslangValidator"),
    },
    Need { package: "glslc", what: "glslc", found: || program("glslc") },
    Need { package: "clang", what: "clang++, for MSL", found: || program("clang++") },
    Need {
        package: "neovim",
        what: "nvim, a client of the language server",
        found: || program("nvim"),
    },
    Need { package: "parallel", what: "GNU parallel, for shards", found: || program("parallel") },
    Need {
        package: "redis-server",
        what: "redis-server, for shared caches",
        found: || program("redis-server"),
    },
];

/// Installs what is missing of some packages, or of all that any test needs, if that is allowed.
/// Otherwise prints exactly what to install.
pub fn prepare(only: &Option<Vec<&str>>) -> CommandResult {
    let missing = missing(only);
    if missing.is_empty() {
        return Ok(());
    }
    for (package, what) in &missing {
        eprintln!("missing: {what} (Debian package {package})");
    }
    let packages: Vec<&str> = missing.iter().map(|(package, _)| *package).collect();
    install(&packages)?;
    match self::missing(only).first() {
        None => Ok(()),
        Some((_, what)) => Err(CommandFailure::environment(format!(
            "installed {}, yet {what} is not found",
            packages.join(" "),
        ))),
    }
}

/// The package and the purpose of everything that is missing of what is wanted.
fn missing(only: &Option<Vec<&str>>) -> Vec<(&'static str, &'static str)> {
    let is_wanted = |need: &&Need| only.as_ref().is_none_or(|only| only.contains(&need.package));
    let missing = NEEDS.iter().filter(is_wanted).filter(|need| !(need.found)());
    missing.map(|need| (need.package, need.what)).collect()
}

/// Installs packages of Debian.
pub fn install(packages: &[&str]) -> CommandResult {
    let by_hand = format!(
        "sudo apt-get update && sudo apt-get install -y --no-install-recommends {}",
        packages.join(" ")
    );
    let Some(prefix) = privilege() else {
        return Err(CommandFailure::environment(format!(
            "these tests need more than is installed here; run\n\n    {by_hand}\n"
        )));
    };
    let run = |arguments: &[&str]| {
        let line: Vec<&str> =
            prefix.iter().copied().chain(["apt-get"]).chain(arguments.iter().copied()).collect();
        Command::new(line[0])
            .args(&line[1..])
            .env("DEBIAN_FRONTEND", "noninteractive")
            .status()
            .is_ok_and(|status| status.success())
    };
    let arguments: Vec<&str> = ["install", "-y", "-qq", "--no-install-recommends"]
        .iter()
        .chain(packages)
        .copied()
        .collect();
    if run(&["update", "-qq"]) && run(&arguments) {
        Ok(())
    } else {
        Err(CommandFailure::environment(format!(
            "apt-get could not install what the tests need; run\n\n    {by_hand}\n"
        )))
    }
}

/// What to put before `apt-get`: nothing for root, `sudo -n` if it needs no password.
fn privilege() -> Option<&'static [&'static str]> {
    if !program("apt-get") {
        return None;
    }
    if quiet("id", &["-u"]).is_some_and(|id| id.trim() == "0") {
        return Some(&[]);
    }
    quiet("sudo", &["-n", "true"]).map(|_| ["sudo", "-n"].as_slice())
}

fn quiet(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

pub fn program(name: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(name).is_file())
}

/// A command with the lowest priority, so that it runs while others wait. Where the system has no
/// program `nice`, it is the command itself.
pub fn with_lowest_priority(command: Command) -> Command {
    if !program("nice") {
        return command;
    }
    let mut nice = Command::new("nice");
    nice.args(["-n", "19"]).arg(command.get_program()).args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => nice.env(name, value),
            None => nice.env_remove(name),
        };
    }
    if let Some(folder) = command.get_current_dir() {
        nice.current_dir(folder);
    }
    nice
}

fn library(name: &str) -> bool {
    let folders = [
        "/usr/lib/x86_64-linux-gnu",
        "/usr/lib/aarch64-linux-gnu",
        "/usr/lib64",
        "/usr/lib",
        "/usr/local/lib",
    ];
    folders.iter().any(|folder| Path::new(folder).join(name).exists())
}

fn lavapipe() -> bool {
    let folders = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    folders
        .iter()
        .flat_map(std::fs::read_dir)
        .flatten()
        .flatten()
        .any(|entry| entry.file_name().to_string_lossy().starts_with("lvp_icd"))
}

fn installed(package: &str) -> bool {
    if !program("dpkg") {
        return library("dri/swrast_dri.so") || library("libgallium_dri.so");
    }
    quiet("dpkg-query", &["-W", "-f=${Status}", package])
        .is_some_and(|status| status.contains("install ok installed"))
}
