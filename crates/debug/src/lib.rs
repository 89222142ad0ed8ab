//! Why is this pixel black: a fragment, or a call of a function, run line by line of the author's
//! file.
//!
//! `module + arguments -> subject -> events -> table | JSON`
//!
//! A [`Replay`] is a run that goes forth and back, for debuggers that stop. A [`Survey`] runs many
//! fragments, and says only which kinds of marks each has.
//!
//! A [`Subject`] can be run again and again, each time with the same result. So nothing of a run is
//! kept: [`record`] shows each statement with what it gave a name, in f32, in f64 and with the bound
//! of the error that WGSL allows, and forgets it. The f32 decides what runs.
//!
//! A statement is what ends with `;` or begins a block in the author's text, in WESL as in GLSL. Each
//! instruction of the evaluator belongs to the statement that its place leads back to.

mod expression;
mod graph;
mod json;
mod mark;
mod record;
mod replay;
mod scope;
mod subject;
mod survey;
mod table;
mod text;
mod value;
mod walk;
mod why;

pub use expression::Expressions;
pub use json::{event_json, statement_place};
pub use mark::Mark;
pub use record::{Change, Event, Options, Outcome, Step, record};
pub use replay::{Found, Halt, Marked, Place, Replay, Seen};
pub use subject::{Call, Ended, FunctionName, Subject, SubjectText, diagnosed};
pub use survey::Survey;
pub use table::{Table, outcome_text, statement_text, texture_lines, turn_text};
pub use text::{Statement, StatementId, Statements};
pub use value::{Scalar, Value, digits_text, number_json};
pub use walk::{Frame, Loop};
pub use why::{Cause, Why, WhyError, why};
