//! Links that somebody crafted, in `links.toml`.

use std::time::Duration;

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use flate2::{Compress, Compression, FlushCompress};
use lamplight::browser::BrowserPage;
use libtest_mimic::Failed;
use serde::Deserialize;
use serde_json::{Value, json};

use super::{Opened, Outcome, PATIENCE, text, without_errors};

/// The most seconds of processor time that the page itself, which cannot be used meanwhile, spends on
/// a link, on a machine that needs `FIXED_SECONDS` for `FIXED_WORK`. Slower ones get more.
const LIMIT: f64 = 2.0;

/// Work of the same amount on every machine.
const FIXED_WORK: &str = "let sum = 0; for (let i = 0; i < 3e8; i++) sum = (sum * 31 + i) | 0; sum";

/// The seconds of processor time that `FIXED_WORK` takes on an idle core of 3 GHz.
const FIXED_SECONDS: f64 = 0.4;

/// How often a link that took too long is followed again. The shortest time counts: other tests
/// share the caches and the clock of the processor.
const AGAIN: usize = 2;

/// Within this time the page answers, also on a machine that runs other tests.
const BUSY: Duration = Duration::from_secs(10);

/// The fewest links in the table.
const LINKS: usize = 60;

/// The most bytes of a repeated text that are compressed at once.
const CHUNK: usize = 16 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    link: Vec<Link>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Link {
    hash: Option<Parts>,
    state: Option<Parts>,
    bytes: Option<Vec<u8>>,
    #[serde(default)]
    cut: usize,
    #[serde(default)]
    more: String,
    says: String,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Parts {
    One(String),
    Several(Vec<Part>),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Part {
    Text(String),
    Repeated(String, usize),
}

impl Part {
    fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Repeated(text, times) if text.contains('#') => {
                (0..*times).map(|index| text.replace('#', &index.to_string())).collect()
            }
            Self::Repeated(text, times) => text.repeat(*times),
        }
    }

    /// The part as blocks of DEFLATE that refer to nothing before them, so that those of a text that
    /// is repeated hundreds of millions of times are made once.
    fn blocks(&self) -> Result<Vec<u8>, Failed> {
        let Self::Repeated(text, times) = self else { return blocks(self.text().as_bytes()) };
        let at_once = CHUNK / text.len();
        if text.contains('#') || *times <= at_once {
            return blocks(self.text().as_bytes());
        }
        let mut packed = blocks(text.repeat(at_once).as_bytes())?.repeat(times / at_once);
        packed.extend(blocks(text.repeat(times % at_once).as_bytes())?);
        Ok(packed)
    }
}

impl Parts {
    fn all(&self) -> Vec<Part> {
        match self {
            Self::One(text) => vec![Part::Text(text.clone())],
            Self::Several(parts) => parts
                .iter()
                .map(|part| match part {
                    Part::Text(text) => Part::Text(text.clone()),
                    Part::Repeated(text, times) => Part::Repeated(text.clone(), *times),
                })
                .collect(),
        }
    }
}

impl Link {
    fn hash(&self) -> Result<String, Failed> {
        let mut packed = Vec::new();
        match (&self.hash, &self.state, &self.bytes) {
            (Some(hash), None, None) => return Ok(hash.all().iter().map(Part::text).collect()),
            (None, Some(state), None) => {
                for part in state.all() {
                    packed.extend(part.blocks()?);
                }
            }
            (None, None, Some(bytes)) => packed = blocks(bytes)?,
            _ => return Err("a link has one of `hash`, `state` and `bytes`".into()),
        }
        // A last block without anything.
        packed.extend([3, 0]);
        let mut text = BASE64_URL_SAFE_NO_PAD.encode(packed);
        text.truncate(text.len().saturating_sub(self.cut));
        Ok(format!("/playground?state={text}{}", self.more))
    }

    /// The link, as far as somebody needs it to find it in the table.
    fn name(&self, hash: &str) -> String {
        format!("#{}, which says `{}`", hash.chars().take(60).collect::<String>(), self.says)
    }
}

/// Bytes as blocks of DEFLATE, the last of which is not the last of the text.
fn blocks(bytes: &[u8]) -> Result<Vec<u8>, Failed> {
    let mut made = Vec::with_capacity(bytes.len() / 100 + 1024);
    let mut compress = Compress::new(Compression::best(), false);
    loop {
        let read = usize::try_from(compress.total_in())?;
        let room = made.capacity();
        compress.compress_vec(&bytes[read..], &mut made, FlushCompress::Full)?;
        if usize::try_from(compress.total_in())? == bytes.len() && made.len() < room {
            return Ok(made);
        }
        made.reserve(made.capacity());
    }
}

/// The page answers each link within two seconds of its time, with a message or a page, and goes on:
/// nothing fails that it does not catch. All links are opened one after
/// another, so each finds a page that bore those before it.
pub fn links() -> Outcome {
    let table: Table = toml::from_str(include_str!("links.toml"))?;
    assert!(table.link.len() >= LINKS, "the table has {} links", table.link.len());
    let opened = Opened::new()?;
    let mut page = opened.page("#/catalogue")?;
    // The toolchain reads the library for the first of these pages, whatever the link.
    for first in ["#/programs/forward", "#/playground"] {
        page.evaluate(&format!("location.hash = '{first}'"), PATIENCE)?;
        page.until("document.body.dataset.ready !== undefined", PATIENCE)?;
    }
    page.call("Performance.enable", json!({ "timeDomain": "threadTicks" }))?;
    let mut wrong = Vec::new();
    for link in &table.link {
        let hash = link.hash()?;
        if let Err(problem) = followed_in_time(&mut page, link, &hash) {
            let reason = problem.message().unwrap_or_default();
            wrong.push(format!("{}: {reason}", link.name(&hash)));
        }
    }
    assert!(wrong.is_empty(), "{} links:\n{}", wrong.len(), wrong.join("\n"));
    page.evaluate("location.hash = '#/catalogue/brdf::specular::blinn_phong'", PATIENCE)?;
    page.until("document.querySelector('article h1')?.textContent === 'blinn_phong'", PATIENCE)?;
    without_errors(&mut page)
}

/// Seconds of processor time that the page has spent.
fn spent(page: &BrowserPage) -> Result<f64, Failed> {
    let answer = page.call("Performance.getMetrics", json!({}))?;
    let metrics = answer["metrics"].as_array().ok_or("no metrics")?;
    let found = metrics.iter().find(|one| one["name"] == "TaskDuration");
    Ok(found.and_then(|one| one["value"].as_f64()).ok_or("no duration of tasks")?)
}

/// How much slower this machine is, now, than the one `LIMIT` is for.
fn slowness(page: &mut BrowserPage) -> Result<f64, Failed> {
    let before = spent(page)?;
    page.evaluate(FIXED_WORK, PATIENCE)?;
    Ok(((spent(page)? - before) / FIXED_SECONDS).max(1.0))
}

fn followed_in_time(page: &mut BrowserPage, link: &Link, hash: &str) -> Outcome {
    let mut shortest = followed(page, link, hash)?;
    let mut allowed = LIMIT;
    for _ in 0..AGAIN {
        if shortest <= allowed {
            return Ok(());
        }
        page.evaluate("location.hash = '#/catalogue'", PATIENCE)?;
        page.until("document.body.dataset.ready !== undefined", PATIENCE)?;
        shortest = shortest.min(followed(page, link, hash)?);
        allowed = LIMIT * slowness(page)?;
    }
    if shortest <= allowed {
        return Ok(());
    }
    Err(format!("it took the page {shortest:.1} s, and {allowed:.1} s are allowed").into())
}

/// Opens a link, and waits until the page has answered what it should. Returns the seconds of
/// processor time of that.
fn followed(page: &mut BrowserPage, link: &Link, hash: &str) -> Result<f64, Failed> {
    let open = format!(
        "(async () => {{
            const before = document.querySelector('main');
            const start = performance.now();
            location.hash = {};
            const isThere = () => {{
                const main = document.querySelector('main');
                return main !== before && main.firstElementChild !== null;
            }};
            while (!isThere() && performance.now() < start + 60000) await new Promise((next) => setTimeout(next, 5));
            return Math.round(performance.now() - start);
        }})()",
        Value::from(hash)
    );
    let before = spent(page)?;
    let answered = page.evaluate(&open, PATIENCE)?.as_u64().ok_or("no time")?;
    let says = format!(
        "document.querySelector('main').textContent.includes({})",
        Value::from(&*link.says)
    );
    page.until(&says, Duration::from_secs(15)).map_err(|_| {
        let found =
            page.evaluate("document.querySelector('main').textContent.slice(0, 600)", PATIENCE);
        format!("the page says {}", found.unwrap_or_default())
    })?;
    page.until("document.body.dataset.ready !== undefined", Duration::from_secs(30))?;
    let spent = spent(page)? - before;
    let failed = text(page, "document.querySelector('#notice').textContent")?;
    let errors = page.errors().join("; ");
    match () {
        () if u128::from(answered) > BUSY.as_millis() => {
            Err(format!("answered after {answered} ms").into())
        }
        () if !failed.is_empty() => Err(format!("the page says {failed}").into()),
        () if !errors.is_empty() => Err(format!("errors: {errors}").into()),
        () => Ok(spent),
    }
}
