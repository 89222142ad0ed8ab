//! Reads laws from a case file.

use super::FormulaText;
use super::reader::{CaseNode, CaseValue};
use crate::laws::{
    self, Albedo, Area, Equality, Formulas, Integral, IntegralValue, Inverse, Law, Over, Takes,
};
use lamplight_diagnostic::{Diagnostic, codes};

pub fn read_law(node: &CaseNode) -> Result<Law, Diagnostic> {
    let entries = node.entries()?;
    let found = entries
        .iter()
        .find_map(|(key, value)| laws::find_kind(&key.name).map(|kind| (kind, value)));
    let Some((kind, value)) = found else {
        let known: Vec<_> = laws::KINDS.iter().map(|kind| kind.name).collect();
        return Err(node
            .error("this table is not a law")
            .note(format!("laws are {}", known.join(", "))));
    };
    let options = kind.takes.options();
    let unknown = entries
        .iter()
        .find(|(key, _)| key.name != kind.name && !options.contains(&key.name.as_str()));
    if let Some((key, _)) = unknown {
        let message = format!("the law `{}` has no `{}`", kind.name, key.name);
        return Err(Diagnostic::error(codes::CASE_INVALID, message)
            .at(key.span, "here")
            .suggest(&key.name, options.iter().copied()));
    }
    fill_law(Law::new(kind, node.span), node, value)
}

/// The law with the values that its kind takes.
fn fill_law(mut law: Law, node: &CaseNode, value: &CaseNode) -> Result<Law, Diagnostic> {
    match law.kind.takes {
        Takes::Numbers => law.numbers = value.numbers()?,
        Takes::Names => law.names = read_names(law.kind.name, value)?,
        Takes::Slope => {
            law.names = read_texts(value)?;
            law.numbers = vec![node.required("slope")?.number()?];
        }
        Takes::Integral => {
            law.names = read_texts(value)?;
            law.numbers =
                node.get("at_most").map_or_else(|| node.required("gives"), Ok)?.numbers()?;
            law.integral = Some(read_integral(node)?);
        }
        Takes::Point => {
            law.at = super::values_by_path("", value, &[])?;
            law.numbers = node.required("gives")?.numbers()?;
        }
        Takes::Albedo => {
            law.partners = read_texts(value)?;
            law.albedo = Some(read_albedo(node)?);
        }
        Takes::Inverse => {
            law.partners = vec![value.text()?.to_owned()];
            law.inverse = Some(read_inverse(node)?);
        }
        Takes::Equality => {
            law.partners = read_texts(value)?;
            law.equality = Some(read_equality(node)?);
        }
        Takes::Area => {
            law.partners = read_texts(value)?;
            law.area = Some(read_area(node)?);
        }
        Takes::Finite => {
            law.numbers = vec![read_magnitude(value)?];
            law.filter = node.get("where").map(FormulaText::read).transpose()?;
            let reason = node.get("because").map(CaseNode::text).transpose()?;
            if law.filter.is_some() && reason.is_none_or(str::is_empty) {
                return Err(node.error("a law with `where` says why in `because`"));
            }
        }
    }
    Ok(law)
}

/// Reads the largest magnitude of arguments, for the law `finite`.
fn read_magnitude(node: &CaseNode) -> Result<f64, Diagnostic> {
    let number = node.number()?;
    match number > 0.0 && number.is_finite() {
        true => Ok(number),
        false => Err(node.error("expected a magnitude above 0")),
    }
}

fn read_texts(node: &CaseNode) -> Result<Vec<String>, Diagnostic> {
    node.one_or_more().iter().map(|one| one.text().map(str::to_owned)).collect()
}

/// Reads names of parameters. The law `swap` needs pairs of them.
fn read_names(kind: &str, node: &CaseNode) -> Result<Vec<String>, Diagnostic> {
    let names = read_texts(node)?;
    match kind == "swap" && (names.is_empty() || names.len() % 2 != 0) {
        true => Err(node.error("parameters are exchanged in pairs")),
        false => Ok(names),
    }
}

fn read_integral(node: &CaseNode) -> Result<Integral, Diagnostic> {
    let about = node.get("about").map(|about| about.text().map(str::to_owned)).transpose()?;
    let cosine =
        node.get("cosine").is_some_and(|cosine| matches!(cosine.value, CaseValue::Bool(true)));
    if cosine && about.is_none() {
        return Err(node.error("`cosine` is that to `about`, which is missing"));
    }
    Ok(Integral {
        about,
        cosine,
        steps: read_steps(node)?,
        within: node.required("within")?.number()?,
        at_most: node.get("at_most").is_some(),
    })
}

fn read_steps(node: &CaseNode) -> Result<usize, Diagnostic> {
    Ok(node.get("steps").map_or(Ok(16), |steps| steps.count(2, 128))? as usize)
}

fn read_albedo(node: &CaseNode) -> Result<Albedo, Diagnostic> {
    let text = |name: &str| node.get(name).map(|node| node.text().map(str::to_owned)).transpose();
    let over =
        [("l", Over::Light), ("h", Over::Half), ("below", Over::Below), ("sphere", Over::Sphere)];
    Ok(Albedo {
        over: node.get("over").map_or(Ok(Over::Light), |node| node.choice(&over))?,
        view: text("view")?.unwrap_or_else(|| "nv".to_owned()),
        azimuth: node.get("azimuth").map_or(Ok(0.0), CaseNode::number)?,
        peak: node.get("peak").map(FormulaText::read).transpose()?,
        with: node.get("with").map_or(Ok(Formulas::new()), read_formulas)?,
        component: node
            .get("component")
            .map(|node| node.count(0, 3).map(|component| component as usize))
            .transpose()?,
        steps: read_steps(node)?,
        within: node.required("within")?.number()?,
        wanted: read_wanted(node)?,
    })
}

fn read_wanted(node: &CaseNode) -> Result<IntegralValue, Diagnostic> {
    Ok(match (node.get("gives"), node.get("at_most")) {
        (Some(gives), _) => IntegralValue::Exactly(read_formula(gives)?),
        (None, Some(most)) => IntegralValue::AtMost(read_formula(most)?),
        (None, None) => IntegralValue::Own,
    })
}

fn read_equality(node: &CaseNode) -> Result<Equality, Diagnostic> {
    let tables = node.get("with").map_or(&[][..], CaseNode::one_or_more);
    let with = tables.iter().map(read_formulas).collect::<Result<_, _>>()?;
    Ok(Equality { with, within: node.required("within")?.number()? })
}

fn read_area(node: &CaseNode) -> Result<Area, Diagnostic> {
    Ok(Area {
        along: node.required("along")?.text()?.to_owned(),
        from: read_formula(node.required("from")?)?,
        to: read_formula(node.required("to")?)?,
        finest: node.get("finest").map(read_formula).transpose()?,
        times: node.get("times").map(read_formula).transpose()?,
        with: node.get("with").map_or(Ok(Formulas::new()), read_formulas)?,
        steps: read_steps(node)?,
        within: node.required("within")?.number()?,
        wanted: read_wanted(node)?,
    })
}

fn read_formulas(node: &CaseNode) -> Result<Formulas, Diagnostic> {
    let entries = node.entries()?.iter();
    entries.map(|(key, value)| Ok((key.name.clone(), read_formula(value)?))).collect()
}

/// Reads a formula. Plain numbers become the formula `vec(...)` of them.
fn read_formula(node: &CaseNode) -> Result<FormulaText, Diagnostic> {
    if let CaseValue::Text(_) = node.value {
        return FormulaText::read(node);
    }
    let numbers: Vec<String> =
        node.numbers()?.iter().map(|number| format!("(0 + {number:?})")).collect();
    Ok(FormulaText { text: format!("vec({})", numbers.join(", ")), span: node.span })
}

fn read_inverse(node: &CaseNode) -> Result<Inverse, Diagnostic> {
    let of = node.get("of").map(|of| of.text().map(str::to_owned)).transpose()?;
    Ok(Inverse { of, within: node.required("within")?.number()? })
}
