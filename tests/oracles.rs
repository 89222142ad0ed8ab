//! Functions compared with what their formulas stand for, where this is no property of single values
//! that a case file could hold: a sum without end, a whole march, random distributions of depths.

mod depths;
mod film;
mod march;

use std::collections::BTreeMap;
use std::sync::Mutex;

use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::check::library::Library;
use lamplight::execute::kernel::Kernel;
use lamplight::execute::{Session, executors, kernel, on_thread};
use lamplight::source::SourceSet;
use lamplight_testing::joined_messages;
use libtest_mimic::{Failed, Trial};

/// A property of functions that are called in one language.
type Property = fn(&mut Calls<'_>) -> Result<(), String>;

const PROPERTIES: &[(&str, Property)] = &[
    ("film_orders_sum_up_to_airy", film::orders_sum_up),
    ("film_two_orders", film::two_orders),
    ("march_in_small_steps", march::small_steps),
    ("march_from_sphere_to_sphere", march::large_steps),
    ("moments_bound_the_shadow", depths::bound_the_shadow),
    ("moments_of_three_depths", depths::three_depths),
];

pub fn tests() -> Vec<Trial> {
    let test = |(name, property): &(&str, Property)| {
        let property = *property;
        Trial::test(format!("oracles::{name}"), move || in_both_languages(property))
    };
    PROPERTIES.iter().map(test).collect()
}

/// The evaluator and a language.
struct Calls<'a> {
    session: &'a mut dyn Session,
    language: Language,
}

fn in_both_languages(property: Property) -> Result<(), Failed> {
    let outcome = on_thread(|| {
        let entry = executors::ALL.iter().find(|entry| entry.name == "eval").ok_or("no `eval`")?;
        let mut session = entry.start()?;
        for language in [Language::Wesl, Language::Glsl] {
            let mut calls = Calls { session: session.as_mut(), language };
            property(&mut calls).map_err(|error| format!("{language:?}: {error}"))?;
        }
        Ok(())
    });
    outcome.ok_or("panicked")?.map_err(|error: String| Failed::from(error))
}

impl Calls<'_> {
    /// A function of the library.
    fn kernel(&self, module: &str, function: &str) -> Result<Kernel, String> {
        let sources = Mutex::new(SourceSet::default());
        let library = Library::shipped(LIBRARY_FILES);
        let naga = library.module(&sources, module, self.language, &[function.to_owned()]);
        let naga = naga.map_err(|errors| joined_messages(&errors))?;
        kernel::build_kernel(&naga, function, &BTreeMap::new())
            .map_err(|error| joined_messages(&[error]))
    }

    /// The results for rows of f32 arguments, one after another.
    fn run(&mut self, kernel: &Kernel, rows: &[Vec<f64>]) -> Result<Vec<f64>, String> {
        let words: Vec<u32> =
            rows.iter().flatten().map(|value| (*value as f32).to_bits()).collect();
        let results =
            self.session.run(kernel, &words).map_err(|error| joined_messages(&[error]))?;
        Ok(results.into_iter().map(|word| f64::from(f32::from_bits(word))).collect())
    }
}
