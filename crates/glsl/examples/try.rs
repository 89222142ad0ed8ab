#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]
use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::{translate, tree::Stage};
fn main() {
    let mut args = std::env::args().skip(1);
    let out = args.next().unwrap();
    for file in args {
        let stage = if file.contains("/vert/") || file.ends_with(".vert") { Stage::Vertex } else if file.contains("/frag/") || file.ends_with(".frag") { Stage::Fragment } else { Stage::Compute };
        let text = std::fs::read_to_string(&file).unwrap();
        let result = std::panic::catch_unwind(|| translate(&text, stage, SourceId(0), Default::default()));
        match result {
            Err(_) => println!("PANIC {file}"),
            Ok(Ok((w, _))) => { println!("ok {file}"); std::fs::write(format!("{out}/{}.wgsl", file.replace("/tmp/pp/", "").replace('/', "~")), w.text).unwrap(); }
            Ok(Err(problems)) => { let p = &problems[0]; println!("no {file}: {} `{}`", p.message, p.labels.first().map(|l| text[l.span.range()].chars().take(60).collect::<String>()).unwrap_or_default()); }
        }
    }
}
