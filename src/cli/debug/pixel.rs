//! A fragment of the picture that `render` draws with the same options.

use lamplight_debug::{Call, Subject, SubjectText};

use super::{Arguments, Ready};
use crate::cli::failure::{DiagnosticForm, Failure};
use crate::cli::render::{self, ReadyFragments};

/// Calls `then` with the visible fragment of a pixel, ready to run.
pub fn with_pixel(
    arguments: &Arguments,
    pixel: [u32; 2],
    form: DiagnosticForm,
    then: Ready<'_>,
) -> Result<(), Failure> {
    let ReadyFragments { fragments, sources } =
        render::fragments_at(&arguments.render, pixel, form)?;
    let Some(first) = fragments.into_iter().next() else {
        let [x, y] = pixel;
        return Err(Failure::input(format!(
            "nothing covers the pixel {x},{y}: no fragment runs there"
        )));
    };
    let text = SubjectText {
        module: &first.stage.written.module,
        text: &first.stage.text,
        map: &first.stage.map,
        sources: &sources,
    };
    let fragment = first.fragment;
    let call = Call::Quad(fragment.arguments, fragment.lane);
    match Subject::new(text, first.stage.entry, call, fragment.resources) {
        Ok(subject) => then(text, subject),
        Err(error) => Err(Failure::Input(sources.clone(), vec![error])),
    }
}
