//! Composes GLSL: preprocesses it, keeps the items that are reached, and writes them.

mod always;
mod condition;
mod expand;
mod gap;
mod items;
mod parts;
mod preprocess;
mod reach;
mod reads;
mod table;
mod token;
mod write;

use std::cell::Cell;
use std::ops::Range;

use crate::resolve::glsl::Graph;
use crate::{Composed, Keep, Options};
use items::Items;
use lamplight_bundle::{Language, Stage};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::Settings;
use preprocess::{Preprocessed, preprocess};
use token::{NO_SETTING, Tok};
use write::Writer;

/// The most tokens whose memory is kept for the next composition.
const ROOM_TOKENS: usize = 1 << 16;

thread_local! {
    /// The memory of the thread's last composition. The next one needs about as much, and a new
    /// allocation of that size is slow.
    static ROOM: Cell<Vec<Tok>> = const { Cell::new(Vec::new()) };
}

/// One permutation of a GLSL file: `#version`, extensions and pragmas, then the items that are
/// kept.
///
/// The settings are macros: `two_sided` is `TWO_SIDED` (1 or 0), `max_lights` is `MAX_LIGHTS`, and
/// an enum axis `shadow` is `SHADOW`, with `SHADOW_NONE` and so on for the numbers of its values.
/// Settings read are those that a condition evaluates and those whose value stands in the output.
pub fn compose(
    graph: &Graph,
    settings: &Settings,
    options: &Options,
) -> Result<Composed, Diagnostics> {
    let stage = stage_of(graph, options)?;
    let preprocessed = preprocess(graph, settings, ROOM.take())?;
    let items =
        items::split_items(&preprocessed.tokens, &graph.modules).map_err(|error| vec![error])?;
    let kept =
        reach::reached_items(&preprocessed.tokens, &items, &preprocessed.spellings, &options.keep)?;
    let (writer, ranges) = write_kept(graph, &preprocessed, &items, &kept, &options.keep);
    let (text, map) = (writer.text, writer.map);
    let parts = parts::make_parts(&preprocessed, &items, &kept, ranges);
    let decisions = preprocessed.decisions.clone();
    let mut warnings = preprocessed.warnings.clone();
    warnings.extend(warn_unversioned(graph, &preprocessed, &options.keep));
    let reads = settings_read(graph, preprocessed, &items, &kept)?;
    Ok(Composed {
        language: Language::Glsl,
        stage: Some(stage),
        text,
        map,
        parts,
        reads,
        warnings,
        decisions,
        library: graph.library,
    })
}

/// Warns of a shader without a version, which other compilers read as GLSL 1.10.
fn warn_unversioned(
    graph: &Graph,
    preprocessed: &Preprocessed<'_, '_>,
    keep: &Keep,
) -> Option<Diagnostic> {
    let is_part = matches!(keep, Keep::Items(_) | Keep::Root);
    // What is wrapped is of a site that chooses the version.
    if preprocessed.version.is_some() || is_part || graph.ending.is_some() {
        return None;
    }
    let root = graph.modules.first()?;
    let first = Span::new(root.source, 0..root.text.find('\n').unwrap_or(root.text.len()));
    let message = "the shader has no `#version`, and is read as `#version 450`";
    Some(
        Diagnostic::warning(codes::MISSING_VERSION, message)
            .at(first, "the version belongs before this")
            .note("help: begin the file with `#version 450`: other compilers take 110 without it"),
    )
}

/// How the names of files end, before an optional `.glsl`, and the stage that this stands for.
const STAGES: &[(&str, Stage)] = &[
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vsh", Stage::Vertex),
    ("vertexshader", Stage::Vertex),
    ("frag", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fsh", Stage::Fragment),
    ("fragmentshader", Stage::Fragment),
    ("comp", Stage::Compute),
    ("cs", Stage::Compute),
];

/// The stage that the name of a GLSL file says, such as `a.vert`, `a.vs` or `a.vert.glsl`.
pub fn named_stage(path: &str) -> Option<Stage> {
    let name = path.strip_suffix(".glsl").unwrap_or(path);
    let ending = name.rsplit('.').next()?;
    STAGES.iter().find(|(known, _)| *known == ending).map(|(_, stage)| *stage)
}

fn stage_of(graph: &Graph, options: &Options) -> Result<Stage, Diagnostics> {
    match options.stage.or_else(|| named_stage(&graph.root)) {
        Some(stage) => Ok(stage),
        None if matches!(options.keep, Keep::Items(_) | Keep::Root) => Ok(Stage::Fragment),
        None => Err(vec![
            Diagnostic::error(
                codes::UNKNOWN_STAGE,
                format!("the name `{}` does not say for which stage it is", graph.root),
            )
            .note("help: add `--stage`, or end it in `.vert.glsl`, `.frag.glsl` or `.comp.glsl`"),
        ]),
    }
}

fn write_kept<'a>(
    graph: &'a Graph,
    preprocessed: &'a Preprocessed<'a, '_>,
    items: &Items,
    kept: &[bool],
    keep: &Keep,
) -> (Writer<'a>, WrittenPieces) {
    let tokens: &[Tok] = &preprocessed.tokens;
    let mut writer = Writer::new(&graph.modules, &preprocessed.spellings, tokens.len() * 8);
    match preprocessed.version {
        Some(line) => writer.line(line),
        None => writer.made("#version 450\n"),
    }
    preprocessed.header.iter().for_each(|line| writer.line(*line));
    let mut written = WrittenPieces { header: 0..writer.text.len(), items: Vec::new(), main: None };
    for (item, _) in items.list.iter().zip(kept).filter(|(_, kept)| **kept) {
        writer.made("\n");
        let start = writer.text.len();
        writer.item(tokens, item);
        written.items.push(start..writer.text.len());
    }
    let main = lamplight_syntax::glsl::known::MAIN;
    if matches!(keep, Keep::Items(_) | Keep::Root)
        && !items.names.iter().any(|(name, item)| *name == main && kept[*item as usize])
    {
        let start = writer.text.len();
        writer.made("\nvoid main() {}\n");
        written.main = Some(start..writer.text.len());
    }
    (writer, written)
}

/// Where each piece of the output was written.
struct WrittenPieces {
    /// The directives.
    header: Range<usize>,
    /// The kept items, in order.
    items: Vec<Range<usize>>,
    /// The entry point that was added because the text needs one.
    main: Option<Range<usize>>,
}

/// The settings that were read: those of the conditions, then those whose values are in the kept
/// items.
fn settings_read(
    graph: &Graph,
    preprocessed: Preprocessed<'_, '_>,
    items: &Items,
    kept: &[bool],
) -> Result<Vec<(String, lamplight_permute::Setting)>, Diagnostics> {
    let Preprocessed { tokens, mut reads, .. } = preprocessed;
    let mut errors = Vec::new();
    for (item, _) in items.list.iter().zip(kept).filter(|(_, kept)| **kept) {
        for token in tokens[item.tokens.clone()].iter().filter(|token| token.setting != NO_SETTING)
        {
            if let Err((name, value)) = reads.read(token.setting) {
                let message = format!("`{value}` is not a declared value of `{name}`");
                errors.push(
                    Diagnostic::error(codes::BAD_SETTING, message)
                        .at(token.span(&graph.modules), "asked for here"),
                );
            }
        }
    }
    if tokens.capacity() <= ROOM_TOKENS {
        ROOM.set(tokens);
    }
    if errors.is_empty() { Ok(reads.finish()) } else { Err(errors) }
}
