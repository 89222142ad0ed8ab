//! Gives naga large stacks, and turns its panics into diagnostics.

use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Once, OnceLock};

use rayon::{ThreadPool, ThreadPoolBuilder};

use lamplight_diagnostic::{Diagnostic, codes, stopped_message};

/// The stack of each thread that runs naga. It is reserved address space, of which only the used
/// part takes memory. With [`super::LIMITS`] it is several times what the deepest accepted text was
/// measured to need.
const STACK_BYTES: usize = 128 << 20;

/// How much of the composed text a report of an internal error quotes, in bytes.
const QUOTED_BYTES: usize = 16 << 10;

thread_local! {
    static ON_LARGE_STACK: Cell<bool> = const { Cell::new(false) };
    static GUARDED: Cell<bool> = const { Cell::new(false) };
    static PANIC: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `work` on a thread with a large stack. The threads form a pool, which is made once.
///
/// Wrap a whole batch in one call: rayon's iterators inside it use the same pool, and nested calls
/// run in place. Where no thread can be made, `work` runs on the caller's thread.
pub fn on_large_stack<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    match thread_pool() {
        Some(pool) if !ON_LARGE_STACK.get() => pool.install(work),
        _ => work(),
    }
}

/// Runs `work`, which calls naga with `text`. A panic becomes a diagnostic and prints nothing.
pub fn guard<R>(text: &str, work: impl FnOnce() -> R) -> Result<R, Diagnostic> {
    catch_panics(work).map_err(|reason| {
        Diagnostic::error(codes::NAGA_INTERNAL, format!("{}: {reason}", stopped_message("naga")))
            .note(quote_start(text))
    })
}

/// Runs `work`, which calls code of others; a panic becomes its message, and prints nothing.
pub fn catch_panics<R>(work: impl FnOnce() -> R) -> Result<R, String> {
    hush_panics();
    let outer = GUARDED.replace(true);
    // A panic may leave values half changed. They are dropped with `work`, since callers keep only
    // its result.
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(outer);
    result.map_err(|_| PANIC.take().unwrap_or_else(|| "no message".to_owned()))
}

fn thread_pool() -> Option<&'static ThreadPool> {
    static POOL: OnceLock<Option<ThreadPool>> = OnceLock::new();
    POOL.get_or_init(|| {
        ThreadPoolBuilder::new()
            .stack_size(STACK_BYTES)
            .thread_name(|index| format!("naga-{index}"))
            .start_handler(|_| ON_LARGE_STACK.set(true))
            .build()
            .ok()
    })
    .as_ref()
}

/// Installs, once, a panic hook that keeps guarded panics silent and calls the previous hook for
/// others.
fn hush_panics() {
    static HUSHED: Once = Once::new();
    HUSHED.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if GUARDED.get() {
                PANIC.set(Some(describe_panic(info)));
            } else {
                previous(info);
            }
        }));
    });
}

/// The panic's message and its line in naga, without the path on this machine.
fn describe_panic(info: &panic::PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let message = payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let message = message.unwrap_or("no message");
    match info.location() {
        Some(place) => {
            let file = place.file().replace('\\', "/");
            let file = file.rsplit_once("/src/").map_or(file.as_str(), |(_, tail)| tail);
            format!("{message} ({file}:{})", place.line())
        }
        None => message.to_owned(),
    }
}

fn quote_start(text: &str) -> String {
    let end = (0..=QUOTED_BYTES.min(text.len()))
        .rev()
        .find(|end| text.is_char_boundary(*end))
        .unwrap_or_default();
    let rest = if end < text.len() {
        format!("\n[{} more bytes]", text.len() - end)
    } else {
        String::new()
    };
    format!("the composed text:\n{}{rest}", &text[..end])
}
