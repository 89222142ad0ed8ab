//! The browser that tests and executors drive. A page can be evaluated, its errors read, and a
//! picture taken of it. A page that hangs or crashes, and a missing browser, each give an error.

mod executors;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, PATIENCE, Problem, Screenshot};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 7] = [
        ("pages", pages),
        ("nothing_is_hidden", nothing_is_hidden),
        ("errors_are_read", errors_are_read),
        ("folders_are_served", folders_are_served),
        ("a_page_hangs", a_page_hangs),
        ("a_page_crashes", a_page_crashes),
        ("missing", missing),
    ];
    let own = cases.into_iter().map(|(name, case)| Trial::test(format!("browser::{name}"), case));
    own.chain(executors::tests()).collect()
}

/// Long enough for a page to answer, and short enough to wait for an answer that never comes.
const SHORT: Duration = Duration::from_millis(500);

fn served(files: &[(&str, &str)]) -> std::io::Result<HttpServer> {
    let own = |(path, text): &(&str, &str)| ((*path).to_owned(), text.as_bytes().to_vec());
    HttpServer::start(ServedFiles::Memory(files.iter().map(own).collect::<BTreeMap<_, _>>()))
}

/// A page evaluates scripts, has WebGPU and WebGL2, and its picture has the width that was asked
/// for. Without this, executors and tests of the site could not use the browser at all.
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
        assert_eq!(picture.dimensions(), (width, 300), "size of the screenshot");
        let other = picture.pixels().find(|pixel| pixel.0 != [255, 0, 0]);
        assert_eq!(other, None, "the page is red, but at width {width} a pixel is not");
    }
    assert_eq!(page.errors(), &[] as &[String]);
    Ok(())
}

/// A page gets animation frames and notices what is in view while other pages are open. A page that
/// the browser takes for hidden would wait for them for ever.
fn nothing_is_hidden() -> Outcome {
    let server = served(&[("index.html", "<!doctype html><link rel=icon href=data:,><p>text")])?;
    let browser = Browser::shared()?;
    let pages = [browser.open(&server.address(""))?, browser.open(&server.address(""))?];
    for page in pages {
        page.loaded(PATIENCE)?;
        let seen = "new Promise((seen) => requestAnimationFrame(() =>
            new IntersectionObserver(([{ isIntersecting }]) => seen(isIntersecting)).observe(document.body)))";
        assert_eq!(page.evaluate(seen, PATIENCE)?, serde_json::json!(true));
    }
    Ok(())
}

/// The caller can read every error of a page: of the console, of exceptions that nobody caught, and
/// of files that could not be loaded. If one were lost, a broken page could pass its test.
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
        assert!(errors.contains(expected), "expected `{expected}` among the errors:\n{errors}");
    }
    match page.evaluate("missing.something", PATIENCE) {
        Err(Problem::Threw(words)) if words.contains("missing is not defined") => Ok(()),
        other => {
            Err(format!("`missing.something`: expected its exception, found {other:?}").into())
        }
    }
}

/// A page can load every file below the served folder, and no file outside of it.
fn folders_are_served() -> Outcome {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("secret.txt"), "secret")?;
    let site = folder.path().join("site");
    std::fs::create_dir_all(site.join("a b"))?;
    std::fs::write(site.join("a b/index.html"), "<!doctype html><title>found</title>")?;
    let server = HttpServer::start(ServedFiles::Folder(site))?;
    let page = Browser::shared()?.open(&server.address("a%20b/"))?;
    page.until("document.title === 'found'", PATIENCE)?;
    for path in ["nothing.html", "..%2fsecret.txt", "a%20b/..%2f..%2fsecret.txt"] {
        let status =
            page.evaluate(&format!("fetch('/{path}').then((it) => it.status)"), PATIENCE)?;
        assert_eq!(status, serde_json::json!(404), "status of `{path}`");
    }
    Ok(())
}

/// A page that never answers is given up after the time limit, and other pages still work.
fn a_page_hangs() -> Outcome {
    let browser = Browser::shared()?;
    let (page, other) = (browser.open("about:blank")?, browser.open("about:blank")?);
    let started = Instant::now();
    match page.evaluate("for (;;) {}", SHORT) {
        Err(Problem::Late { after: SHORT, .. }) => {}
        found => return Err(format!("endless loop: expected `Late`, found {found:?}").into()),
    }
    match page.until("false", SHORT) {
        Err(Problem::Late { .. }) => {}
        found => return Err(format!("until `false`: expected `Late`, found {found:?}").into()),
    }
    drop(page);
    assert!(started.elapsed() < 10 * SHORT, "giving up took {:?}", started.elapsed());
    assert_eq!(other.evaluate("1", PATIENCE)?, serde_json::json!(1));
    Ok(())
}

/// A page whose process ended gives another error than a slow page, and other pages still work.
fn a_page_crashes() -> Outcome {
    let browser = Browser::shared()?;
    let (page, other) = (browser.open("about:blank")?, browser.open("about:blank")?);
    assert_eq!(page.call("Page.crash", serde_json::json!({})), Err(Problem::Crashed));
    assert_eq!(page.evaluate("1", PATIENCE), Err(Problem::Crashed));
    assert_eq!(other.evaluate("1", PATIENCE)?, serde_json::json!(1));
    Ok(())
}

/// The error names the program that was expected to be a browser, whether the program is missing or
/// is not a browser (`false` ends at once).
fn missing() -> Outcome {
    match Browser::start_as("no-such-browser") {
        Err(Problem::Missing(words)) if words.contains("`no-such-browser` is not installed") => {}
        found => {
            return Err(format!("expected `is not installed`, found {:?}", found.err()).into());
        }
    }
    match Browser::start_as("false") {
        Err(Problem::Missing(words)) if words.contains("`false` does not start") => Ok(()),
        found => Err(format!("expected `does not start`, found {:?}", found.err()).into()),
    }
}
