//! `lamplight-bind MODULE FOLDER`: the JavaScript and the TypeScript types around a module that
//! wasm-bindgen prepared. A program of its own, so that the maintainer's commands stay light.

#![allow(clippy::print_stderr)]

use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [module, folder] = &arguments[..] else {
        eprintln!("usage: lamplight-bind MODULE FOLDER");
        return ExitCode::from(2);
    };
    match bind(module, folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn bind(module: &str, folder: &str) -> Result<(), String> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).out_name("toolchain").typescript(true);
    bindgen.remove_name_section(true).remove_producers_section(true);
    // Lets the page restart the module after a trap.
    bindgen.reset_state_function(true);
    let bindgen = bindgen.web(true).map_err(|error| format!("{error:?}"))?;
    bindgen.generate(folder).map_err(|error| format!("{error:?}"))
}
