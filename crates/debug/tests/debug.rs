//! Runs of small texts, with values and marks computed by hand.

#![allow(clippy::unwrap_used, clippy::panic)]

use lamplight_bundle::Language;
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{self as compose, Composed, Keep};
use lamplight_debug::{
    Call, Event, Found, Halt, Mark, Options, Outcome, Replay, Seen, Step, Subject, SubjectText,
    Survey, Table, Why, WhyError, record, why,
};
use lamplight_diagnostic::source::SourceSet;
use lamplight_eval::{FindingKind, Resources};
use lamplight_permute::Settings;
use lamplight_validate::{glsl_as_wgsl, validate};

/// A text with the subject that calls its function `f`.
struct Given {
    sources: SourceSet,
    subject: Subject,
}

fn composed(name: &str, text: &str, language: Language) -> (Composed, SourceSet) {
    let mut sources = SourceSet::default();
    let packages = Packages::of_text(name, text.to_owned());
    let graph = resolve::load(&mut sources, &packages, name, language).unwrap();
    let options = compose::Options { keep: Keep::All, ..compose::Options::default() };
    (compose::compose(&graph, &Settings::default(), &options).unwrap(), sources)
}

fn given_of(composed: &Composed, sources: SourceSet, arguments: &[f32]) -> Given {
    called(composed, sources, Call::Alone(arguments.to_vec()))
}

fn called(composed: &Composed, sources: SourceSet, call: Call) -> Given {
    let subject = subject(composed, &sources, ("f", call), Resources::default());
    Given { sources, subject }
}

fn subject(
    composed: &Composed,
    sources: &SourceSet,
    (function, call): (&str, Call),
    resources: Resources,
) -> Subject {
    let validated = validate(composed).unwrap();
    let text = SubjectText {
        module: &validated.module,
        text: &composed.text,
        map: &composed.map,
        sources,
    };
    Subject::new(text, function, call, resources).unwrap()
}

fn given(text: &str, arguments: &[f32]) -> Given {
    let (composed, sources) = composed("own.wesl", text, Language::Wesl);
    given_of(&composed, sources, arguments)
}

impl Given {
    fn events(&self, options: Options) -> Vec<Event> {
        let mut events = Vec::new();
        record(&self.subject, options, &mut |event| events.push(event)).unwrap();
        events
    }

    fn steps(&self) -> Vec<Step> {
        let events = self.events(Options { turns: u64::MAX, ..Options::default() });
        events
            .into_iter()
            .filter_map(|event| if let Event::Step(step) = event { Some(step) } else { None })
            .collect()
    }

    fn with_limit(self, turns: u64) -> Self {
        Self { subject: self.subject.with_loop_limit(turns), ..self }
    }

    /// The line of a step, what it changed, and its turns.
    fn lines(&self) -> Vec<(u32, String, Vec<u64>)> {
        let line = |step: &Step| self.subject.statements.get(step.statement.unwrap()).unwrap().line;
        let text = |step: &Step| {
            let changes = step.changes.iter();
            changes.map(|one| format!("{} = {}", one.name, one.value.text())).collect::<Vec<_>>()
        };
        self.steps()
            .iter()
            .map(|one| (line(one), text(one).join(", "), one.turns.clone()))
            .collect()
    }

    /// The marks with their lines.
    fn marks(&self) -> Vec<(u32, Mark)> {
        let mut found = Vec::new();
        for step in self.steps() {
            let line = self.subject.statements.get(step.statement.unwrap()).unwrap().line;
            found.extend(step.marks.into_iter().map(|mark| (line, mark)));
        }
        found
    }

    fn table(&self) -> String {
        let options = Options::default();
        let mut table = Table::new(&self.subject, &self.sources, options);
        let mut text = String::new();
        record(&self.subject, options, &mut |event| text += &table.rows(&event)).unwrap();
        text + &table.summary()
    }
}

#[test]
fn statements_in_order_of_evaluation() {
    let text = "fn g(a: f32) -> f32 {\n    return a * 2.0;\n}\n\
                fn f(x: f32) -> f32 {\n    var y = x;\n    for (var i = 0; i < 2; i++) {\n        \
                y += g(y); // 3, 9\n    }\n    if y > 5.0 { return y; }\n    return 0.0;\n}\n";
    let lines = given(text, &[1.0]).lines();
    let shown: Vec<String> =
        lines.iter().map(|(line, text, turns)| format!("{line}: {text} {turns:?}")).collect();
    let expected = [
        "5: y = 1 []",
        "6:  [1]",
        "2: return = 2 [1]",
        "7: y = 3 [1]",
        "6: i = 1 [1]",
        "6:  [2]",
        "2: return = 6 [2]",
        "7: y = 9 [2]",
        "6: i = 2 [2]",
        "6:  []",
        "9:  []",
        "9: return = 9 []",
    ];
    assert_eq!(shown, expected, "{shown:#?}");
}

#[test]
fn conditions_and_ends_of_loops() {
    let text = "fn f(x: f32) -> f32 {\n    var y = x;\n    loop {\n        y = y * 2.0;\n        \
                if y > 10.0 { break; }\n    }\n    return y;\n}\n";
    let given = given(text, &[1.0]);
    let conditions: Vec<bool> = given
        .steps()
        .iter()
        .flat_map(|step| step.outcomes.clone())
        .filter_map(|one| if let Outcome::Condition(holds) = one { Some(holds) } else { None })
        .collect();
    assert_eq!(conditions, [false, false, false, true]);
    let left: Vec<u64> = given
        .events(Options::default())
        .iter()
        .filter_map(|event| if let Event::Left { made, .. } = event { Some(*made) } else { None })
        .collect();
    assert_eq!(left, [4]);
}

#[test]
fn marks_where_they_happen_first() {
    let text = "fn f(x: f32, i: u32) -> f32 {\n    let power = pow(x, 2.5);\n    \
                let again = power + 1.0;\n    var a = array<f32, 2>(1.0, 2.0);\n    \
                let clamped = a[i];\n    let divided = again / (clamped - 2.0);\n    \
                return divided;\n}\n";
    let found = given(text, &[-1.0, f32::from_bits(7)]).marks();
    let kinds: Vec<(u32, &str)> = found.iter().map(|(line, mark)| (*line, mark.name())).collect();
    assert_eq!(kinds, [(2, "domain"), (5, "clamped-index"), (6, "division-by-zero")]);
    let Mark::Found(FindingKind::Domain, Some(domain)) = found[0].1 else { panic!("{found:?}") };
    assert!(domain.contains("negative base"));
}

#[test]
fn digits_that_are_lost() {
    // 1e6 + 1/3 keeps 1/16 of a unit, which is a fifth of what is left.
    let text = "fn f(x: f32) -> f32 {\n    let large = 1e6 + x / 3.0;\n    \
                let left = large - 1e6;\n    let more = left * 2.0;\n    return more;\n}\n";
    let found = given(text, &[1.0]).marks();
    let [(3, Mark::LostDigits(share))] = found.as_slice() else { panic!("{found:?}") };
    assert!((0.1..0.5).contains(share), "{share}");
}

#[test]
fn arguments_outside_of_their_range() {
    let text = "/// A cone.\n///\n/// Parameters: `c` cosine of the angle, [-1, 1].\n\
                fn cone(c: f32) -> f32 {\n    return max(c, 0.0);\n}\n\
                fn f(x: f32) -> f32 {\n    return cone(x);\n}\n";
    let marks = |x: f32| -> Vec<Mark> {
        let events = given(text, &[x]).events(Options::default());
        let of = |event| match event {
            Event::Call { marks, .. } => marks,
            _ => Vec::new(),
        };
        events.into_iter().flat_map(of).collect()
    };
    assert!(marks(0.5).is_empty());
    let found = marks(30.0);
    let [Mark::OutOfRange(name, words, value)] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!((name.as_str(), *value), ("c", 30.0));
    assert!(words.contains("[-1, 1]"));
}

/// A survey says of each fragment of a quad what a recorded run of it is marked with.
#[test]
fn a_survey_of_a_quad() {
    let text = "
/// What is left.
///
/// Parameters: `x` share, [-1, 1].
fn share(x: f32) -> f32 {
    return 1.0 - x;
}
fn f(x: f32) -> f32 {
    let r = sqrt(x);
    var sum = share(x);
    while sum == 7.0 {}
    return r / (x - 0.25) + sum;
}";
    let own = given(text, &[0.0]).with_limit(100);
    let survey = Survey::new(&own.subject, Resources::default(), 0.01).unwrap();
    let quad = [0.5, 0.25, -2.0, -6.0].map(|x| vec![x]);
    let found = |lane| survey.fragment(&own.subject, &quad, lane).map(Vec::from_iter);
    assert_eq!(found(0).unwrap(), Vec::<&str>::new());
    assert_eq!(found(1).unwrap(), ["division-by-zero"]);
    assert_eq!(found(2).unwrap(), ["domain", "out-of-range"]);
    assert!(found(3).unwrap_err().message.contains("more than 100 trips"));
    // One does not see what another one was marked with.
    assert_eq!(found(0).unwrap(), Vec::<&str>::new());
}

#[test]
fn endless_loops_end_with_their_line() {
    let text = "fn f(x: f32) -> f32 {\n    var y = x;\n    loop {\n        y += 1.0;\n        \
                if y < 0.0 { break; }\n    }\n    return y;\n}\n";
    let given = given(text, &[1.0]);
    let mut events = 0_u64;
    let error = record(&given.subject, Options::default(), &mut |_| events += 1).unwrap_err();
    assert_eq!(error.code.name, "eval-loop-limit");
    let range = error.span.to_range().unwrap();
    assert!(text[range].starts_with("loop"));
    assert!(events > 1_000_000);
}

#[test]
fn shares_of_a_value() {
    // With a = 2, b = 3 and c = 4: the value is 2 * 3 * 3 + 4 = 22.
    let text = "fn f(a: f32, b: f32, c: f32, n: i32) -> f32 {\n    let square = b * b;\n    \
                var sum = c;\n    if n > 1 {\n        sum += a * square;\n    }\n    return sum;\n}\n";
    let given = given(text, &[2.0, 3.0, 4.0, f32::from_bits(5)]);
    let Why { value, causes, is_cut } = why(&given.subject, "color").unwrap();
    assert_eq!((value, is_cut), (22.0, false));
    let share = |name: &str| {
        let cause = causes.iter().find(|cause| cause.name == name).unwrap();
        (cause.share, cause.slope)
    };
    assert_eq!(share("a"), (Some(18.0 / 22.0), Some(9.0)));
    assert_eq!(share("b"), (Some(36.0 / 22.0), Some(12.0)));
    assert_eq!(share("c"), (Some(4.0 / 22.0), Some(1.0)));
    assert_eq!(share("square"), (Some(18.0 / 22.0), Some(2.0)));
    assert_eq!(share("n"), (None, None));
    let decides =
        causes.iter().find(|cause| cause.instead.iter().any(|one| one.contains("decides")));
    assert_eq!(given.subject.statements.get(decides.unwrap().statement.unwrap()).unwrap().line, 4);
    let WhyError::Unknown(names) = why(&given.subject, "some").unwrap_err() else { panic!() };
    assert!(names.contains(&"sum".to_owned()));
}

#[test]
fn a_loop_counts_in_all_turns() {
    // 1 + 1/2 + 1/3 of x, each times w: w counts in all turns, sum with its last value.
    let text = "fn f(x: f32) -> f32 {\n    var sum = 0.0;\n    for (var i = 1; i < 4; i++) {\n        \
                let w = x / f32(i);\n        sum += w;\n    }\n    return sum;\n}\n";
    let found = why(&given(text, &[6.0]).subject, "color").unwrap();
    assert_eq!(found.value, 11.0);
    let share =
        |name: &str| found.causes.iter().find(|one| one.name == name).unwrap().share.unwrap();
    assert!((share("w") - 1.0).abs() < 1e-6, "{}", share("w"));
    assert!((share("sum") - 1.0).abs() < 1e-6, "{}", share("sum"));
}

/// A text in GLSL is shown in the lines of its author.
#[test]
fn lines_of_glsl() {
    let text = "#version 450\nfloat g(float a) {\n    float d = a * 2.0; // twice\n    return d;\n}\n\
                float f(float x) {\n    float y = g(x);\n    y += 1.0;\n    return y;\n}\n\
                void main() {}\n";
    let (composed, sources) = composed("own.frag", text, Language::Glsl);
    let given = given_of(&glsl_as_wgsl(&composed, Default::default()).unwrap(), sources, &[3.0]);
    let shown: Vec<String> =
        given.lines().iter().map(|(line, text, _)| format!("{line}: {text}")).collect();
    assert_eq!(shown, ["3: d = 6", "4: return = 6", "7: y = 6", "8: y = 7", "9: return = 7"]);
}

#[test]
fn a_table() {
    let text = "fn f(x: f32) -> f32 {\n    let root = sqrt(x);\n    return root * 3.0;\n}\n";
    let expected = "\x20      > f
         x          -4
own.wesl
    2  let root = sqrt(x)
         root       NaN                              f64 NaN                                +- inf
     ! outside the domain: the root of a negative number; WGSL leaves the result open
    3  return root * 3.0  -> returns
         return     NaN                              f64 NaN                                +- inf

Marked:
  own.wesl:2: `let root = sqrt(x)`
      outside the domain: the root of a negative number; WGSL leaves the result open
";
    assert_eq!(given(text, &[-4.0]).table(), expected);
}

/// A long loop is held in few copies, and steps back from its end lead through its last turns.
#[test]
fn a_long_loop_goes_back() {
    let text = "fn f(x: f32) -> f32 {\n    var sum = x;\n    for (var i = 0; i < 60000; i++) {\n        \
                sum += 1.0;\n    }\n    return sum;\n}\n";
    let Given { sources: _, subject } = given(text, &[1.0]);
    let mut replay = Replay::new(subject, 0.01).unwrap();
    let line = |seen: &Seen<'_>| {
        let statement = seen.place.statement().and_then(|id| seen.subject.statements.get(id));
        statement.map_or(0, |one| one.line)
    };
    let found = replay.forward(&mut |seen| line(seen) == 6, &|| false);
    assert_eq!((found, line(&replay.seen())), (Found::Yes, 6));
    assert!((8..200).contains(&replay.copies()), "{}", replay.copies());
    let end = replay.seen().place.clock();
    let mut lines = Vec::new();
    for _ in 0..5 {
        assert_eq!(replay.back(&mut |_| true, &|| false), Found::Yes);
        lines.push(line(&replay.seen()));
    }
    assert_eq!(lines, [3, 3, 4, 3, 3]);
    assert_eq!(replay.seen().place.clock(), end - 5);
    // Forth again to the same place, and to the end.
    let found = replay.forward(&mut |seen| line(seen) == 6, &|| false);
    assert_eq!((found, replay.seen().place.clock()), (Found::Yes, end));
    assert_eq!(replay.forward(&mut |_| false, &|| false), Found::No);
    assert_eq!(*replay.seen().place.halt(), Halt::End);
    // To the tenth turn, from the end.
    let tenth = |seen: &Seen<'_>| {
        line(seen) == 4 && seen.place.statement().is_some_and(|id| seen.place.runs(id) == 10)
    };
    assert_eq!(replay.back(&mut |seen| tenth(seen), &|| false), Found::Yes);
    assert!(tenth(&replay.seen()));
    // Nobody is asked for less than some thousand instructions.
    assert_eq!(replay.forward(&mut |_| false, &|| true), Found::Interrupted);
}

/// Copies of a run with much memory are few, or there are none, and steps back lead to the same places.
/// Each of the four fragments of a quad has the array.
#[test]
fn copies_have_bounded_memory() {
    for (count, is_copied) in [(1 << 12, true), (1 << 17, true), (1 << 19, false)] {
        let text = format!(
            "fn f(x: f32) -> f32 {{\n    var all: array<f32, {count}>;\n    \
             for (var i = 0; i < 400; i++) {{\n        all[i] = x;\n    }}\n    return all[7];\n}}\n"
        );
        let (composed, sources) = composed("own.wesl", &text, Language::Wesl);
        let quad = Call::Quad(std::array::from_fn(|_| vec![1.0]), 2);
        let Given { sources: _, subject } = called(&composed, sources, quad);
        let mut replay = Replay::new(subject, 0.01).unwrap();
        assert_eq!(replay.forward(&mut |_| false, &|| false), Found::No);
        let end = replay.seen().place.clock();
        for step in 1..4 {
            assert_eq!(replay.back(&mut |_| true, &|| false), Found::Yes);
            assert_eq!(replay.seen().place.clock(), end - step);
        }
        let (copies, bytes) = (replay.copies(), replay.copied_bytes());
        assert_eq!(copies > 0, is_copied, "{count}: {copies}");
        assert!(bytes <= 96 << 20, "{count}: {bytes}");
        // Each number has at least its f32 and its f64.
        assert!(bytes >= 12 * copies * 4 * count, "{count}: {bytes}");
    }
}

/// What an expression calls reads inputs, globals and buffers as they are where the run stands.
#[test]
fn expressions_read_the_module() {
    let text = "#version 330 core
in vec3 at;
out vec4 color;
float scale = 1.0;
float scaled(float x) { return x * scale + at.x; }
void main() {
    scale = 3.0;
    color = vec4(scaled(2.0));
}
";
    let (composed, sources) = composed("own.frag", text, Language::Glsl);
    let composed = glsl_as_wgsl(&composed, Default::default()).unwrap();
    let call = Call::Alone(vec![0.5, 0.0, 0.0]);
    let subject = subject(&composed, &sources, ("main", call), Resources::default());
    let mut replay = Replay::new(subject, 0.5).unwrap();
    let mut expressions = lamplight_debug::Expressions::default();
    let mut found = Vec::new();
    for line in [7, 8] {
        let mut is_there = |seen: &Seen<'_>| {
            let at = seen.place.statement().and_then(|at| seen.subject.statements.get(at));
            *seen.place.halt() == Halt::Statement && at.is_some_and(|at| at.line == line)
        };
        assert_eq!(replay.forward(&mut is_there, &|| false), Found::Yes);
        let seen = replay.seen();
        let frame = seen.place.frames().last().map(|one| (one.function, one.statement)).unwrap();
        for text in ["scaled(2.0)", "scale", "at.x"] {
            found.push(expressions.value(&seen, frame, text).unwrap().text());
        }
    }
    assert_eq!(found, ["2.5", "1", "0.5", "6.5", "3", "0.5"]);
}

/// A buffer that the run has written has its new content in what an expression calls.
#[test]
fn expressions_read_buffers() {
    let text = "@group(0) @binding(0) var<storage, read_write> all: array<f32>;
fn second() -> f32 { return all[1]; }
fn f(x: f32) -> f32 {
    all[1] = x;
    return second();
}
";
    let (composed, sources) = composed("own.wesl", text, Language::Wesl);
    let mut resources = Resources::default();
    let bytes = [1.0_f32, 2.0, 3.0].iter().flat_map(|one| one.to_le_bytes()).collect();
    resources.buffers.insert((0, 0), bytes);
    let subject = subject(&composed, &sources, ("f", Call::Alone(vec![9.0])), resources);
    let mut replay = Replay::new(subject, 0.5).unwrap();
    let mut expressions = lamplight_debug::Expressions::default();
    let mut found = Vec::new();
    for _ in 0..2 {
        replay.forward(&mut |seen| *seen.place.halt() == Halt::Statement, &|| false);
        let seen = replay.seen();
        let frame = seen.place.frames().last().map(|one| (one.function, one.statement)).unwrap();
        for text in ["second()", "all[1]", "all[2] + f32(arrayLength(&all))"] {
            found.push(expressions.value(&seen, frame, text).unwrap().text());
        }
    }
    assert_eq!(found, ["2", "2", "6", "9", "9", "6"]);
}
