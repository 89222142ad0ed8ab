//! Parameters of a new function of the shader library, as WESL declares them.

/// A type that a new function may take or return.
#[derive(Debug, Clone, Copy)]
pub struct Type {
    /// In WESL.
    pub wesl: &'static str,
    /// The method that reads an argument of this type in the reference, which is in Rust.
    pub read: &'static str,
    /// The reference's placeholder for a result: a value that equals no other, such as NaN.
    pub nothing: &'static str,
    /// A number made of the value, for a plot. `$` stands for the value.
    pub number: &'static str,
    /// A value that a plot gives a parameter.
    pub plotted: &'static str,
    /// A domain of a numeric case.
    domain: ParameterDomain,
}

#[derive(Debug, Clone, Copy)]
enum ParameterDomain {
    /// Numbers of a range.
    Range,
    /// The same text for every parameter.
    Fixed(&'static str),
}

const fn number(wesl: &'static str, plotted: &'static str, domain: ParameterDomain) -> Type {
    let (read, nothing) = ("f64", "f64::NAN");
    Type { wesl, read, nothing, number: "f32($)", plotted, domain }
}

const fn vector(
    names: [&'static str; 2],
    nothing: &'static str,
    plotted: &'static str,
    domain: &'static str,
) -> Type {
    let [wesl, read] = names;
    Type { wesl, read, nothing, number: "$.x", plotted, domain: ParameterDomain::Fixed(domain) }
}

/// Every type that a new function may take or return.
pub const TYPES: [Type; 9] = [
    Type { number: "$", ..number("f32", "0.5", ParameterDomain::Range) },
    number("i32", "1", ParameterDomain::Fixed("[-2, -1, 0, 1, 2]")),
    number("u32", "1u", ParameterDomain::Fixed("[0, 1, 2, 3]")),
    Type { read: "bool", ..number("bool", "true", ParameterDomain::Fixed("[false, true]")) },
    vector(["vec2f", "vec2"], "glam::DVec2::NAN", "vec2f(0.6, 0.8)", "{ unit = 32 }"),
    vector(["vec3f", "vec3"], "glam::DVec3::NAN", "vec3f(0.0, 0.0, 1.0)", "{ unit = 32 }"),
    vector(["vec4f", "vec4"], "glam::DVec4::NAN", "vec4f(0.5)", "{ grid = [0, 1], count = 3 }"),
    Type {
        number: "$[0].x",
        ..vector(
            ["mat3x3f", "mat3"],
            "glam::DMat3::NAN",
            "mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)",
            "{ random = [-1, 1], count = 16 }",
        )
    },
    Type {
        number: "$[0].x",
        ..vector(
            ["mat4x4f", "mat4"],
            "glam::DMat4::NAN",
            "mat4x4f(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)",
            "{ random = [-1, 1], count = 16 }",
        )
    },
];

/// The type of that name in WESL.
pub fn type_of(name: &str) -> Result<Type, String> {
    TYPES.into_iter().find(|known| known.wesl == name).ok_or_else(|| {
        let names = TYPES.map(|known| known.wesl).join(", ");
        format!(
            "`{name}` is not one of the types {names}; write other types into the files afterwards"
        )
    })
}

/// One parameter.
#[derive(Debug)]
pub struct NewParameter<'t> {
    /// Its name.
    pub name: &'t str,
    /// Its type.
    pub ty: Type,
    /// The lowest and the highest value of a number, as written.
    pub range: [&'t str; 2],
}

impl<'t> NewParameter<'t> {
    /// Reads `NAME: TYPE`, or `NAME: f32 LOW..HIGH`.
    fn read(text: &'t str) -> Result<Self, String> {
        let wrong =
            || format!("`{}` is not a parameter: NAME: TYPE, or NAME: f32 LOW..HIGH", text.trim());
        let (name, rest) = text.split_once(':').ok_or_else(wrong)?;
        let (ty, range) = rest.trim().split_once(' ').unwrap_or((rest.trim(), "0..1"));
        let (low, high) = range.trim().split_once("..").ok_or_else(wrong)?;
        let is_number = |text: &str| text.parse::<f64>().is_ok();
        super::check_name(name.trim(), '_')?;
        match is_number(low) && is_number(high) {
            true => Ok(Self { name: name.trim(), ty: type_of(ty)?, range: [low, high] }),
            false => Err(wrong()),
        }
    }

    /// Whether it is a plain number.
    pub fn is_number(&self) -> bool {
        self.ty.wesl == "f32"
    }

    /// A domain of a numeric case, as one of `all` parameters. Their combinations stay below a few
    /// thousand.
    pub fn domain(&self, all: usize) -> String {
        let [low, high] = self.range;
        let count = [33, 17, 9].get(all - 1).unwrap_or(&5);
        match self.ty.domain {
            ParameterDomain::Range => format!("[{{ grid = [{low}, {high}], count = {count} }}]"),
            ParameterDomain::Fixed(domain) => domain.to_owned(),
        }
    }
}

/// Reads a list of parameters.
pub fn read_parameters(text: &str) -> Result<Vec<NewParameter<'_>>, String> {
    let found: Vec<NewParameter<'_>> =
        text.split(',').map(NewParameter::read).collect::<Result<_, _>>()?;
    let is_known = |(at, one): (usize, &NewParameter<'_>)| {
        found[..at].iter().any(|other| other.name == one.name)
    };
    match found.iter().enumerate().find(|pair| is_known(*pair)) {
        Some((_, twice)) => Err(format!("two parameters are called `{}`", twice.name)),
        None => Ok(found),
    }
}
