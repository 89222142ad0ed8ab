//! Random programs: every value is defined, and floats stay small and exact.

use std::fmt::Write as _;

use lamplight_testing::random::Random;

/// The types of variables.
const TYPES: [&str; 11] =
    ["int", "uint", "float", "bool", "vec2", "vec3", "vec4", "ivec3", "uvec2", "mat2", "mat3"];

/// What values of each type are made of: constants, members of blocks and variables of the text.
const LEAVES: [(&str, &[&str]); 9] = [
    ("bool", &["true", "false", "block.flag", "flag"]),
    (
        "float",
        &[
            "block.list[1]",
            "list[calls % 3]",
            "block.part.weight",
            "block.rows[1][calls & 1]",
            "parts[calls & 1].weight",
        ],
    ),
    (
        "vec2",
        &["vec2(1.5, -2.0)", "pairs[calls & 1]", "block.small[1]", "wide[1].xy", "block.pairs[0]"],
    ),
    (
        "vec3",
        &["vec3(1.0, 2.5, -1.0)", "block.color", "rows[2]", "wide[0]", "block.rows[calls % 3]"],
    ),
    ("vec4", &["vec4(0.5)", "block.whole[2]", "grid[1][2]", "block.grid[0][calls % 3]"]),
    ("ivec3", &["ivec3(1, 2, 3)", "kept.count", "ivec3(block.color)"]),
    ("uvec2", &["uvec2(3u, 9u)"]),
    (
        "mat2",
        &["mat2(2.0)", "block.small", "small", "kept.turn", "parts[1].turn", "block.part.turn"],
    ),
    ("mat3", &["mat3(1.0)", "block.rows", "rows", "mat3(block.whole)"]),
];

/// A variable that statements may use.
#[derive(Clone)]
struct Variable {
    name: String,
    ty: &'static str,
    writable: bool,
}

/// A function that was written: result, name, parameters; `true` for `inout`.
type Function = (&'static str, String, Vec<(&'static str, bool)>);

struct Writer<'r> {
    random: &'r mut Random,
    text: String,
    variables: Vec<Variable>,
    depth: usize,
    loops: usize,
    next: usize,
    functions: Vec<Function>,
    /// Whether expressions may have effects.
    effects: bool,
}

/// A program.
pub fn write_program(random: &mut Random) -> String {
    let mut writer = Writer {
        random,
        text: String::new(),
        variables: Vec::new(),
        depth: 0,
        loops: 0,
        next: 0,
        functions: Vec::new(),
        effects: false,
    };
    writer.head();
    writer.globals();
    for _ in 0..2 + writer.random.below(3) {
        writer.function();
    }
    writer.main();
    writer.text
}

impl Writer<'_> {
    fn head(&mut self) {
        self.text.push_str(
            "#version 450\nlayout(local_size_x = 1) in;\n\
             layout(std430, binding = 0) buffer Out { uint words[]; } result;\n\
             struct Part { float weight; ivec3 count; mat2 turn; };\n",
        );
        let members = [
            "float list[3];",
            "mat2 small;",
            "layout(row_major) mat3 rows;",
            "vec3 color;",
            "float after;",
            "Part part;",
            "vec2 pairs[2];",
            "layout(row_major) mat2x3 wide;",
            "mat4 whole;",
            "Part parts[2];",
            "vec4 grid[2][3];",
            "bool flag;",
        ];
        let mut chosen: Vec<&str> = members.to_vec();
        self.random.shuffle(&mut chosen);
        let list = chosen.join(" ");
        let rows = if self.random.chance(30) { ", row_major" } else { "" };
        let _ = writeln!(
            self.text,
            "layout(std140, binding = 1{rows}) uniform Block {{ {list} }} block;"
        );
        self.random.shuffle(&mut chosen);
        let list = chosen.join(" ");
        let _ =
            writeln!(self.text, "layout(std430, binding = 2) readonly buffer Store {{ {list} }};");
    }

    fn globals(&mut self) {
        self.text.push_str("int calls = 0;\nfloat total = 1.0;\nPart kept;\n");
        self.text.push_str("int table[2][3] = int[2][3](int[3](1, 2, 3), int[3](4, 5, 6));\n");
        self.text
            .push_str("bool called(bool value) { calls += 1; total += 0.25; return value; }\n");
        self.text.push_str("int count(int value) { calls++; return value + calls; }\n");
        // Drivers need not keep the sign of a zero (Vulkan 1.3, SignedZeroInfNanPreserve), so it is not
        // written.
        self.text.push_str("uint bits(float x) { return x == 0.0 ? 0u : floatBitsToUint(x); }\n");
        self.text.push_str(
            "float limited(float x) { return isnan(x) ? 0.0 : floor(clamp(x, -64.0, 64.0) * 4.0) * 0.25; }\n\
             vec2 limited(vec2 v) { return vec2(limited(v.x), limited(v.y)); }\n\
             vec3 limited(vec3 v) { return vec3(limited(v.xy), limited(v.z)); }\n\
             vec4 limited(vec4 v) { return vec4(limited(v.xyz), limited(v.w)); }\n\
             mat2 limited(mat2 m) { return mat2(limited(m[0]), limited(m[1])); }\n\
             mat3 limited(mat3 m) { return mat3(limited(m[0]), limited(m[1]), limited(m[2])); }\n",
        );
    }

    fn name(&mut self) -> String {
        const NAMES: [&str; 8] = ["a", "loop", "mix", "f32", "value", "let", "t1", "vec3f"];
        self.next += 1;
        let base = *self.random.pick(&NAMES);
        // The cases of a `switch` share a scope, so no name is used twice there.
        let bare = self.depth < 2 && self.random.chance(20);
        if bare { base.to_owned() } else { format!("{base}{}", self.next) }
    }

    /// A name that no other variable in scope has.
    fn fresh(&mut self) -> String {
        loop {
            let name = self.name();
            let taken = self.variables.iter().any(|variable| variable.name == name);
            let reserved = ["mix", "f", "calls"].contains(&name.as_str());
            if !taken && !reserved {
                return name;
            }
        }
    }

    fn function(&mut self) {
        let ret = *self.random.pick(&TYPES[..7]);
        let name = format!("helper{}", self.functions.len());
        let mut params: Vec<(&'static str, bool)> = Vec::new();
        let mut list = Vec::new();
        self.variables.clear();
        for _ in 0..1 + self.random.below(3) {
            let ty = *self.random.pick(&TYPES);
            let inout = self.random.chance(40);
            let name = self.fresh();
            list.push(format!("{}{ty} {name}", if inout { "inout " } else { "" }));
            self.variables.push(Variable { name, ty, writable: true });
            params.push((ty, inout));
        }
        let _ = writeln!(self.text, "{ret} {name}({}) {{", list.join(", "));
        self.depth = 1;
        self.effects = false;
        for _ in 0..2 + self.random.below(4) {
            self.statement();
        }
        if self.random.chance(30) {
            let condition = self.expr("bool", 2);
            let value = self.limited(ret);
            self.line(&format!("if ({condition}) return {value};"));
        }
        let value = self.limited(ret);
        self.line(&format!("return {value};"));
        self.text.push_str("}\n");
        self.functions.push((ret, name, params));
    }

    fn main(&mut self) {
        self.text.push_str("void main() {\n");
        self.variables.clear();
        self.depth = 1;
        self.effects = true;
        self.line("kept = Part(1.5, ivec3(1, -2, 3), mat2(1.0, 2.0, 3.0, 4.0));");
        self.line("int at = 0;");
        for ty in TYPES {
            self.declare(ty);
        }
        for _ in 0..6 + self.random.below(10) {
            self.statement();
        }
        self.line("result.words[at++] = uint(calls);");
        self.line("result.words[at++] = bits(total);");
        for index in 0..6 {
            let (row, column) = (index / 3, index % 3);
            self.line(&format!("result.words[at++] = uint(table[{row}][{column}]);"));
        }
        self.line("for (int i = 0; i < 3; i++) result.words[at++] = uint(kept.count[i]);");
        for variable in self.variables.clone() {
            self.emit(&variable);
        }
        self.text.push_str("}\n");
    }

    /// Writes a variable to the buffer.
    fn emit(&mut self, variable: &Variable) {
        let name = &variable.name;
        let parts: Vec<String> = match variable.ty {
            "int" | "uint" => vec![format!("uint({name})")],
            "bool" => vec![format!("uint({name})")],
            "float" => vec![format!("bits({name})")],
            "vec2" | "vec3" | "vec4" => {
                let size: usize = variable.ty[3..].parse().unwrap_or(2);
                (0..size).map(|at| format!("bits({name}[{at}])")).collect()
            }
            "ivec3" => (0..3).map(|at| format!("uint({name}[{at}])")).collect(),
            "uvec2" => (0..2).map(|at| format!("{name}[{at}]")).collect(),
            _ => {
                let size: usize = variable.ty[3..].parse().unwrap_or(2);
                let cell = |at: usize| format!("bits({name}[{}][{}])", at / size, at % size);
                (0..size * size).map(cell).collect()
            }
        };
        for part in parts {
            self.line(&format!("if (at < 250) result.words[at++] = {part};"));
        }
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.text, "{}{text}", "    ".repeat(self.depth));
    }

    fn declare(&mut self, ty: &'static str) {
        let name = self.fresh();
        let value = self.limited(ty);
        self.line(&format!("{ty} {name} = {value};"));
        self.variables.push(Variable { name, ty, writable: true });
    }

    fn statement(&mut self) {
        let choice = self.random.below(if self.depth > 3 { 6 } else { 14 });
        match choice {
            0..=2 => self.assign(),
            3 => {
                let ty = *self.random.pick(&TYPES);
                self.declare(ty);
            }
            4 => self.step(),
            5 => self.swizzle(),
            6 | 7 => self.if_statement(),
            8 | 9 => self.for_loop(),
            10 => self.switch(),
            11 => self.call(),
            12 => self.do_loop(),
            _ => self.global_effect(),
        }
    }

    fn block(&mut self, statements: usize) {
        let kept = self.variables.len();
        self.depth += 1;
        for _ in 0..statements {
            self.statement();
        }
        self.depth -= 1;
        self.variables.truncate(kept);
    }

    fn writable(&mut self, ty: Option<&str>) -> Option<Variable> {
        let fits = |v: &&Variable| v.writable && ty.is_none_or(|ty| ty == v.ty);
        let list: Vec<Variable> = self.variables.iter().filter(fits).cloned().collect();
        if list.is_empty() { None } else { Some(self.random.pick(&list).clone()) }
    }

    fn assign(&mut self) {
        let Some(variable) = self.writable(None) else { return };
        let (name, ty) = (variable.name, variable.ty);
        if self.random.chance(40) && !matches!(ty, "bool") {
            let op = match ty {
                "int" | "uint" | "ivec3" | "uvec2" => {
                    *self.random.pick(&["+", "-", "*", "&", "|", "^"])
                }
                _ => *self.random.pick(&["+", "-"]),
            };
            let value = self.limited(ty);
            self.line(&format!("{name} {op}= {value};"));
            self.bound(&name, ty);
            return;
        }
        if self.random.chance(15)
            && let Some(other) = self.writable(Some(ty))
        {
            let value = self.limited(ty);
            self.line(&format!("{name} = {} = {value};", other.name));
            return;
        }
        let value = self.limited(ty);
        self.line(&format!("{name} = {value};"));
    }

    fn bound(&mut self, name: &str, ty: &str) {
        if matches!(ty, "float" | "vec2" | "vec3" | "vec4" | "mat2" | "mat3") {
            self.line(&format!("{name} = limited({name});"));
        }
    }

    fn step(&mut self) {
        let ty = *self.random.pick(&["int", "uint", "float", "ivec3", "mat2"]);
        let Some(variable) = self.writable(Some(ty)) else { return };
        let op = *self.random.pick(&["++", "--"]);
        let text = match self.random.chance(50) {
            true => format!("{op}{};", variable.name),
            false => format!("{}{op};", variable.name),
        };
        self.line(&text);
        self.bound(&variable.name, ty);
    }

    fn swizzle(&mut self) {
        let (ty, letters, part): (&str, &str, &str) = *self.random.pick(&[
            ("vec4", "zx", "vec2"),
            ("vec4", "xyz", "vec3"),
            ("vec3", "zy", "vec2"),
            ("vec3", "y", "float"),
            ("vec2", "yx", "vec2"),
            ("ivec3", "x", "int"),
            ("uvec2", "gr", "uvec2"),
            ("vec4", "rgba", "vec4"),
        ]);
        let Some(variable) = self.writable(Some(ty)) else { return };
        let op = *self.random.pick(&["=", "+=", "="]);
        let value = self.limited(part);
        self.line(&format!("{}.{letters} {op} {value};", variable.name));
        self.bound(&variable.name, ty);
    }

    fn if_statement(&mut self) {
        let condition = self.expr("bool", 3);
        self.line(&format!("if ({condition}) {{"));
        let count = 1 + self.random.below(2);
        self.block(count);
        if self.random.chance(50) {
            self.line("} else {");
            self.block(count);
        }
        self.line("}");
    }

    fn for_loop(&mut self) {
        let name = format!("i{}", self.loops);
        self.loops += 1;
        let count = 2 + self.random.below(3);
        let head = match self.random.below(4) {
            0 => format!("for (int {name} = 0; {name} < {count}; {name}++) {{"),
            1 => format!("for (int {name} = {count}; {name} > 0; --{name}) {{"),
            2 => format!("for (int {name} = 0, end = {count}; {name}++ < end; calls++) {{"),
            _ => format!("for (int {name} = 0; called({name} < {count}); {name} += 1) {{"),
        };
        self.line(&head);
        self.variables.push(Variable { name, ty: "int", writable: false });
        let condition = self.expr("bool", 2);
        let jump = *self.random.pick(&["continue", "break"]);
        self.block(1);
        self.depth += 1;
        self.line(&format!("if ({condition}) {jump};"));
        self.depth -= 1;
        self.block(1);
        self.line("}");
        self.variables.pop();
    }

    fn do_loop(&mut self) {
        let name = format!("round{}", self.loops);
        self.loops += 1;
        self.line(&format!("int {name} = 0;"));
        self.line("do {");
        let condition = self.expr("bool", 2);
        self.depth += 1;
        self.line(&format!("if ({condition} && {name} < 2) {{ {name} += 2; continue; }}"));
        self.depth -= 1;
        self.block(1);
        self.line(&format!("}} while (++{name} < 3);"));
    }

    fn switch(&mut self) {
        let selector = self.expr("int", 2);
        let kind = self.random.chance(30);
        let (open, suffix) = if kind { ("uint(", "u") } else { ("int(", "") };
        self.line(&format!("switch ({open}{selector}) & 3{suffix}) {{"));
        let mut labels = vec![
            format!("case 0{suffix}:"),
            format!("case 1{suffix}:"),
            format!("case 2{suffix}:"),
            "default:".to_owned(),
        ];
        self.random.shuffle(&mut labels);
        for (index, label) in labels.iter().enumerate() {
            self.line(label);
            let last = index + 1 == labels.len();
            if self.random.chance(20) && !last {
                continue;
            }
            self.block(1);
            let condition = self.expr("bool", 1);
            match self.random.below(4) {
                0 => {}
                1 => self.line(&format!("    if ({condition}) break;")),
                _ => self.line("    break;"),
            }
        }
        if self.text.trim_end().ends_with(':') {
            self.line("    break;");
        }
        self.line("}");
    }

    /// Calls a function; arguments of `inout` are different variables, elements or components.
    fn call(&mut self) {
        if self.functions.is_empty() || !self.effects {
            return;
        }
        let index = self.random.below(self.functions.len());
        let (ret, name, params) = self.functions[index].clone();
        let mut used: Vec<String> = Vec::new();
        let mut list = Vec::new();
        for (ty, inout) in params {
            if !inout {
                list.push(self.limited(ty));
                continue;
            }
            let place = match (ty, self.random.chance(50)) {
                ("float", true) => "block_copy.weight".replace("block_copy", "kept"),
                ("int", true) => format!("table[{}][calls & 1]", self.random.below(2)),
                ("ivec3", true) => "kept.count".to_owned(),
                _ => match self.writable(Some(ty)) {
                    Some(variable) => variable.name,
                    None => return,
                },
            };
            if used.contains(&place) {
                return;
            }
            used.push(place.clone());
            list.push(place);
        }
        let Some(target) = self.writable(Some(ret)) else { return };
        if used.contains(&target.name) {
            return;
        }
        self.line(&format!("{} = {name}({});", target.name, list.join(", ")));
    }

    fn global_effect(&mut self) {
        let text = match self.random.below(5) {
            0 => "table[calls & 1][count(0) % 3] += 10;".to_owned(),
            1 => "kept.count.zx = kept.count.xy;".to_owned(),
            2 => {
                let value = self.limited("float");
                format!("total = limited(total + {value});")
            }
            3 => "kept.turn[1] = limited(kept.turn[0] + block.pairs[1]);".to_owned(),
            _ => "kept.weight = limited(block.list[calls % 3]);".to_owned(),
        };
        self.line(&text);
    }

    /// An expression whose floats are small and exact.
    fn limited(&mut self, ty: &str) -> String {
        let text = self.expr(ty, 3);
        match ty {
            "float" | "vec2" | "vec3" | "vec4" | "mat2" | "mat3" => format!("limited({text})"),
            _ => text,
        }
    }

    fn leaf(&mut self, ty: &str) -> String {
        let fits: Vec<String> =
            self.variables.iter().filter(|v| v.ty == ty).map(|v| v.name.clone()).collect();
        if !fits.is_empty() && self.random.chance(60) {
            return self.random.pick(&fits).clone();
        }
        let number = self.random.below(9) as i32 - 4;
        match ty {
            "int" => number.to_string(),
            "uint" => format!("{}u", self.random.below(9)),
            "float" if self.random.chance(30) => format!("{number}.5"),
            _ => {
                let (_, texts) = LEAVES.iter().find(|(known, _)| *known == ty).unwrap();
                (*self.random.pick(texts)).to_owned()
            }
        }
    }

    fn expr(&mut self, ty: &str, depth: usize) -> String {
        if depth == 0 || self.random.chance(20) {
            return self.leaf(ty);
        }
        let depth = depth - 1;
        match ty {
            "bool" => self.bool_expr(depth),
            "int" => self.int_expr(depth),
            "uint" => self.uint_expr(depth),
            "float" => self.float_expr(depth),
            "mat2" | "mat3" => self.matrix_expr(ty, depth),
            _ => self.vector_expr(ty, depth),
        }
    }

    fn choice(&mut self, ty: &str, depth: usize) -> String {
        let (c, a, b) = (self.expr("bool", depth), self.expr(ty, depth), self.expr(ty, depth));
        format!("({c} ? {a} : {b})")
    }

    fn bool_expr(&mut self, depth: usize) -> String {
        let (a, b) = (self.expr("bool", depth), self.expr("bool", depth));
        match self.random.below(8) {
            0 => format!("({a} && {b})"),
            1 => format!("({a} || {b})"),
            2 => format!("({a} ^^ {b})"),
            3 => format!("!{a}"),
            4 => format!("({a} && called({b}))"),
            5 => format!("(called({a}) || called({b}))"),
            6 => {
                let ty = *self.random.pick(&["int", "vec3", "ivec3", "uvec2", "mat2"]);
                let op = *self.random.pick(&["==", "!="]);
                let (a, b) = (self.expr(ty, depth), self.expr(ty, depth));
                format!("({a} {op} {b})")
            }
            _ => {
                let ty = *self.random.pick(&["int", "uint", "float"]);
                let op = *self.random.pick(&["<", ">", "<=", ">="]);
                let (a, b) = (self.expr(ty, depth), self.expr(ty, depth));
                format!("({a} {op} {b})")
            }
        }
    }

    fn int_expr(&mut self, depth: usize) -> String {
        let (a, b) = (self.expr("int", depth), self.expr("int", depth));
        match self.random.below(9) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} - {b})"),
            2 => format!("({a} * {b})"),
            3 => format!("({a} / 3)"),
            4 => format!("(({a} & {b}) | ({a} >> 2))"),
            5 => format!("({a} << ({b} & 7))"),
            6 => self.choice("int", depth),
            7 => format!("count({a})"),
            _ => format!("max(-({a}), table[1][calls & 1])"),
        }
    }

    fn uint_expr(&mut self, depth: usize) -> String {
        let (a, b) = (self.expr("uint", depth), self.expr("uint", depth));
        match self.random.below(6) {
            0 => format!("({a} * {b} + 1u)"),
            1 => format!("({a} % 7u)"),
            2 => format!("({a} ^ ~{b})"),
            3 => format!("uint({})", self.expr("int", depth)),
            4 => format!("-({a})"),
            _ => self.choice("uint", depth),
        }
    }

    fn float_expr(&mut self, depth: usize) -> String {
        let (a, b) = (self.expr("float", depth), self.expr("float", depth));
        match self.random.below(9) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} - {b})"),
            2 => format!("(limited({a}) * 2.0)"),
            3 => format!("min({a}, abs({b}))"),
            4 => format!("limited({}).y", self.expr("vec3", depth)),
            5 => format!("float({} % 100u)", self.expr("uint", depth)),
            6 => format!("float({})", self.expr("bool", depth)),
            7 => format!("floor({a})"),
            _ => self.choice("float", depth),
        }
    }

    fn vector_expr(&mut self, ty: &str, depth: usize) -> String {
        let (a, b) = (self.expr(ty, depth), self.expr(ty, depth));
        let size: usize = ty[ty.len() - 1..].parse().unwrap_or(2);
        match self.random.below(7) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} - {b})"),
            2 => format!("max({a}, {b})"),
            3 => self.choice(ty, depth),
            4 if ty == "vec3" => {
                format!("vec3({}, {})", self.expr("vec2", depth), self.expr("float", depth))
            }
            4 if ty == "vec4" => {
                format!("vec4({}, {})", self.expr("float", depth), self.expr("vec3", depth))
            }
            5 => format!("{a}.{}", &"yxwz"[..size].replace(['w', 'z'], "x")),
            _ => format!("-({b})"),
        }
    }

    fn matrix_expr(&mut self, ty: &str, depth: usize) -> String {
        let (a, b) = (self.expr(ty, depth), self.expr(ty, depth));
        match self.random.below(6) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} - {b})"),
            2 => format!("transpose({a})"),
            3 => format!("(limited({a}) * 2.0)"),
            4 => format!("(limited({a}) + {})", self.random.below(3) as f32 + 0.5),
            _ => self.choice(ty, depth),
        }
    }
}
