//! The valid GLSL that naga's front end reads in another way, without an error. All of it is
//! refused.

/// A construct that is refused, and what to write instead.
pub struct Construct {
    pub message: &'static str,
    pub label: &'static str,
    pub help: &'static str,
}

/// A table of constructs, each with its message, its label and its advice.
macro_rules! constructs {
    ($($name:ident { $message:literal, $label:literal, $help:literal })*) => {
        $(pub const $name: Construct =
            Construct { message: $message, label: $label, help: $help };)*
    };
}

constructs! {
    SHORT_CIRCUIT {
        "the right operand of `&&` or `||` has a side effect, which would always happen",
        "a side effect that the left operand may skip",
        "write it as an `if`: `bool both = a; if (both) { both = f(); }`"
    }
    INDEX_EFFECT {
        "the index of a compound assignment has a side effect, which would happen twice",
        "this effect would happen twice",
        "compute the index first: `int k = i++; x[k] += v;`"
    }
    OUTPUT_EFFECT {
        "an argument for an `out` or `inout` parameter has a side effect, which would happen twice",
        "this effect would happen twice",
        "compute the index first: `int k = i++; f(x[k]);`"
    }
    ARRAY_OF_ARRAYS {
        "an array of arrays would get its dimensions in the wrong order",
        "two dimensions",
        "use one array, `float w[6]` with `w[3 * i + j]`, or an array of a structure that has an array"
    }
    INITIAL_VALUE {
        "the initial value of this global variable would be lost",
        "not a constant that the translation can compute",
        "assign it at the start of `main`"
    }
    BLOCK_ARRAY {
        "an array of blocks would become one buffer",
        "this block is an array",
        "declare each block with its own binding, or put an array into one block"
    }
    LONE_DECLARATION {
        "a declaration that is the only statement of an `if`, an `else` or a loop would be visible after it",
        "declared without braces",
        "put it in braces, or leave it out: nothing can use it"
    }
    DECLARED_TWICE {
        "this name is declared twice in one scope",
        "the second declaration",
        "give one of the two another name"
    }
    CONTINUE_IN_DO {
        "`continue` in a `do` loop would skip the condition of the loop",
        "the condition is not tested after this",
        "write `while (true) { ...; if (!condition) break; }`, and test the condition before each `continue`"
    }
    NO_LOCATION {
        "an input or output of a stage has no location",
        "without a location",
        "write `layout(location = 0)` before it, with a number that no other input or output has"
    }
    COMBINED_SAMPLER {
        "a texture and its sampler must be two objects",
        "a texture with a sampler",
        "write `uniform texture2D t;` and `uniform sampler s;`, each with its binding, and `sampler2D(t, s)` where it is sampled"
    }
    PUSH_CONSTANT {
        "push constants are not read, since most targets have none",
        "a push constant",
        "write a uniform block: `layout(set = 0, binding = 0) uniform ...`"
    }
    SWITCH_VECTOR {
        "`switch` takes an `int` or a `uint`",
        "this `switch`",
        "choose by one component, such as `switch (v.x)`"
    }
}
