//! What a page does when a part of it is lost.

use std::fs;
use std::path::Path;

use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, PATIENCE as SHORT};
use serde_json::json;

use super::playground::{endless, typed};
use super::{Opened, Outcome, PATIENCE, site, text, wait, without_errors};

/// A page ends in a picture, or in a sentence that says why not: if the browser loses its GPU, if the
/// toolchain is restarted while a picture is drawn, and if the toolchain cannot be loaded.
pub fn lost() -> Outcome {
    lost_device()?;
    lost_toolchain()?;
    unloaded()
}

/// After the process of the GPU has ended, the next picture is drawn on another device.
fn lost_device() -> Outcome {
    let server = HttpServer::start(ServedFiles::Folder(site()?))?;
    // In a browser of its own, since all pages lose their devices.
    let browser = Browser::start()?;
    for address in ["#/programs/forward", "?device=webgl2#/programs/forward"] {
        let page = browser.open(&server.address(address))?;
        wait(&page, "document.querySelector('canvas')?.dataset.controls !== undefined")?;
        let drawn = "document.querySelector('canvas').dataset.drawn";
        let before = text(&page, drawn)?;
        browser.command("Browser.crashGpuProcess", json!({}))?;
        page.evaluate(
            "document.querySelector('.lamp').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowDown' }))",
            SHORT,
        )?;
        wait(&page, &format!("{drawn} !== '{before}'"))?;
    }
    Ok(())
}

/// A picture that was begun before the toolchain was restarted is drawn all the same.
fn lost_toolchain() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/playground")?;
    let drawn = "document.querySelector('.sketch canvas')?.dataset.drawn";
    wait(&page, &format!("{drawn} !== undefined"))?;
    let before = text(&page, drawn)?;
    // While the device draws, the toolchain gets work that does not end, and is replaced.
    let slow = format!("}} {}", endless().trim_end_matches('}'));
    let both = format!(
        "(() => {{
            document.querySelector('.sketch canvas').dispatchEvent(new KeyboardEvent('keydown', {{ key: 'ArrowLeft' }}));
            {};
            const it = document.querySelector('.eval input');
            it.value = 'package::lit::slow()';
            it.dispatchEvent(new Event('input')); }})()",
        typed("return vec4f", &slow)
    );
    page.evaluate(&both, PATIENCE)?;
    wait(&page, "document.querySelector('.status').textContent.includes('was restarted')")?;
    wait(&page, &format!("{drawn} !== '{before}'"))?;
    without_errors(&mut page)
}

/// Without the file of the toolchain, or of its worker, pages say so.
fn unloaded() -> Outcome {
    for lacking in ["toolchain_bg", "worker"] {
        let folder = tempfile::tempdir()?;
        copy_without(&site()?, folder.path(), lacking)?;
        let server = HttpServer::start(ServedFiles::Folder(folder.path().to_owned()))?;
        let page = Browser::shared()?.open(&server.address("#/catalogue"))?;
        let text = "document.querySelector('main').textContent";
        wait(&page, &format!("{text}.includes('the toolchain could not be loaded')"))?;
    }
    Ok(())
}

/// Copies a site without the files whose name begins with some words.
fn copy_without(from: &Path, to: &Path, lacking: &str) -> Outcome {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let name = entry.file_name();
        if entry.file_type()?.is_dir() {
            copy_without(&entry.path(), &to.join(&name), lacking)?;
        } else if !name.to_string_lossy().starts_with(lacking) {
            fs::copy(entry.path(), to.join(&name))?;
        }
    }
    Ok(())
}
