//! The executors in the browser: a shader that is refused or never ends, a browser that ends while
//! it draws, and no browser at all.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

use lamplight::browser::Browser;
use lamplight::execute::web::{Api, Web};
use lamplight::execute::{Session as _, kernel, on_thread};
use libtest_mimic::{Failed, Trial};

use super::Outcome;

const APIS: [Api; 2] = [Api::WebGpu, Api::WebGl2];

/// Enough for a draw, and over soon.
const SHORT: Duration = Duration::from_secs(4);

pub fn trials() -> Vec<Trial> {
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
        other => Err(format!("{other:?}").into()),
    }
}

/// What naga takes and a browser does not is told in the browser's words, and others run.
fn a_shader_is_refused() -> Outcome {
    // WGSL: derivatives are taken in uniform control flow. GLSL ES: vertices and fragments have no
    // room for so many numbers.
    let texts = [
        (
            Api::WebGpu,
            "fn f(x: f32) -> f32 { if x > 1.0 { return dpdx(x); } return 0.0; }",
            "uniform",
        ),
        (
            Api::WebGl2,
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
            other => return Err(format!("{api:?}: {other:?}").into()),
        }
        doubles(&mut web)?;
    }
    Ok(())
}

/// A shader that never ends is given up in time, and the one after it runs in another browser.
fn a_shader_never_ends() -> Outcome {
    // An odd number is never zero.
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
            found => return Err(format!("{api:?}: {found:?}").into()),
        }
        assert!(started.elapsed() < 3 * SHORT, "{api:?}: {:?}", started.elapsed());
        doubles(&mut web)?;
    }
    Ok(())
}

/// Where the process that draws ends, the next draw gets another.
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
        // It has no answer: what would give it is gone.
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

/// Without a browser the command says what to install.
fn no_browser() -> Outcome {
    let nothing = tempfile::tempdir()?;
    for executor in ["webgpu", "webgl2"] {
        let mut command = lamplight(&["check", "lighting/spot", "--executor", executor]);
        let said = command.env("PATH", nothing.path()).output()?;
        let words = String::from_utf8_lossy(&said.stderr);
        assert_eq!(said.status.code(), Some(4), "{words}");
        for expected in ["`chromium` is not installed", "apt-get install chromium"] {
            assert!(words.contains(expected), "{words}");
        }
    }
    Ok(())
}

/// Killed in the middle of its work, the command leaves neither a browser nor its folder behind.
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
    assert!(within("", false), "something stays in {}", folder.path().display());
    Ok(())
}
