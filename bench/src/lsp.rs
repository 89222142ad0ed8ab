//! The language server in a large package: the time from an edit to its diagnostics, and from a
//! request to its answer.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::Outcome;

const FOLDERS: usize = 10;
const FILES: usize = 200;
/// Functions of a file, about 16 lines each with what belongs to them.
const FUNCTIONS: usize = 9;
const FEATURES: usize = 200;
const KEYSTROKES: usize = 300;

/// Prints how long answers take, and how much memory the server has taken at most.
pub fn run() -> Outcome {
    let folder = std::env::temp_dir().join(format!("lamplight-bench-lsp-{}", std::process::id()));
    let lines = write(&folder)?;
    let mut server = Server::start(&folder)?;
    let name = module(FILES - 1);
    let path = folder.join(&name);
    let text = fs::read_to_string(&path)?;
    let uri = format!("file://{}", path.display());
    server.notify(
        "textDocument/didOpen",
        json!({
            "textDocument": { "uri": uri, "languageId": "wesl", "version": 0, "text": text }
        }),
    )?;
    let first = server.time_to_diagnostics()?;
    println!("lsp: {FILES} files, {lines} lines, {FEATURES} features; opened in {first:.1?}");
    time_keystrokes(&mut server, &uri, &text)?;
    for (what, method) in [
        ("hover after an edit", "textDocument/hover"),
        ("completion after an edit", "textDocument/completion"),
        ("references after an edit", "textDocument/references"),
    ] {
        time_answers(&mut server, &uri, &text, (what, method))?;
    }
    println!("lsp: {} MB of memory at most", server.memory()? / 1000);
    Ok(fs::remove_dir_all(&folder)?)
}

/// Times edits: from a keystroke to its diagnostics.
fn time_keystrokes(server: &mut Server, uri: &str, text: &str) -> Outcome {
    let mut times = Vec::new();
    for stroke in 0..KEYSTROKES {
        // Up to seven letters are added to a comment, a name or a use of it.
        let place = ["// Sum", "var sum", "return sum"][stroke % 3];
        let text = text.replacen(place, &format!("{place}{}", &"abcdefgh"[..stroke % 8]), 1);
        times.push(server.change(uri, stroke, &text)?);
    }
    shown("keystroke to diagnostics", &mut times);
    Ok(())
}

/// Times requests about a name, each after an edit.
fn time_answers(
    server: &mut Server,
    uri: &str,
    text: &str,
    (what, method): (&str, &str),
) -> Outcome {
    let line = text.lines().take_while(|line| !line.contains("var sum")).count();
    let mut times = Vec::new();
    for version in 0..KEYSTROKES / 10 {
        server.change(uri, version, text)?;
        times.push(server.ask(
            method,
            json!({
                "textDocument": { "uri": uri },
                "position": { "line": line, "character": 9 },
            }),
        )?);
    }
    shown(what, &mut times);
    Ok(())
}

fn shown(what: &str, times: &mut [Duration]) {
    times.sort();
    let at = |part: usize| times[(times.len() * part / 100).min(times.len() - 1)];
    println!("lsp: {what}: {:.1?} in the middle, {:.1?} for 99 of 100", at(50), at(99));
}

fn module(index: usize) -> String {
    format!("part_{}/module_{index}.wesl", index % FOLDERS)
}

/// Writes a package whose modules import those before them, with blocks under conditions. Returns
/// its number of lines.
fn write(folder: &Path) -> Result<usize, Box<dyn std::error::Error>> {
    let mut manifest = "[package]\nedition = \"2026_pre\"\nroot = \".\"\n\n[features]\n".to_owned();
    (0..FEATURES)
        .try_for_each(|index| writeln!(manifest, "FEATURE_{index} = {}", index % 3 == 0))?;
    fs::create_dir_all(folder)?;
    fs::write(folder.join("wesl.toml"), manifest)?;
    let mut lines = 0;
    for index in 0..FILES {
        let text = source(index)?;
        lines += text.lines().count();
        let path = folder.join(module(index));
        fs::create_dir_all(path.parent().unwrap_or(folder))?;
        fs::write(path, text)?;
    }
    Ok(lines)
}

fn source(index: usize) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let used: Vec<usize> = [1, 3, 7].iter().filter_map(|back| index.checked_sub(*back)).collect();
    for other in &used {
        let path = format!("package::part_{}::module_{other}", other % FOLDERS);
        writeln!(text, "import {path}::{{term_{other}_0, Share{other}}};")?;
    }
    writeln!(
        text,
        "\n/// What module {index} hands on.\nstruct Share{index} {{\n    value: f32,\n    weight: f32,\n}}\n"
    )?;
    for function in 0..FUNCTIONS {
        let feature = (index * 7 + function) % FEATURES;
        writeln!(text, "// Sum {function} of module {index}.")?;
        writeln!(
            text,
            "@if(FEATURE_{feature}) {{\nconst GAIN_{index}_{function}: f32 = 2.0;\n}} @else {{\nconst GAIN_{index}_{function}: f32 = 1.0;\n}}"
        )?;
        writeln!(
            text,
            "fn term_{index}_{function}(x: f32) -> f32 {{\n    var sum = x * GAIN_{index}_{function};"
        )?;
        if let Some(other) = used.get(function % used.len().max(1)) {
            writeln!(
                text,
                "    let share = Share{other}(sum, 0.5);\n    sum += term_{other}_0(share.value) * share.weight;"
            )?;
        }
        writeln!(
            text,
            "    @if(FEATURE_{}) {{\n        sum *= 0.5;\n    }}\n    return sum;\n}}\n",
            (feature + 1) % FEATURES
        )?;
    }
    Ok(text)
}

struct Server {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    next: u64,
}

impl Server {
    fn start(folder: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        let mut program = std::env::current_exe()?;
        program.set_file_name("lamplight");
        if !program.is_file() {
            return Err(
                format!("there is no `{}`: cargo build --release", program.display()).into()
            );
        }
        let mut command = Command::new(program);
        command.arg("lsp").current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn()?;
        let to = child.stdin.take().ok_or("no input")?;
        let from = BufReader::new(child.stdout.take().ok_or("no output")?);
        let mut server = Self { child, to, from, next: 0 };
        server.ask("initialize", json!({ "capabilities": {} }))?;
        Ok(server)
    }

    fn send(&mut self, message: &Value) -> std::io::Result<()> {
        let text = message.to_string();
        write!(self.to, "Content-Length: {}\r\n\r\n{text}", text.len())?;
        self.to.flush()
    }

    fn notify(&mut self, method: &str, parameters: Value) -> std::io::Result<()> {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": parameters }))
    }

    /// Sends a changed text; returns the time until its diagnostics are published.
    fn change(
        &mut self,
        uri: &str,
        version: usize,
        text: &str,
    ) -> Result<Duration, Box<dyn std::error::Error>> {
        self.notify(
            "textDocument/didChange",
            json!({
                "textDocument": { "uri": uri, "version": version },
                "contentChanges": [{ "text": text }],
            }),
        )?;
        self.time_to_diagnostics()
    }

    /// The time until diagnostics are published.
    fn time_to_diagnostics(&mut self) -> Result<Duration, Box<dyn std::error::Error>> {
        let start = Instant::now();
        while self.receive()?["method"] != "textDocument/publishDiagnostics" {}
        Ok(start.elapsed())
    }

    /// Sends a request; returns the time until its answer.
    fn ask(
        &mut self,
        method: &str,
        parameters: Value,
    ) -> Result<Duration, Box<dyn std::error::Error>> {
        let start = Instant::now();
        self.next += 1;
        let id = self.next;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": parameters }))?;
        while self.receive()?["id"] != id {}
        Ok(start.elapsed())
    }

    fn receive(&mut self) -> Result<Value, Box<dyn std::error::Error>> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.from.read_line(&mut line)? == 0 {
                return Err("the server ended".into());
            }
            match line.trim().split_once(": ") {
                Some((_, value)) => length = value.parse()?,
                None => break,
            }
        }
        let mut bytes = vec![0; length];
        self.from.read_exact(&mut bytes)?;
        Ok(serde_json::from_slice(&bytes)?)
    }

    /// The peak memory of the process in kilobytes.
    fn memory(&self) -> Result<u64, Box<dyn std::error::Error>> {
        let status = fs::read_to_string(format!("/proc/{}/status", self.child.id()))?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no VmHWM")?;
        Ok(line.split_whitespace().next().ok_or("no number")?.parse()?)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
