//! The browser that trials and executors drive: what pages compute, say and show, and what is told
//! where a page hangs or crashes, or where there is no browser.

mod executors;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lamplight::browser::serve::{Files, Server};
use lamplight::browser::{Browser, PATIENCE, Problem, Screenshot};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn trials() -> Vec<Trial> {
    let cases: [Case; 6] = [
        ("pages", pages),
        ("errors_are_read", errors_are_read),
        ("folders_are_served", folders_are_served),
        ("a_page_hangs", a_page_hangs),
        ("a_page_crashes", a_page_crashes),
        ("missing", missing),
    ];
    let own = cases.into_iter().map(|(name, case)| Trial::test(format!("browser::{name}"), case));
    own.chain(executors::trials()).collect()
}

/// Long enough for what is at hand, and short enough for what never comes.
const SHORT: Duration = Duration::from_millis(500);

fn served(files: &[(&str, &str)]) -> std::io::Result<Server> {
    let own = |(path, text): &(&str, &str)| ((*path).to_owned(), text.as_bytes().to_vec());
    Server::start(Files::Memory(files.iter().map(own).collect::<BTreeMap<_, _>>()))
}

/// A page computes, has WebGPU and WebGL2, and is seen as wide as asked for.
fn pages() -> Outcome {
    let server = served(&[(
        "index.html",
        "<!doctype html><title>t</title><link rel=icon href=data:,><body style='margin:0;background:#ff0000'>
         <script>setTimeout(() => { document.title = 'ready'; }, 50)</script>",
    )])?;
    let browser = Browser::shared()?;
    let mut page = browser.open(&server.address(""))?;
    page.loaded(PATIENCE)?;
    page.until("document.title === 'ready'", PATIENCE)?;
    assert_eq!(page.evaluate("Promise.resolve([6 * 7])", PATIENCE)?, serde_json::json!([42]));
    let both = "isSecureContext && !!navigator.gpu
        && !!document.createElement('canvas').getContext('webgl2')";
    assert_eq!(page.evaluate(both, PATIENCE)?, serde_json::json!(true));
    for width in [360, 800] {
        let shot = page.screenshot(Screenshot { width, height: 300, whole: false })?;
        let picture = image::load_from_memory(&shot)?.into_rgb8();
        assert_eq!(picture.dimensions(), (width, 300));
        assert!(picture.pixels().all(|pixel| pixel.0 == [255, 0, 0]));
    }
    assert_eq!(page.errors(), &[] as &[String]);
    Ok(())
}

/// Whatever a page complains of is known to who drives it.
fn errors_are_read() -> Outcome {
    let server = served(&[(
        "index.html",
        "<!doctype html><link rel=icon href=data:,><script src='nowhere.js'></script>
         <script>console.error('one', 2); throw new Error('three');</script>",
    )])?;
    let mut page = Browser::shared()?.open(&server.address("index.html"))?;
    page.loaded(PATIENCE)?;
    let errors = page.errors().join("\n");
    for expected in ["one 2", "Error: three", "nowhere.js"] {
        assert!(errors.contains(expected), "no `{expected}` in {errors}");
    }
    match page.evaluate("missing.something", PATIENCE) {
        Err(Problem::Threw(words)) if words.contains("missing is not defined") => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}

/// Everything below a folder is there, and nothing above it.
fn folders_are_served() -> Outcome {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("secret.txt"), "secret")?;
    let site = folder.path().join("site");
    std::fs::create_dir_all(site.join("a b"))?;
    std::fs::write(site.join("a b/index.html"), "<!doctype html><title>found</title>")?;
    let server = Server::start(Files::Folder(site))?;
    let page = Browser::shared()?.open(&server.address("a%20b/"))?;
    page.until("document.title === 'found'", PATIENCE)?;
    for path in ["nothing.html", "..%2fsecret.txt", "a%20b/..%2f..%2fsecret.txt"] {
        let status =
            page.evaluate(&format!("fetch('/{path}').then((it) => it.status)"), PATIENCE)?;
        assert_eq!(status, serde_json::json!(404), "{path}");
    }
    Ok(())
}

/// A page that never answers is given up in time, and others go on.
fn a_page_hangs() -> Outcome {
    let browser = Browser::shared()?;
    let (page, other) = (browser.open("about:blank")?, browser.open("about:blank")?);
    let started = Instant::now();
    match page.evaluate("for (;;) {}", SHORT) {
        Err(Problem::Late { after: SHORT, .. }) => {}
        found => return Err(format!("{found:?}").into()),
    }
    match page.until("false", SHORT) {
        Err(Problem::Late { .. }) => {}
        found => return Err(format!("{found:?}").into()),
    }
    drop(page);
    assert!(started.elapsed() < 10 * SHORT, "{:?}", started.elapsed());
    assert_eq!(other.evaluate("1", PATIENCE)?, serde_json::json!(1));
    Ok(())
}

/// A page whose process ends is told apart from one that is slow, and others go on.
fn a_page_crashes() -> Outcome {
    let browser = Browser::shared()?;
    let (page, other) = (browser.open("about:blank")?, browser.open("about:blank")?);
    assert_eq!(page.call("Page.crash", serde_json::json!({})), Err(Problem::Crashed));
    assert_eq!(page.evaluate("1", PATIENCE), Err(Problem::Crashed));
    assert_eq!(other.evaluate("1", PATIENCE)?, serde_json::json!(1));
    Ok(())
}

/// What is no browser is told, whether it is absent or something else.
fn missing() -> Outcome {
    match Browser::start_as("no-such-browser") {
        Err(Problem::Missing(words)) if words.contains("`no-such-browser` is not installed") => {}
        found => return Err(format!("{found:?}").into()),
    }
    match Browser::start_as("false") {
        Err(Problem::Missing(words)) if words.contains("`false` does not start") => Ok(()),
        found => Err(format!("{found:?}").into()),
    }
}
