//! The language of constraints: `shadow == none || lights != none`.
//!
//! ```text
//! condition   = disjunction [ "=>" condition ]
//! disjunction = conjunction { "||" conjunction }
//! conjunction = unary { "&&" unary }
//! unary       = "!" unary | "(" condition ")" | atom
//! atom        = axis                             a boolean axis
//!             | axis ( "==" | "!=" ) value
//!             | axis ( "<" | "<=" | ">" | ">=" ) integer
//!             | axis "in" "[" value { "," value } [ "," ] "]"
//! ```
//!
//! `=>` reads "requires" and binds weakest, to the right. The integer of an order comparison
//! need not be one of the axis's values; a value of `==`, `!=` and `in` must.

mod lexer;
mod parser;

pub use parser::parse;
