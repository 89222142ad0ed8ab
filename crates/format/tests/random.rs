//! Random programs and token soups, with comments everywhere, whole and cut anywhere.

use lamplight_diagnostic::source::SourceSet;
use lamplight_format::{
    Braces, Indent, Language, LineEnds, Margin, Options, apply_edits, format_edits, format_range,
    format_text, format_typed,
};
use lamplight_testing::random::{Random, asked_number};
use libtest_mimic::{Failed, Trial};
use similar::TextDiff;

use super::lexer::tokens_of;

/// What both languages have.
const WORDS: &str = "struct const if else for while break switch case default return discard x \
    longer_name été 1 2.5 1e-3 .5 7u ( ) ( ) [ ] { } { } ; ; ; , , : . = += == < > <= >= << + - \
    * / % & && || ! ++ --";
/// What WESL has besides.
const WESL_WORDS: &str = "fn let var loop continuing import vec4f array 0x1p+2 :: -> | ^ ~ @ \
    @if(A) @else @group(0) #{N}";
/// What GLSL has besides.
const GLSL_WORDS: &str = "void float do layout uniform vec4 MACRO 0x1F ? ^^ \"s\"";
const DIRECTIVES: [&str; 8] = [
    "#if X",
    "#else",
    "#endif",
    "#define A(x) \\\n  x + 1",
    "#ifdef Y // why",
    "#include \"a.glsl\"",
    "#  elif Z /* so\n far */",
    "#version 450",
];
const COMMENTS: [&str; 5] =
    ["// one\n", "/* two */", "/* three\n     * four\n  */", "//\n", "/**/ "];
const GAPS: [&str; 10] = [" ", " ", " ", "\n", "\n    ", "\n\n\n", "\t", "  ", "\r", "\u{2028}"];

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("random_texts", random_texts)]
}

fn word_of<'w>(random: &mut Random, words: &[&'w str]) -> &'w str {
    words[random.below(words.len())]
}

/// Tokens in any order.
fn soup(random: &mut Random, language: Language) -> String {
    let own = if language == Language::Wesl { WESL_WORDS } else { GLSL_WORDS };
    let words: Vec<&str> = WORDS.split(' ').chain(own.split(' ')).collect();
    let mut text = String::new();
    for _ in 0..random.below(120) {
        text += word_of(random, &words);
        text += word_of(random, &GAPS);
        noise(random, &mut text, 12);
    }
    text
}

fn noise(random: &mut Random, text: &mut String, rarity: usize) {
    if random.below(rarity) == 0 {
        *text += word_of(random, &COMMENTS);
    }
    if random.below(rarity * 3) == 0 {
        *text += "\n";
        *text += word_of(random, &DIRECTIVES);
        *text += "\n";
    }
}

/// A program that has the shape of one, with comments and line breaks anywhere.
struct Program<'r> {
    random: &'r mut Random,
    language: Language,
    text: String,
    rarity: usize,
}

impl Program<'_> {
    fn put(&mut self, word: &str) {
        self.text += word;
        let gap =
            if self.random.below(self.rarity) == 0 { word_of(self.random, &GAPS) } else { " " };
        self.text += gap;
        if self.random.below(self.rarity * 2) == 0 {
            noise(self.random, &mut self.text, 3);
        }
    }

    fn all(&mut self, words: &str) {
        words.split(' ').for_each(|word| self.put(word));
    }

    fn expression(&mut self, depth: usize) {
        for index in 0..=self.random.below(4) {
            if index > 0 {
                let operator =
                    word_of(self.random, &["+", "-", "*", "/", "&&", "||", "<", "==", "%"]);
                self.put(operator);
            }
            match self.random.below(if depth == 0 { 3 } else { 7 }) {
                0 => self.put("1.5"),
                1 => self.put("some_name"),
                2 => self.all("- x"),
                3 => self.call(depth - 1),
                4 => {
                    self.put("(");
                    self.expression(depth - 1);
                    self.put(")");
                }
                5 => {
                    self.all("values [");
                    self.expression(depth - 1);
                    self.put("]");
                }
                _ if self.language == Language::Wesl => self.all("vec4 < f32 > ( 0 )"),
                _ => {
                    self.put("( a ?");
                    self.expression(depth - 1);
                    self.put(": 2 )");
                }
            }
        }
    }

    fn call(&mut self, depth: usize) {
        self.all("call_me (");
        for index in 0..self.random.below(6) {
            if index > 0 {
                self.put(",");
            }
            self.expression(depth);
        }
        self.put(")");
    }

    fn statement(&mut self, depth: usize) {
        let is_wesl = self.language == Language::Wesl;
        match self.random.below(if depth == 0 { 3 } else { 9 }) {
            0 => {
                self.all(if is_wesl { "let a : f32 =" } else { "float a =" });
                self.expression(2);
                self.put(";");
            }
            1 => {
                self.all("return");
                self.expression(3);
                self.put(";");
            }
            2 => {
                self.call(2);
                self.put(";");
            }
            3 | 4 => {
                self.all("if (");
                self.expression(1);
                self.put(")");
                if is_wesl || self.random.below(2) == 0 {
                    self.block(depth - 1);
                } else {
                    self.statement(depth - 1);
                }
                if self.random.below(2) == 0 {
                    self.put("else");
                    self.block(depth - 1);
                }
            }
            5 => {
                self.all("for ( i = 0 ; i < 4 ; i ++ )");
                self.block(depth - 1);
            }
            6 => self.choice(depth - 1),
            7 if is_wesl => {
                self.put("@if(A)");
                self.statement(depth - 1);
                self.put("@else");
                self.block(depth - 1);
            }
            _ => self.block(depth - 1),
        }
    }

    fn choice(&mut self, depth: usize) {
        self.all("switch ( a ) { case 1 :");
        self.block(depth);
        self.put("default :");
        self.statement(0);
        self.put("}");
    }

    fn block(&mut self, depth: usize) {
        self.put("{");
        for _ in 0..self.random.below(4) {
            self.statement(depth);
        }
        self.put("}");
    }

    fn item(&mut self) {
        match (self.language, self.random.below(4)) {
            (Language::Wesl, 0) => self.all("@if(A) import a::b::{ c , d as e } ;"),
            (Language::Wesl, 1) => self.all("struct S { @align(16) a : f32 , b : vec4 < f32 > , }"),
            (Language::Wesl, _) => {
                self.all("@compute fn f ( a : f32 , @builtin(x) b : u32 ) -> f32");
                self.block(3);
            }
            (Language::Glsl, 0) => self.all("layout ( location = 0 ) uniform B { float a ; } b ;"),
            (Language::Glsl, 1) => self.all("const float t [ 3 ] = { 1.0 , 2.0 , 3.0 } ;"),
            (Language::Glsl, _) => {
                self.all("void f ( in float a , out vec4 b )");
                self.block(3);
            }
        }
    }
}

fn program(random: &mut Random, language: Language) -> String {
    let rarity = 2 + random.below(30);
    let mut program = Program { random, language, text: String::new(), rarity };
    for _ in 0..=program.random.below(5) {
        program.item();
    }
    program.text
}

fn some_options(random: &mut Random) -> Options {
    let braces = [Braces::Keep, Braces::SameLine, Braces::NextLine];
    let margins = [Margin::Keep, Margin::Start, Margin::Indented];
    Options {
        width: 20 + random.below(100),
        indent: [Indent::Spaces(4), Indent::Spaces(2), Indent::Tab][random.below(3)],
        braces: braces[random.below(3)],
        directives: margins[random.below(3)],
        conditions: margins[random.below(3)],
        line_ends: LineEnds::Keep,
        final_newline: random.below(2) == 0,
    }
}

/// What must hold for every text.
pub fn check_text(
    text: &str,
    language: Language,
    options: &Options,
    at: usize,
) -> Result<(), String> {
    let mut sources = SourceSet::default();
    let id = sources.add("text", text.to_owned());
    let once = format_text(text, id, language, options).text;
    let (before, after) = (tokens_of(text, language), tokens_of(&once, language));
    if let Some((old, new)) = before.iter().zip(&after).find(|(old, new)| old != new) {
        return Err(format!("`{old}` became `{new}`"));
    }
    if before.len() != after.len() {
        return Err(format!("{} tokens of {}", after.len(), before.len()));
    }
    let twice = format_text(&once, id, language, options).text;
    if twice != once {
        let diff = TextDiff::from_lines(&once, &twice);
        return Err(format!("the second time:\n{}", diff.unified_diff().context_radius(4)));
    }
    let edited = apply_edits(text, &format_edits(text, language, options));
    if edited != once {
        return Err(format!("with edits:\n{edited}"));
    }
    let at = text.floor_char_boundary(at);
    for edits in [
        format_range(text, at..text.floor_char_boundary(at + 20), language, options),
        format_typed(text, at, language, options),
    ] {
        let edited = apply_edits(text, &edits);
        if tokens_of(&edited, language) != before {
            return Err(format!("in a range:\n{edited}"));
        }
    }
    Ok(())
}

/// The text without the pieces that a mistake does not need.
fn shrink_text(text: &str, fails: impl Fn(&str) -> bool) -> String {
    let mut pieces: Vec<&str> = text.split_inclusive(char::is_whitespace).collect();
    let mut length = pieces.len().div_ceil(2);
    while length > 0 {
        let mut at = 0;
        while at < pieces.len() {
            let end = (at + length).min(pieces.len());
            let rest = [&pieces[..at], &pieces[end..]].concat();
            match fails(&rest.concat()) {
                true => pieces = rest,
                false => at = end,
            }
        }
        length /= 2;
    }
    pieces.concat()
}

fn random_texts() -> Result<(), Failed> {
    let first = asked_number("LAMPLIGHT_FORMAT_SEED", 1);
    for seed in first..first + asked_number("LAMPLIGHT_FORMAT_PROGRAMS", 600) {
        let mut random = Random(seed);
        let language = [Language::Wesl, Language::Glsl][random.below(2)];
        let is_soup = random.below(3) == 0;
        let mut text = match is_soup {
            true => soup(&mut random, language),
            false => program(&mut random, language),
        };
        if random.below(4) == 0 {
            let length = random.below(text.len() + 1);
            text.truncate(text.floor_char_boundary(length));
        }
        if random.below(5) == 0 {
            text = text.replace('\n', "\r\n");
        }
        let options = some_options(&mut random);
        let at = random.below(text.len() + 1);
        let check = |text: &str| {
            let at = at.min(text.len());
            let checked = std::panic::catch_unwind(|| check_text(text, language, &options, at));
            checked.unwrap_or_else(|_| Err("a panic".to_owned()))
        };
        if check(&text).is_err() {
            let small = shrink_text(&text, |text| check(text).is_err());
            let found = check(&small).err().unwrap_or_default();
            let about = format!("seed {seed}, {language:?}, {options:?}");
            return Err(format!("{about}:\n{small:?}\n{small}\n----\n{found}").into());
        }
    }
    Ok(())
}
