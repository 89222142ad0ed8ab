//! Values that HLSL makes otherwise: vectors of one number, structures, arrays.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::super::expression::{Bound, POSTFIX, UNARY, Writer, listed};
use super::super::item::ItemWriter;
use super::super::lines::Indented;
use crate::tree::{Argument, ItemPath, Structure, Type};
use crate::wesl::untranslated;

impl Writer<'_> {
    /// A constructor; nothing if it is written as in GLSL.
    pub fn hlsl_construct(
        &self,
        ty: &Type,
        arguments: &[Argument],
        is_broken: bool,
        span: Span,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        match (ty, arguments) {
            (Type::Vector(..), [argument]) if matches!(argument.value.ty, Type::Scalar(_)) => {
                let text = match (ty.scalar(), argument.value.ty.scalar()) {
                    (to, from) if to == from => self.operand(&argument.value, UNARY, indent)?,
                    (Some(scalar), _) => self.scalar_conversion(scalar, &argument.value, indent)?,
                    (None, _) => return Ok(None),
                };
                self.splat(ty, &text, span).map(Some)
            }
            (Type::Structure(path), _) => {
                let texts = self.parts(ty, arguments, is_broken, indent)?;
                let name = self.names.maker(path);
                Ok(Some(Bound(listed(name, &texts, is_broken, indent), POSTFIX)))
            }
            (Type::Array(..), _) => {
                Err(untranslated(span, "an array that is made within an expression")
                    .note("help: give it a name first: HLSL has lists in declarations alone"))
            }
            _ => Ok(None),
        }
    }
}

impl ItemWriter<'_> {
    /// The function that makes a structure of its members.
    pub fn make_function(
        &self,
        path: &ItemPath,
        structure: &Structure,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        let name = self.own_name(&structure.name);
        let mut parameters = Vec::new();
        let mut lines = Vec::new();
        for node in &structure.members {
            if node.branch.is_some() {
                let what = "a structure that is made, and has members under a condition";
                return Err(untranslated(node.span, what));
            }
            let (ty, lengths) = self.names.declared_type(&node.body.ty, node.body.span)?;
            let member = self.names.member(path, &node.body.name);
            parameters.push(format!("{ty} {member}{lengths}"));
            lines.push(format!("made.{member} = {member};"));
        }
        out.blank();
        out.line(&format!("{name} {}({}) {{", self.names.maker(path), parameters.join(", ")));
        out.depth += 1;
        out.line(&format!("{name} made;"));
        lines.iter().for_each(|line| out.line(line));
        out.line("return made;");
        out.depth -= 1;
        out.line("}");
        Ok(())
    }
}
