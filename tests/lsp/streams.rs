//! Streams that are no conversation, and editors that end without a word.

use std::fs::File;
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use lamplight::lsp::wire;
use serde_json::json;

use super::Outcome;

/// How long the server may need to notice.
const PATIENCE: Duration = Duration::from_secs(60);

fn server(input: Stdio) -> std::io::Result<Child> {
    Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .arg("lsp")
        .stdin(input)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
}

/// Waits for the end of the server, whose exit code and message are expected.
fn ends(mut child: Child, words: &str) -> Outcome {
    let start = Instant::now();
    while child.try_wait()?.is_none() {
        if start.elapsed() > PATIENCE {
            child.kill()?;
            return Err("the server did not end".into());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let output = child.wait_with_output()?;
    let stderr = String::from_utf8_lossy(&output.stderr);
    match output.status.code() == Some(1) && stderr.contains(words) {
        true => Ok(()),
        false => Err(format!("{:?}: {stderr}", output.status).into()),
    }
}

/// A stream that never ends and has no messages.
pub fn endless() -> Outcome {
    ends(server(File::open("/dev/zero")?.into())?, "no header of a message")
}

/// The editor's process has ended, and the stream is still open.
pub fn gone() -> Outcome {
    let mut editor = Command::new("true").spawn()?;
    let process = editor.id();
    editor.wait()?;
    let mut child = server(Stdio::piped())?;
    let mut stream = child.stdin.take().ok_or("no input")?;
    let parameters = json!({ "processId": process, "capabilities": {} });
    let begin = json!({ "jsonrpc": "2.0", "id": 1, "method": "initialize", "params": parameters });
    wire::write_message(&mut stream, &begin)?;
    stream.flush()?;
    let outcome = ends(child, "has ended");
    drop(stream);
    outcome
}
