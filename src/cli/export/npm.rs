//! An npm package with the library as a `weslBundle`, for wesl-js.

use serde_json::{Value, json};

use super::{
    DESCRIPTION, EDITION, KEYWORDS, PackageContents, files_below, license_files, wesl_toml,
};
use crate::project::LIBRARY;

/// The package's name. wesl-js finds a package by the first name of an import path, so it is that
/// of the library.
pub const NAME: &str = LIBRARY;

pub fn npm_contents(modules: PackageContents, glsl: PackageContents) -> PackageContents {
    let own = [
        ("package.json", npm_manifest()),
        ("dist/weslBundle.js", bundled_module(&modules)),
        ("dist/weslBundle.d.ts", TYPES.to_owned()),
        ("README.md", README.to_owned()),
        ("wesl.toml", wesl_toml("npm", "shaders")),
    ];
    let own = own.into_iter().map(|(path, text)| (path.to_owned(), text));
    own.chain(license_files())
        .chain(files_below("shaders", modules))
        .chain(files_below("glsl/lamplight", glsl))
        .collect()
}

/// The text of `package.json`. It is a template, since the order of the conditions in `exports`
/// matters: tools take the first one that they know, and `types` must come before `import`.
fn npm_manifest() -> String {
    let (name, description) = (json!(NAME), json!(DESCRIPTION));
    let keywords = json!(KEYWORDS);
    let (version, license) = (env!("CARGO_PKG_VERSION"), env!("CARGO_PKG_LICENSE"));
    let repository = env!("CARGO_PKG_REPOSITORY");
    format!(
        r#"{{
  "name": {name},
  "version": "{version}",
  "description": {description},
  "license": "({license})",
  "repository": {{ "type": "git", "url": "git+{repository}.git" }},
  "keywords": {keywords},
  "type": "module",
  "sideEffects": false,
  "files": ["dist", "shaders", "glsl", "wesl.toml", "LICENSE-MIT", "LICENSE-APACHE"],
  "exports": {{
    ".": {{ "types": "./dist/weslBundle.d.ts", "import": "./dist/weslBundle.js" }},
    "./glsl/*": "./glsl/*",
    "./package.json": "./package.json"
  }}
}}
"#
    )
}

/// The module: one object in JSON, which is JavaScript too, with its texts as strings.
fn bundled_module(modules: &PackageContents) -> String {
    let bundle = json!({ "name": LIBRARY, "edition": EDITION, "modules": modules });
    format!(
        "export const weslBundle = {};\n\nexport default weslBundle;\n",
        pretty_json(&bundle).trim_end()
    )
}

fn pretty_json(value: &Value) -> String {
    format!("{value:#}\n")
}

const TYPES: &str = r#"export interface WeslBundle {
  /** First name of import paths into the package. */
  name: string;
  /** Edition of WESL. */
  edition: string;
  /** Text of each module, by its path below the package's root. */
  modules: Record<string, string>;
  /** Packages that this one imports from. */
  dependencies?: WeslBundle[];
}

export declare const weslBundle: WeslBundle;
export default weslBundle;
"#;

const README: &str = r#"# lamplight

The shader library of Lamplight for [wesl-js](https://www.npmjs.com/package/wesl): attenuation,
spot cones, classic and microfacet highlights, ambient light, shadow filters, and what they need.

```js
import { link } from "wesl";
import lamplight from "lamplight";

const linked = await link({
  weslSrc: { "main.wesl": source },
  rootModuleName: "main",
  libs: [lamplight],
});
```

```wgsl
import lamplight::brdf::specular::blinn_phong;
```

The same functions in GLSL are below `glsl/`; a compiler's include path is that folder:
`#include "lamplight/brdf/specular.glsl"`.

Each function says in its comment what it computes, the space, unit and range of its parameters,
its source, what happens at its edges, and how large its error may be. Functions are pure: no
bindings, no globals.
"#;
