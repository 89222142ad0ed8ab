// The parts of a text that have colours, for the editor, for listings and for the pages that the build
// writes. A line is read from left to right; only block comments go on in the next one.

export type Kind = "comment" | "keyword" | "type" | "number" | "string" | "attribute" | "function" | "prompt";

export type Language = "wgsl" | "glsl" | "hlsl" | "msl" | "rust" | "c" | "js" | "toml" | "json" | "console" | "other";

/** What goes on in the next line: how many block comments are open. */
export type State = { depth: number };

export type Token = { kind?: Kind; text: string };

type Rule = [RegExp, Kind | undefined];

/** One of some words, written with blanks between them. Names have letters of all scripts. */
const words = (text: string, before = ""): RegExp =>
    new RegExp(`(?:${text.trim().replace(/\s+/g, "|")})(?!\\p{XID_Continue})${before}`, "yu");

const LINE_COMMENT: Rule = [/\/\/.*/y, "comment"];
const NUMBER: Rule = [/(?:0[xX][\da-fA-F.]+(?:[pP][+-]?\d+)?|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[a-zA-Z]*/y, "number"];
const STRING: Rule = [/"(?:[^"\\]|\\.)*"?/y, "string"];
const CALL: Rule = [/[\p{XID_Start}_]\p{XID_Continue}*(?=\s*\()/yu, "function"];
const WORD: Rule = [/[\p{XID_Start}_]\p{XID_Continue}*/yu, undefined];
const BLANK: Rule = [/[^\S\n]+/y, undefined];

const WGSL: Rule[] = [
    LINE_COMMENT, [/@(?:if|elif|else)\b/y, "keyword"], [/@\w+/y, "attribute"], NUMBER, STRING,
    [words(`alias as break case const const_assert continue continuing default diagnostic discard else enable false fn for if
        import let loop override package requires return struct super switch true var while`), "keyword"],
    [words("bool i32 u32 f32 f16 vec[234][iufh]? mat[234]x[234][fh]? array atomic ptr sampler sampler_comparison texture_\\w+ binding_array"), "type"],
    [words("function private workgroup uniform storage read write read_write", "(?=\\s*[,>])"), "keyword"],
    CALL, WORD, BLANK,
];

const C_TYPES = `void bool int uint float double half char long short unsigned size_t auto
    [biud]?vec[234] d?mat[234](?:x[234])? [iu]?(?:sampler|texture|image|subpassInput)\\w* atomic_uint
    (?:float|half|int|uint|bool)[1234](?:x[1234])? Texture\\w+ Sampler\\w+ \\w*Buffer texture\\w*`;

const C_KEYWORDS = `attribute break buffer case cbuffer centroid const constant continue coherent constexpr default device discard do else
    enum extern false flat fragment for goto highp if in inline inout invariant kernel layout lowp mediump namespace noperspective
    nointerpolation out patch precise precision readonly register restrict return row_major shared sizeof smooth static struct switch
    template thread threadgroup true typedef uniform using varying vertex volatile while writeonly`;

const C_LIKE: Rule[] = [
    LINE_COMMENT, [/#\s*\w+/y, "attribute"], [/\[\[\s*\w[^\]]*\]\]/y, "attribute"], NUMBER, STRING,
    [words(C_KEYWORDS), "keyword"], [words(C_TYPES), "type"], CALL, WORD, BLANK,
];

const RUST: Rule[] = [
    LINE_COMMENT, [/#!?\[.*?\]/y, "attribute"], NUMBER, STRING, [/'\w+\b(?!')/y, "type"],
    [words(`as async await break const continue crate dyn else enum extern false fn for if impl in let loop match mod move mut pub ref
        return self Self static struct super trait true type unsafe use where while`), "keyword"],
    [words("bool char str [iu](?:8|16|32|64|128|size) f32 f64 [A-Z]\\w*"), "type"], CALL, WORD, BLANK,
];

const JS: Rule[] = [
    LINE_COMMENT, NUMBER, STRING, [/'(?:[^'\\]|\\.)*'?/y, "string"], [/`[^`]*`?/y, "string"],
    [words(`async await break case catch class const continue default delete do else export extends false finally for from function if
        import in instanceof interface let new null of return static super switch this throw true try type typeof undefined var void
        while yield`), "keyword"],
    [words("[A-Z]\\w*"), "type"], CALL, WORD, BLANK,
];

const TOML: Rule[] = [
    [/#.*/y, "comment"], [/\[\[?[^\]"']+\]\]?(?=\s*(?:#.*)?$)/y, "keyword"], STRING, [/'[^']*'?/y, "string"],
    [/[\w.-]+(?=\s*=)/y, "attribute"], [words("true false inf nan"), "keyword"], NUMBER, WORD, BLANK,
];

const JSON_RULES: Rule[] = [[/"(?:[^"\\]|\\.)*"(?=\s*:)/y, "attribute"], STRING, [words("true false null"), "keyword"], [/-?\d[\d.eE+-]*/y, "number"], BLANK];

/** A line that somebody types has its sign before it; all others are answers. */
const CONSOLE: Rule[] = [[/^[$>] (?=\S)/y, "prompt"], [/.+/y, undefined]];

const RULES: Record<Language, Rule[]> = {
    wgsl: WGSL, glsl: C_LIKE, hlsl: C_LIKE, msl: C_LIKE, c: C_LIKE, rust: RUST, js: JS, toml: TOML, json: JSON_RULES, console: CONSOLE, other: [],
};

/** Languages whose block comments are read; those in which one can stand within another. */
const [COMMENTED, NESTED] = [new Set<Language>(["wgsl", "glsl", "hlsl", "msl", "c", "rust", "js"]), new Set<Language>(["wgsl", "rust"])];

/** Names of languages as fenced blocks, targets and endings of files have them. */
const NAMES: Record<string, Language> = {
    wgsl: "wgsl", wesl: "wgsl", composed: "wgsl", glsl: "glsl", glsl450: "glsl", glsl330: "glsl", essl300: "glsl", frag: "glsl", vert: "glsl", comp: "glsl",
    hlsl: "hlsl", msl: "msl", metal: "msl", rust: "rust", rs: "rust", c: "c", cpp: "c", h: "c", "c++": "c", js: "js", ts: "js", javascript: "js",
    typescript: "js", toml: "toml", json: "json", console: "console",
};

export const languageOf = (name: string): Language => (Object.hasOwn(NAMES, name) ? NAMES[name] : "other");

/** The language of a file by the endings of its name: `lit.frag.glsl`. */
export const languageOfFile = (path: string): Language => languageOf(path.slice(path.lastIndexOf(".") + 1));

/** The end of the comment that a line is in, as far as the line goes. */
function commentEnd(language: Language, line: string, at: number, state: State): number {
    const ends = /\/\*|\*\//g;
    ends.lastIndex = at;
    for (let found = ends.exec(line); found; found = ends.exec(line)) {
        if (found[0] === "*/") state.depth -= 1;
        else if (NESTED.has(language) || state.depth === 0) state.depth += 1;
        if (state.depth === 0) return ends.lastIndex;
    }
    return line.length;
}

/** The token at a place of a line: where it ends, and its kind. */
export function next(language: Language, line: string, at: number, state: State): { end: number; kind?: Kind } {
    const isComment = state.depth > 0 || COMMENTED.has(language) && line.startsWith("/*", at);
    if (isComment) return { end: commentEnd(language, line, at, state), kind: "comment" };
    for (const [rule, kind] of RULES[language]) {
        rule.lastIndex = at;
        const found = rule.exec(line);
        if (found?.[0]) return { end: at + found[0].length, kind };
    }
    return { end: at + 1 };
}

/** Letters of a text that gets colours. A longer one would keep the page waiting. */
const LONGEST = 400_000;

/** A text in tokens, which together are the text. Neighbours of one kind are one token. */
export function tokens(text: string, language: Language): Token[] {
    if (language === "other" || text.length > LONGEST) return [{ text }];
    const found: Token[] = [];
    const add = (kind: Kind | undefined, text: string) => {
        const last = found.at(-1);
        if (last && last.kind === kind) last.text += text;
        else found.push({ kind, text });
    };
    const state: State = { depth: 0 };
    text.split("\n").forEach((line, index) => {
        if (index) add(undefined, "\n");
        for (let at = 0; at < line.length;) {
            const { end, kind } = next(language, line, at, state);
            add(kind, line.slice(at, end));
            at = end;
        }
    });
    return found;
}
