//! Prints a run.

use std::io::Write as _;

use lamplight_debug::{Options, Subject, SubjectText, Table, diagnosed, event_json, record};
use serde_json::json;

use super::Arguments;
use crate::cli::failure::Failure;
use crate::cli::terminal::stdout;

/// Prints a run as a table, or as a line of JSON for each event. A run that does not end is an error
/// after that.
pub fn report_run(
    arguments: &Arguments,
    text: SubjectText<'_>,
    subject: &Subject,
) -> Result<(), Failure> {
    if let Some(asked) = &arguments.why {
        return super::why::report_why(arguments, asked, text, subject);
    }
    let options = Options { share: arguments.lost_share(), turns: arguments.turns };
    let mut out = stdout();
    let mut written = Ok(());
    let mut write = |line: String| {
        if written.is_ok() && !line.is_empty() {
            written = out.write_all(line.as_bytes());
        }
    };
    let mut table = Table::new(subject, text.sources, options);
    let is_json = arguments.render.is_json();
    let ended = record(subject, options, &mut |event| match is_json {
        true if !event.is_shown(options) => {}
        true => write(format!("{}\n", event_json(subject, text.sources, &event))),
        false => write(table.rows(&event)),
    });
    if let Ok(ended) = &ended {
        let discarded = if ended.is_discarded { "\nThe fragment is discarded.\n" } else { "" };
        match is_json {
            true => {
                write(format!("{}\n", json!({ "event": "end", "discarded": ended.is_discarded })))
            }
            false => write(discarded.to_owned()),
        }
    }
    if !is_json {
        write(table.summary());
    }
    written?;
    match ended {
        Ok(_) => Ok(()),
        Err(error) => Err(Failure::Input(text.sources.clone(), vec![diagnosed(&error, text.map)])),
    }
}
