//! The documentation in keys is text, whatever it says.

use lamplight::keys;

use super::{Outcome, execute, parsed};

/// Documentation that a tool of Rust would run, if it were copied as it is.
const CODE: &str = r#"
[program.p]
wesl = "a.wesl"
doc = '''
```
panic!("fence");
```
> ```rust
> panic!("quoted fence");
> ```

~~~
panic!("other fence");
~~~

- item

          panic!("indented");

\tpanic!("tab");'''
[program.p.axis]
fog = { values = ["no", "yes"], doc = "Turned \u202E round.\n\n    panic!();" }
"#;

/// `rustdoc` finds no code to run in the documentation of keys, and no mark that turns text round.
pub fn is_no_code() -> Outcome {
    let folder = tempfile::tempdir()?;
    let rust = keys::find("rust").ok_or("no such language")?;
    let text = keys::write(&parsed(CODE)?, None, rust);
    if text.contains('\u{202e}') || !text.contains("quoted fence") {
        return Err(text.into());
    }
    let path = folder.path().join("keys.rs");
    std::fs::write(&path, text)?;
    let path = path.to_string_lossy();
    let stdout = execute(folder.path(), &["rustdoc", "--edition", "2024", "--test", &path], "")?;
    match stdout.contains("running 0 tests") {
        true => Ok(()),
        false => Err(stdout.into()),
    }
}
