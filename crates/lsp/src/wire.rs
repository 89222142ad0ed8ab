//! Messages on a stream: headers, a blank line, JSON. Malformed input is skipped or answered with
//! an error, and reading continues after it.

use std::io::{self, BufRead, Read, Write};

use serde_json::{Value, json};

use lamplight_files::limits::MESSAGE_BYTES;

/// The most bytes of a line of a header.
const HEADER_LINE: u64 = 1 << 10;

/// What came in.
#[derive(Debug)]
pub enum Incoming {
    /// JSON, whatever it says.
    Message(Value),
    /// Bytes that are no message, with the answer that says so.
    Malformed(Value),
    /// The end of the stream.
    End,
}

/// The most bytes between two messages. A stream with more is no conversation, such as
/// `/dev/zero`.
const MOST_NOISE: usize = 1 << 20;

const LENGTH: &str = "content-length:";

/// Reads the next message.
///
/// A header without a length, or with one that is no number, is answered with an error. Nobody
/// knows where its message ends, so the next header is looked for, also within a line.
///
/// # Errors
/// Those of the stream itself, and too many bytes without a header.
pub fn read_message(stream: &mut impl BufRead) -> io::Result<Incoming> {
    let mut header = Header::default();
    let (mut noise, mut line) = (0, Vec::new());
    loop {
        let before = keep_end(&mut line);
        let read = stream.by_ref().take(HEADER_LINE).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(Incoming::End);
        }
        noise += read;
        if noise > MOST_NOISE {
            let words = format!("{MOST_NOISE} bytes have no header of a message");
            return Err(io::Error::new(io::ErrorKind::InvalidData, words));
        }
        let text = String::from_utf8_lossy(&line).to_ascii_lowercase();
        match text.rfind(LENGTH) {
            Some(at) => header.note_length(text[at + LENGTH.len()..].trim()),
            None if text.trim().is_empty() && before == 0 => match header {
                Header { length: Some(Ok(length)), .. } => return read_body(stream, length),
                Header { length: Some(Err(())), .. } => return Ok(malformed(WRONG_LENGTH)),
                Header { is_begun: true, .. } => return Ok(malformed(NO_LENGTH)),
                // Blank lines and other noise between messages.
                Header { .. } => {}
            },
            None => header.is_begun |= text.starts_with("content-"),
        }
    }
}

const WRONG_LENGTH: &str = "the `Content-Length` of a header is not a number of bytes";
const NO_LENGTH: &str = "a header has no `Content-Length`";

/// The header that is being read.
#[derive(Default)]
struct Header {
    /// The number of bytes, or that it cannot be read.
    length: Option<Result<u64, ()>>,
    is_begun: bool,
}

impl Header {
    fn note_length(&mut self, written: &str) {
        self.length = Some(written.parse().map_err(|_| ()));
    }
}

/// Keeps the end of a line that goes on, since the next header may begin there. Returns how many
/// bytes are kept.
fn keep_end(line: &mut Vec<u8>) -> usize {
    let goes_on = line.last().is_some_and(|last| *last != b'\n');
    let kept = if goes_on { line.len().min(LENGTH.len()) } else { 0 };
    line.drain(..line.len() - kept);
    kept
}

fn malformed(words: &str) -> Incoming {
    Incoming::Malformed(error_message(&Value::Null, PARSE_ERROR, words))
}

fn read_body(stream: &mut impl BufRead, length: u64) -> io::Result<Incoming> {
    if length > MESSAGE_BYTES {
        let skipped = io::copy(&mut stream.by_ref().take(length), &mut io::sink())?;
        let words = format!("a message of {skipped} bytes is more than {MESSAGE_BYTES}");
        return Ok(Incoming::Malformed(error_message(&Value::Null, PARSE_ERROR, &words)));
    }
    let mut bytes = Vec::new();
    stream.by_ref().take(length).read_to_end(&mut bytes)?;
    Ok(match serde_json::from_slice(&bytes) {
        Ok(message) => Incoming::Message(message),
        Err(wrong) => {
            Incoming::Malformed(error_message(&Value::Null, PARSE_ERROR, &wrong.to_string()))
        }
    })
}

/// Writes one message.
///
/// # Errors
/// Those of the stream.
pub fn write_message(stream: &mut impl Write, message: &Value) -> io::Result<()> {
    let text = message.to_string();
    write!(stream, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    stream.flush()
}

/// JSON-RPC's error codes: parse error, method not found, invalid parameters.
pub const PARSE_ERROR: i32 = -32700;
pub const NO_METHOD: i32 = -32601;
pub const WRONG_PARAMETERS: i32 = -32602;
/// A request that is well formed and cannot be done.
pub const FAILED: i32 = -32803;

/// The answer to a request.
pub fn answer_message(id: &Value, result: Value) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "result": result })
}

/// The answer to a request that cannot be done.
pub fn error_message(id: &Value, code: i32, words: &str) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code, "message": words } })
}

/// A notification: a message that answers no request.
pub fn notification_message(method: &str, parameters: Value) -> Value {
    json!({ "jsonrpc": "2.0", "method": method, "params": parameters })
}
