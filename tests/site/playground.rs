//! The playground.

use serde_json::Value;

use super::{Opened, Outcome, PATIENCE, text, without_errors};

/// The playground shows outputs and a value for its first text, and underlines a mistake that is
/// typed, at its column.
pub fn playground() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/playground")?;
    page.until(
        "document.querySelector('.texts pre')?.textContent.includes('fn lambert')",
        PATIENCE,
    )?;
    page.until("document.querySelector('.eval output').textContent === '0.25'", PATIENCE)?;
    // Types a text at the end of the line with `let n`.
    let typed = |text: &str| {
        format!(
            "(() => {{ const it = document.querySelector('.cm-content'); it.focus();
                const lines = [...document.querySelectorAll('.cm-line')];
                const line = lines.find((one) => one.textContent.includes('let n ='));
                const range = document.createRange(); range.selectNodeContents(line); range.collapse(false);
                getSelection().removeAllRanges(); getSelection().addRange(range);
                document.execCommand('insertText', false, {}); }})()",
            Value::from(text)
        )
    };
    page.evaluate(&typed(" let m = nowhere(n);"), PATIENCE)?;
    let mark = "document.querySelector('.cm-lintRange-error')?.textContent";
    page.until(&format!("{mark} === 'nowhere'"), PATIENCE)?;
    let problem = text(&page, "document.querySelector('.problems').textContent")?;
    assert!(problem.contains("lit.wesl:7:40: "), "expected lit.wesl:7:40 in `{problem}`");
    without_errors(&mut page)
}
