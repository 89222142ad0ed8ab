//! A headless Chromium, driven by its DevTools protocol.
//!
//! `Browser::start -> Browser::open -> BrowserPage::evaluate, until, errors, screenshot`
//!
//! Messages go through a pair of pipes (`--remote-debugging-pipe`) and not through a socket. So no
//! port is open to others, no second protocol is needed, and the browser ends when the pipes close.
//! It therefore ends with this process, however that ends, and the shell that started it removes
//! its profile ([`process`]). Every wait has a limit. [`serve`] serves the files of a page.

mod process;
pub mod serve;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use process::{Process, Wire};
use serde_json::{Value, json};
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::{Duration, Instant};

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
        let answer = wire.call(None, "Browser.getVersion", json!({}), PATIENCE);
        let answer = answer.map_err(|problem| match problem {
            Problem::Gone(_) => {
                Problem::Missing(format!("`{program}` does not start: {}", process.words()))
            }
            other => other,
        })?;
        let version =
            answer["product"].as_str().unwrap_or("Chromium").replace("Chrome/", "Chromium ");
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

/// The time between two looks at a condition that is waited for.
const LOOK: Duration = Duration::from_millis(10);

/// A page of a browser; it closes when it is dropped.
#[derive(Debug)]
pub struct BrowserPage {
    browser: Arc<Browser>,
    target: String,
    session: String,
    errors: Vec<String>,
}

/// What a picture of a page shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Screenshot {
    /// The width of the window, in pixels.
    pub width: u32,
    /// The height of the window. If `whole` is set and the page is higher, the picture has the
    /// page's height.
    pub height: u32,
    pub whole: bool,
}

impl BrowserPage {
    pub(super) fn open(browser: Arc<Browser>, address: &str) -> Result<Self, Problem> {
        let text = |value: &Value, name: &str| match value[name].as_str() {
            Some(text) => Ok(text.to_owned()),
            None => Err(Problem::Refused(format!("there is no `{name}` in {value}"))),
        };
        // In a window of its own: a page behind another one is hidden, and draws nothing.
        let blank = json!({ "url": "about:blank", "newWindow": true });
        let made = browser.call(None, "Target.createTarget", blank, PATIENCE)?;
        let target = text(&made, "targetId")?;
        let attach = json!({ "targetId": target, "flatten": true });
        let attached = browser.call(None, "Target.attachToTarget", attach, PATIENCE)?;
        let session = text(&attached, "sessionId")?;
        let page = Self { browser, target, session, errors: Vec::new() };
        for domain in ["Inspector.enable", "Page.enable", "Runtime.enable", "Log.enable"] {
            page.call(domain, json!({}))?;
        }
        page.go(address)?;
        Ok(page)
    }

    /// Opens another address in it.
    ///
    /// # Errors
    /// The browser's, among them that there is nothing at the address.
    pub fn go(&self, address: &str) -> Result<(), Problem> {
        let gone = self.call("Page.navigate", json!({ "url": address }))?;
        match gone["errorText"].as_str() {
            Some(words) => Err(Problem::Refused(format!("{address}: {words}"))),
            None => Ok(()),
        }
    }

    /// The value of an expression of JavaScript; of a promise, the value that it resolves to.
    ///
    /// # Errors
    /// It throws, or there is none within the time, or the page or the browser is gone.
    pub fn evaluate(&self, expression: &str, patience: Duration) -> Result<Value, Problem> {
        let parameters = json!({
            "expression": expression,
            "awaitPromise": true,
            "returnByValue": true,
        });
        let method = "Runtime.evaluate";
        let mut answer = self.browser.call(Some(&self.session), method, parameters, patience)?;
        match answer.get("exceptionDetails") {
            Some(details) => Err(Problem::Threw(exception_text(details))),
            None => Ok(answer["result"]["value"].take()),
        }
    }

    /// Waits until an expression is true. It may fail meanwhile, as it does before a page is
    /// loaded.
    ///
    /// # Errors
    /// It is not true within the time, or the page or the browser is gone.
    pub fn until(&self, expression: &str, patience: Duration) -> Result<(), Problem> {
        let started = Instant::now();
        loop {
            let left = patience.saturating_sub(started.elapsed());
            match self.evaluate(expression, left.max(LOOK)) {
                Ok(Value::Bool(true)) => return Ok(()),
                Ok(_) | Err(Problem::Threw(_) | Problem::Refused(_)) if !left.is_zero() => {
                    std::thread::sleep(LOOK);
                }
                Ok(_) | Err(Problem::Threw(_) | Problem::Refused(_) | Problem::Late { .. }) => {
                    return Err(Problem::Late { what: expression.to_owned(), after: patience });
                }
                Err(other) => return Err(other),
            }
        }
    }

    /// Waits until everything that the page names is loaded.
    ///
    /// # Errors
    /// Those of [`Self::until`].
    pub fn loaded(&self, patience: Duration) -> Result<(), Problem> {
        self.until("document.readyState === 'complete'", patience)
    }

    /// The page's errors so far: errors of the console, exceptions that were not caught, and files
    /// that could not be loaded.
    pub fn errors(&mut self) -> &[String] {
        let events = self.browser.wire.events(&self.session);
        self.errors.extend(events.iter().filter_map(error_of_event));
        &self.errors
    }

    /// A picture of the page, as PNG.
    ///
    /// # Errors
    /// The browser's.
    pub fn screenshot(&self, shot: Screenshot) -> Result<Vec<u8>, Problem> {
        let Screenshot { width, height, whole } = shot;
        let size = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false,
        });
        self.call("Emulation.setDeviceMetricsOverride", size)?;
        // The page is drawn for the new size first.
        let drawn =
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))";
        self.evaluate(&format!("{drawn}.then(() => true)"), PATIENCE)?;
        let parameters = json!({ "format": "png", "captureBeyondViewport": whole });
        let answer = self.call("Page.captureScreenshot", parameters)?;
        let text = answer["data"].as_str().unwrap_or_default();
        BASE64_STANDARD.decode(text).map_err(|error| Problem::Refused(error.to_string()))
    }

    /// Ends the browser at once, with all its pages.
    pub fn end_browser(&self) {
        self.browser.kill();
    }

    /// Runs any command of the protocol for this page.
    ///
    /// # Errors
    /// The browser's.
    pub fn call(&self, method: &str, parameters: Value) -> Result<Value, Problem> {
        self.browser.call(Some(&self.session), method, parameters, PATIENCE)
    }
}

impl Drop for BrowserPage {
    fn drop(&mut self) {
        // The answer is hardly waited for, since a page that hangs must be closed too.
        let parameters = json!({ "targetId": self.target });
        let _ = self.browser.call(None, "Target.closeTarget", parameters, LOOK);
    }
}

fn exception_text(details: &Value) -> String {
    let description = details["exception"]["description"].as_str();
    let value = || match &details["exception"]["value"] {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    description.map_or_else(value, str::to_owned)
}

/// The error that an event reports, if it reports one.
fn error_of_event(event: &Value) -> Option<String> {
    let parameters = &event["params"];
    match event["method"].as_str()? {
        "Runtime.exceptionThrown" => Some(exception_text(&parameters["exceptionDetails"])),
        "Runtime.consoleAPICalled"
            if matches!(parameters["type"].as_str(), Some("error" | "assert")) =>
        {
            let words = parameters["args"].as_array()?.iter().map(|one| {
                let described = one["description"].as_str().or(one["value"].as_str());
                described.map_or_else(|| one["value"].to_string(), str::to_owned)
            });
            Some(words.collect::<Vec<_>>().join(" "))
        }
        "Log.entryAdded" if parameters["entry"]["level"] == "error" => {
            let [text, address] = ["text", "url"].map(|name| parameters["entry"][name].as_str());
            Some([text, address].into_iter().flatten().collect::<Vec<_>>().join(" "))
        }
        _ => None,
    }
}
