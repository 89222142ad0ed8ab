//! Messages of the DevTools protocol: JSON, each ended by a zero byte. Answers are matched by their
//! number.

use std::collections::HashMap;
use std::io::{BufRead as _, BufReader, Read, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use serde_json::{Value, json};

use super::Problem;

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
