//! The executors that run in the browser, when something goes wrong: the browser refuses a shader,
//! a shader never ends, the browser's GPU process ends, or there is no browser at all.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

use lamplight::browser::Browser;
use lamplight::execute::web::{Web, WebApi};
use lamplight::execute::{Session as _, kernel, on_thread};
use libtest_mimic::{Failed, Trial};

use super::Outcome;

const APIS: [WebApi; 2] = [WebApi::WebGpu, WebApi::WebGl2];

/// Long enough for a draw, and short enough to wait for a draw that never ends.
const SHORT: Duration = Duration::from_secs(4);

pub fn tests() -> Vec<Trial> {
    let threaded = |run: fn() -> Outcome| {
        move || {
            let words = |failed: Failed| failed.message().unwrap_or_default().to_owned();
            on_thread(|| run().map_err(words)).ok_or("panicked")?.map_err(Failed::from)
        }
    };
    vec![
        Trial::test("browser::a_shader_is_refused", threaded(a_shader_is_refused)),
        Trial::test("browser::a_shader_never_ends", threaded(a_shader_never_ends)),
        Trial::test("browser::the_device_is_lost", threaded(the_device_is_lost)),
        Trial::test("browser::no_browser", no_browser),
        Trial::test("browser::nothing_stays", nothing_stays),
    ]
}

fn built(text: &str, function: &str) -> Result<kernel::Kernel, Failed> {
    let module = naga::front::wgsl::parse_str(text)?;
    kernel::build_kernel(&module, function, &BTreeMap::new()).map_err(|error| error.message.into())
}

/// A kernel that every session can run.
fn doubled() -> Result<kernel::Kernel, Failed> {
    built("fn doubled(x: u32) -> u32 { return x * 2u; }", "doubled")
}

fn doubles(web: &mut Web) -> Outcome {
    match web.run(&doubled()?, &[1, 2, 21]).map_err(|error| error.message)?.as_slice() {
        [2, 4, 42] => Ok(()),
        other => Err(format!("twice 1, 2 and 21: expected [2, 4, 42], found {other:?}").into()),
    }
}

/// If naga accepts a shader and the browser refuses it, the error has the browser's own message.
/// Other shaders still run in the same session.
fn a_shader_is_refused() -> Outcome {
    // In WGSL, derivatives must be in uniform control flow. In GLSL ES, the uniform block is larger
    // than a stage may have.
    let texts = [
        (
            WebApi::WebGpu,
            "fn f(x: f32) -> f32 { if x > 1.0 { return dpdx(x); } return 0.0; }",
            "uniform",
        ),
        (
            WebApi::WebGl2,
            "@group(0) @binding(9) var<uniform> all: array<vec4f, 100000>;
             fn f(x: f32) -> f32 { return all[u32(x)].x; }",
            "the emitted text",
        ),
    ];
    for (api, text, words) in texts {
        let mut web = Web::open(api)?;
        let kernel = built(text, "f")?;
        web.prepare(&[&doubled()?, &kernel]);
        match web.run(&kernel, &[0]) {
            Err(error) if error.message.contains(words) => {}
            other => {
                let what = format!("{api:?}: expected a refusal with `{words}`, found {other:?}");
                return Err(what.into());
            }
        }
        doubles(&mut web)?;
    }
    Ok(())
}

/// A shader that never ends is given up after the time limit, and the next shader runs in a new
/// browser.
fn a_shader_never_ends() -> Outcome {
    // `y` stays odd, so it never becomes zero and the loop does not end.
    let text = "fn f(x: u32) -> u32 {
        var y = x;
        loop { y = (y + 2u) | 1u; if y == 0u { break; } }
        return y;
    }";
    for api in APIS {
        let mut web = Web::open_in(Box::new(Browser::start), api, SHORT)?;
        let started = Instant::now();
        match web.run(&built(text, "f")?, &[2]) {
            Err(error) if error.message.contains("did not answer") => {}
            found => {
                return Err(format!("{api:?}: expected `did not answer`, found {found:?}").into());
            }
        }
        let took = started.elapsed();
        assert!(took < 3 * SHORT, "{api:?}: giving up a shader that never ends took {took:?}");
        doubles(&mut web)?;
    }
    Ok(())
}

/// If the browser's GPU process ends, the next draw starts another one.
fn the_device_is_lost() -> Outcome {
    for api in APIS {
        let known: Arc<Mutex<Weak<Browser>>> = Arc::default();
        let noted = Arc::clone(&known);
        let start = move || {
            let browser = Browser::start()?;
            *noted.lock().unwrap() = Arc::downgrade(&browser);
            Ok(browser)
        };
        let mut web = Web::open_in(Box::new(start), api, SHORT)?;
        doubles(&mut web)?;
        let browser = known.lock().unwrap().upgrade().ok_or("the browser is not kept")?;
        // This command has no answer: the process that would send it has ended.
        let _ = browser.command("Browser.crashGpuProcess", serde_json::json!({}));
        drop(browser);
        doubles(&mut web).map_err(|error| format!("{api:?}: {error:?}"))?;
    }
    Ok(())
}

fn lamplight(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.args(arguments).stdin(Stdio::null());
    command
}

/// Without a browser, the command ends with exit code 4 and says what to install.
fn no_browser() -> Outcome {
    let nothing = tempfile::tempdir()?;
    for executor in ["webgpu", "webgl2"] {
        let mut command = lamplight(&["check", "lighting/spot", "--executor", executor]);
        let output = command.env("PATH", nothing.path()).output()?;
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(4), "{words}");
        for expected in ["`chromium` is not installed", "apt-get install chromium"] {
            assert!(words.contains(expected), "{executor}: expected `{expected}` in:\n{words}");
        }
    }
    Ok(())
}

/// A command that is killed while it works leaves neither a browser nor the browser's folder behind.
fn nothing_stays() -> Outcome {
    let folder = tempfile::tempdir()?;
    let holds = |what: &str| {
        let entries = std::fs::read_dir(folder.path()).into_iter().flatten().flatten();
        entries.into_iter().any(|entry| what.is_empty() || Path::exists(&entry.path().join(what)))
    };
    let within = |what: &str, wanted: bool| {
        let started = Instant::now();
        while holds(what) != wanted && started.elapsed() < 6 * SHORT {
            std::thread::sleep(Duration::from_millis(10));
        }
        holds(what) == wanted
    };
    let mut command = lamplight(&["eval", "--executor", "webgl2"]);
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .env("TMPDIR", folder.path())
        .spawn()?;
    assert!(within("profile", true), "no browser was started");
    child.kill()?;
    child.wait()?;
    assert!(within("", false), "the browser's files stay in {}", folder.path().display());
    Ok(())
}
