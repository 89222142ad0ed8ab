//! A headless Chromium, driven by its DevTools protocol.
//!
//! `Browser::start -> Browser::open -> BrowserPage::evaluate, until, errors, screenshot`
//!
//! Messages go through a pair of pipes (`--remote-debugging-pipe`) and not through a socket. So no
//! port is open to others, no second protocol is needed, and the browser ends when the pipes close.
//! It therefore ends with this process, however that ends, and the shell that started it removes
//! its profile ([`process`]). Every wait has a limit. [`serve`] serves the files of a page.

mod page;
mod process;
pub mod serve;
mod wire;

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::Duration;

use serde_json::json;

pub use page::{BrowserPage, Screenshot};
use process::Process;
use wire::Wire;

/// The Debian package that has the browser.
pub const PACKAGE: &str = "chromium";

/// The longest wait for something that a browser does at once.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// What can go wrong with a browser or a page of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Problem {
    /// The browser is not installed, or does not start.
    Missing(String),
    /// The browser has ended; with its last output.
    Gone(String),
    /// The page's process has ended.
    Crashed,
    /// Nothing came within the time.
    Late { what: String, after: Duration },
    /// The browser refuses a command.
    Refused(String),
    /// A script of the page threw this.
    Threw(String),
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(words) => f.write_str(words),
            Self::Gone(words) if words.is_empty() => f.write_str("the browser has ended"),
            Self::Gone(words) => write!(f, "the browser has ended: {words}"),
            Self::Crashed => f.write_str("the page crashed"),
            Self::Late { what, after } => {
                write!(f, "the page did not answer {what} within {:.1} s", after.as_secs_f64())
            }
            Self::Refused(words) => write!(f, "the browser refuses a command: {words}"),
            Self::Threw(words) => write!(f, "the page threw: {words}"),
        }
    }
}

impl std::error::Error for Problem {}

/// The browser of this process.
struct SharedBrowser {
    open: Weak<Browser>,
    /// Whether it stays open although nobody else holds it.
    keeps: bool,
    kept: Option<Arc<Browser>>,
}

static SHARED: Mutex<SharedBrowser> =
    Mutex::new(SharedBrowser { open: Weak::new(), keeps: false, kept: None });

/// A browser with a profile of its own. It ends when its last page and its last owner are dropped.
#[derive(Debug)]
pub struct Browser {
    wire: Arc<Wire>,
    version: String,
    process: Process,
}

impl Browser {
    /// Starts the browser that is installed.
    ///
    /// # Errors
    /// `Missing` where it does not start.
    pub fn start() -> Result<Arc<Self>, Problem> {
        Self::start_as("chromium")
    }

    /// Starts the browser with this program name.
    ///
    /// # Errors
    /// Those of [`Self::start`].
    pub fn start_as(program: &str) -> Result<Arc<Self>, Problem> {
        let (process, stdin, stdout) = Process::start(program)?;
        let wire = Wire::new(stdin, stdout);
        let said = wire.call(None, "Browser.getVersion", json!({}), PATIENCE);
        let said = said.map_err(|problem| match problem {
            Problem::Gone(_) => {
                Problem::Missing(format!("`{program}` does not start: {}", process.words()))
            }
            other => other,
        })?;
        let version =
            said["product"].as_str().unwrap_or("Chromium").replace("Chrome/", "Chromium ");
        Ok(Arc::new(Self { wire, version, process }))
    }

    /// The browser of this process. Everyone who asks gets the same one, as long as somebody holds
    /// it, or until the process ends after [`Self::keep_shared`].
    ///
    /// # Errors
    /// Those of [`Self::start`].
    pub fn shared() -> Result<Arc<Self>, Problem> {
        // The lock is held while the browser starts, so that only one is started.
        let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        let open = shared.open.upgrade().filter(|browser| !browser.wire.is_closed());
        let browser = open.map_or_else(Self::start, Ok)?;
        shared.open = Arc::downgrade(&browser);
        shared.kept = shared.keeps.then(|| Arc::clone(&browser));
        Ok(browser)
    }

    /// The shared browser that somebody next asks for stays open until the process ends. This is for
    /// a process that needs it again and again, since each start takes more than a second of
    /// processor time.
    pub fn keep_shared() {
        SHARED.lock().unwrap_or_else(PoisonError::into_inner).keeps = true;
    }

    /// Name and version.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Opens an address in a page of its own, without waiting until it is loaded.
    ///
    /// # Errors
    /// The browser's.
    pub fn open(self: &Arc<Self>, address: &str) -> Result<BrowserPage, Problem> {
        BrowserPage::open(Arc::clone(self), address)
    }

    /// The result of any command of the protocol to the browser.
    ///
    /// # Errors
    /// The browser's.
    pub fn command(
        &self,
        method: &str,
        parameters: serde_json::Value,
    ) -> Result<serde_json::Value, Problem> {
        self.call(None, method, parameters, PATIENCE)
    }

    /// Ends the browser at once, whatever it is doing.
    fn kill(&self) {
        self.wire.close();
        self.process.terminate();
    }

    /// Runs a command, for a page if one is named.
    fn call(
        &self,
        page: Option<&str>,
        method: &str,
        parameters: serde_json::Value,
        patience: Duration,
    ) -> Result<serde_json::Value, Problem> {
        let result = self.wire.call(page, method, parameters, patience);
        result.map_err(|problem| match problem {
            Problem::Gone(_) => Problem::Gone(self.process.words()),
            other => other,
        })
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        self.wire.close();
        self.process.end();
    }
}
