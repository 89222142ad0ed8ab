//! What comes from stores: bundles whose checksums are right, and records of a cache.

use std::sync::{Arc, Mutex};

use lamplight::bundle::{Bundle, Clip, Language, Target, merge, pack};
use lamplight::cache::{Cache, Job, Storage};
use lamplight::compose::{Composed, Options};
use lamplight::diagnostic::render::{Form, render};
use lamplight::source::SourceSet;

use super::seal;

/// A bundle whose checksums are put right: opened, verified, and copied into another.
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
    assert!(verified.is_ok() || merged.is_err(), "what `verify` refuses is merged");
    answer + &format!("{:?}", merged.and_then(|all| pack(&all)).map(|bytes| bytes.len()))
}

/// One record for every name that is asked for.
struct Fixed {
    packed: Vec<u8>,
    asked: Arc<Mutex<Vec<String>>>,
}

impl Storage for Fixed {
    fn get(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
        if let Ok(mut asked) = self.asked.lock() {
            asked.push(name.to_owned());
        }
        Ok(Some(seal::record(name, &self.packed)))
    }

    fn put(&self, _: &str, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

/// A record of a cache with the right checksum, whatever name it is asked for under.
pub fn record(bytes: &[u8]) -> String {
    let asked = Arc::<Mutex<Vec<String>>>::default();
    let cache = Cache::new(vec![Box::new(Fixed { packed: bytes.to_vec(), asked: asked.clone() })]);
    let composed = Composed::of_text(Language::Wesl, None, "fn f() {}".to_owned());
    let found = cache.find(Job {
        text: "fn f() {}",
        composed: &composed,
        entry: "f",
        options: &Options::default(),
        targets: &[Target::WGSL],
        clip: Clip::default(),
    });
    let told = match &found {
        Some(Ok(made)) => format!("{} {:?}", made.unit.targets.len(), made.warnings),
        Some(Err(errors)) => render(&SourceSet::default(), errors, Form::Human),
        None => "none".to_owned(),
    };
    told + &asked.lock().map(|asked| asked.join(" ")).unwrap_or_default()
}
