//! A call of a function of the library or of the user's own package.

use std::sync::{Mutex, PoisonError};

use lamplight_debug::{Call, Subject, SubjectText};

use super::{Arguments, Ready};
use crate::check::expression::compose_expression;
use crate::cli::failure::Failure;
use crate::cli::own::OwnPackage;
use crate::eval::Resources;
use crate::source::SourceSet;

/// Calls `then` with the call, ready to run.
pub fn with_call(arguments: &Arguments, text: &str, then: Ready<'_>) -> Result<(), Failure> {
    let library = OwnPackage::at(arguments.render.root()).library()?;
    let sources = Mutex::new(SourceSet::default());
    let composed = compose_expression(&library, &sources, text.trim());
    let sources = sources.into_inner().unwrap_or_else(PoisonError::into_inner);
    let found = match composed {
        Ok(found) => found,
        Err(errors) => return Err(Failure::Input(sources, errors)),
    };
    let text = SubjectText {
        module: &found.validated.module,
        text: &found.composed.text,
        map: &found.composed.map,
        sources: &sources,
    };
    let subject = Subject::new(text, found.function, Call::Alone(Vec::new()), Resources::default());
    match subject {
        Ok(subject) => then(text, subject),
        Err(error) => Err(Failure::Input(sources.clone(), vec![error])),
    }
}
