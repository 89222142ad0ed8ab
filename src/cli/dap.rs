//! `lamplight dap`: a debug adapter on standard input and output.

use std::io::{BufReader, stdin};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use clap::{Args, FromArgMatches};
use serde_json::Value;

use super::debug;
use super::failure::{DiagnosticForm, Failure};
use super::terminal;
use crate::dap::{Adapter, Host, Launched, Refusal};
use crate::diagnostic::render::{Form, render};
use crate::diagnostic::stopped_message;
use crate::execute::on_thread;
use crate::lsp::wire::{self, Incoming};
use crate::source::Source;

/// Run a debug adapter on standard input and output, for editors.
///
/// It steps forth and back through what `lamplight debug` shows.
#[derive(Args)]
pub struct Arguments {}

pub fn run_dap(_: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let (sender, receiver) = channel();
    let urgent = Arc::new(AtomicUsize::new(0));
    let noted = Arc::clone(&urgent);
    // A thread of its own reads messages, so that a run that takes long can be paused.
    thread::spawn(move || read_messages(&sender, &noted));
    on_thread(move || serve(&receiver, &urgent, form))
        .unwrap_or_else(|| Err(Failure::environment(stopped_message("the debugger"))))
}

type Received = std::io::Result<Incoming>;

/// Requests for which a run stops.
const URGENT: [&str; 3] = ["pause", "terminate", "disconnect"];

fn is_urgent(message: &Value) -> bool {
    message.get("command").and_then(Value::as_str).is_some_and(|name| URGENT.contains(&name))
}

fn read_messages(sender: &Sender<Received>, urgent: &AtomicUsize) {
    let mut stream = BufReader::new(stdin().lock());
    loop {
        let incoming = wire::read_message(&mut stream);
        let is_end = matches!(incoming, Ok(Incoming::End) | Err(_));
        let stops = match &incoming {
            Ok(Incoming::Message(message)) => is_urgent(message),
            _ => is_end,
        };
        urgent.fetch_add(usize::from(stops), Ordering::SeqCst);
        if sender.send(incoming).is_err() || is_end {
            return;
        }
    }
}

/// Answers until the client leaves.
fn serve(
    receiver: &Receiver<Received>,
    urgent: &AtomicUsize,
    form: DiagnosticForm,
) -> Result<(), Failure> {
    let here = std::env::current_dir()?;
    let (mut adapter, mut host) = (Adapter::default(), Machine { urgent, form, here });
    let mut written = Ok(());
    let mut send = |message: Value| {
        if written.is_ok() {
            written = write_message(&message);
        }
    };
    for incoming in receiver {
        match incoming {
            Ok(Incoming::Message(message)) => {
                if is_urgent(&message) {
                    urgent.fetch_sub(1, Ordering::SeqCst);
                }
                adapter.receive(&message, &mut host, &mut send);
            }
            Ok(Incoming::Malformed(answer)) => {
                let words = answer.pointer("/error/message").and_then(Value::as_str);
                adapter.reject(words.unwrap_or_default(), &mut send);
            }
            Ok(Incoming::End) => break,
            Err(error) => {
                return Err(Failure::input(format!("what comes in is no conversation: {error}")));
            }
        }
        if adapter.is_ended() {
            break;
        }
    }
    written
}

fn write_message(message: &Value) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    wire::write_message(&mut bytes, message)?;
    terminal::write_data(&bytes)?;
    Ok(terminal::flush_stdout()?)
}

/// The machine that the adapter runs on.
struct Machine<'a> {
    /// How many messages came in for which a run stops.
    urgent: &'a AtomicUsize,
    form: DiagnosticForm,
    /// The folder that the debugger was started in.
    here: PathBuf,
}

impl Host for Machine<'_> {
    fn launch(&mut self, arguments: &Value) -> Result<Launched, Refusal> {
        let before = std::env::current_dir();
        let launched = self.enter(arguments).and_then(|()| self.made(arguments));
        // Paths of a run that stays begin at its own folder.
        if let (Err(_), Ok(before)) = (&launched, before) {
            let _ = std::env::set_current_dir(before);
        }
        launched
    }

    fn path_of(&self, source: &Source) -> Option<String> {
        if !source.on_disk {
            return None;
        }
        let path = std::path::absolute(&source.path).ok()?;
        Some(path.display().to_string())
    }

    fn is_same(&self, one: &str, other: &str) -> bool {
        let real = |path: &str| Path::new(path).canonicalize().ok();
        one == other || real(one).is_some_and(|one| real(other) == Some(one))
    }

    fn is_interrupted(&self) -> bool {
        self.urgent.load(Ordering::SeqCst) > 0
    }
}

impl Machine<'_> {
    fn made(&self, arguments: &Value) -> Result<Launched, Refusal> {
        let asked = arguments_of(arguments)?;
        let (title, share) = (asked.title(), asked.lost_share());
        let mut launched = None;
        let outcome = debug::with_subject(&asked, self.form, &mut |text, subject| {
            let (sources, title) = (text.sources.clone(), title.clone());
            let imports = text.map.imports.iter().copied().collect();
            launched = Some(Launched { subject, sources, imports, title, share });
            Ok(())
        });
        outcome.map_err(refusal)?;
        launched.ok_or_else(|| plain_refusal("nothing was made ready to run"))
    }

    /// Goes to the folder that the paths of a launch begin at.
    fn enter(&self, arguments: &Value) -> Result<(), Refusal> {
        let folder = arguments.get("cwd").and_then(Value::as_str).unwrap_or_default();
        std::env::set_current_dir(self.here.join(folder))
            .map_err(|error| plain_refusal(&format!("`cwd` is {folder}: {error}")))
    }
}

/// The options of `lamplight debug` that a launch has as arguments of their names.
fn options(command: &clap::Command) -> Vec<String> {
    let shown = command.get_arguments().filter(|argument| !argument.is_hide_set());
    let is_left_out = |name: &str| LEFT_OUT.contains(&name);
    let names = shown.filter_map(|argument| argument.get_long()).map(str::to_owned);
    names.filter(|name| !is_left_out(name)).collect()
}

/// Those of a run that is printed and of the text that is made, and one whose name means the file in a
/// launch.
const LEFT_OUT: [&str; 7] = ["json", "why", "turns", "executor", "keep-all", "mangle", "program"];

/// What `lamplight debug` would get on its command line.
fn arguments_of(arguments: &Value) -> Result<debug::Arguments, Refusal> {
    let command = debug::launch_command();
    let mut line = vec!["launch".to_owned()];
    for name in options(&command) {
        let Some(value) = arguments.get(&name) else { continue };
        add_option(&mut line, &name, value)?;
    }
    let further = arguments.get("args").and_then(Value::as_array);
    line.extend(further.into_iter().flatten().filter_map(Value::as_str).map(str::to_owned));
    if let Some(program) = arguments.get("program").and_then(Value::as_str) {
        line.push("--".to_owned());
        line.push(shortened(program));
    }
    let matches = command.try_get_matches_from(line);
    let read = matches.and_then(|matches| debug::Arguments::from_arg_matches(&matches));
    read.map_err(|error| {
        let output = error.render().to_string();
        let first = output.lines().next().unwrap_or_default();
        let message = first.trim_start_matches("error: ").to_owned();
        Refusal { message, output }
    })
}

/// A path below this folder from here, so that messages have short paths.
fn shortened(program: &str) -> String {
    let below = std::env::current_dir()
        .ok()
        .and_then(|here| Path::new(program).strip_prefix(here).map(Path::to_path_buf).ok());
    below.unwrap_or_else(|| PathBuf::from(program)).display().to_string()
}

/// Adds an option with what a launch says of it. A list of numbers is one value, such as a pixel; any
/// other list has several, and so has an object, which names them.
fn add_option(line: &mut Vec<String>, name: &str, value: &Value) -> Result<(), Refusal> {
    let joint = if name == "size" { "x" } else { "," };
    let text = |value: &Value| match value {
        Value::String(text) => Ok(text.clone()),
        Value::Number(number) => Ok(number.to_string()),
        Value::Bool(is_so) => Ok(is_so.to_string()),
        Value::Array(parts) => {
            let part = |part: &Value| part.as_str().map_or_else(|| part.to_string(), str::to_owned);
            Ok(parts.iter().map(part).collect::<Vec<_>>().join(joint))
        }
        Value::Object(_) | Value::Null => Err(plain_refusal(&format!(
            "`{name}` of the launch is {value}: expected text or numbers"
        ))),
    };
    let mut add = |value: String| line.push(format!("--{name}={value}"));
    match value {
        Value::Null => {}
        Value::Object(members) => {
            for (member, value) in members {
                add(format!("{member}={}", text(value)?));
            }
        }
        Value::Array(parts) if !parts.iter().all(Value::is_number) => {
            for part in parts {
                add(text(part)?);
            }
        }
        value => add(text(value)?),
    }
    Ok(())
}

fn plain_refusal(message: &str) -> Refusal {
    Refusal { message: message.to_owned(), output: format!("error: {message}\n") }
}

fn refusal(failure: Failure) -> Refusal {
    match failure {
        Failure::Input(sources, errors) | Failure::Check(sources, errors) => {
            let first = errors.first().map(|error| error.message.clone());
            Refusal {
                message: first.unwrap_or_else(|| "the shader has errors".to_owned()),
                output: render(&sources, &errors, Form::Human),
            }
        }
        Failure::Message(_, message) => {
            let first = message.lines().next().unwrap_or_default().to_owned();
            Refusal { message: first, output: format!("error: {message}\n") }
        }
    }
}
