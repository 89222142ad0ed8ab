//! Random programs.

use std::fmt::Write as _;

/// A generator of numbers.
pub struct Dice(pub u32);

impl Dice {
    pub fn roll(&mut self, sides: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 3) % sides
    }

    /// Mostly small numbers, with those among them that operations treat specially.
    pub fn number(&mut self) -> f32 {
        match self.roll(60) {
            0 => 0.0,
            1 => -0.0,
            2 => 1.0,
            3 => f32::INFINITY,
            4 => f32::NAN,
            _ => (self.roll(4001) as f32 - 2000.0) / 500.0,
        }
    }
}

/// A random program. Its numbers are variables, or in a buffer, since naga computes expressions of
/// constants by itself. All of its variables are in scope everywhere: `x` and `y` are numbers, `v` is a
/// vector, `i` an integer and `a` an array.
struct Draft {
    dice: Dice,
    text: String,
    /// How deep blocks may nest from here.
    depth: u32,
    loops: u32,
    /// Functions that may be called.
    callees: u32,
    /// How many loops enclose the statement. Outside of all loops, there is no `break` and
    /// `continue`.
    inside: u32,
}

impl Draft {
    fn number(&mut self) -> String {
        let options = [
            "x",
            "y",
            "v.x",
            "v[i & 3]",
            "a[i]",
            "f32(i)",
            "given[0].z",
            "-given[1].y",
            "given[2].w",
            "v.w",
            "held",
        ];
        let pick = self.dice.roll(options.len() as u32) as usize;
        options[pick].to_owned()
    }

    fn value(&mut self) -> String {
        let (a, b, c) = (self.number(), self.number(), self.number());
        match self.dice.roll(26) {
            0 => format!("{a} + {b}"),
            1 => format!("{a} - {b} * {c}"),
            2 => format!("{a} / {b}"),
            3 => format!("min({a}, {b})"),
            4 => format!("max({a}, {b})"),
            5 => format!("clamp({a}, -1.0, {b})"),
            6 => format!("mix({a}, {b}, {c})"),
            7 => format!("smoothstep(0.0, 2.0, {a})"),
            8 => format!("sin({a}) + cos({b})"),
            9 => format!("pow(abs({a}), 1.5)"),
            10 => format!("sqrt(abs({a})) + inverseSqrt(abs({b}) + 0.1)"),
            11 => format!("floor({a}) + fract({b}) + round({c}) + trunc({a})"),
            12 => format!("dot(v, vec4f({a}, {b}, {c}, 1.0))"),
            13 => format!("length(v.xyz) + distance(v.xy, vec2f({a}, {b}))"),
            14 => format!("normalize(vec3f({a}, {b}, {c})).y"),
            15 => format!("reflect(v.xyz, vec3f({a}, {b}, 0.0)).x + cross(v.xyz, v.zyx).z"),
            16 => format!("select({a}, {b}, {c} < {a})"),
            17 => format!("fma({a}, {b}, {c}) + {a} % 3.0"),
            18 => format!("(mat2x2f({a}, {b}, {c}, 1.0) * v.xy).y"),
            19 => format!("determinant(mat3x3f(v.xyz, v.yzx, vec3f({a}, {b}, {c})))"),
            20 => format!(
                "refract(v.xyz, vec3f(0.0, 0.0, 1.0), {a}).x + faceForward(v.xy, v.zw, v.yx).x"
            ),
            21 => format!("bitcast<f32>(bitcast<u32>({a}) & 0xfffffff0u)"),
            22 => {
                format!("unpack2x16float(pack2x16float(vec2f({a}, {b}))).y + f32(pack4x8unorm(v))")
            }
            23 => format!("exp2(clamp({a}, -9.0, 9.0)) + atan2({b}, {c}) + sign({a})"),
            24 => self.met(),
            _ => self.called(),
        }
    }

    /// A derivative, which depends on the other lanes of the quad, or a texture lookup.
    fn met(&mut self) -> String {
        let (a, b) = (self.number(), self.number());
        match self.dice.roll(9) {
            0 => format!("dpdx({a})"),
            1 => format!("dpdyFine({a})"),
            2 => format!("dpdxCoarse({a})"),
            3 => format!("fwidth({a})"),
            4 => format!("textureSample(image, smooth_sampler, vec2f({a}, {b})).y"),
            5 => format!("textureSampleBias(image, smooth_sampler, vec2f({a}, {b}), 0.5).x"),
            6 => format!("textureSampleLevel(image, smooth_sampler, vec2f({a}, {b}), {a}).x"),
            7 => "textureLoad(image, vec2i(i, 1), 0).x".to_owned(),
            _ => format!("textureSampleCompareLevel(depths, depth_sampler, vec2f({a}, {b}), {a})"),
        }
    }

    fn called(&mut self) -> String {
        if self.callees == 0 {
            return self.number();
        }
        let callee = self.dice.roll(self.callees);
        format!("helper_{callee}({}, &y, i)", self.number())
    }

    fn whole(&mut self) -> String {
        let options = [
            "i + 1",
            "i * 3 - 2",
            "i32(clamp(x, -5.0, 5.0))",
            "i & 6",
            "i >> 1u",
            "-i",
            "i / 2",
            "countOneBits(i)",
            "extractBits(i, 1u, 3u)",
            "insertBits(i, 2, 1u, 2u)",
            "abs(i) % 7",
            "max(i, -2)",
            "select(i, 2, y > x)",
            "firstLeadingBit(i)",
            "i32(any(v.xy > v.zw))",
        ];
        let pick = self.dice.roll(options.len() as u32) as usize;
        options[pick].to_owned()
    }

    fn condition(&mut self) -> String {
        let (a, b) = (self.number(), self.number());
        match self.dice.roll(5) {
            0 => format!("{a} < {b}"),
            1 => format!("{a} >= {b}"),
            2 => format!("{a} == {b}"),
            3 => "i > 1".to_owned(),
            _ => "(i & 1) == 0".to_owned(),
        }
    }

    fn block(&mut self) -> String {
        self.depth -= 1;
        let count = 1 + self.dice.roll(4);
        let block = (0..count).map(|_| self.statement()).collect();
        self.depth += 1;
        block
    }

    fn statement(&mut self) -> String {
        let sides = if self.depth == 0 { 7 } else { 13 };
        match self.dice.roll(sides) {
            0 => format!("x = {};\n", self.value()),
            1 => format!("y = {};\n", self.value()),
            2 => format!("v[i & 3] = {};\n", self.value()),
            3 => format!("i = {};\n", self.whole()),
            4 => format!("a[i] = {};\n", self.value()),
            5 => format!("v = vec4f(v.yzw, {});\n", self.value()),
            6 => format!("held += {};\n", self.value()),
            7 | 8 => format!("if {} {{\n{}}}\n", self.condition(), self.block()),
            9 => {
                let condition = self.condition();
                format!("if {condition} {{\n{}}} else {{\n{}}}\n", self.block(), self.block())
            }
            10 => format!(
                "switch i {{\ncase 0, 2: {{\n{}}}\ncase 1: {{\n{}}}\ndefault: {{\n{}}}\n}}\n",
                self.block(),
                self.block(),
                self.block()
            ),
            11 => self.repeated(),
            _ => self.left(),
        }
    }

    fn repeated(&mut self) -> String {
        let name = format!("turn_{}", self.loops);
        self.loops += 1;
        self.inside += 1;
        let (condition, block) = (self.condition(), self.block());
        self.inside -= 1;
        // A counter ends the loop, whatever its lanes do.
        let most = 1 + self.dice.roll(4);
        match self.dice.roll(2) {
            0 => {
                format!("for (var {name} = 0; {name} < {most} + (i & 3); {name}++) {{\n{block}}}\n")
            }
            _ => format!(
                "{{\nvar {name} = 0;\nloop {{\n{name}++;\nif {name} > {most} {{ break; }}\n{block}\
                 if {condition} {{ continue; }}\nx += 0.25;\n}}\n}}\n"
            ),
        }
    }

    /// Leaves a loop, a function, or the fragment.
    fn left(&mut self) -> String {
        let condition = self.condition();
        let way = match self.dice.roll(4) {
            0 if self.inside > 0 => "break;",
            1 if self.inside > 0 => "continue;",
            2 => "discard;",
            _ => "return x + y;",
        };
        format!("if {condition} {{ {way} }}\n")
    }
}

/// The text of a random program, whose function `f` takes two numbers, a vector and an integer.
pub fn draft_program(seed: u32) -> String {
    let dice = Dice(seed.wrapping_mul(2_654_435_761) | 1);
    let mut draft = Draft { dice, text: String::new(), depth: 0, loops: 0, callees: 0, inside: 0 };
    draft.text += "diagnostic(off, derivative_uniformity);\n\
        @group(0) @binding(0) var image: texture_2d<f32>;\n\
        @group(0) @binding(1) var smooth_sampler: sampler;\n\
        @group(0) @binding(2) var depths: texture_depth_2d;\n\
        @group(0) @binding(3) var depth_sampler: sampler_comparison;\n\
        @group(0) @binding(4) var<uniform> given: array<vec4f, 3>;\n\
        var<private> held: f32 = 0.75;\n";
    for helper in 0..2 {
        draft.depth = 2;
        let body = draft.block();
        let _ = writeln!(
            draft.text,
            "fn helper_{helper}(given_x: f32, out: ptr<function, f32>, given_i: i32) -> f32 {{\n\
             var x = given_x; var y = *out; var i = given_i;\n\
             var v = vec4f(x, y, given[i].z, 0.5); var a = array<f32, 3>(x, y, 1.0);\n\
             {body}*out = y + 1.0;\nreturn x + a[i];\n}}"
        );
        draft.callees += 1;
    }
    draft.depth = 4;
    let body: String = (0..5).map(|_| draft.block()).collect();
    let _ = writeln!(
        draft.text,
        "fn f(given_x: f32, given_y: f32, given_v: vec4f, given_i: i32) -> f32 {{\n\
         var x = given_x; var y = given_y; var v = given_v; var i = given_i;\n\
         var a = array<f32, 3>(x, y, given[0].y);\n\
         {body}return x + 2.0 * y + dot(v, v) + a[0] + held;\n}}"
    );
    draft.text
}
