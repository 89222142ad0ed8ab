//! The playground.

use std::collections::BTreeMap;
use std::process::Command;
use std::time::Instant;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use lamplight::browser::BrowserPage;
use libtest_mimic::Failed;
use serde_json::{Value, json};

use super::keys::press;
use super::{Opened, Outcome, PATIENCE, text, wait, without_errors};

const VALUE: &str = "document.querySelector('.eval output').textContent";
const FIRST_OUTPUT: &str = "document.querySelector('.texts pre')?.textContent";
const DRAWN: &str = "document.querySelector('.sketch canvas')?.dataset.drawn";

/// The playground shows outputs, a value and a picture for its first text, and underlines a mistake
/// that is typed, at its column. Nothing that was typed is lost. The toolchain is replaced if it
/// hangs.
pub fn playground() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/playground")?;
    wait(&page, &format!("{FIRST_OUTPUT}?.includes('fn lambert')"))?;
    wait(&page, &format!("{VALUE} === '0.25'"))?;
    wait(&page, &format!("{DRAWN} !== undefined"))?;
    taken_by_the_command_line(&page)?;
    page.evaluate(&typed("let n =", " let m = nowhere(n);"), PATIENCE)?;
    let mark = "document.querySelector('.cm-lintRange-error')?.textContent";
    wait(&page, &format!("{mark} === 'nowhere'"))?;
    let problem = text(&page, "document.querySelector('.problems').textContent")?;
    assert!(problem.contains("lit.wesl:7:40: "), "expected lit.wesl:7:40 in `{problem}`");
    kept(&opened, &page)?;
    too_large(&page)?;
    replaced(&page)?;
    without_errors(&mut page)?;
    helped()?;
    examples()
}

/// Names are completed, and an import is added; Format lays the text out. While a text has a mistake,
/// its picture is marked as old.
fn helped() -> Outcome {
    // A server of its own has no files of before.
    let opened = Opened::new()?;
    let mut page = opened.page("playground.html")?;
    wait(&page, &format!("{DRAWN} !== undefined"))?;
    let content = "document.querySelector('.cm-content').textContent";
    page.evaluate(&typed("let n =", " let q = f_schl"), PATIENCE)?;
    let offered = "[...document.querySelectorAll('.cm-tooltip-autocomplete li')].map((it) => it.textContent).join()";
    wait(&page, &format!("{offered}.includes('f_schlick')"))?;
    wait(&page, "document.querySelector('.sketch.stale') !== null")?;
    // A list that has just come, or waits for a newer one, takes no key: nobody can have read it.
    let ready = "document.querySelector('.cm-tooltip-autocomplete:not(.cm-tooltip-autocomplete-disabled) li[aria-selected=true]')?.textContent.includes('f_schlick')";
    let still = format!(
        "(async () => {{ if (!({ready})) return false;
            await new Promise((done) => setTimeout(done, 200)); return {ready} === true; }})()"
    );
    wait(&page, &still)?;
    press(&page, "Enter")?;
    wait(&page, &format!("{content}.includes('import lamplight::brdf::specular::f_schlick;')"))?;
    page.evaluate(&typed("let q =", "(vec3f(0.04), 1.0, 0.5);"), PATIENCE)?;
    wait(&page, "document.querySelector('.sketch.stale') === null")?;
    page.evaluate(&typed("let l =", "    "), PATIENCE)?;
    let formatted =
        "[...document.querySelectorAll('.cm-line')].every((it) => !/ $/.test(it.textContent))";
    assert_eq!(text(&page, &format!("String({formatted})"))?, "false");
    page.evaluate(
        "[...document.querySelectorAll('button')].find((it) => it.textContent === 'Format').click()",
        PATIENCE,
    )?;
    wait(&page, formatted)?;
    without_errors(&mut page)
}

/// Each example has no mistake, and its picture shows something.
fn examples() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("playground.html")?;
    wait(&page, &format!("{DRAWN} !== undefined"))?;
    let select =
        "[...document.querySelectorAll('select')].find((it) => it.querySelector('optgroup'))";
    let names = format!("[...{select}.querySelectorAll('optgroup option')].map((it) => it.value)");
    let names: Vec<String> = serde_json::from_value(page.evaluate(&names, PATIENCE)?)?;
    assert!(names.len() >= 20, "there are {} examples", names.len());
    for name in names {
        let choose = format!(
            "(() => {{ delete document.querySelector('main').dataset.runs; const it = {select};
                it.value = {}; it.dispatchEvent(new Event('change')); }})()",
            Value::from(name.as_str())
        );
        page.evaluate(&choose, PATIENCE)?;
        wait(&page, "document.querySelector('main').dataset.runs !== undefined")?;
        wait(&page, &format!("{DRAWN} !== undefined"))?;
        let status =
            "[...document.querySelectorAll('.status')].map((it) => it.textContent).join('; ')";
        let status = text(&page, status)?;
        assert!(status.contains("no errors"), "{name}: {status}");
        assert!(!status.contains("Every pixel"), "{name}: {status}");
    }
    without_errors(&mut page)
}

/// Types a text at the end of the line that contains some words.
pub fn typed(line: &str, text: &str) -> String {
    format!(
        "(() => {{ const it = document.querySelector('.cm-content'); it.focus();
            const lines = [...document.querySelectorAll('.cm-line')];
            const line = lines.find((one) => one.textContent.includes({}));
            const range = document.createRange(); range.selectNodeContents(line); range.collapse(false);
            getSelection().removeAllRanges(); getSelection().addRange(range);
            document.execCommand('insertText', false, {}); }})()",
        Value::from(line),
        Value::from(text)
    )
}

/// The files of the zip compile with the command line, to the bytes that the page shows.
fn taken_by_the_command_line(page: &BrowserPage) -> Outcome {
    let save = "(async () => {
        const make = URL.createObjectURL;
        const blob = new Promise((found) => {
            URL.createObjectURL = (blob) => { found(blob); return make.call(URL, blob); };
        });
        const click = HTMLAnchorElement.prototype.click;
        HTMLAnchorElement.prototype.click = () => {};
        [...document.querySelectorAll('button')].find((it) => it.textContent === 'Save as zip').click();
        HTMLAnchorElement.prototype.click = click;
        URL.createObjectURL = make;
        const bytes = new Uint8Array(await (await blob).arrayBuffer());
        return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));
    })()";
    let files = stored_files(&BASE64_STANDARD.decode(text(page, save)?)?)?;
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(names, ["lamp.wesl", "lit.frag.glsl", "lit.wesl"]);
    let folder = tempfile::tempdir()?;
    for (name, bytes) in &files {
        std::fs::write(folder.path().join(name), bytes)?;
    }
    let mut compile = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    compile.args(["compile", "lit.wesl", "lit.frag.glsl", "--target", "wgsl", "-o", "out"]);
    let ran = compile.current_dir(folder.path()).output()?;
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let made = std::fs::read_to_string(folder.path().join("out/lit.fs_main.frag.wgsl"))?;
    assert_eq!(text(page, FIRST_OUTPUT)?, made, "the page shows other bytes");
    Ok(())
}

/// The files of a zip whose entries are stored as they are, by its central directory.
fn stored_files(zip: &[u8]) -> Result<BTreeMap<String, Vec<u8>>, Failed> {
    let short = |at: usize| -> Option<usize> {
        Some(usize::from(u16::from_le_bytes(zip.get(at..at + 2)?.try_into().ok()?)))
    };
    let long = |at: usize| Some(short(at)? | short(at + 2)? << 16);
    let read = || {
        let end = zip.len().checked_sub(22)?;
        let (count, mut at) = (short(end + 10)?, long(end + 16)?);
        let mut files = BTreeMap::new();
        for _ in 0..count {
            let (method, size, name, local) =
                (short(at + 10)?, long(at + 24)?, short(at + 28)?, long(at + 42)?);
            let path = String::from_utf8(zip.get(at + 46..at + 46 + name)?.to_vec()).ok()?;
            let start = local + 30 + short(local + 26)? + short(local + 28)?;
            files.insert(path, zip.get(start..start + size).filter(|_| method == 0)?.to_vec());
            at += 46 + name;
        }
        Some(files)
    };
    read().ok_or_else(|| "the zip has another form".into())
}

/// What was typed right before a reload is there afterwards. The link has it too, for a browser that
/// never had it. A link does not destroy other files, and a second one does not either.
fn kept(opened: &Opened, page: &BrowserPage) -> Outcome {
    let lines =
        "[...document.querySelectorAll('.cm-line')].map((it) => it.textContent).join('\\n')";
    let there = |words: &str| format!("{lines}.includes({})", Value::from(words));
    page.evaluate(&typed("let l =", " // before the reload"), PATIENCE)?;
    page.call("Page.reload", json!({}))?;
    wait(page, &format!("document.body?.dataset.ready && {}", there("// before the reload")))?;
    wait(page, "document.querySelector('.problems li') !== null")?;
    wait(page, "location.hash.includes('state=')")?;
    let link = text(page, "location.hash")?;
    page.evaluate(
        "localStorage.setItem('lamplight-playground', JSON.stringify({
            files: { 'own.wesl': '// my own', }, open: 'own.wesl', target: 'wgsl', expression: '1.0' }))",
        PATIENCE,
    )?;
    let other = opened.page(&link)?;
    wait(&other, &there("// before the reload"))?;
    let back = "[...document.querySelectorAll('button')].find((it) => it.textContent.startsWith('Back to my files'))";
    // Typing into what a link opened, and then opening another link, leaves both within reach.
    other.evaluate(&typed("let l =", " // typed after the link"), PATIENCE)?;
    wait(&other, "localStorage.getItem('lamplight-playground').includes('typed after the link')")?;
    let third = opened.page(&link)?;
    wait(&third, &there("// before the reload"))?;
    let all = "[...document.querySelectorAll('button')].filter((it) => it.textContent.startsWith('Back to ')).map((it) => it.textContent)";
    let offered = text(&third, &format!("{all}.join('; ')"))?;
    assert_eq!(offered, "Back to my files before the link; Back to own.wesl");
    third.evaluate(&format!("{back}.click()"), PATIENCE)?;
    wait(&third, &there("// typed after the link"))?;
    other.evaluate(&format!("{back}.click()"), PATIENCE)?;
    wait(&other, &there("// my own"))?;
    Ok(())
}

/// A huge text is not inserted, with a sentence that says so. The text before it stays.
fn too_large(page: &BrowserPage) -> Outcome {
    page.evaluate(
        "(() => { const data = new DataTransfer(); data.setData('text/plain', '// x '.repeat(2000000));
            const paste = new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true });
            document.querySelector('.cm-content').dispatchEvent(paste); })()",
        PATIENCE,
    )?;
    wait(page, "document.querySelector('.status').textContent.startsWith('Not inserted')")?;
    let letters =
        page.evaluate("document.querySelector('.cm-content').textContent.length", PATIENCE)?;
    assert!(letters.as_u64().is_some_and(|count| count < 10_000), "the page has {letters} letters");
    Ok(())
}

/// A function that keeps the toolchain busy for minutes.
pub fn endless() -> String {
    let work = "x = sin(x) + cos(x); ".repeat(2000);
    format!(
        " fn slow() -> f32 {{ var x = 0.5; for (var i = 0; i < 900000; i++) {{ {work} }} return x; }}"
    )
}

/// A text that keeps the toolchain busy is given up: after ten seconds, or after one second if
/// somebody types on. The page goes on with a new toolchain, and answers all the time.
fn replaced(page: &BrowserPage) -> Outcome {
    let expression = |text: &str| {
        format!(
            "(() => {{ const it = document.querySelector('.eval input'); it.value = '{text}';
                it.dispatchEvent(new Event('input')); }})()"
        )
    };
    // The mistake of before goes away.
    let replace =
        "(() => { document.querySelector('.cm-content').focus(); document.execCommand('selectAll');
        document.execCommand('insertText', false, TEXT); })()";
    page.evaluate(&replace.replace("TEXT", &Value::from(endless()).to_string()), PATIENCE)?;
    page.evaluate(&expression("package::lit::slow()"), PATIENCE)?;
    let started = Instant::now();
    let status = "document.querySelector('.status').textContent";
    wait(page, &format!("{status}.includes('the toolchain was restarted')"))?;
    println!("the toolchain was given up after {:.1} s", started.elapsed().as_secs_f64());
    page.evaluate(&expression("package::lit::slow() + 1.0"), PATIENCE)?;
    wait(page, &format!("{status} === 'Still computing …'"))?;
    let started = Instant::now();
    page.evaluate(&expression("2.0 + 1.0"), PATIENCE)?;
    wait(page, &format!("{VALUE} === '3' || {VALUE} === '3.0'"))?;
    let spent = started.elapsed().as_secs_f64();
    println!("after the next keystroke, its value came in {spent:.1} s");
    Ok(())
}
