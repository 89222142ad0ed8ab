//! The files of pages, which can be read without JavaScript, and how soon they arrive.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use lamplight::LIBRARY_FILES;
use lamplight::browser::{Browser, BrowserPage};
use lamplight::catalogue;
use libtest_mimic::Failed;
use serde_json::{Value, json};

use super::{Opened, Outcome, PATIENCE, site, text, wait, without_errors};

/// The address where the site is published.
const SITE: &str = "https://lamplight-shaders.github.io/lamplight/";

/// Each function and each page of the guide is a file with title, description, canonical address and
/// picture, and is in the site's map. Its links lead to files. It has the same main heading as the
/// page that is live, which keeps its address. Old addresses still open the same pages.
pub fn files() -> Outcome {
    let folder = site()?;
    let modules = catalogue::library_modules(LIBRARY_FILES);
    let items = modules.iter().flat_map(|module| &module.items);
    let mut wanted: Vec<(String, String)> = items
        .map(|item| {
            (format!("functions/{}.html", item.path().replace("::", "/")), item.name.clone())
        })
        .collect();
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide");
    for entry in fs::read_dir(guide)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let Some(name) = name.strip_suffix(".md").filter(|name| *name != "SUMMARY") else {
            continue;
        };
        let name = if name == "README" { "index" } else { name };
        wanted.push((format!("guide/{name}.html"), String::new()));
    }
    let map = fs::read_to_string(folder.join("sitemap.xml"))?;
    let (mut titles, mut count) = (BTreeSet::new(), 0);
    for (file, name) in &wanted {
        let page =
            fs::read_to_string(folder.join(file)).map_err(|error| format!("{file}: {error}"))?;
        described(&page, file, name)?;
        titles.insert(between(&page, "<title>", "</title>").unwrap_or_default().to_owned());
        let is_folder = file == "index.html" || file.ends_with("/index.html");
        let address = if is_folder { file.trim_end_matches("index.html") } else { file };
        assert!(map.contains(&format!("<loc>{SITE}{address}</loc>")), "the map lacks {file}");
        count += linked(&folder, file, &page)?;
    }
    println!("{} files with {count} links", wanted.len());
    // Items of several modules may have the same name.
    assert!(titles.len() > wanted.len() * 4 / 5, "{} titles", titles.len());
    without_script()?;
    live()
}

/// A page says what it is to search engines and to whoever shows a link to it.
fn described(page: &str, file: &str, name: &str) -> Outcome {
    let head = between(page, "<head>", "</head>").ok_or("no head")?;
    let has = |start: &str, end: &str| {
        between(head, start, end).filter(|found| !found.trim().is_empty()).map(str::to_owned)
    };
    let title = has("<title>", "</title>").ok_or_else(|| format!("{file} has no title"))?;
    assert!(title.contains(name), "{file}: the title is `{title}`");
    let description = has("name=\"description\" content=\"", "\"");
    assert!(description.is_some_and(|it| it.len() < 300), "{file} has no description");
    let is_folder = file == "index.html" || file.ends_with("/index.html");
    let address = if is_folder { file.trim_end_matches("index.html") } else { file };
    let canonical = has("rel=\"canonical\" href=\"", "\"");
    assert_eq!(canonical, Some(format!("{SITE}{address}")), "{file}");
    let image = has("property=\"og:image\" content=\"", "\"").unwrap_or_default();
    let image =
        image.strip_prefix(SITE).ok_or_else(|| format!("{file} has no picture"))?.to_owned();
    assert!(site()?.join(&image).is_file(), "{file}: there is no {image}");
    let main = between(page, "<main", "</main>").unwrap_or_default();
    assert!(main.contains("<h1") && main.len() > 200, "{file} has no text");
    Ok(())
}

fn between<'t>(text: &'t str, start: &str, end: &str) -> Option<&'t str> {
    let from = text.find(start)? + start.len();
    let to = text[from..].find(end)? + from;
    Some(&text[from..to])
}

/// How many links a page has to files of the site. Each leads to one.
fn linked(folder: &Path, file: &str, page: &str) -> Result<usize, Failed> {
    let base = folder.join(file);
    let base = base.parent().unwrap_or(folder);
    let mut count = 0;
    for part in page.split("href=\"").skip(1) {
        let to = part.split(['"', '#', '?']).next().unwrap_or_default();
        if to.is_empty() || to.contains("://") || to.starts_with("data:") {
            continue;
        }
        let target = base.join(to);
        assert!(target.is_file(), "{file} links to {to}, which is not there");
        count += 1;
    }
    Ok(count)
}

/// Without JavaScript, a page has its text and its colours, and is not wider than a phone.
fn without_script() -> Outcome {
    let opened = Opened::new()?;
    let page = opened.browser.open("about:blank")?;
    page.call("Emulation.setScriptExecutionDisabled", json!({ "value": true }))?;
    let phone = json!({ "width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": false });
    page.call("Emulation.setDeviceMetricsOverride", phone)?;
    for (file, words) in
        [("functions/brdf/specular/d_ggx.html", "fn d_ggx"), ("guide/cases.html", "Numeric cases")]
    {
        page.go(&opened.server.address(file))?;
        page.loaded(PATIENCE)?;
        let there = format!("document.querySelector('main').textContent.includes('{words}')");
        wait(&page, &there)?;
        assert_eq!(
            page.evaluate("document.querySelectorAll('.tok-keyword').length > 0", PATIENCE)?,
            json!(true)
        );
        let wide = page.evaluate("document.documentElement.scrollWidth", PATIENCE)?;
        assert!(wide.as_u64().is_some_and(|wide| wide <= 390), "{file} is {wide} pixels wide");
    }
    Ok(())
}

/// A file becomes the live page at its address. Links between files need no new document, also back.
fn live() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("functions/brdf/specular/d_ggx.html")?;
    wait(&page, "document.querySelector('.live .curve') !== null")?;
    assert_eq!(
        text(&page, "location.pathname + location.hash")?,
        "/functions/brdf/specular/d_ggx.html"
    );
    page.evaluate("window.same = true", PATIENCE)?;
    let phong = "document.querySelector(\".list a[href$='/specular/phong.html']\")";
    page.evaluate(&format!("{phong}.click()"), PATIENCE)?;
    wait(&page, "document.querySelector('article h1')?.textContent === 'phong'")?;
    assert_eq!(text(&page, "location.pathname")?, "/functions/brdf/specular/phong.html");
    page.evaluate("document.querySelector('nav a[href$=\"guide/index.html\"]').click()", PATIENCE)?;
    wait(&page, "document.body.dataset.ready === 'guide'")?;
    page.evaluate("history.go(-2)", PATIENCE)?;
    wait(&page, "document.querySelector('article h1')?.textContent === 'd_ggx'")?;
    assert_eq!(text(&page, "String(window.same)")?, "true", "the document was loaded again");
    // An address of older versions, on a file.
    page.evaluate("location.hash = '#/guide/cases/an-example'", PATIENCE)?;
    wait(&page, "document.querySelector('.guide h1')?.textContent === 'Numeric cases'")?;
    without_errors(&mut page)
}

/// A line of 10 Mbit/s with 40 ms to the server and back.
const LINE: (f64, f64) = (10e6 / 8.0, 40.0);

/// Something is painted before the toolchain is there. When both come on a line of 10 Mbit/s is printed:
/// a second and four are aimed at, with the toolchain as it is published.
pub fn arrival() -> Outcome {
    let opened = Opened::new()?;
    let packed = fs::read_dir(site()?.join("assets"))?
        .filter_map(Result::ok)
        .find(|entry| entry.file_name().to_string_lossy().ends_with(".packed"))
        .ok_or("there is no packed toolchain")?;
    let size = packed.metadata()?.len();
    for address in ["", "functions/brdf/specular/d_ggx.html", "guide/cases.html", "playground.html"]
    {
        let page = Browser::shared()?.open("about:blank")?;
        slow_line(&page)?;
        page.go(&opened.server.address(address))?;
        let painted = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime";
        wait(&page, &format!("{painted} !== undefined"))?;
        let painted = number(&page, painted)?;
        println!("`{address}`: painted after {painted:.0} ms");
        if address.starts_with("guide") {
            continue;
        }
        let ready = "performance.getEntriesByName('toolchain-ready')[0]?.startTime";
        wait(&page, &format!("{ready} !== undefined"))?;
        let ready = number(&page, ready)?;
        println!("`{address}`: the toolchain, {size} bytes packed, is ready after {ready:.0} ms");
        assert!(ready > painted, "`{address}` waits for the toolchain");
    }
    Ok(())
}

fn slow_line(page: &BrowserPage) -> Outcome {
    let (bytes, milliseconds) = LINE;
    page.call("Network.enable", json!({}))?;
    page.call(
        "Network.emulateNetworkConditions",
        json!({
            "offline": false, "latency": milliseconds,
            "downloadThroughput": bytes, "uploadThroughput": bytes,
        }),
    )?;
    Ok(())
}

fn number(page: &BrowserPage, expression: &str) -> Result<f64, Failed> {
    let found: Value = page.evaluate(expression, PATIENCE)?;
    found.as_f64().ok_or_else(|| format!("{expression} is {found}").into())
}
