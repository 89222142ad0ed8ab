//! The interface for engines.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::contents::Contents;
use super::store::{self, Store};
use super::usage::{Recorder, Usage};
use super::{
    Artifact, Axis, EntryContents, Error, Language, LayoutBinding, Miss, Native, ProgramContents,
    Reflection, ShardOrigin, Target, Unit, directory, file, key,
};

/// An open bundle of either form. Cheap to share between threads.
///
/// ```no_run
/// # fn main() -> Result<(), lamplight_bundle::Error> {
/// use lamplight_bundle::{Bundle, Target};
///
/// let bundle = Bundle::open("shaders.lamplight")?;
/// let shader = bundle.program("forward")?.shader("fs_main")?;
/// let found = shader.get("shadow=hard", Target::SPIRV)?;
/// println!("{} bytes, entry point {}", found.bytes.len(), found.native.entry_name);
/// # Ok(())
/// # }
/// ```
pub struct Bundle {
    store: Box<dyn Store>,
    recorder: Option<Recorder>,
    /// Where it was opened. `None` for a bundle in memory.
    path: Option<PathBuf>,
}

/// Opens a bundle of either form.
pub fn store_of(path: &Path) -> Result<Box<dyn Store>, Error> {
    Ok(if path.is_dir() { Box::new(directory::open(path)?) } else { Box::new(file::open(path)?) })
}

/// One program of a bundle.
pub struct Program<'a> {
    store: &'a dyn Store,
    recorder: Option<&'a Recorder>,
    name: &'a str,
    program: &'a store::StoredProgram,
}

/// One entry point of a program, in one source language.
#[derive(Clone, Copy)]
pub struct Shader<'a> {
    store: &'a dyn Store,
    program: &'a str,
    recorder: Option<&'a Recorder>,
    axes: &'a [Axis],
    entry: usize,
}

/// One permutation in one target.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// The output: text, or the words of SPIR-V.
    pub bytes: Vec<u8>,
    /// What is bound, and what enters and leaves the stage.
    pub reflection: Arc<Reflection>,
    /// Names and numbers that the target has for what the reflection lists.
    pub native: Arc<Native>,
    /// The values that the key chooses for overrides: pass each as [`Native::choices`] says.
    pub constants: Vec<Constant>,
}

/// The value of an override.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Constant {
    /// As in the reflection.
    pub name: String,
    /// Type in WGSL: `bool`, `i32`, `u32` or `f32`.
    #[serde(rename = "type")]
    pub ty: String,
    /// `true`, `false` or an integer.
    pub value: String,
    /// The value as the 32 bits of its type, as a specialisation constant takes it; 0 and 1 for
    /// `false` and `true`.
    pub bits: u32,
}

impl Constant {
    /// The constant for a value of an axis, which is a truth value or an integer.
    fn of_axis(axis: &Axis, ty: &str, value: &str) -> Result<Self, Error> {
        let bits = match (ty, value) {
            ("bool", "true") => Some(1),
            ("bool", "false") => Some(0),
            ("i32", _) => value.parse::<i32>().ok().map(|value| value as u32),
            ("u32", _) => value.parse().ok(),
            ("f32", _) => value.parse::<f32>().ok().map(f32::to_bits),
            _ => None,
        };
        let bits = bits.ok_or_else(|| Error::BadKey {
            key: format!("{}={value}", axis.name),
            reason: format!("an override of type `{ty}` does not take this value"),
        })?;
        Ok(Self { name: axis.name.clone(), ty: ty.to_owned(), value: value.to_owned(), bits })
    }
}

impl Bundle {
    /// Opens a directory (its `index.bin`) or a single file.
    ///
    /// To change a file while it is open, replace it by renaming: this reader then keeps the old
    /// one. If it is changed in place, readers report an error. Checksums are verified on first use
    /// of what they cover; [`Bundle::verify`] checks all.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        Ok(Self { store: store_of(path)?, recorder: None, path: Some(path.to_owned()) })
    }

    /// A single-file bundle that is in memory.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, Error> {
        Ok(Self { store: Box::new(file::from_bytes(bytes)?), recorder: None, path: None })
    }

    /// What the bundle was made of, if it is a part of one.
    pub fn shard(&self) -> Option<&ShardOrigin> {
        self.store.shard()
    }

    pub(super) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    pub(super) fn store(&self) -> &dyn Store {
        &*self.store
    }

    pub(super) fn replace_store(&mut self, store: Box<dyn Store>) {
        self.store = store;
    }

    /// Names of the programs, sorted.
    pub fn programs(&self) -> impl Iterator<Item = &str> {
        self.store.programs().keys().map(String::as_str)
    }

    /// The program of that name.
    pub fn program(&self, name: &str) -> Result<Program<'_>, Error> {
        let programs = self.store.programs();
        let found = programs.get_key_value(name);
        let (name, program) = found.ok_or_else(|| not_found("program", name, programs.keys()))?;
        Ok(Program { store: &*self.store, recorder: self.recorder.as_ref(), name, program })
    }

    /// Records from now on which permutations are asked for, including those that are missing.
    /// Write [`Bundle::usage`] to a file that the manifest names, and the next bundle has exactly
    /// these.
    pub fn record(&mut self) {
        self.recorder.get_or_insert_with(Recorder::default);
    }

    /// The permutations asked for since [`Bundle::record`].
    pub fn usage(&self) -> Usage {
        self.recorder.as_ref().map(Recorder::usage).unwrap_or_default()
    }

    /// Checks every byte and every reference.
    pub fn verify(&self) -> Result<(), Error> {
        self.store.verify()
    }

    /// The single-file form, as [`super::pack`] makes it of [`Self::contents`]. One output at a time
    /// is in memory.
    ///
    /// # Errors
    /// Those of reading each output, and those of [`super::pack`].
    pub fn pack(&self) -> Result<Vec<u8>, Error> {
        self.store.pack()
    }

    /// Everything, in memory: to merge, compare, or write in the other form. Units with the same
    /// blob share its memory.
    pub fn contents(&self) -> Result<Contents, Error> {
        self.store.measure()?;
        let mut blobs = BTreeMap::new();
        let mut contents = Contents { shard: self.store.shard().cloned(), ..Contents::default() };
        for (name, program) in self.store.programs() {
            let mut copy =
                ProgramContents { axes: program.axes.clone(), ..ProgramContents::default() };
            for ((language, entry), number) in &program.entries {
                copy.languages
                    .entry(*language)
                    .or_default()
                    .insert(entry.clone(), self.entry_contents(*number, &mut blobs)?);
            }
            contents.programs.insert(name.clone(), copy);
        }
        Ok(contents)
    }

    fn entry_contents(
        &self,
        entry: usize,
        blobs: &mut BTreeMap<u32, Arc<[u8]>>,
    ) -> Result<EntryContents, Error> {
        let mut keys = Vec::new();
        self.store.each_key(entry, &mut |key, unit| keys.push((key.to_owned(), unit)))?;
        let mut contents = EntryContents::default();
        let mut hashes = BTreeMap::new();
        for (key, number) in keys {
            let hash = match hashes.get(&number) {
                Some(hash) => *hash,
                None => contents.add(self.unit_with(number, blobs)?)?,
            };
            hashes.insert(number, hash);
            contents.keys.insert(key, hash);
        }
        Ok(contents)
    }

    pub(super) fn unit(&self, number: u32) -> Result<Unit, Error> {
        self.unit_with(number, &mut BTreeMap::new())
    }

    /// A unit. Blobs that were read before are shared.
    fn unit_with(&self, number: u32, blobs: &mut BTreeMap<u32, Arc<[u8]>>) -> Result<Unit, Error> {
        let unit = self.store.unit(number)?;
        let targets = unit.targets.into_iter().map(|(target, found)| {
            let bytes = match blobs.get(&found.blob) {
                Some(bytes) => bytes.clone(),
                None => {
                    let bytes: Arc<[u8]> = self.store.blob(found.blob)?.into();
                    blobs.insert(found.blob, bytes.clone());
                    bytes
                }
            };
            Ok((target, Artifact { bytes, extension: found.extension, native: found.native }))
        });
        Ok(Unit { reflection: unit.reflection, targets: targets.collect::<Result<_, Error>>()? })
    }
}

impl<'a> Program<'a> {
    /// Its name.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// Its axes, in the manifest's order.
    pub fn axes(&self) -> &'a [Axis] {
        &self.program.axes
    }

    /// What all permutations in a language bind together, by group and binding: what an engine makes
    /// one pipeline layout of. Empty for a language that the program does not have.
    pub fn layout(&self, language: Language) -> &'a [LayoutBinding] {
        self.program.layouts.get(&language).map_or(&[], Vec::as_slice)
    }

    /// Its entry points, by language and name.
    pub fn entries(&self) -> impl Iterator<Item = (Language, &'a str)> {
        self.program.entries.keys().map(|(language, name)| (*language, name.as_str()))
    }

    /// An entry point written in one language.
    pub fn entry(&self, language: Language, name: &str) -> Result<Shader<'a>, Error> {
        let found = self.program.entries.get(&(language, name.to_owned()));
        let names = self.entries().filter(|(found, _)| *found == language).map(|(_, name)| name);
        let entry = *found.ok_or_else(|| not_found("entry point", name, names))?;
        Ok(Shader {
            store: self.store,
            program: self.name,
            recorder: self.recorder,
            axes: &self.program.axes,
            entry,
        })
    }

    /// An entry point, in whichever language has it. If both have it, this is the one in WESL.
    pub fn shader(&self, name: &str) -> Result<Shader<'a>, Error> {
        let language =
            self.entries().find(|(_, found)| *found == name).map(|(language, _)| language);
        let language = language
            .ok_or_else(|| not_found("entry point", name, self.entries().map(|(_, name)| name)))?;
        self.entry(language, name)
    }
}

impl Shader<'_> {
    /// The permutation of a key, for one target. Axes may be in any order, and defaults may be
    /// written out.
    ///
    /// # Errors
    /// [`Error::Miss`] names the nearest permutation that exists; [`Error::BadKey`] where the key
    /// names an axis or a value the program does not have; [`Error::NotFound`] for the target.
    pub fn get(&self, key: &str, target: Target) -> Result<Found, Error> {
        let unit = self.find(key)?;
        let (reflection, artifact) = self.store.artifact(unit, target.name())?;
        let constants = constants(self.axes, key, &reflection)?;
        Ok(Found {
            bytes: self.store.blob(artifact.blob)?,
            reflection,
            native: artifact.native,
            constants,
        })
    }

    /// The number of a key's unit: equal numbers are equal shaders, in every target.
    pub fn find(&self, key: &str) -> Result<u32, Error> {
        if let Some(unit) = self.store.find(self.entry, key)? {
            self.note(key);
            return Ok(unit);
        }
        let requested = key::canonical(self.axes, key)?;
        self.note(&requested);
        match self.store.find(self.entry, &requested)? {
            Some(unit) => Ok(unit),
            None => {
                Err(Error::Miss(Box::new(Miss { nearest: self.nearest(&requested)?, requested })))
            }
        }
    }

    /// Every key, sorted.
    pub fn keys(&self) -> Result<Vec<String>, Error> {
        let mut keys = Vec::new();
        self.store.each_key(self.entry, &mut |key, _| keys.push(key.to_owned()))?;
        Ok(keys)
    }

    /// Every key with the number of its unit.
    pub(super) fn numbered(&self) -> Result<Vec<(String, u32)>, Error> {
        let mut keys = Vec::new();
        self.store.each_key(self.entry, &mut |key, unit| keys.push((key.to_owned(), unit)))?;
        Ok(keys)
    }

    /// The reflection of a key's shader, without reading its bytes.
    pub fn reflection(&self, key: &str) -> Result<Arc<Reflection>, Error> {
        Ok(self.store.unit(self.find(key)?)?.reflection)
    }

    /// Names of the targets that a key was compiled for, sorted.
    pub fn targets(&self, key: &str) -> Result<Vec<String>, Error> {
        Ok(self.store.unit(self.find(key)?)?.targets.into_keys().collect())
    }

    fn note(&self, key: &str) {
        if let Some(recorder) = self.recorder {
            recorder.note(self.program, key);
        }
    }

    fn nearest(&self, requested: &str) -> Result<Option<String>, Error> {
        let mut best: Option<(usize, String)> = None;
        self.store.each_key(self.entry, &mut |known, _| {
            let distance = key::distance(requested, known);
            // Keys are sorted, so of several equally near ones the first stays.
            if best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, known.to_owned()));
            }
        })?;
        Ok(best.map(|(_, key)| key))
    }
}

/// The values that a key gives to axes that are overrides of the shader.
///
/// # Errors
/// [`Error::BadKey`] where the key names an axis or a value that does not exist.
pub fn constants(
    axes: &[Axis],
    key: &str,
    reflection: &Reflection,
) -> Result<Vec<Constant>, Error> {
    let open = axes.iter().filter(|axis| axis.mode == "spec").filter_map(|axis| {
        let mut overrides = reflection.overrides.iter();
        let found = overrides.find(|constant| constant.name.as_ref() == Some(&axis.name))?;
        Some((axis, found.ty.as_str()))
    });
    let open: Vec<_> = open.collect();
    if open.is_empty() {
        return Ok(Vec::new());
    }
    let key = key::canonical(axes, key)?;
    open.into_iter().map(|(axis, ty)| Constant::of_axis(axis, ty, key::value(&key, axis))).collect()
}

fn not_found<T: AsRef<str>>(
    what: &'static str,
    name: &str,
    known: impl Iterator<Item = T>,
) -> Error {
    Error::NotFound {
        what,
        name: name.to_owned(),
        known: known.map(|name| name.as_ref().to_owned()).collect(),
    }
}
