// What the editor knows of the languages: colours, and what the language server says of a place.
import { type Completion, type CompletionContext, type CompletionResult, autocompletion, completionKeymap } from "@codemirror/autocomplete";
import { HighlightStyle, LanguageSupport, StreamLanguage, bracketMatching, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { type Extension, type Text } from "@codemirror/state";
import { EditorView, type Tooltip, hoverTooltip, keymap } from "@codemirror/view";
import { Tag } from "@lezer/highlight";
import { toolchain, typed } from "../client";
import { code, h, sentence } from "../dom";
import { type Kind, type Language, type State, languageOf, languageOfFile, next } from "../highlight";

const KINDS: Kind[] = ["comment", "keyword", "type", "number", "string", "attribute", "function", "prompt"];
/** What the tokens of a kind are called: some of the kinds' own names mean something else to CodeMirror. */
const called = (kind: Kind) => `lamplight-${kind}`;

const TAGS = Object.fromEntries(KINDS.map((kind) => [called(kind), Tag.define(kind)]));
const COLOURS = HighlightStyle.define(KINDS.map((kind) => ({ tag: TAGS[called(kind)], class: `tok-${kind}` })));

/** The grammar of a language for the editor, by the tokens that listings have too. */
function grammar(language: Language): LanguageSupport {
    return new LanguageSupport(StreamLanguage.define<State>({
        startState: () => ({ depth: 0 }),
        copyState: ({ depth }) => ({ depth }),
        token(stream, state) {
            const { end, kind } = next(language, stream.string, stream.pos, state);
            stream.pos = Math.max(end, stream.pos + 1);
            return kind ? called(kind) : null;
        },
        tokenTable: TAGS,
        languageData: { commentTokens: { line: language === "toml" ? "#" : "//" }, closeBrackets: { brackets: ["(", "[", "{"] } },
    }));
}

/** The project, and which of its files is open. */
export type Asked = { files: Record<string, string>; open: string };

/** What the protocol has, as far as it is used here. */
type Place = { line: number; character: number };
type Edit = { range: { start: Place; end: Place }; newText: string };
type Item = { label: string; kind: number; detail?: string; additionalTextEdits?: Edit[] };
type Said = { contents?: { value: string } | string; range?: Edit["range"] };

const offset = (doc: Text, { line, character }: Place): number => {
    if (line >= doc.lines) return doc.length;
    const found = doc.line(line + 1);
    return Math.min(found.to, found.from + character);
};

/** What the language server says of a place. Nothing if somebody typed on, or if it takes too long. */
async function ask<T>(view: { state: EditorView["state"] }, project: Asked, method: string, at: number, isOld: () => boolean): Promise<T | undefined> {
    const line = view.state.doc.lineAt(at);
    const files = { ...project.files, [project.open]: view.state.doc.toString() };
    try {
        const { json } = await toolchain.call(typed(isOld), "editor", {
            files, path: project.open, method, line: line.number - 1, character: at - line.from,
        });
        return isOld() ? undefined : JSON.parse(json) ?? undefined;
    } catch {
        return undefined;
    }
}

const changes = (doc: Text, edits: Edit[]) =>
    edits.map(({ range, newText }) => ({ from: offset(doc, range.start), to: offset(doc, range.end), insert: newText }));

/** Kinds of completions by the numbers of the protocol. */
const TYPES: Record<number, string> = { 2: "method", 3: "function", 5: "property", 6: "variable", 7: "class", 9: "namespace", 12: "constant", 14: "keyword", 20: "enum", 21: "constant", 22: "class" };

function completion(item: Item): Completion {
    const made: Completion = { label: item.label, detail: item.detail, type: TYPES[item.kind] };
    if (!item.additionalTextEdits?.length) return made;
    // Somewhere else, an import is added.
    return { ...made, boost: -1, apply: (view, _, from, to) => view.dispatch({
        changes: [...changes(view.state.doc, item.additionalTextEdits!), { from, to, insert: item.label }], userEvent: "input.complete",
    }) };
}

const completed = (project: Asked) => async (context: CompletionContext): Promise<CompletionResult | null> => {
    const word = context.matchBefore(/[A-Za-z_]\w*/);
    const isAsked = context.explicit || word || context.matchBefore(/::|\.|@/);
    if (!isAsked) return null;
    const items = await ask<Item[] | { items: Item[] }>(context, project, "completion", context.pos, () => context.aborted);
    const list = Array.isArray(items) ? items : items?.items ?? [];
    return list.length ? { from: word?.from ?? context.pos, options: list.map(completion), validFor: /^\w*$/ } : null;
};

/** Text of the server in Markdown, as far as it writes any: code in fences, paragraphs, emphasis. */
function markdown(text: string): HTMLElement {
    const parts = text.split(/```(\w*)\n([^]*?)\n?```/);
    const made = h("div", { class: "said" });
    for (let index = 0; index < parts.length; index += 3) {
        const paragraphs = parts[index].split(/\n\s*\n/).map((part) => part.trim()).filter(Boolean);
        made.append(...paragraphs.map((part) => h("p", {}, ...sentence(part.replace(/\*\*/g, "")))));
        if (index + 2 < parts.length) made.append(code(parts[index + 2], "declaration", languageOf(parts[index + 1])));
    }
    return made;
}

const hovered = (project: Asked) => hoverTooltip(async (view, pos): Promise<Tooltip | null> => {
    const { doc } = view.state;
    const said = await ask<Said>(view, project, "hover", pos, () => view.state.doc !== doc);
    const text = typeof said?.contents === "string" ? said.contents : said?.contents?.value;
    if (!text) return null;
    const [from, to] = said?.range ? [offset(doc, said.range.start), offset(doc, said.range.end)] : [pos, pos];
    return { pos: from, end: to, above: true, create: () => ({ dom: markdown(text) }) };
});

/** Lays the text out, if its brackets close. False if they do not, or nothing changed. */
export async function format(view: EditorView, project: Asked): Promise<boolean> {
    const { doc } = view.state;
    const edits = await ask<Edit[]>(view, project, "formatting", 0, () => view.state.doc !== doc);
    const wanted = changes(doc, edits ?? []).filter(({ from, to, insert }) => doc.sliceString(from, to) !== insert);
    if (wanted.length) view.dispatch({ changes: wanted, userEvent: "format" });
    return wanted.length > 0;
}

/** Everything about the languages for an editor of a project's open file. */
export const languages = (project: Asked): Extension => [
    grammar(languageOfFile(project.open)), syntaxHighlighting(COLOURS), bracketMatching(), indentUnit.of("    "),
    autocompletion({ override: [completed(project)], maxRenderedOptions: 50 }), hovered(project),
    keymap.of([...completionKeymap, { key: "Shift-Alt-f", run: (view) => { format(view, project); return true; } }]),
];
