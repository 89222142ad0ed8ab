//! The table of requests, and those that are about the session as a whole.

use lamplight_debug::Mark;
use serde_json::{Value, json};

use crate::answer::{Failed, Turn};
use crate::motion::Motion;
use crate::numbers::Counting;
use crate::session::Session;

/// A request that is known.
pub(crate) struct Request {
    pub name: &'static str,
    pub run: fn(&mut Session, &mut Turn<'_>) -> Result<Value, Failed>,
}

/// All requests by name.
const REQUESTS: [Request; 27] = [
    Request { name: "initialize", run: initialize },
    Request { name: "launch", run: launch },
    Request { name: "attach", run: attach },
    Request { name: "setBreakpoints", run: |session, turn| session.set_breakpoints(turn) },
    Request { name: "setFunctionBreakpoints", run: no_breakpoints },
    Request { name: "setExceptionBreakpoints", run: |session, turn| session.set_marks(turn) },
    Request {
        name: "breakpointLocations",
        run: |session, turn| session.breakpoint_locations(turn),
    },
    Request { name: "configurationDone", run: configuration_done },
    Request { name: "threads", run: |session, _| session.threads() },
    Request { name: "stackTrace", run: |session, turn| session.stack_trace(turn) },
    Request { name: "scopes", run: |session, turn| session.scopes(turn) },
    Request { name: "variables", run: |session, turn| session.variables(turn) },
    Request { name: "evaluate", run: |session, turn| session.evaluate(turn) },
    Request { name: "exceptionInfo", run: |session, _| session.exception_info() },
    Request { name: "source", run: |session, turn| session.source(turn) },
    Request { name: "loadedSources", run: |session, turn| session.loaded_sources(turn) },
    Request { name: "continue", run: |session, _| session.begin(Motion::Continue) },
    Request { name: "next", run: |session, _| session.begin(Motion::Next) },
    Request { name: "stepIn", run: |session, _| session.begin(Motion::In) },
    Request { name: "stepOut", run: |session, _| session.begin(Motion::Out) },
    Request { name: "stepBack", run: |session, _| session.begin(Motion::Back) },
    Request { name: "reverseContinue", run: |session, _| session.begin(Motion::ContinueBack) },
    Request { name: "restart", run: |session, turn| session.restart(turn) },
    // A run that was interrupted has stopped by now.
    Request { name: "pause", run: |session, _| session.running().map(|_| Value::Null) },
    Request { name: "terminate", run: terminate },
    Request { name: "disconnect", run: disconnect },
    Request { name: "cancel", run: cancel },
];

/// The request of a name.
pub(crate) fn find(name: &str) -> Option<&'static Request> {
    REQUESTS.iter().find(|request| request.name == name)
}

fn initialize(session: &mut Session, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    let starts_at_1 = |name: &str| turn.arguments.get(name).and_then(Value::as_bool);
    session.counting = Counting {
        line: u32::from(starts_at_1("linesStartAt1").unwrap_or(true)),
        column: u32::from(starts_at_1("columnsStartAt1").unwrap_or(true)),
    };
    let filter = |(name, label): (&str, &str)| json!({ "filter": name, "label": label });
    let marks: Vec<Value> = Mark::KINDS.into_iter().map(filter).collect();
    Ok(json!({
        "supportsConfigurationDoneRequest": true,
        "supportsConditionalBreakpoints": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsLogPoints": true,
        "supportsBreakpointLocationsRequest": true,
        "supportsEvaluateForHovers": true,
        "supportsExceptionInfoRequest": true,
        "supportsLoadedSourcesRequest": true,
        "supportsRestartRequest": true,
        "supportsStepBack": true,
        "supportsTerminateRequest": true,
        "exceptionBreakpointFilters": marks,
    }))
}

fn launch(session: &mut Session, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    session.launch(turn.arguments, turn)?;
    turn.event("initialized", Value::Null);
    Ok(Value::Null)
}

fn attach(_: &mut Session, _: &mut Turn<'_>) -> Result<Value, Failed> {
    Err("a shader does not run anywhere to be attached to: use `launch`".to_owned())
}

fn no_breakpoints(_: &mut Session, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    let asked = turn.arguments.get("breakpoints").and_then(Value::as_array);
    let none = json!({ "verified": false, "message": "breakpoints are set on lines" });
    Ok(json!({ "breakpoints": vec![none; asked.map_or(0, Vec::len)] }))
}

fn configuration_done(session: &mut Session, _: &mut Turn<'_>) -> Result<Value, Failed> {
    session.set_off()
}

fn terminate(session: &mut Session, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    session.end();
    turn.event("terminated", Value::Null);
    Ok(Value::Null)
}

fn disconnect(session: &mut Session, _: &mut Turn<'_>) -> Result<Value, Failed> {
    session.end();
    session.is_ended = true;
    Ok(Value::Null)
}

/// A request is answered before its run goes on, so none waits that could be cancelled.
fn cancel(_: &mut Session, _: &mut Turn<'_>) -> Result<Value, Failed> {
    Err("no request waits that could be cancelled: `pause` stops a run".to_owned())
}
