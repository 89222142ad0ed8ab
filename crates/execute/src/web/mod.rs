//! Runs emitted WGSL and GLSL ES unchanged in a page of a browser, on WebGPU and WebGL2.
//!
//! The page's script (`webgpu.js`, `webgl2.js`) keeps kernels and draws. Its arguments and results
//! are JSON, with textures and words as base64. A page that is lost is opened again. So a kernel
//! that crashes its page fails, and the kernels after it still run.

mod asked;
mod frames;

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};

use super::emitted;
use super::frame::{Drawing, Frame};
use super::gpu::run_batches;
use super::kernel::{Kernel, kernels_to_compile};
use super::{Session, ShippedPair, executor_failed};
use lamplight_bundle::Target;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_tools::browser::serve::{HttpServer, ServedFiles};
use lamplight_tools::browser::{Browser, BrowserPage, PATIENCE, Problem};
use lamplight_validate::on_large_stack;

/// The longest wait for one draw, or for compiling some kernels.
const LONGEST: Duration = Duration::from_secs(60);
/// How many kernels are compiled at once.
const AT_ONCE: usize = 32;

const COMMON: &str = include_str!("common.js");

/// An interface that a page offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WebApi {
    WebGpu,
    WebGl2,
}

impl WebApi {
    fn name(self) -> &'static str {
        match self {
            Self::WebGpu => "WebGPU",
            Self::WebGl2 => "WebGL2",
        }
    }

    fn target(self) -> Target {
        match self {
            Self::WebGpu => Target::WGSL,
            Self::WebGl2 => Target::ESSL300,
        }
    }

    fn script(self) -> &'static str {
        match self {
            Self::WebGpu => include_str!("webgpu.js"),
            Self::WebGl2 => include_str!("webgl2.js"),
        }
    }
}

/// Starts the browser of a session.
pub type Start = Box<dyn Fn() -> Result<Arc<Browser>, Problem> + Send>;

/// A session: a page, which is opened again if it is lost.
pub struct Web {
    api: WebApi,
    start: Start,
    server: HttpServer,
    patience: Duration,
    adapter: String,
    state: Mutex<WebState>,
}

#[derive(Default)]
struct WebState {
    page: Option<BrowserPage>,
    /// The kernels that the page has compiled, or why it could not.
    kept: HashMap<u64, Result<(), Diagnostic>>,
}

/// An answer of the script.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Answer {
    Value(Value),
    /// What is needed and not supported here, as a message.
    Lacks(String),
    /// What went wrong with one kernel or frame.
    Error(String),
    /// The device was lost, and everything on it.
    Lost(String),
}

impl Web {
    /// Opens a page.
    ///
    /// # Errors
    /// A message: there is no browser, or it does not have the interface.
    pub fn open(api: WebApi) -> Result<Self, String> {
        Self::open_in(Box::new(Browser::shared), api, LONGEST)
    }

    /// Opens a page of a browser, which may take `patience` for each answer.
    ///
    /// # Errors
    /// Those of [`Self::open`].
    pub fn open_in(start: Start, api: WebApi, patience: Duration) -> Result<Self, String> {
        let page = "<!doctype html><title>kernels</title><link rel=icon href=data:,>
            <script src=common.js></script><script src=script.js></script>";
        let files = [("index.html", page), ("common.js", COMMON), ("script.js", api.script())];
        let files = files.map(|(path, text)| (path.to_owned(), text.as_bytes().to_vec()));
        let server = HttpServer::start(ServedFiles::Memory(BTreeMap::from(files)));
        let server = server.map_err(|error| format!("nothing can be served: {error}"))?;
        let state = Mutex::default();
        let mut web = Self { api, start, server, patience, adapter: String::new(), state };
        let (page, adapter) = web.opened().map_err(|problem| problem.to_string())?;
        web.adapter = adapter;
        web.state = Mutex::new(WebState { page: Some(page), ..WebState::default() });
        Ok(web)
    }

    /// Opens a page and its device; also returns the device's name.
    fn opened(&self) -> Result<(BrowserPage, String), Problem> {
        let browser = (self.start)()?;
        let page = browser.open(&self.server.address(""))?;
        page.loaded(PATIENCE)?;
        let device = page.evaluate("lamplight.open()", PATIENCE)?;
        let device = device.as_str().unwrap_or_default();
        let adapter = format!("{}, {} on {device}", browser.version(), self.api.name());
        Ok((page, adapter))
    }

    /// Asks the script. If the page is lost, it is closed.
    fn ask(&self, state: &mut WebState, call: &str) -> Result<Value, WebFailure> {
        let page = match &state.page {
            Some(page) => page,
            None => {
                let (page, _) = self.opened().map_err(WebFailure::lost)?;
                state.page.insert(page)
            }
        };
        let answer = page.evaluate(call, self.patience).and_then(|answer| {
            serde_json::from_value(answer).map_err(|error| Problem::Refused(error.to_string()))
        });
        let failure = match answer {
            Ok(Answer::Value(value)) => return Ok(value),
            Ok(Answer::Lacks(words)) => {
                return Err(WebFailure::Of(Diagnostic::error(codes::EXECUTOR_LACKS, words)));
            }
            Ok(Answer::Error(words)) => return Err(WebFailure::Of(executor_failed(words))),
            Err(Problem::Threw(words)) => return Err(WebFailure::Of(executor_failed(words))),
            Ok(Answer::Lost(words)) => WebFailure::Lost(executor_failed(words)),
            // A page that was slow once is slow again. Its work may continue in the process that
            // draws for all pages, where nothing stops it but the end of the browser.
            Err(problem @ Problem::Late { .. }) => {
                page.end_browser();
                WebFailure::Of(executor_failed(problem.to_string()))
            }
            Err(problem) => WebFailure::lost(problem),
        };
        *state = WebState::default();
        Err(failure)
    }

    /// Runs a job, and runs it once more if the page is lost: another page may have caused that.
    fn twice<T>(
        &self,
        mut job: impl FnMut(&Self, &mut WebState) -> Result<T, WebFailure>,
    ) -> Result<T, Diagnostic> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let result = match job(self, &mut state) {
            Err(WebFailure::Lost(_)) => job(self, &mut state),
            other => other,
        };
        result.map_err(|failure| match failure {
            WebFailure::Of(error) | WebFailure::Lost(error) => error,
        })
    }

    /// Gives the page the kernels that are new to it, some at a time.
    fn compile(&self, state: &mut WebState, kernels: &[&Kernel]) -> Result<(), WebFailure> {
        let new = kernels_to_compile(kernels, |code| state.kept.contains_key(&code));
        let target = self.api.target();
        for some in new.chunks(AT_ONCE) {
            let emit = |kernel: &&Kernel| {
                asked::kernel_json(kernel, &emitted::emit_kernel(kernel, target)?)
            };
            let made: Vec<Result<Value, Diagnostic>> =
                on_large_stack(|| some.par_iter().map(emit).collect());
            let texts: Vec<&Value> = made.iter().flatten().collect();
            let said = match texts.is_empty() {
                true => Value::Array(Vec::new()),
                false => self.ask(state, &format!("lamplight.prepare({})", json!(texts)))?,
            };
            let said: Vec<Answer> = serde_json::from_value(said)
                .map_err(|error| WebFailure::Of(executor_failed(error.to_string())))?;
            if let Some(Answer::Lost(words)) =
                said.iter().find(|one| matches!(one, Answer::Lost(_)))
            {
                let lost = executor_failed(words.clone());
                *state = WebState::default();
                return Err(WebFailure::Lost(lost));
            }
            let mut said = said.into_iter();
            for (kernel, made) in some.iter().zip(&made) {
                let result =
                    made.as_ref().map_err(Clone::clone).and_then(|_| check_kept(said.next()));
                state.kept.insert(kernel.code, result);
            }
        }
        Ok(())
    }

    /// One draw: the words of the target.
    fn draw(&self, kernel: &Kernel, texels: &[u32], rows: u32) -> Result<Vec<u32>, Diagnostic> {
        let texels = asked::base64_of_words(texels);
        let question = json!({ "id": kernel.code, "rows": rows, "texels": texels });
        let call = format!("lamplight.run({question})");
        let said = self.twice(|web, state| {
            web.compile(state, &[kernel])?;
            match state.kept.get(&kernel.code) {
                Some(Err(error)) => Err(WebFailure::Of(error.clone())),
                _ => web.ask(state, &call),
            }
        })?;
        asked::words_of_answer(&said).map_err(executor_failed)
    }
}

impl Session for Web {
    fn adapter(&self) -> String {
        self.adapter.clone()
    }

    fn prepare(&mut self, kernels: &[&Kernel]) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        // If the page is lost over some of them, each is tried by itself when it is run.
        let _ = self.compile(&mut state, kernels);
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        run_batches(kernel, inputs, |texels, rows| self.draw(kernel, texels, rows))
    }

    fn draw_shipped(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        let question = frames::frames_question(self.api, pair, drawing)?;
        let call = format!("lamplight.frames({question})");
        let said = self.twice(|web, state| web.ask(state, &call))?;
        frames::frames_answer(&said).map_err(executor_failed)
    }
}

/// Whether the page has a kernel, or why not.
fn check_kept(said: Option<Answer>) -> Result<(), Diagnostic> {
    match said {
        Some(Answer::Value(_)) => Ok(()),
        Some(Answer::Lacks(words)) => Err(Diagnostic::error(codes::EXECUTOR_LACKS, words)),
        Some(Answer::Error(words) | Answer::Lost(words)) => Err(executor_failed(words)),
        None => Err(executor_failed("the page has forgotten a kernel")),
    }
}

/// Why there is no answer.
enum WebFailure {
    /// Because of what was asked.
    Of(Diagnostic),
    /// Because the page was lost, perhaps through another page.
    Lost(Diagnostic),
}

impl WebFailure {
    fn lost(problem: Problem) -> Self {
        Self::Lost(executor_failed(problem.to_string()))
    }
}
