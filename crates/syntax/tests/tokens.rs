//! What the readers of WESL and GLSL find in small texts.

use std::fmt::Debug;

use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_syntax::glsl::{self, Directive, FilePart};
use lamplight_syntax::wesl::{self, Expression, Names, Origin, blank};
use lamplight_syntax::words;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 7] = [
        ("pieces_give_the_text_again", pieces_give_the_text_again),
        ("numbers_keep_their_exponents", numbers_keep_their_exponents),
        ("comments_nest", comments_nest),
        ("imports_are_flattened", imports_are_flattened),
        ("branches_know_their_siblings", branches_know_their_siblings),
        ("errors_of_wesl_have_places", errors_of_wesl_have_places),
        ("directives_know_their_ends", directives_know_their_ends),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("tokens::{name}"), run)).collect()
}

fn same<T: PartialEq + Debug>(what: &str, found: T, wanted: T) -> Outcome {
    match found == wanted {
        true => Ok(()),
        false => Err(format!("{what}: {found:?}, expected {wanted:?}").into()),
    }
}

/// No byte is lost between pieces, whatever the text has.
fn pieces_give_the_text_again() -> Outcome {
    for text in ["", "a + 1.5e-3f;", "α\u{3000}β→γ", "\u{85}\r\n\t//", "0x1p+3.x", "\0.5"] {
        let joined: String = words::pieces(text).map(|piece| piece.text).collect();
        same("the pieces", joined.as_str(), text)?;
        let mut end = 0;
        for piece in words::pieces(text) {
            same("the place", piece.at, end)?;
            end = piece.end();
        }
    }
    Ok(())
}

/// A sign belongs to a number behind the letter of its exponent, which is `p` in hexadecimal.
fn numbers_keep_their_exponents() -> Outcome {
    let number = |text: &'static str| &text[..words::number_end(text, 0)];
    same("decimal", number("1.5e-3f - 2"), "1.5e-3f")?;
    same("hexadecimal", number("0x1p+3-1"), "0x1p+3")?;
    same("hexadecimal digits", number("0xe-1"), "0xe")?;
    same("no word is in a number", words::has_word("1.0e5f + e6", "e5f"), false)?;
    same("a word", words::has_word("1.0e5f + e6", "e6"), true)
}

/// Block comments nest in WGSL, and what is without comments keeps all offsets.
fn comments_nest() -> Outcome {
    same("closed", blank::block_comment("/* /* */ */ x"), (11, true))?;
    same("open", blank::block_comment("/* /* */ x"), (10, false))?;
    let text = "a /* b /* c */ d */ e // f\ng";
    let bare = blank::without_comments(text);
    same("the length", bare.len(), text.len())?;
    same("the words", bare.split_whitespace().collect::<Vec<_>>(), vec!["a", "e", "g"])?;
    same("the place of a word", bare.find('g'), text.find('g'))?;
    let quoted = blank::without_comments("import \"a//b\" // c \"\n\"d // e\nf // g");
    same("quotes", quoted.as_str(), "import \"a//b\"       \n\"d // e\nf     ")
}

fn parse_wesl(text: &str) -> (wesl::Module, Names) {
    let mut names = Names::default();
    let module = wesl::parse(SourceId(0), text.into(), &mut names);
    (module, names)
}

/// One entry for each name of nested braces, with its whole path.
fn imports_are_flattened() -> Outcome {
    let (module, names) =
        parse_wesl("import super::super::a::{b, c::{d as e, f}};\nimport package::g;\n");
    let imports: Vec<(Origin, String, &str)> = module
        .imports
        .iter()
        .map(|import| {
            let path: Vec<&str> =
                import.path.segments.iter().map(|segment| names.text(*segment)).collect();
            (import.path.origin, path.join("::"), names.text(import.alias))
        })
        .collect();
    let wanted = vec![
        (Origin::Super(2), "a::b".to_owned(), "b"),
        (Origin::Super(2), "a::c::d".to_owned(), "e"),
        (Origin::Super(2), "a::c::f".to_owned(), "f"),
        (Origin::Package, "g".to_owned(), "g"),
    ];
    same("the imports", imports, wanted)
}

/// `@elif` and `@else` name the sibling before them, and `@else` has no expression.
fn branches_know_their_siblings() -> Outcome {
    let (module, names) = parse_wesl(
        "@if(a && b) const x = 1;\n@elif(!a) const x = 2;\n@else const x = 3;\nfn f() {}\n",
    );
    same("the items", module.items.len(), 4)?;
    let after: Vec<Option<u32>> =
        module.conditions.iter().map(|condition| condition.after).collect();
    same("the siblings", after, vec![None, Some(0), Some(1)])?;
    let has_expression: Vec<bool> =
        module.conditions.iter().map(|condition| condition.expression.is_some()).collect();
    same("the expressions", has_expression, vec![true, true, false])?;
    let flags: Vec<&str> = module
        .expressions
        .iter()
        .flat_map(Expression::names)
        .map(|name| names.text(name))
        .collect();
    same("the flags", flags, vec!["a", "b", "a"])
}

/// An error is at the author's text, and items behind it are still found.
fn errors_of_wesl_have_places() -> Outcome {
    let text = "fn f( { }\nconst x = 1;\n";
    let (module, _) = parse_wesl(text);
    let placed = wesl::PlacedModule::new(module.into(), SourceId(0));
    let error = placed.errors.first().ok_or("there should be an error")?;
    let label = error.labels.first().ok_or("the error should have a place")?;
    same("the place", &text[label.span.range()], "(")
}

/// Every branch of a conditional knows the next one, and all but the first the `#endif`.
fn directives_know_their_ends() -> Outcome {
    let text = "#version 300 es\n#if A\nx\n#elif B\n#else\ny\n#endif\n#include <a/b.glsl>\n";
    let mut sources = SourceSet::default();
    let id = sources.add("main.glsl", text);
    let module = glsl::parse(&sources, id, &mut glsl::Symbols::default());
    same("the errors", module.errors.len(), 0)?;
    let links: Vec<(usize, usize)> = module
        .parts
        .iter()
        .filter_map(|part| match part {
            FilePart::Directive(Directive::If { next, .. }, _) => Some((*next, 0)),
            FilePart::Directive(Directive::Elif { next, end, .. }, _) => Some((*next, *end)),
            FilePart::Directive(Directive::Else { end }, _) => Some((0, *end)),
            _ => None,
        })
        .collect();
    // The parts: #version, #if, x, #elif, #else, y, #endif, #include.
    same("the branches", links, vec![(3, 0), (4, 6), (0, 6)])?;
    let include = module.includes.first().ok_or("there should be an include")?;
    same("the path", (include.path.as_str(), include.angled), ("a/b.glsl", true))?;
    same("the line of `y`", text.find('y').map(|at| module.line(at as u32)), Some(6))
}
