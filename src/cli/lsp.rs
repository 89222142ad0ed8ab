//! `lamplight lsp`: a language server on standard input and output.

use std::cell::OnceCell;
use std::io::{BufReader, stdin};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use clap::Args;
use serde_json::Value;

use super::failure::Failure;
use super::terminal;
use crate::LIBRARY_FILES;
use crate::input;
use crate::lsp::wire::{self, Incoming};
use crate::lsp::{LanguageServer, LibraryPaths};
use crate::output::{self, Replace};
use crate::source::Files;
use crate::validate::on_large_stack;

/// Run a language server for WESL, WGSL and GLSL on standard input and output.
#[derive(Args)]
pub struct Arguments {}

/// How long to wait for more messages before analysing changed documents.
const PAUSE: Duration = Duration::from_millis(1);

pub fn run_lsp(_: Arguments) -> Result<(), Failure> {
    let (sender, receiver) = channel();
    // A thread of its own reads messages, so that a keystroke is noticed while a document is
    // analysed.
    thread::spawn(move || {
        let mut stream = BufReader::new(stdin().lock());
        loop {
            let incoming = wire::read_message(&mut stream);
            let is_end = matches!(incoming, Ok(Incoming::End) | Err(_));
            if sender.send(incoming).is_err() || is_end {
                return;
            }
        }
    });
    // The server runs on a thread with the large stack that naga needs, so that no keystroke waits
    // for a switch to another thread.
    match on_large_stack(move || serve_editor(&receiver))? {
        0 => Ok(()),
        _ => Err(Failure::input("the editor closed the connection without `shutdown`")),
    }
}

/// How often to look whether the editor still runs.
const ALIVE: Duration = Duration::from_secs(5);

/// Waits for the next message as long as the editor runs. If its process has ended, another process
/// may still hold the other end of the stream, and no message would come.
fn receive_while_alive(
    receiver: &Receiver<std::io::Result<Incoming>>,
    editor: Option<u64>,
) -> Result<Result<std::io::Result<Incoming>, RecvTimeoutError>, Failure> {
    loop {
        match receiver.recv_timeout(ALIVE) {
            Err(RecvTimeoutError::Timeout) => {
                if let Some(editor) = editor.filter(|editor| has_ended(*editor)) {
                    let message = format!("the editor, process {editor}, has ended");
                    return Err(Failure::input(message));
                }
            }
            found => return Ok(found),
        }
    }
}

/// The number of the editor's process, which it gives when it begins.
fn process_of_editor(message: &Value) -> Option<u64> {
    let begins = message.get("method").and_then(Value::as_str) == Some("initialize");
    message.pointer("/params/processId").filter(|_| begins).and_then(Value::as_u64)
}

/// Whether a process has ended, where the system shows processes as files.
fn has_ended(process: u64) -> bool {
    let processes = Path::new("/proc");
    processes.join("self").exists() && !processes.join(process.to_string()).exists()
}

/// Answers until the editor leaves; returns the exit code that the protocol demands.
fn serve_editor(receiver: &Receiver<std::io::Result<Incoming>>) -> Result<u8, Failure> {
    let mut server = LanguageServer::new(library_copy(), LIBRARY_FILES);
    let (mut pause, mut editor) = (PAUSE, None);
    loop {
        let next = match server.is_idle() {
            false => receiver.recv_timeout(pause),
            true => receive_while_alive(receiver, editor)?,
        };
        let sent = match next {
            Ok(Err(error)) => {
                return Err(Failure::input(format!("what comes in is no conversation: {error}")));
            }
            Ok(Ok(Incoming::Message(message))) => {
                pause = PAUSE;
                editor = editor.or_else(|| process_of_editor(&message));
                guard_request(&mut server, &message, |server| server.receive(&message))
            }
            Ok(Ok(Incoming::Malformed(answer))) => vec![answer],
            Ok(Ok(Incoming::End)) | Err(RecvTimeoutError::Disconnected) => return Ok(0),
            Err(RecvTimeoutError::Timeout) => {
                pause = Duration::ZERO;
                guard_request(&mut server, &Value::Null, LanguageServer::look)
            }
        };
        for message in sent {
            let mut bytes = Vec::new();
            wire::write_message(&mut bytes, &message)?;
            terminal::write_data(&bytes)?;
            terminal::flush_stdout()?;
        }
        if let Some(code) = server.exit {
            return Ok(code);
        }
    }
}

/// A request that panics is answered with an error, and the server continues.
fn guard_request(
    server: &mut LanguageServer,
    message: &Value,
    work: impl FnOnce(&mut LanguageServer) -> Vec<Value>,
) -> Vec<Value> {
    catch_unwind(AssertUnwindSafe(|| work(server))).unwrap_or_else(|_| {
        let id = message.get("id");
        id.map(|id| wire::error_message(id, wire::FAILED, "internal error")).into_iter().collect()
    })
}

/// A copy of the library where editors can open its files, written when the first one is asked for.
/// All files are written, since the definitions in one lead to others.
fn library_copy() -> LibraryPaths {
    let copy = OnceCell::new();
    Box::new(move |name| {
        let folder: &Option<PathBuf> = copy.get_or_init(write_library);
        LIBRARY_FILES.read(name).ok()??;
        Some(folder.as_ref()?.join(name))
    })
}

fn write_library() -> Option<PathBuf> {
    let variable =
        |name| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let cache = variable("XDG_CACHE_HOME").or_else(|| Some(variable("HOME")?.join(".cache")))?;
    let folder = cache.join("lamplight").join(env!("CARGO_PKG_VERSION"));
    let names = LIBRARY_FILES.list(&["wesl", "wgsl", "glsl", "toml"]);
    let text = |name: &String| Some((name.clone(), LIBRARY_FILES.read(name).ok()??));
    let files: Vec<(String, String)> = names.iter().filter_map(text).collect();
    let is_there = |(name, text): &(String, String)| {
        let found = input::read_file(&folder.join(name), text.len() as u64);
        found.is_ok_and(|known| known == text.as_bytes())
    };
    if !files.iter().all(is_there) {
        let files = files.iter().map(|(name, text)| (name.as_str(), text.as_bytes()));
        output::write_folder(&folder, files, Replace::Any).ok()?;
    }
    Some(folder)
}
