use std::cell::Cell;
use std::rc::Rc;

use lamplight_bundle::Language;
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{self as compose, Keep};
use lamplight_dap::{Adapter, Host, Launched, Refusal};
use lamplight_debug::{Call, Subject, SubjectText};
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Source, SourceSet};
use lamplight_eval::Resources;
use lamplight_permute::Settings;
use lamplight_validate::validate;
use serde_json::{Value, json};

/// A machine with one file, `/own.wesl`, whose function `f` is called with 1.
struct Desk {
    text: String,
    /// Whether a message waits that asks for a stop.
    is_interrupted: Rc<Cell<bool>>,
    /// How many messages went out, and after how many such a message comes in.
    sent: Rc<Cell<usize>>,
    patience: usize,
    /// Whether making a run fails in the middle.
    panics: bool,
}

impl Host for Desk {
    fn launch(&mut self, _: &Value) -> Result<Launched, Refusal> {
        assert!(!self.panics, "as asked");
        let mut sources = SourceSet::default();
        let packages = Packages::of_text("own.wesl", self.text.clone());
        let refusal = |errors: Diagnostics| Refusal {
            message: errors.first().map_or(String::new(), |error| error.message.clone()),
            output: String::new(),
        };
        let graph = resolve::load(&mut sources, &packages, "own.wesl", Language::Wesl);
        let graph = graph.map_err(refusal)?;
        let options = compose::Options { keep: Keep::All, ..compose::Options::default() };
        let composed = compose::compose(&graph, &Settings::default(), &options).unwrap();
        let validated = validate(&composed).unwrap();
        let text = SubjectText {
            module: &validated.module,
            text: &composed.text,
            map: &composed.map,
            sources: &sources,
        };
        let call = Call::Alone(vec![1.0]);
        let subject = Subject::new(text, "f", call, Resources::default()).unwrap();
        let imports = composed.map.imports.iter().copied().collect();
        Ok(Launched { subject, sources, imports, title: "f(1)".to_owned(), share: 0.01 })
    }

    fn path_of(&self, source: &Source) -> Option<String> {
        Some(format!("/{}", source.path))
    }

    fn is_same(&self, one: &str, other: &str) -> bool {
        assert_ne!(other, "/panic", "as asked");
        one == other
    }

    fn is_interrupted(&self) -> bool {
        self.is_interrupted.get() || self.sent.get() > self.patience
    }
}

/// An adapter with its machine.
struct Talk {
    adapter: Adapter,
    desk: Desk,
    sent: i64,
}

impl Talk {
    fn about(text: &str) -> Self {
        let desk = Desk {
            text: text.to_owned(),
            is_interrupted: Rc::default(),
            sent: Rc::default(),
            patience: usize::MAX,
            panics: false,
        };
        let mut talk = Self { adapter: Adapter::default(), desk, sent: 0 };
        talk.ask("initialize", json!({}));
        talk.ask("launch", json!({ "stopOnEntry": true }));
        talk
    }

    /// The answer and the events of a request.
    fn say(&mut self, command: &str, arguments: Value) -> Vec<Value> {
        self.sent += 1;
        let message = json!({
            "seq": self.sent, "type": "request", "command": command, "arguments": arguments,
        });
        let (mut said, count) = (Vec::new(), Rc::clone(&self.desk.sent));
        self.adapter.receive(&message, &mut self.desk, &mut |message| {
            count.set(count.get() + 1);
            said.push(message);
        });
        said
    }

    fn ask(&mut self, command: &str, arguments: Value) -> Value {
        let said = self.say(command, arguments);
        let answer = said.iter().find(|one| one["type"] == "response").unwrap();
        assert_eq!(answer["success"], true, "{answer}");
        answer["body"].clone()
    }

    /// Why a request is refused.
    fn refused(&mut self, command: &str, arguments: Value) -> String {
        let said = self.say(command, arguments);
        let answer = said.iter().find(|one| one["type"] == "response").unwrap();
        assert_eq!(answer["success"], false, "{answer}");
        answer["message"].as_str().unwrap().to_owned()
    }

    /// Why the run stopped after a motion, and the line.
    fn go(&mut self, command: &str) -> (String, u64) {
        let said = self.say(command, json!({ "threadId": 1 }));
        let stop = said.iter().find(|one| one["event"] == "stopped").unwrap();
        let reason = stop["body"]["reason"].as_str().unwrap().to_owned();
        (reason, self.line())
    }

    fn line(&mut self) -> u64 {
        let stack = self.ask("stackTrace", json!({ "threadId": 1 }));
        stack["stackFrames"][0]["line"].as_u64().unwrap()
    }

    fn value(&mut self, expression: &str) -> String {
        let found = self.ask("evaluate", json!({ "expression": expression }));
        found["result"].as_str().unwrap().to_owned()
    }

    fn breakpoint(&mut self, breakpoint: Value) -> Value {
        let source = json!({ "path": "/own.wesl" });
        let asked = json!({ "source": source, "breakpoints": [breakpoint] });
        self.ask("setBreakpoints", asked)["breakpoints"][0].clone()
    }
}

const LOOP: &str = "fn twice(x: f32) -> f32 {
    return 2.0 * x;
}

fn f(x: f32) -> f32 {
    var sum = x;
    for (var i = 0; i < 5; i++) {
        let before = sum;
        sum = twice(before) + f32(i);
    }
    return sum / (x - 1.0);
}
";

/// `sum` is 1, and after the turns 2, 5, 12, 27 and 58.
#[test]
fn forth_and_back() {
    let mut talk = Talk::about(LOOP);
    assert_eq!(talk.go("configurationDone"), ("entry".to_owned(), 6));
    assert_eq!(talk.go("next").1, 7);
    assert_eq!(talk.go("next").1, 8);
    assert_eq!(talk.go("next").1, 9);
    assert_eq!(talk.go("stepIn"), ("step".to_owned(), 2));
    assert_eq!(talk.value("x"), "1");
    // Out of the call, in the middle of the line that called.
    assert_eq!(talk.go("stepOut").1, 9);
    assert_eq!(talk.value("sum"), "1");
    // Over the call, and not into it.
    assert_eq!(talk.go("stepBack").1, 9);
    assert_eq!(talk.go("stepBack").1, 8);
    assert_eq!(talk.breakpoint(json!({ "line": 8, "condition": "sum > 10.0" }))["verified"], true);
    assert_eq!(talk.go("continue"), ("breakpoint".to_owned(), 8));
    assert_eq!(talk.value("vec2f(sum, f32(i))"), "(12, 3)");
    assert_eq!(talk.go("continue"), ("breakpoint".to_owned(), 8));
    assert_eq!(talk.value("twice(sum) + sum"), "81");
    assert_eq!(talk.go("reverseContinue"), ("breakpoint".to_owned(), 8));
    assert_eq!(talk.value("sum"), "12");
    talk.breakpoint(json!({ "line": 9, "hitCondition": "<= 2" }));
    assert_eq!(talk.go("reverseContinue"), ("breakpoint".to_owned(), 9));
    assert_eq!(talk.value("i"), "1");
    assert_eq!(talk.value("before"), "2");
    talk.breakpoint(json!({ "line": 1000 }));
    talk.ask("setExceptionBreakpoints", json!({ "filters": ["division-by-zero"] }));
    assert_eq!(talk.go("continue"), ("exception".to_owned(), 11));
    assert_eq!(talk.go("continue"), ("end".to_owned(), 11));
    assert_eq!(talk.go("reverseContinue"), ("exception".to_owned(), 11));
    assert_eq!(talk.go("reverseContinue"), ("entry".to_owned(), 6));
    assert_eq!(talk.go("restart"), ("entry".to_owned(), 6));
}

/// What a block declares is not seen outside of it, and before it is declared.
#[test]
fn only_what_is_in_scope() {
    let mut talk = Talk::about(LOOP);
    talk.go("configurationDone");
    let is_known = |talk: &mut Talk, name: &str| {
        talk.say("evaluate", json!({ "expression": name }))[0]["success"] == true
    };
    assert!(is_known(&mut talk, "x") && !is_known(&mut talk, "sum"));
    talk.breakpoint(json!({ "line": 8 }));
    talk.go("continue");
    assert!(is_known(&mut talk, "sum") && is_known(&mut talk, "i"));
    assert!(!is_known(&mut talk, "before"));
    talk.breakpoint(json!({ "line": 11 }));
    talk.go("continue");
    assert!(is_known(&mut talk, "sum") && !is_known(&mut talk, "i"));
    for wrong in ["", "sum +", "sum; return 1.0", "}", "sum // sum", "1u + 1.0", "sum.x"] {
        let said = talk.say("evaluate", json!({ "expression": wrong }));
        assert_eq!(said[0]["success"], false, "{wrong}");
        assert!(!said[0]["message"].as_str().unwrap().is_empty());
    }
    let deep = format!("{}1.0{}", "(".repeat(900), ")".repeat(900));
    assert_eq!(talk.say("evaluate", json!({ "expression": deep }))[0]["success"], false);
}

/// Values are trees, and of a long array the client gets the part that it asks for.
#[test]
fn trees() {
    let mut talk = Talk::about(
        "struct Pair { at: vec2f, m: mat2x2f }
fn f(x: f32) -> f32 {
    var pairs: array<Pair, 300>;
    pairs[257].at = vec2f(3.0, x);
    pairs[257].m[1] = vec2f(5.0, 7.0);
    return pairs[257].at.x;
}
",
    );
    talk.go("configurationDone");
    talk.go("next");
    talk.go("next");
    assert_eq!(talk.line(), 6);
    assert_eq!(talk.value("pairs[257].m[1].y"), "7");
    let row = talk.ask("evaluate", json!({ "expression": "pairs" }));
    assert_eq!(row["indexedVariables"], 300);
    let part = json!({
        "variablesReference": row["variablesReference"], "start": 257, "count": 2,
    });
    let rows = talk.ask("variables", part)["variables"].clone();
    assert_eq!((&rows[0]["name"], &rows[1]["name"]), (&json!("[257]"), &json!("[258]")));
    assert_eq!(rows[0]["evaluateName"], "pairs[257]");
    let inner =
        talk.ask("variables", json!({ "variablesReference": rows[0]["variablesReference"] }));
    assert_eq!(inner["variables"][0]["value"], "(3, 1)");
    assert_eq!(inner["variables"][1]["type"], "mat2x2<f32>");
    let of = inner["variables"][1]["variablesReference"].clone();
    let columns = talk.ask("variables", json!({ "variablesReference": of }));
    assert_eq!(columns["variables"][1]["value"], "(5, 7)");
    // What was shown before a step is gone.
    talk.go("stepBack");
    let said = talk.say("variables", json!({ "variablesReference": of }));
    assert_eq!(said[0]["success"], false);
}

const ENDLESS: &str = "fn f(x: f32) -> f32 {
    var sum = x;
    loop {
        sum += 1.0;
        if sum < 0.0 { break; }
    }
    return sum;
}
";

/// Endless loops end at the limit, with their line, and the run goes back from there.
#[test]
fn an_endless_loop_ends() {
    let mut talk = Talk::about(ENDLESS);
    talk.go("configurationDone");
    let (reason, line) = talk.go("continue");
    assert_eq!(reason, "exception");
    assert!((3..=5).contains(&line), "{line}");
    let info = talk.ask("exceptionInfo", json!({ "threadId": 1 }));
    assert!(info["description"].as_str().unwrap().contains("trips"), "{info}");
    talk.go("stepBack");
    assert_eq!(talk.go("stepBack").0, "step");
    let said = talk.say("continue", json!({ "threadId": 1 }));
    assert!(said.iter().any(|one| one["event"] == "stopped"));
    let said = talk.say("continue", json!({ "threadId": 1 }));
    assert!(said.iter().any(|one| one["event"] == "terminated"));
}

/// A restart reads the file again, and sets the breakpoints again. A file that cannot run leaves the
/// run as it is.
#[test]
fn restart_reads_the_file() {
    let mut talk = Talk::about(LOOP);
    talk.breakpoint(json!({ "line": 8 }));
    talk.go("configurationDone");
    assert_eq!(talk.go("continue"), ("breakpoint".to_owned(), 8));
    talk.desk.text =
        format!("// A new line.\n{}", LOOP.replace("var sum = x", "var sum = 7.0 * x"));
    assert_eq!(talk.go("restart"), ("entry".to_owned(), 7));
    // The client has not moved the breakpoint, so it is at the loop.
    assert_eq!(talk.go("continue"), ("breakpoint".to_owned(), 8));
    assert_eq!(talk.value("sum"), "7");
    talk.desk.text = "fn f(x: f32) {".to_owned();
    assert!(talk.refused("restart", json!({})).contains("never closed"));
    assert_eq!((talk.line(), talk.value("sum")), (8, "7".to_owned()));
    // What the client launches may have changed: no stop at the first statement.
    talk.desk.text = LOOP.to_owned();
    let said = talk.say("restart", json!({ "arguments": { "stopOnEntry": false } }));
    let stop = said.iter().find(|one| one["event"] == "stopped").unwrap();
    assert_eq!(stop["body"]["reason"], "breakpoint");
    assert_eq!(talk.value("sum"), "1");
}

/// Each request has an answer, also one in which the debugger fails. The numbers of messages go on.
#[test]
fn failures_are_answered() {
    let mut talk = Talk::about(LOOP);
    talk.desk.panics = true;
    let said = talk.say("launch", json!({}));
    assert!(said[0]["message"].as_str().unwrap().contains("failed at `launch`"), "{said:?}");
    assert_eq!((&said[0]["success"], &said[0]["request_seq"]), (&json!(false), &json!(3)));
    assert_eq!(said[1]["event"], "terminated");
    let numbers: Vec<i64> = said.iter().map(|one| one["seq"].as_i64().unwrap()).collect();
    assert_eq!(numbers, [4, 5]);
    talk.desk.panics = false;
    talk.ask("launch", json!({ "stopOnEntry": true }));
    assert_eq!(talk.go("configurationDone"), ("entry".to_owned(), 6));
    let words = talk.refused("source", json!({ "source": { "path": "/panic" } }));
    assert!(words.contains("failed at `source`"), "{words}");
    assert!(talk.refused("next", json!({})).contains("`launch` comes first"));
}

/// Numbers that fit nowhere are refused by their names.
#[test]
fn numbers_that_do_not_fit() {
    let mut talk = Talk::about(LOOP);
    talk.go("configurationDone");
    for (command, name) in [
        ("scopes", "frameId"),
        ("evaluate", "frameId"),
        ("variables", "variablesReference"),
        ("variables", "start"),
        ("variables", "count"),
        ("stackTrace", "startFrame"),
        ("stackTrace", "levels"),
        ("source", "sourceReference"),
        ("breakpointLocations", "line"),
    ] {
        for wrong in [json!(i64::MIN), json!(u64::MAX), json!(1_u64 << 32), json!(0.5), json!("1")]
        {
            let said = talk.refused(command, json!({ (name): wrong }));
            assert!(said.starts_with(&format!("`{name}` is {wrong}: ")), "{command}: {said}");
        }
    }
    // None of these is the number of something.
    for id in [0_u32, 99, u32::MAX] {
        assert!(talk.refused("scopes", json!({ "frameId": id })).contains("no such frame"));
        talk.refused("variables", json!({ "variablesReference": id }));
        talk.refused("source", json!({ "sourceReference": id }));
    }
    for wrong in [json!(-1), json!((1_u64 << 32) + 8), json!(0), json!(null)] {
        let answer = talk.breakpoint(json!({ "line": wrong }));
        assert_eq!(answer["verified"], false, "{wrong}");
        assert!(answer["message"].as_str().unwrap().contains("line"), "{answer}");
    }
    // Past the end of all lists, and of the text.
    let far = json!({ "startFrame": u32::MAX, "levels": u32::MAX });
    assert_eq!(talk.ask("stackTrace", far)["stackFrames"], json!([]));
    assert_eq!(talk.breakpoint(json!({ "line": u32::MAX }))["verified"], false);
}

/// What is no condition is said when the breakpoint is set, and what has no value once.
#[test]
fn wrong_conditions() {
    let long = "fn long(n: i32) -> i32 {
    var i = 0;
    while i < n {
        i += 1;
    }
    return i;
}
";
    let mut talk = Talk::about(&format!("{LOOP}{long}"));
    talk.go("configurationDone");
    for (condition, what) in
        [("sum", "f32"), ("i + 1", "i32"), ("vec2f(sum) > vec2f()", "vec2<bool>")]
    {
        let answer = talk.breakpoint(json!({ "line": 8, "condition": condition }));
        let words = answer["message"].as_str().unwrap();
        assert_eq!(answer["verified"], false);
        assert!(words.contains(&format!("no condition, but {what}")), "{words}");
    }
    talk.breakpoint(json!({ "line": 1000 }));
    assert_eq!(talk.go("continue").0, "end");
    // More turns than an expression may make, at each of the five hits.
    let answer = talk.breakpoint(json!({ "line": 8, "condition": "long(20000) > 0" }));
    assert_eq!(answer["verified"], true);
    let said = talk.say("reverseContinue", json!({ "threadId": 1 }));
    let outputs: Vec<&Value> = said.iter().filter(|one| one["event"] == "output").collect();
    assert_eq!(outputs.len(), 1, "{said:?}");
    let words = outputs[0]["body"]["output"].as_str().unwrap();
    assert!(words.starts_with("the condition in line 8 has no value: "), "{words}");
    let again = talk.say("reverseContinue", json!({ "threadId": 1 }));
    assert!(again.iter().all(|one| one["event"] != "output"), "{again:?}");
    assert_eq!(talk.value("i"), "3");
}

/// The request that interrupts a run is answered before the event that says so.
#[test]
fn a_pause_is_answered_first() {
    let mut talk = Talk::about(ENDLESS);
    talk.go("configurationDone");
    talk.desk.is_interrupted.set(true);
    let said = talk.say("continue", json!({ "threadId": 1 }));
    assert!(said.iter().all(|one| one["event"] != "stopped"), "{said:?}");
    // What came in between.
    talk.ask("threads", json!({}));
    talk.desk.is_interrupted.set(false);
    let said = talk.say("pause", json!({ "threadId": 1 }));
    assert_eq!((&said[0]["command"], &said[0]["success"]), (&json!("pause"), &json!(true)));
    assert_eq!(
        (&said[1]["event"], &said[1]["body"]["reason"]),
        (&json!("stopped"), &json!("pause"))
    );
    assert_eq!(said.len(), 2);
    assert_eq!(talk.go("next").0, "step");
    // Where the run has ended, nobody asks why it stopped.
    talk.desk.is_interrupted.set(true);
    talk.say("continue", json!({ "threadId": 1 }));
    talk.desk.is_interrupted.set(false);
    let said = talk.say("terminate", json!({}));
    assert_eq!(said[1]["event"], "terminated");
    assert_eq!(said.len(), 2);
    assert!(talk.refused("cancel", json!({ "requestId": 3 })).contains("`pause` stops a run"));
}

/// Messages of breakpoints go out while the run goes on: a pause after the third ends it.
#[test]
fn messages_as_they_occur() {
    let mut talk = Talk::about(ENDLESS);
    talk.go("configurationDone");
    talk.breakpoint(json!({ "line": 4, "logMessage": "sum is {sum}" }));
    talk.desk.patience = talk.desk.sent.get() + 3;
    let said = talk.say("continue", json!({ "threadId": 1 }));
    let logged: Vec<&Value> = said.iter().filter(|one| one["event"] == "output").collect();
    assert_eq!(logged[1]["body"]["output"], "sum is 2\n");
    // Somebody is asked each some thousand instructions; a turn has a few.
    assert!((3..3000).contains(&logged.len()), "{}", logged.len());
}
