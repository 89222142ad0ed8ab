//! Writes programs that use the typed keys of a manifest, in each language. For each line of
//! ordinals that they read, they print the key, its number, and whether the number gives the key
//! back.

use lamplight::permute::{AxisKind, Manifest, Mode, Setting};

fn camel(name: &str) -> String {
    name.split('_').map(|word| word[..1].to_uppercase() + &word[1..]).collect()
}

pub fn rust_main(manifest: &Manifest) -> String {
    let mut arms = String::new();
    for (index, program) in manifest.programs.iter().enumerate() {
        let field = |(at, axis): (usize, &lamplight::permute::Axis)| match axis.kind {
            _ if axis.mode == Mode::Dynamic => String::new(),
            AxisKind::Bool => {
                let truth = usize::from(axis.values[1] == Setting::Bool(true));
                format!("{}: o[{at}] == {truth}, ", axis.name)
            }
            _ => format!("{}: {}::{}::ALL[o[{at}]], ", axis.name, program.name, camel(&axis.name)),
        };
        let fields: String = program.space.axes().iter().enumerate().map(field).collect();
        arms += &format!(
            "            {index} => {{ let k = {0}::Key {{ {fields} }}; let n = k.to_ordinal(); format!(\"{{k}} {{n}} {{}}\", {0}::Key::from_ordinal(n) == Some(k)) }},\n",
            program.name
        );
    }
    let start = "include!(\"keys.rs\");\nfn main() {\n    for line in std::io::stdin().lines() {\n        let line = line.unwrap();\n";
    let parse = "        let n: Vec<usize> = line.split_whitespace().map(|n| n.parse().unwrap()).collect();\n        let o = &n[1..];\n        let _ = o;\n";
    format!(
        "{start}{parse}        println!(\"{{}}\", match n[0] {{\n{arms}            _ => String::new(),\n        }});\n    }}\n}}\n"
    )
}

pub fn c_main(manifest: &Manifest) -> String {
    let mut cases = String::new();
    for (index, program) in manifest.programs.iter().enumerate() {
        let name = format!("lamplight_{}", program.name);
        let field = |axis: &lamplight::permute::Axis| match axis.kind {
            _ if axis.mode == Mode::Dynamic => "            (void)next();\n".to_owned(),
            AxisKind::Bool => {
                let truth = u8::from(axis.values[1] == Setting::Bool(true));
                format!("            key.{} = next() == {truth};\n", axis.name)
            }
            _ => format!("            key.{} = ({name}_{})next();\n", axis.name, axis.name),
        };
        let fields: String = program.space.axes().iter().map(field).collect();
        let bytes = name.to_uppercase();
        cases += &format!(
            "        case {index}: {{\n            char text[{bytes}_KEY_BYTES];\n            {name} key = {name}_default();\n{fields}            {name}_to_key(&key, text);\n            uint64_t number = {name}_to_ordinal(&key);\n            {name} same;\n            char back[{bytes}_KEY_BYTES] = \"\";\n            if ({name}_from_ordinal(number, &same))\n                {name}_to_key(&same, back);\n            printf(\"%s %llu %s\\n\", text, (unsigned long long)number, strcmp(text, back) ? \"false\" : \"true\");\n            break;\n        }}\n"
        );
    }
    format!(
        "#include <stdio.h>\n#include \"keys.h\"\nstatic int next(void) {{ int value = -1; return scanf(\"%d\", &value) == 1 ? value : -1; }}\nint main(void) {{\n    int program;\n    while ((program = next()) >= 0)\n        switch (program) {{\n{cases}        }}\n    return 0;\n}}\n"
    )
}

pub fn typescript_main(manifest: &Manifest) -> String {
    let mut text = String::from(
        "import * as keys from './keys.mjs';\nimport { readFileSync } from 'node:fs';\nconst programs = [\n",
    );
    for program in &manifest.programs {
        let camel = camel(&program.name);
        let axes: Vec<String> = program
            .space
            .axes()
            .iter()
            .map(|axis| {
                let values: Vec<String> = axis
                    .values
                    .iter()
                    .map(|value| match value {
                        Setting::Name(name) => format!("'{name}'"),
                        other => other.to_string(),
                    })
                    .collect();
                format!("['{}', [{}]]", axis.name, values.join(", "))
            })
            .collect();
        text += &format!(
            "  [keys.{0}Key, [{1}], keys.{0}Ordinal, keys.{0}FromOrdinal],\n",
            camel[..1].to_lowercase() + &camel[1..],
            axes.join(", ")
        );
    }
    text + "];\nfor (const line of readFileSync(0, 'utf8').trim().split('\\n')) {\n  const [program, ...ordinals] = line.split(' ').map(Number);\n  const [key, axes, toOrdinal, fromOrdinal] = programs[program];\n  const chosen = Object.fromEntries(axes.map(([name, values], index) => [name, values[ordinals[index]]]));\n  const number = toOrdinal(chosen);\n  console.log(key(chosen), String(number), key(fromOrdinal(number)) === key(chosen));\n}\n"
}
