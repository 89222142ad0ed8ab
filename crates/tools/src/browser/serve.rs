//! Serves a folder, or files in memory, at an address that only this machine reaches.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The longest wait for a browser to send or take something.
const PATIENCE: Duration = Duration::from_secs(10);
/// The most bytes of a request.
const QUESTION: u64 = 64 << 10;

#[derive(Debug, Clone)]
pub enum ServedFiles {
    /// Texts and other bytes, by their paths without a slash before them.
    Memory(BTreeMap<String, Vec<u8>>),
    /// Everything below a folder.
    Folder(PathBuf),
}

/// A server; it ends when it is dropped.
#[derive(Debug)]
pub struct HttpServer {
    address: SocketAddr,
    ends: Arc<AtomicBool>,
}

impl HttpServer {
    /// Serves files on a free port.
    ///
    /// # Errors
    /// The system's.
    pub fn start(files: ServedFiles) -> std::io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let address = listener.local_addr()?;
        let ends = Arc::new(AtomicBool::new(false));
        let (files, ending) = (Arc::new(files), Arc::clone(&ends));
        std::thread::Builder::new().spawn(move || {
            for stream in listener.incoming() {
                if ending.load(Ordering::Relaxed) {
                    break;
                }
                let files = Arc::clone(&files);
                // If a connection fails, the browser asks again.
                std::thread::spawn(move || {
                    stream.and_then(|stream| answer_request(stream, &files))
                });
            }
        })?;
        Ok(Self { address, ends })
    }

    /// The address of a path.
    pub fn address(&self, path: &str) -> String {
        format!("http://{}/{path}", self.address)
    }
}

impl Drop for HttpServer {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        // Wakes the thread that waits for a connection.
        let _ = TcpStream::connect_timeout(&self.address, PATIENCE);
    }
}

impl ServedFiles {
    /// The bytes of a path. For a folder, those of its `index.html`.
    fn read(&self, path: &str) -> Option<(String, Vec<u8>)> {
        let path = match path.ends_with('/') || path.is_empty() {
            true => format!("{path}index.html"),
            false => path.to_owned(),
        };
        let bytes = match self {
            Self::Memory(files) => files.get(&path).cloned(),
            Self::Folder(folder) => {
                let is_below = |part| matches!(part, Component::Normal(_));
                let below = Path::new(&path).components().all(is_below);
                below.then(|| std::fs::read(folder.join(&path)).ok())?
            }
        };
        Some((path, bytes?))
    }
}

/// Answers one request and closes the connection.
fn answer_request(stream: TcpStream, files: &ServedFiles) -> std::io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut lines = BufReader::new((&stream).take(QUESTION));
    let mut first = String::new();
    lines.read_line(&mut first)?;
    let mut line = String::new();
    while lines.read_line(&mut line)? > 2 {
        line.clear();
    }
    let path = first.split(' ').nth(1).unwrap_or_default();
    let path = path.split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    let found = if first.starts_with("GET ") { files.read(&decoded_path(path)) } else { None };
    let (status, kind, bytes) = match &found {
        Some((path, bytes)) => ("200 OK", content_type(path), bytes.as_slice()),
        None => ("404 Not Found", "text/plain", b"there is nothing here".as_slice()),
    };
    let mut stream = &stream;
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n\
         Cache-Control: no-store\r\nConnection: close\r\n\r\n",
        bytes.len()
    )?;
    stream.write_all(bytes)?;
    stream.flush()
}

/// The path with `%20` and the like decoded.
fn decoded_path(path: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = path.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let coded = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let coded = coded.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match (first, coded) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            _ => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The content type of a file.
fn content_type(path: &str) -> &'static str {
    match path.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" | "map" => "application/json",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "txt" | "md" | "wgsl" | "glsl" | "wesl" => "text/plain; charset=utf-8",
        "zip" => "application/zip",
        "woff2" => "font/woff2",
        _ => "application/octet-stream",
    }
}
