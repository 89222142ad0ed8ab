//! A place where functions and frames run: a device of wgpu, or like one that exists.

use super::{Kind, Made, Repository, check_name};

pub const KIND: Kind =
    Kind { name: "executor", example: &["dx12"], rest: "[EXECUTOR THAT IT IS LIKE]", make };

const FOLDER: &str = "src/execute/executors";
const CARGO: &str = "Cargo.toml";

/// Interfaces that wgpu has on some systems only: the name, which is also that of a feature of wgpu,
/// and the system.
const INTERFACES: [(&str, &str); 2] = [("dx12", "windows"), ("metal", "macos, ios")];

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<Made, String> {
    check_name(name, '_')?;
    let file = format!("{FOLDER}/{name}.rs");
    repository.refuse_existing(&file)?;
    let known = repository.stems(FOLDER)?;
    let interface = INTERFACES.iter().find(|(one, _)| *rest.first().unwrap_or(&name) == *one);
    let text = match rest {
        [] | [_] if interface.is_some() => of_wgpu(name, interface),
        [] => of_wgpu(name, None),
        [like] if known.iter().any(|known| known == like) => {
            let text = repository.read(&format!("{FOLDER}/{like}.rs"))?;
            text.replace(&format!("name: {like:?}"), &format!("name: {name:?}"))
        }
        _ => return Err(format!("name one executor of {}, dx12, metal", known.join(", "))),
    };
    let mut next = vec![
        format!(
            "{file}: `about`, and what opens it (trials house::described, harness::executor::{name})"
        ),
        format!(
            "{file}: `needs`, each package listed in xtask/src/machine.rs too (trial house::needs_of_executors)"
        ),
        format!(
            "{file}: `samples: None` where it draws no frames, and `shipping` where it takes a target's files as they are (trials harness::executor::{name}, frames/shipped)"
        ),
        "cargo xtask record diagnostics; cargo xtask record guide; read the difference".to_owned(),
    ];
    if interface.is_none() && rest.is_empty() {
        next.insert(0, format!(
            "{file}: opens a Vulkan device whose name contains `{name}`; the interfaces are `cargo xtask new executor {name} dx12` and `... metal`"
        ));
    }
    let mut files = vec![(file, text)];
    if let Some((interface, _)) = interface {
        files.push((CARGO.to_owned(), with_feature(&repository.read(CARGO)?, interface)?));
        next.push(
            "cargo build, with a network: Cargo.lock gets what the interface needs".to_owned(),
        );
    }
    Ok(Made { files, next })
}

/// A device of an interface of wgpu, or else a device of Vulkan whose driver has this name.
fn of_wgpu(name: &str, interface: Option<&(&str, &str)>) -> String {
    let (systems, needs, backend, part) = match interface {
        Some((interface, systems)) => (*systems, "", interface.to_uppercase(), ""),
        None => ("every system but WebAssembly", "\"libvulkan1\"", "VULKAN".to_owned(), name),
    };
    let words = [
        ("NAME", name),
        ("SYSTEMS", systems),
        ("NEEDS", needs),
        ("BACKEND", &backend),
        ("PART", part),
    ];
    words.iter().fold(TEXT.to_owned(), |text, (word, value)| text.replace(word, value))
}

/// The manifest of the crate, with a feature of wgpu.
fn with_feature(text: &str, feature: &str) -> Result<String, String> {
    let wrong = || format!("`{CARGO}` has no line `wgpu = {{ ... features = [...] }}`");
    let start = text.find("\nwgpu = {").ok_or_else(wrong)?;
    let end = start + text[start..].find("] }").ok_or_else(wrong)?;
    if text[start..end].contains(&format!("{feature:?}")) {
        return Ok(text.to_owned());
    }
    Ok(format!("{}, {feature:?}{}", &text[..end], &text[end..]))
}

const TEXT: &str = r#"//! wgpu on NAME.
//!
//! Runs on: SYSTEMS

use super::{DEVICE_SAMPLES, Entry};
use crate::execute::gpu::{Named, Shaders, Wanted};

pub const EXECUTOR: Entry = Entry {
    name: "NAME",
    about: "",
    needs: &[NEEDS],
    before_threads: None,
    samples: Some(DEVICE_SAMPLES),
    open: || {
        super::open_gpu(Wanted {
            backend: wgpu::Backends::BACKEND,
            // A part of the adapter's name. An empty part allows every adapter. `Without` is for
            // adapters whose names do not have the part.
            named: Named::With("PART"),
            // Or `Emitted`, with a target, for texts that the driver gets unchanged.
            shaders: Shaders::Translated,
        })
    },
    shipping: None,
};
"#;
