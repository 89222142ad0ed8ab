//! The table of requests, and those that are about the session as a whole.

use lamplight_debug::Mark;
use serde_json::{Value, json};

use crate::answer::{Adapter, Failed, Turn};
use crate::motion::Motion;

/// A request that is known.
pub(crate) struct Request {
    name: &'static str,
    pub run: fn(&mut Adapter, &mut Turn<'_>) -> Result<Value, Failed>,
}

/// All requests by name.
const REQUESTS: [Request; 27] = [
    Request { name: "initialize", run: initialize },
    Request { name: "launch", run: launch },
    Request { name: "attach", run: attach },
    Request { name: "setBreakpoints", run: |adapter, turn| adapter.session.set_breakpoints(turn) },
    Request { name: "setFunctionBreakpoints", run: no_breakpoints },
    Request {
        name: "setExceptionBreakpoints",
        run: |adapter, turn| adapter.session.set_marks(turn),
    },
    Request {
        name: "breakpointLocations",
        run: |adapter, turn| adapter.session.breakpoint_locations(turn),
    },
    Request { name: "configurationDone", run: configuration_done },
    Request { name: "threads", run: |adapter, _| adapter.session.threads() },
    Request { name: "stackTrace", run: |adapter, turn| adapter.session.stack_trace(turn) },
    Request { name: "scopes", run: |adapter, turn| adapter.session.scopes(turn) },
    Request { name: "variables", run: |adapter, turn| adapter.session.variables(turn) },
    Request { name: "evaluate", run: |adapter, turn| adapter.session.evaluate(turn) },
    Request { name: "exceptionInfo", run: |adapter, _| adapter.session.exception_info() },
    Request { name: "source", run: |adapter, turn| adapter.session.source(turn) },
    Request { name: "loadedSources", run: |adapter, turn| adapter.session.loaded_sources(turn) },
    Request { name: "continue", run: |adapter, _| adapter.session.begin(Motion::Continue) },
    Request { name: "next", run: |adapter, _| adapter.session.begin(Motion::Next) },
    Request { name: "stepIn", run: |adapter, _| adapter.session.begin(Motion::In) },
    Request { name: "stepOut", run: |adapter, _| adapter.session.begin(Motion::Out) },
    Request { name: "stepBack", run: |adapter, _| adapter.session.begin(Motion::Back) },
    Request {
        name: "reverseContinue",
        run: |adapter, _| adapter.session.begin(Motion::ContinueBack),
    },
    Request { name: "restart", run: |adapter, _| adapter.session.begin(Motion::Restart) },
    Request { name: "pause", run: |adapter, _| adapter.session.running().map(|_| Value::Null) },
    Request { name: "terminate", run: terminate },
    Request { name: "disconnect", run: disconnect },
    Request { name: "cancel", run: |_, _| Ok(Value::Null) },
];

/// The request of a name.
pub(crate) fn find(name: &str) -> Option<&'static Request> {
    REQUESTS.iter().find(|request| request.name == name)
}

fn initialize(adapter: &mut Adapter, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    let starts_at_1 = |name: &str| turn.arguments.get(name).and_then(Value::as_bool);
    adapter.session.first_line = u32::from(starts_at_1("linesStartAt1").unwrap_or(true));
    adapter.session.first_column = u32::from(starts_at_1("columnsStartAt1").unwrap_or(true));
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
        "supportsCancelRequest": true,
        "exceptionBreakpointFilters": marks,
    }))
}

fn launch(adapter: &mut Adapter, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    let launched = match turn.host.launch(turn.arguments) {
        Ok(launched) => launched,
        Err(refusal) => {
            let output = json!({ "category": "stderr", "output": refusal.output });
            turn.before.push(("output", output));
            return Err(refusal.message);
        }
    };
    adapter.session.start(launched, turn)?;
    turn.event("initialized", Value::Null);
    Ok(Value::Null)
}

fn attach(_: &mut Adapter, _: &mut Turn<'_>) -> Result<Value, Failed> {
    Err("a shader does not run anywhere to be attached to: use `launch`".to_owned())
}

fn no_breakpoints(_: &mut Adapter, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    let asked = turn.arguments.get("breakpoints").and_then(Value::as_array);
    let none = json!({ "verified": false, "message": "breakpoints are set on lines" });
    Ok(json!({ "breakpoints": vec![none; asked.map_or(0, Vec::len)] }))
}

fn configuration_done(adapter: &mut Adapter, _: &mut Turn<'_>) -> Result<Value, Failed> {
    let stops = adapter.session.stops_on_entry;
    adapter.session.begin(if stops { Motion::Entry } else { Motion::Continue })?;
    Ok(Value::Null)
}

fn terminate(adapter: &mut Adapter, turn: &mut Turn<'_>) -> Result<Value, Failed> {
    adapter.session.end();
    turn.event("terminated", Value::Null);
    Ok(Value::Null)
}

fn disconnect(adapter: &mut Adapter, _: &mut Turn<'_>) -> Result<Value, Failed> {
    adapter.session.end();
    adapter.is_ended = true;
    Ok(Value::Null)
}
