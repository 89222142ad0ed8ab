//! Numbers: expressions, curves and references.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::diagnostic::{self, Diagnostics, codes};
use lamplight::eval::{Bounded, Number};
use lamplight::project::LIBRARY;
use lamplight::source::{Memory, SourceSet};
use lamplight_check::expression;
use lamplight_check::library::Library;
use lamplight_check::references;
use lamplight_execute::executors::eval::EXECUTOR;
use lamplight_execute::interpreter::Interpreter;
use lamplight_execute::kernel;
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::diagnostic::{Diagnostic, diagnostics};
use crate::package::Files;
use crate::{Answer, answer};

/// An expression over the functions of the library, or of a package that may import it.
#[derive(Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct EvalRequest {
    #[serde(default)]
    #[tsify(optional, type = "Record<string, string>")]
    pub files: Option<Files>,
    /// WGSL, such as `lighting::spot::cone_exponent(0.9, 0.8, 4.0)`.
    pub expression: String,
    /// Whether the GLSL modules are called instead.
    #[serde(default)]
    #[tsify(optional)]
    pub glsl: bool,
}

/// Its value in f32.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct EvalResult {
    /// The value as `lamplight eval` prints it; absent if there is none.
    pub value: Option<String>,
    pub diagnostics: Vec<Diagnostic>,
}

/// The value of an expression.
#[wasm_bindgen]
pub fn evaluate(request: Ts<EvalRequest>) -> Answer<EvalResult> {
    let request = request.to_rust()?;
    let sources = Mutex::new(SourceSet::default());
    let language = if request.glsl { Language::Glsl } else { Language::Wesl };
    let found = EXECUTOR.start().map_err(|_| vec![stopped()]).and_then(|mut session| {
        let text = request.expression.trim();
        expression::evaluate_expression(
            &library(request.files),
            &sources,
            text,
            language,
            session.as_mut(),
        )
    });
    let sources = sources.into_inner().unwrap_or_default();
    answer(&match found {
        Ok(value) => EvalResult { value: Some(value.to_string()), diagnostics: Vec::new() },
        Err(problems) => EvalResult { value: None, diagnostics: diagnostics(&sources, &problems) },
    })
}

/// What the package is called in expressions, which are a package of their own: `package::` there
/// means this one, as on the command line.
const OWN: &str = "lamplight_own";

fn library(files: Option<Files>) -> Library {
    match files {
        None => Library::shipped(LIBRARY_FILES),
        Some(files) => Library::new(
            OWN,
            Arc::new(Memory(files)),
            vec![(LIBRARY.to_owned(), Arc::new(LIBRARY_FILES))],
        ),
    }
}

fn stopped() -> diagnostic::Diagnostic {
    diagnostic::Diagnostic::error(codes::EVAL_INTERNAL, "the evaluator could not be started")
}

/// Curves of a function.
#[derive(Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct CurveRequest {
    /// Path of the function: `lighting::spot::cone_exponent`.
    pub path: String,
    /// WGSL of type f32 over `x` and the second parameter, in the form of the library's plots.
    pub value: String,
    /// Name of the second parameter.
    #[serde(default)]
    #[tsify(optional)]
    pub parameter: Option<String>,
    /// Values of the second parameter, one for each curve.
    #[serde(default)]
    #[tsify(optional)]
    pub values: Vec<f64>,
    pub from: f64,
    pub to: f64,
    pub samples: u32,
}

/// Curves at evenly spaced inputs.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct CurveResult {
    pub inputs: Vec<f64>,
    pub curves: Vec<Curve>,
    /// WGSL of the function that was evaluated; a page can run it too.
    pub module: Option<String>,
    pub diagnostics: Vec<Diagnostic>,
}

/// One curve.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Curve {
    /// The second parameter.
    pub parameter: f64,
    /// Each operation rounded to f32.
    pub single: Vec<f64>,
    /// In f64.
    pub double: Vec<f64>,
    /// How far an implementation within WGSL's bounds may be from `double`.
    pub error: Vec<f64>,
}

/// A kernel that is ready, and the text it was made from, since sliders ask for the same one again.
struct Kept {
    text: String,
    interpreter: Interpreter,
}

thread_local! {
    static KEPT: RefCell<Option<Kept>> = const { RefCell::new(None) };
}

/// Computes curves in f32 and in f64, and how far they may be apart.
#[wasm_bindgen]
pub fn curves(request: Ts<CurveRequest>) -> Answer<CurveResult> {
    let request = request.to_rust()?;
    let sources = Mutex::new(SourceSet::default());
    let made = KEPT.with_borrow_mut(|kept| drawn(&request, &sources, kept));
    answer(&match made {
        Ok((inputs, curves, text)) => {
            CurveResult { inputs, curves, module: Some(text), diagnostics: Vec::new() }
        }
        Err(problems) => {
            let sources = sources.into_inner().unwrap_or_default();
            let diagnostics = diagnostics(&sources, &problems);
            CurveResult { inputs: Vec::new(), curves: Vec::new(), module: None, diagnostics }
        }
    })
}

type Drawn = (Vec<f64>, Vec<Curve>, String);

fn drawn(
    request: &CurveRequest,
    sources: &Mutex<SourceSet>,
    kept: &mut Option<Kept>,
) -> Result<Drawn, Diagnostics> {
    const FUNCTION: &str = "lamplight_plot";
    const SAMPLES: u32 = 4096;
    let name = request.parameter.as_deref().unwrap_or("unused");
    let text = format!(
        "import {LIBRARY}::{};\n\nfn {FUNCTION}(x: f32, {name}: f32) -> f32 {{\n    return {};\n}}\n",
        request.path, request.value
    );
    if kept.as_ref().is_none_or(|kept| kept.text != text) {
        let root = ("plot.wesl", text.as_str());
        let module = Library::shipped(LIBRARY_FILES)
            .importing(sources, root, Language::Wesl, FUNCTION)?
            .module;
        let one = |problem| vec![problem];
        let kernel = kernel::build_kernel(&module, FUNCTION, &BTreeMap::new()).map_err(one)?;
        if kernel.input_words() != 2 || kernel.result_words() != 1 {
            let message = format!("`{}` is not one number", request.value);
            return Err(vec![diagnostic::Diagnostic::error(codes::UNTESTABLE_FUNCTION, message)]);
        }
        let interpreter = Interpreter::new(&kernel).map_err(one)?;
        *kept = Some(Kept { text: text.clone(), interpreter });
    }
    let kept = kept.as_ref().ok_or_else(|| vec![stopped()])?;
    let samples = request.samples.clamp(2, SAMPLES);
    let step = (request.to - request.from) / f64::from(samples - 1);
    let inputs: Vec<f64> =
        (0..samples).map(|index| request.from + step * f64::from(index)).collect();
    let values = if request.values.is_empty() { &[0.0][..] } else { &request.values };
    let curves = values.iter().map(|value| curve(kept, &inputs, *value)).collect::<Result<_, _>>();
    Ok((inputs, curves.map_err(|problem| vec![problem])?, text))
}

fn curve(kept: &Kept, inputs: &[f64], parameter: f64) -> Result<Curve, diagnostic::Diagnostic> {
    let mut single = kept.interpreter.calls::<f32>()?;
    let mut double = kept.interpreter.calls::<f64>()?;
    let mut bounded = kept.interpreter.calls::<Bounded>()?;
    let size = inputs.len();
    let mut made = Curve {
        parameter,
        single: Vec::with_capacity(size),
        double: Vec::with_capacity(size),
        error: Vec::with_capacity(size),
    };
    for x in inputs {
        let row = [(*x as f32).to_bits(), (parameter as f32).to_bits()];
        let first = |found: Option<f64>| found.unwrap_or(f64::NAN);
        made.single.push(first(single.call(&row)?.first().map(|slot| f64::from(*slot))));
        made.double.push(first(double.call(&row)?.first().copied()));
        made.error.push(first(bounded.call(&row)?.first().map(|slot| slot.error())));
    }
    Ok(made)
}

/// What a function should return by its published formula, in f64. Absent if the library has no
/// formula for it. Arguments are flattened in the order of the parameters.
#[wasm_bindgen]
pub fn reference(path: &str, arguments: Vec<f64>) -> Option<Vec<f64>> {
    let (module, function) = path.rsplit_once("::")?;
    let formula = references::find_reference(module, function)?;
    Some(formula(&mut references::CallArguments::new(&arguments, &[])).value)
}
