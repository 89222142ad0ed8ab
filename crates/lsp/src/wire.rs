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

/// Reads the next message.
///
/// # Errors
/// Those of the stream itself.
pub fn read_message(stream: &mut impl BufRead) -> io::Result<Incoming> {
    let mut length: Option<u64> = None;
    loop {
        let mut line = Vec::new();
        if stream.by_ref().take(HEADER_LINE).read_until(b'\n', &mut line)? == 0 {
            return Ok(Incoming::End);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if let Some((name, value)) = line.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok();
        } else if line.is_empty() {
            match length {
                Some(length) => return read_body(stream, length),
                // Blank lines and other noise between messages.
                None => continue,
            }
        }
    }
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
