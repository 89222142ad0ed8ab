//! The kinds of input that are read from stores: bundles with correct checksums, and records of a
//! cache.

use std::sync::{Arc, Mutex};

use lamplight::bundle::{Bundle, Conventions, Language, Target, merge, pack};
use lamplight::cache::{Cache, CompileJob, Storage};
use lamplight::compose::{Composed, Options};
use lamplight::diagnostic::render::{Form, render};
use lamplight::source::SourceSet;

use super::seal;

/// Corrects the checksums of a bundle, then opens it, verifies it, and merges it into a new bundle.
pub fn sealed(bytes: &[u8]) -> String {
    let bundle = match Bundle::from_bytes(seal::bundle(bytes)) {
        Ok(bundle) => bundle,
        Err(error) => return error.to_string(),
    };
    let verified = bundle.verify();
    let mut answer = format!("{verified:?}\n");
    for name in bundle.programs() {
        let Ok(program) = bundle.program(name) else { continue };
        for (language, entry) in program.entries() {
            let Ok(shader) = program.entry(language, entry) else { continue };
            for key in ["default", "no=such", ""] {
                answer += &format!("{:?}\n", shader.get(key, Target::SPIRV).map(|f| f.bytes.len()));
            }
        }
    }
    let contents = bundle.contents();
    answer += &format!("{:?}\n", contents.as_ref().map(|contents| contents.programs.len()));
    let merged = merge(&[bundle]);
    let consistent = verified.is_ok() || merged.is_err();
    assert!(consistent, "`verify` refuses the bundle, but `merge` accepts it: {verified:?}");
    answer + &format!("{:?}", merged.and_then(|all| pack(&all)).map(|bytes| bytes.len()))
}

/// A storage that has the same record under every name, and keeps the names that it is asked for.
struct Fixed {
    packed: Vec<u8>,
    names: Arc<Mutex<Vec<String>>>,
}

impl Storage for Fixed {
    fn get(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
        if let Ok(mut names) = self.names.lock() {
            names.push(name.to_owned());
        }
        Ok(Some(seal::record(name, &self.packed)))
    }

    fn put(&self, _: &str, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

/// Reads the input as a record of a cache, with the correct checksum for the name it is asked for.
pub fn record(bytes: &[u8]) -> String {
    let names = Arc::<Mutex<Vec<String>>>::default();
    let cache =
        Cache::new("fuzz", vec![Box::new(Fixed { packed: bytes.to_vec(), names: names.clone() })]);
    let composed = Composed::of_text(Language::Wesl, None, "fn f() {}".to_owned());
    let found = cache.find(CompileJob {
        text: "fn f() {}",
        composed: &composed,
        entry: "f",
        options: &Options::default(),
        targets: &[Target::WGSL],
        conventions: Conventions::default(),
        optimiser: None,
    });
    let answer = match &found {
        Some(Ok(made)) => format!("{} {:?}", made.unit.targets.len(), made.warnings),
        Some(Err(errors)) => render(&SourceSet::default(), errors, Form::Human),
        None => "none".to_owned(),
    };
    answer + &names.lock().map(|names| names.join(" ")).unwrap_or_default()
}
