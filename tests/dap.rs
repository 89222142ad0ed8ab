//! The debug adapter: a process that npm's client of the protocol talks to, and one that gets what is
//! no conversation.

use std::collections::BTreeSet;
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use lamplight::lsp::wire::{self, Incoming};
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use crate::npm;

type Outcome = Result<(), Failed>;

const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("dap::session", session),
        Trial::test("dap::no_conversation", no_conversation),
        Trial::test("dap::a_long_run_is_paused", long_run),
        Trial::test("dap::a_call", call),
        Trial::test("dap::a_restart_reads_the_file", restart),
        Trial::test("dap::options_of_a_launch", options),
        Trial::test("dap::picture", picture),
    ]
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/dap")
}

/// Everything that is said in a session over a file in WESL with an import and over one in GLSL, with
/// steps back over a call and over the turns of a loop.
fn session() -> Outcome {
    let output = Command::new("node")
        .arg(folder().join("session.cjs"))
        .arg(LAMPLIGHT)
        .arg(folder())
        .env("NODE_PATH", npm::installed(&folder(), "dap")?)
        .output()
        .map_err(|error| format!("node: {error}; install it with: apt-get install nodejs"))?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    if !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("{said}\n{errors}").into());
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots/dap");
    insta::with_settings!({
        snapshot_path => root, prepend_module_to_snapshot => false, omit_expression => true,
    }, {
        insta::assert_snapshot!("session", said);
    });
    Ok(())
}

/// A process that is talked to message by message.
struct Adapter {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    sent: i64,
}

impl Adapter {
    fn start() -> Result<Self, Failed> {
        let mut child = Command::new(LAMPLIGHT)
            .arg("dap")
            .current_dir(folder())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let to = child.stdin.take().ok_or("no input")?;
        let from = BufReader::new(child.stdout.take().ok_or("no output")?);
        Ok(Self { child, to, from, sent: 0 })
    }

    fn send(&mut self, command: &str, arguments: Value) -> Outcome {
        self.sent += 1;
        let message = json!({
            "seq": self.sent, "type": "request", "command": command, "arguments": arguments,
        });
        Ok(wire::write_message(&mut self.to, &message)?)
    }

    fn receive(&mut self) -> Result<Value, Failed> {
        match wire::read_message(&mut self.from)? {
            Incoming::Message(message) => Ok(message),
            other => Err(format!("expected a message, found {other:?}").into()),
        }
    }

    /// The next message that is an event of this name or the answer to this request.
    fn until(&mut self, name: &str) -> Result<Value, Failed> {
        loop {
            let found = self.receive()?;
            if found["event"] == name || found["command"] == name {
                return Ok(found);
            }
        }
    }

    fn ask(&mut self, command: &str, arguments: Value) -> Result<Value, Failed> {
        self.send(command, arguments)?;
        let found = self.until(command)?;
        match found["success"] == true {
            true => Ok(found["body"].clone()),
            false => Err(format!("{command}: {found:#}").into()),
        }
    }

    fn close(mut self) -> Outcome {
        self.ask("disconnect", json!({}))?;
        let status = self.child.wait()?;
        if status.success() { Ok(()) } else { Err(format!("it ended with {status}").into()) }
    }
}

/// Bytes that are no message, messages without a command, and requests without arguments are
/// answered, and the conversation goes on.
fn no_conversation() -> Outcome {
    let mut adapter = Adapter::start()?;
    adapter.to.write_all(b"Content-Length: 5\r\n\r\n{\"se}")?;
    let said = adapter.until("output")?;
    let text = said["body"]["output"].as_str().unwrap_or_default();
    if !text.contains("no message") {
        return Err(format!("unexpected: {said}").into());
    }
    adapter.to.write_all(b"Content-Length: many\r\n\r\n")?;
    adapter.until("output")?;
    for wrong in [json!([1]), json!({ "seq": "one", "type": "request" }), json!("text")] {
        wire::write_message(&mut adapter.to, &wrong)?;
        let said = adapter.receive()?;
        if said["success"] != false {
            return Err(format!("{wrong} was answered by {said}").into());
        }
    }
    let asked = [
        "launch",
        "setBreakpoints",
        "stackTrace",
        "scopes",
        "variables",
        "evaluate",
        "stepBack",
        "source",
        "reverseContinue",
        "completions",
    ];
    for command in asked {
        adapter.send(command, Value::Null)?;
        let said = adapter.until(command)?;
        let message = said["message"].as_str().unwrap_or_default();
        if command != "setBreakpoints" && message.is_empty() {
            return Err(format!("{command} was answered by {said}").into());
        }
    }
    adapter.ask("initialize", json!({}))?;
    adapter.close()
}

/// A loop of nearly a million turns can be paused, and the run goes back from there.
fn long_run() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let file = scratch.path().join("long.wesl");
    std::fs::write(
        &file,
        "@fragment\nfn fs_main(@location(0) uv: vec2f) -> @location(0) vec4f {\n    \
         var sum = 0.0;\n    for (var i = 0; i < 900000; i++) {\n        sum += uv.x;\n    }\n    \
         return vec4f(sum);\n}\n",
    )?;
    let mut adapter = Adapter::start()?;
    adapter.ask("initialize", json!({}))?;
    adapter.ask(
        "launch",
        json!({ "program": file, "pixel": [32, 32], "size": "64x64", "stopOnEntry": true }),
    )?;
    adapter.ask("configurationDone", json!({}))?;
    adapter.until("stopped")?;
    adapter.ask("continue", json!({ "threadId": 1 }))?;
    std::thread::sleep(Duration::from_millis(50));
    adapter.send("pause", json!({ "threadId": 1 }))?;
    // The answer comes before the event.
    let (answer, said) = (adapter.receive()?, adapter.receive()?);
    if answer["command"] != "pause" || said["body"]["reason"] != "pause" {
        return Err(format!("it stopped otherwise: {answer} {said}").into());
    }
    adapter.ask("next", json!({ "threadId": 1 }))?;
    adapter.until("stopped")?;
    let turn = |adapter: &mut Adapter| -> Result<i64, Failed> {
        let found = adapter.ask("evaluate", json!({ "expression": "i" }))?;
        Ok(found["result"].as_str().unwrap_or_default().parse()?)
    };
    let before = turn(&mut adapter)?;
    for _ in 0..30 {
        adapter.ask("stepBack", json!({ "threadId": 1 }))?;
        adapter.until("stopped")?;
    }
    // Three statements make a turn.
    let after = turn(&mut adapter)?;
    if before - after != 10 || before < 100 {
        return Err(format!("30 steps back led from turn {before} to turn {after}").into());
    }
    adapter.close()
}

/// A call of a function of the library, whose text the client has from the adapter.
fn call() -> Outcome {
    let mut adapter = Adapter::start()?;
    adapter.ask("initialize", json!({}))?;
    let program = "lighting::spot::cone_smooth(0.9, 30.0, 20.0)";
    adapter.ask("launch", json!({ "program": program }))?;
    adapter.ask("setExceptionBreakpoints", json!({ "filters": ["out-of-range"] }))?;
    adapter.ask("configurationDone", json!({}))?;
    let said = adapter.until("stopped")?;
    let text = said["body"]["text"].as_str().unwrap_or_default();
    if said["body"]["reason"] != "exception" || !text.contains("`inner` is 30") {
        return Err(format!("it stopped otherwise: {said}").into());
    }
    let stack = adapter.ask("stackTrace", json!({ "threadId": 1 }))?;
    let top = &stack["stackFrames"][0];
    let reference = top["source"]["sourceReference"].as_i64().ok_or("no reference")?;
    let source = adapter.ask("source", json!({ "sourceReference": reference }))?;
    let line = top["line"].as_u64().unwrap_or(1) as usize;
    let shown = source["content"].as_str().and_then(|text| text.lines().nth(line - 1));
    if !shown.is_some_and(|shown| shown.starts_with("fn cone_smooth(")) {
        return Err(format!("{top} is {shown:?}").into());
    }
    adapter.close()
}

/// A restart runs the file as it is then, from the folder that the launch names, which begins at that
/// of the adapter each time.
fn restart() -> Outcome {
    let scratch = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR"))?;
    let file = scratch.path().join("own.wesl");
    let write = |value: &str| {
        let text = format!(
            "@fragment\nfn fs_main(@location(0) uv: vec2f) -> @location(0) vec4f {{\n    \
             let level = {value};\n    return vec4f(level * uv.x);\n}}\n"
        );
        std::fs::write(&file, text)
    };
    write("0.5")?;
    let mut adapter = Adapter::start()?;
    adapter.ask("initialize", json!({}))?;
    let up = folder().components().map(|_| "..").skip(1).collect::<PathBuf>();
    let cwd = up.join(scratch.path().strip_prefix("/").unwrap_or(scratch.path()));
    adapter.ask(
        "launch",
        json!({ "program": "own.wesl", "pixel": [32, 32], "size": "64x64", "cwd": cwd }),
    )?;
    let here = json!({ "source": { "path": file }, "breakpoints": [{ "line": 4 }] });
    adapter.ask("setBreakpoints", here)?;
    adapter.ask("configurationDone", json!({}))?;
    let level = |adapter: &mut Adapter| -> Result<String, Failed> {
        adapter.until("stopped")?;
        let found = adapter.ask("evaluate", json!({ "expression": "level" }))?;
        Ok(found["result"].as_str().unwrap_or_default().to_owned())
    };
    let before = level(&mut adapter)?;
    write("0.25")?;
    adapter.ask("restart", json!({}))?;
    let after = level(&mut adapter)?;
    if (before.as_str(), after.as_str()) != ("0.5", "0.25") {
        return Err(format!("it was {before} and is {after}").into());
    }
    adapter.close()
}

/// The extension for Visual Studio Code describes each option of `lamplight debug` that a launch has,
/// and no other one.
fn options() -> Outcome {
    let output = Command::new(LAMPLIGHT).args(["debug", "--help"]).output()?;
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    let long = |line: &str| {
        let line = line.trim_start();
        let line = line.strip_prefix(|first| first == '-').filter(|_| line.starts_with('-'))?;
        let name = line.find("--").map_or(line, |at| &line[at + 1..]).strip_prefix('-')?;
        Some(name.split([' ', ',', '[']).next().unwrap_or_default().to_owned())
    };
    let mut options: BTreeSet<String> = help.lines().filter_map(long).collect();
    // Those of a printed run and of the text that is made; `program` is the file in a launch.
    let others = ["json", "why", "turns", "executor", "diagnostics", "color", "help"];
    for name in { others }.into_iter().chain(["keep-all", "mangle"]) {
        if !options.remove(name) {
            return Err(format!("`lamplight debug` has no `--{name}`: {options:?}").into());
        }
    }
    options.extend(["program", "stopOnEntry", "cwd", "args"].map(str::to_owned));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("editors/vscode/package.json");
    let package: Value = serde_json::from_slice(&std::fs::read(file)?)?;
    let debugger = &package["contributes"]["debuggers"][0];
    let described = debugger["configurationAttributes"]["launch"]["properties"].as_object();
    let described: BTreeSet<String> =
        described.into_iter().flatten().map(|(name, _)| name.clone()).collect();
    if described != options {
        let differ: Vec<_> = described.symmetric_difference(&options).collect();
        return Err(format!("the extension and `lamplight debug` differ in {differ:?}").into());
    }
    let activates = package["activationEvents"].as_array().into_iter().flatten();
    match { activates }.any(|event| *event == "onDebugResolve:lamplight") {
        true => Ok(()),
        false => Err("a session does not start the extension".into()),
    }
}

/// The panel of the extension for Visual Studio Code draws a file with the options of its launch, and
/// a click starts a session for the pixel.
fn picture() -> Outcome {
    let output = Command::new("node")
        .arg(folder().join("picture.cjs"))
        .arg(LAMPLIGHT)
        .arg(folder())
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("editors/vscode"))
        .output()
        .map_err(|error| format!("node: {error}; install it with: apt-get install nodejs"))?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let did: Value =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("{error}: {errors}"))?;
    let expected = json!({
        "type": "lamplight", "request": "launch", "name": "main.wesl", "stopOnEntry": true,
        "program": folder().join("main.wesl"), "size": [64, 48], "uniform": { "power": 2 },
        "cwd": folder().join(".."), "root": "dap", "pixel": [2, 47],
    });
    let arguments = [
        "render",
        "a.frag",
        "--out",
        "a.png",
        "--force",
        "--samples",
        "1",
        "--size=512x512",
        "--camera=0,1,2",
        "--uniform=tint=1,0,0.5",
        "--texture=image=checker",
        "--entry=vs",
        "--entry=fs",
        "--time=0.5",
        "--constant=N=4u",
        "--define=A=1",
        "--define=B=2",
        "--cascades=2",
    ];
    // Width and height as the picture's own head has them.
    let size = format!("{:08x}{:08x}", 64, 48);
    let is_right = did["launch"] == expected
        && did["pixels"] == json!([[2, 47], [63, 47]])
        && did["size"] == size.as_str()
        && did["arguments"] == json!(arguments)
        && did["page"] == true;
    let said = did["errors"][0].as_str().unwrap_or_default();
    match is_right && said.contains("`{` is never closed") {
        true => Ok(()),
        false => Err(format!("{did:#}").into()),
    }
}
