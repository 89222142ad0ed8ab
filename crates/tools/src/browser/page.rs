//! One page: evaluates scripts in it, reads its errors, and takes pictures.

use std::sync::Arc;
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

use super::{Browser, PATIENCE, Problem};

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
        let mut said = self.browser.call(Some(&self.session), method, parameters, patience)?;
        match said.get("exceptionDetails") {
            Some(details) => Err(Problem::Threw(exception_text(details))),
            None => Ok(said["result"]["value"].take()),
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
        let said = self.call("Page.captureScreenshot", parameters)?;
        let text = said["data"].as_str().unwrap_or_default();
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

/// The exception as one text.
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
