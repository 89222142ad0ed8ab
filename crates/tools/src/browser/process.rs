//! The process of a browser, and the shell that starts it and removes its files afterwards.

use std::fs;
use std::io::Read as _;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::{PACKAGE, Problem};

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
        let told = |line: &&str| !line.trim().is_empty() && !line.contains("/dbus/");
        let mut last: Vec<&str> = text.lines().rev().filter(told).take(3).collect();
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
