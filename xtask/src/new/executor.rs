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
    let text = match rest {
        [] => of_wgpu(name),
        [like] if known.iter().any(|known| known == like) => {
            let text = repository.read(&format!("{FOLDER}/{like}.rs"))?;
            text.replace(&format!("name: {like:?}"), &format!("name: {name:?}"))
        }
        _ => return Err(format!("name one executor of {}", known.join(", "))),
    };
    let next = vec![
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
    let mut files = vec![(file, text)];
    if INTERFACES.iter().any(|(interface, _)| *interface == name) && rest.is_empty() {
        files.push((CARGO.to_owned(), with_feature(&repository.read(CARGO)?, name)?));
    }
    Ok(Made { files, next })
}

/// A device of an interface of wgpu that has this name, or else a device of Vulkan whose driver has
/// it.
fn of_wgpu(name: &str) -> String {
    let interface = INTERFACES.iter().find(|(interface, _)| *interface == name);
    let (systems, needs, backend, part) = match interface {
        Some((_, systems)) => (*systems, "", name.to_uppercase(), ""),
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
            // A part of the adapter's name. An empty part allows every adapter.
            named: Named::With("PART"),
            shaders: Shaders::Translated,
        })
    },
    shipping: None,
};
"#;
