//! The process of a browser, the shell that starts it and removes its files afterwards, and the
//! messages between them and us.
//!
//! Messages of the DevTools protocol are JSON, each ended by a zero byte. Answers are matched by their
//! number.

use crate::browser::{PACKAGE, Problem};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs;
use std::io::{BufRead as _, BufReader, Read, Write};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::time::{Duration, Instant};

/// How long the browser may take to end after the pipes are closed, before it is killed.
const END: Duration = Duration::from_secs(5);
/// How many bytes of the browser's last output are kept.
const WORDS: usize = 4 << 10;

/// No profile of the user's, no windows, no network of its own, and a GPU that is emulated: the
/// same on every machine.
const FLAGS: &[&str] = &[
    "--headless",
    "--no-sandbox",
    "--remote-debugging-pipe",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--enable-unsafe-swiftshader",
    "--enable-features=Vulkan",
    "--disable-background-networking",
    "--disable-background-timer-throttling",
    "--disable-backgrounding-occluded-windows",
    "--disable-breakpad",
    "--disable-component-update",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-gpu-watchdog",
    "--disable-quic",
    "--disable-renderer-backgrounding",
    "--disable-sync",
    "--force-color-profile=srgb",
    "--hide-scrollbars",
    "--mute-audio",
    "--no-default-browser-check",
    "--no-first-run",
    "--password-store=basic",
];

/// The browser reads commands from file 3 and writes answers to file 4. Nobody else keeps these
/// open, so it ends when they close. The shell removes its folder, whatever the reason for its end.
/// If the shell is asked to terminate, it kills the browser first.
const SHELL: &str = r#"
trap '' INT HUP
folder=$(mktemp -d) || exit 1
exec 3<&0 4>&1 </dev/null >/dev/null
HOME=$folder TMPDIR=$folder "$@" "--user-data-dir=$folder/profile" about:blank &
browser=$!
exec 3<&- 4>&-
trap 'kill -KILL $browser' TERM
while kill -0 $browser 2>/dev/null; do wait $browser; done
rm -rf "$folder" 2>/dev/null || { sleep 1; rm -rf "$folder"; }
"#;

/// The shell.
#[derive(Debug)]
pub struct Process {
    shell: Child,
    words: Arc<Mutex<Vec<u8>>>,
}

impl Process {
    /// Starts the program, and returns the other ends of its pipes.
    pub fn start(program: &str) -> Result<(Self, ChildStdin, ChildStdout), Problem> {
        if !is_installed(program) {
            return Err(Problem::Missing(format!("`{program}` is not installed")));
        }
        let failed =
            |what: &str| Problem::Missing(format!("`{program}` cannot be started: {what}"));
        let mut shell = Command::new("sh")
            .args(["-c", SHELL, PACKAGE, program])
            .args(FLAGS)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| failed(&error.to_string()))?;
        let words = Arc::new(Mutex::new(Vec::new()));
        let pipes = (shell.stdin.take(), shell.stdout.take(), shell.stderr.take());
        let (Some(stdin), Some(stdout), Some(stderr)) = pipes else {
            return Err(failed("it has no pipes"));
        };
        let kept = Arc::clone(&words);
        let reader = std::thread::Builder::new().name("browser's words".to_owned());
        let reader = reader.spawn(move || keep_last_output(stderr, &kept));
        reader.map_err(|error| failed(&error.to_string()))?;
        Ok((Self { shell, words }, stdin, stdout))
    }

    /// The last lines that the browser printed, without messages that it always prints.
    pub fn words(&self) -> String {
        let words = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(&words);
        let is_relevant = |line: &&str| !line.trim().is_empty() && !line.contains("/dbus/");
        let mut last: Vec<&str> = text.lines().rev().filter(is_relevant).take(3).collect();
        last.reverse();
        last.join("\n")
    }

    /// Waits until the browser has ended. The pipes must be closed before.
    pub fn end(&mut self) {
        if !self.has_ended(END) {
            self.terminate();
            if !self.has_ended(END) {
                let _ = self.shell.kill();
            }
        }
        let _ = self.shell.wait();
    }

    fn has_ended(&mut self, within: Duration) -> bool {
        let started = Instant::now();
        while started.elapsed() < within {
            if !matches!(self.shell.try_wait(), Ok(None)) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        false
    }

    /// Makes the shell kill the browser.
    pub fn terminate(&self) {
        let shell = self.shell.id().to_string();
        let _ = Command::new("sh").args(["-c", "kill -TERM \"$0\"", &shell]).status();
    }
}

/// Keeps the last bytes of the browser's output.
fn keep_last_output(mut stderr: ChildStderr, kept: &Mutex<Vec<u8>>) {
    let mut buffer = [0; 1024];
    while let Ok(count @ 1..) = stderr.read(&mut buffer) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend_from_slice(&buffer[..count]);
        let excess = kept.len().saturating_sub(WORDS);
        kept.drain(..excess);
    }
}

fn is_installed(program: &str) -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let is_file = |path: &std::path::Path| fs::metadata(path).is_ok_and(|data| data.is_file());
    std::env::split_paths(&folders).any(|folder| is_file(&folder.join(program)))
        || program.contains('/') && is_file(program.as_ref())
}

/// How many events of a page are kept until they are read.
const EVENTS: usize = 10_000;

/// Both directions of a connection.
#[derive(Debug)]
pub struct Wire {
    state: Arc<Mutex<WireState>>,
    next: AtomicU64,
}

#[derive(Debug, Default)]
struct WireState {
    /// Takes messages to be written; `None` once the connection is closed.
    outgoing: Option<Sender<Vec<u8>>>,
    /// Who waits for an answer, and the session that it is about.
    waiting: HashMap<u64, (Option<String>, Sender<Value>)>,
    /// Events of pages, by their sessions.
    events: HashMap<String, Vec<Value>>,
    /// Sessions whose page crashed.
    crashed: Vec<String>,
}

impl Wire {
    /// Reads and writes on threads of their own, so that a browser which does not read cannot block
    /// anyone who has a time limit.
    pub fn new(mut to: impl Write + Send + 'static, from: impl Read + Send + 'static) -> Arc<Self> {
        let (outgoing, queue): (Sender<Vec<u8>>, Receiver<Vec<u8>>) = mpsc::channel();
        let state =
            Arc::new(Mutex::new(WireState { outgoing: Some(outgoing), ..WireState::default() }));
        std::thread::spawn(move || {
            for message in queue {
                if to.write_all(&message).and_then(|()| to.flush()).is_err() {
                    break;
                }
            }
        });
        let shared = Arc::clone(&state);
        std::thread::spawn(move || receive_messages(from, &shared));
        Arc::new(Self { state, next: AtomicU64::new(1) })
    }

    /// Runs a command, for a page's session if one is named.
    pub fn call(
        &self,
        session: Option<&str>,
        method: &str,
        parameters: Value,
        patience: Duration,
    ) -> Result<Value, Problem> {
        let id = self.next.fetch_add(1, Ordering::Relaxed);
        let mut message = json!({ "id": id, "method": method, "params": parameters });
        if let Some(session) = session {
            message["sessionId"] = session.into();
        }
        let answers = self.send(id, session, &message)?;
        match answers.recv_timeout(patience) {
            Ok(mut answer) => match answer.get("error") {
                None => Ok(answer["result"].take()),
                Some(_) if self.has_crashed(session) => Err(Problem::Crashed),
                Some(error) => {
                    let words = error["message"].as_str().unwrap_or_default();
                    Err(Problem::Refused(format!("{method}: {words}")))
                }
            },
            Err(RecvTimeoutError::Timeout) => {
                lock_state(&self.state).waiting.remove(&id);
                Err(Problem::Late { what: method.to_owned(), after: patience })
            }
            Err(RecvTimeoutError::Disconnected) if self.has_crashed(session) => {
                Err(Problem::Crashed)
            }
            Err(RecvTimeoutError::Disconnected) => Err(Problem::Gone(String::new())),
        }
    }

    fn send(
        &self,
        id: u64,
        session: Option<&str>,
        message: &Value,
    ) -> Result<Receiver<Value>, Problem> {
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        let (sender, answers) = mpsc::channel();
        let mut state = lock_state(&self.state);
        if session.is_some_and(|session| state.crashed.iter().any(|other| other == session)) {
            return Err(Problem::Crashed);
        }
        let outgoing = state.outgoing.clone().ok_or_else(|| Problem::Gone(String::new()))?;
        state.waiting.insert(id, (session.map(str::to_owned), sender));
        drop(state);
        outgoing.send(bytes).map_err(|_| Problem::Gone(String::new()))?;
        Ok(answers)
    }

    fn has_crashed(&self, session: Option<&str>) -> bool {
        let state = lock_state(&self.state);
        session.is_some_and(|session| state.crashed.iter().any(|other| other == session))
    }

    /// The events of a session since the last call.
    pub fn events(&self, session: &str) -> Vec<Value> {
        lock_state(&self.state).events.get_mut(session).map(std::mem::take).unwrap_or_default()
    }

    /// Whether nothing more will come.
    pub fn is_closed(&self) -> bool {
        lock_state(&self.state).outgoing.is_none()
    }

    /// Closes the connection to the browser, which then ends.
    pub fn close(&self) {
        lock_state(&self.state).outgoing = None;
    }
}

/// Passes on messages until the connection ends.
fn receive_messages(from: impl Read, state: &Mutex<WireState>) {
    let mut from = BufReader::with_capacity(1 << 20, from);
    let mut bytes = Vec::new();
    while matches!(from.read_until(0, &mut bytes), Ok(1..)) {
        if bytes.last() == Some(&0) {
            bytes.pop();
        }
        if let Ok(message) = serde_json::from_slice::<Value>(&bytes) {
            lock_state(state).take(message);
        }
        bytes.clear();
    }
    let mut state = lock_state(state);
    state.outgoing = None;
    state.waiting.clear();
}

impl WireState {
    fn take(&mut self, message: Value) {
        if let Some(id) = message["id"].as_u64() {
            if let Some((_, sender)) = self.waiting.remove(&id) {
                // The receiver may have given up already.
                let _ = sender.send(message);
            }
            return;
        }
        let Some(session) = message["sessionId"].as_str().map(str::to_owned) else { return };
        if message["method"] == "Inspector.targetCrashed" {
            self.waiting.retain(|_, (page, _)| page.as_ref() != Some(&session));
            self.crashed.push(session);
            return;
        }
        let events = self.events.entry(session).or_default();
        if events.len() < EVENTS {
            events.push(message);
        }
    }
}

fn lock_state(state: &Mutex<WireState>) -> MutexGuard<'_, WireState> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
