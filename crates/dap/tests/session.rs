use lamplight_bundle::Language;
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{self as compose, Keep};
use lamplight_dap::{Adapter, Host, Launched, Refusal};
use lamplight_debug::{Call, Subject, SubjectText};
use lamplight_diagnostic::source::{Source, SourceSet};
use lamplight_eval::Resources;
use lamplight_permute::Settings;
use lamplight_validate::validate;
use serde_json::{Value, json};

/// A machine with one file, `/own.wesl`, whose function `f` is called with 1.
struct Desk {
    text: &'static str,
}

impl Host for Desk {
    fn launch(&mut self, _: &Value) -> Result<Launched, Refusal> {
        let mut sources = SourceSet::default();
        let packages = Packages::of_text("own.wesl", self.text.to_owned());
        let graph = resolve::load(&mut sources, &packages, "own.wesl", Language::Wesl).unwrap();
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
        Ok(Launched { subject, sources, title: "f(1)".to_owned(), share: 0.01 })
    }

    fn path_of(&self, source: &Source) -> Option<String> {
        Some(format!("/{}", source.path))
    }

    fn is_same(&self, one: &str, other: &str) -> bool {
        one == other
    }

    fn is_interrupted(&self) -> bool {
        false
    }
}

/// An adapter with its machine.
struct Talk {
    adapter: Adapter,
    desk: Desk,
    sent: i64,
}

impl Talk {
    fn about(text: &'static str) -> Self {
        let mut talk = Self { adapter: Adapter::default(), desk: Desk { text }, sent: 0 };
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
        let mut said = Vec::new();
        self.adapter.receive(&message, &mut self.desk, &mut |message| said.push(message));
        said
    }

    fn ask(&mut self, command: &str, arguments: Value) -> Value {
        let said = self.say(command, arguments);
        let answer = said.iter().find(|one| one["type"] == "response").unwrap();
        assert_eq!(answer["success"], true, "{answer}");
        answer["body"].clone()
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

/// Endless loops end at the limit, with their line, and the run goes back from there.
#[test]
fn an_endless_loop_ends() {
    let mut talk = Talk::about(
        "fn f(x: f32) -> f32 {
    var sum = x;
    loop {
        sum += 1.0;
        if sum < 0.0 { break; }
    }
    return sum;
}
",
    );
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
