import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { type Diagnostic as Mark, lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, highlightSpecialChars, keymap, lineNumbers } from "@codemirror/view";
import type { Diagnostic } from "@lamplight/toolchain";
import { OWN, toolchain, typed } from "../client";
import { choose, h, reason, remember, route, say } from "../dom";
import { output } from "../output";
import { zip } from "../pack";
import { FIRST, earlier, keep, keepEarlier, linked, opened } from "../parts/project";
import { LARGEST, type Project } from "../parts/state";
import { Files } from "../parts/files";
import { EXAMPLES } from "../parts/examples";
import { format, languages as known } from "../parts/language";
import { latest } from "../parts/latest";
import { nearest } from "../parts/nearest";
import type { Moment } from "../parts/lines";
import { Listed } from "../parts/listed";
import { Sketch } from "../parts/sketch";
import { showValues, values } from "../parts/values";
import { wrapping } from "../parts/wrapping";

/** Milliseconds after which the page says that it still computes. */
const PATIENCE = 1000;

export async function page(into: HTMLElement, given?: Project) {
    const { project: state, refused } = given ? { project: given, refused: undefined } : await opened(route().query.get("state"));
    const outputs = h("div", { class: "texts" });
    const problems = h("ul", { class: "problems", "aria-label": "Diagnostics", "aria-live": "polite" });
    const status = h("p", { role: "status", class: "status" });
    const value = h("output", {});
    const unkept = h("p", { class: "wrong", role: "alert", hidden: true },
        "The browser has no room to keep these files: they are lost when the page is closed. Save them as a zip.");
    const shown = (moment: Moment | undefined) => {
        [last, isEdited] = [moment, false];
        place();
        listed.show(moment);
    };
    const listed = new Listed((file) => Object.hasOwn(state.files, file));
    const sketch = new Sketch(() => state.look, () => { save(); link(); }, true, shown, (error) => {
        // The browser speaks of what was made of the text: the line that is most like it is meant.
        const line = nearest(editor.state.doc.toString(), error.line);
        const { from, to } = editor.state.doc.line(line ?? 1);
        if (line !== undefined) editor.dispatch(setDiagnostics(editor.state, [{ from, to, severity: "error", message: error.message }]));
        const where = line === undefined ? "" : `${state.open}:${line}: `;
        problems.replaceChildren(h("li", { class: "error" }, h("code", {}, where), `${error.message} `, h("span", { class: "note" }, "In the output: ", h("code", {}, error.line.trim()))));
        status.textContent = "errors, which only the browser finds";
    });
    const panel = h("div", { class: "editor", id: "text", role: "tabpanel", "aria-label": "Text of the open file" });
    const leaving = h("p", { class: "note", id: "leaving" }, "Tab indents. Escape and then Tab leaves the editor.");
    const editor = new EditorView({ parent: panel });

    /** What a pixel's run gave lines, and whether something was typed since. */
    let last: Moment | undefined;
    let isEdited = false;
    const place = () => {
        const { file, line } = last?.now ?? {};
        const lines = last?.files.get(state.open);
        showValues(editor, lines && { lines, now: file === state.open ? line : undefined });
    };
    /** Letters of the files that are not open. */
    const others = () => Object.entries(state.files).reduce((sum, [name, text]) => sum + (name === state.open ? 0 : text.length), 0);
    const begin = () => editor.setState(EditorState.create({
        doc: state.files[state.open] ?? "",
        extensions: [
            // Bidirectional formatting characters and control characters are seen, so that a text reads as it is.
            highlightSpecialChars(), lineNumbers(), history(), drawSelection(), highlightActiveLine(), lintGutter(), values, wrapping, known(state),
            EditorView.contentAttributes.of({ "aria-label": `Text of ${state.open}`, "aria-describedby": "leaving" }),
            EditorState.transactionFilter.of((change) => {
                // Files that are too large already can be made smaller.
                const isSmaller = change.newDoc.length < change.startState.doc.length;
                if (!change.docChanged || isSmaller || change.newDoc.length + others() <= LARGEST) return change;
                status.textContent = `Not inserted: the files would have more than ${LARGEST.toLocaleString("en")} characters in total.`;
                return [];
            }),
            keymap.of([...defaultKeymap, ...historyKeymap, indentWithTab]),
            EditorView.updateListener.of((update) => {
                if (!update.docChanged) return;
                state.files[state.open] = update.state.doc.toString();
                isEdited = true;
                changed();
            }),
        ],
    }));
    /** How often something was typed or chosen. */
    let changes = 0;
    function changed() {
        changes += 1;
        // Saved before anything is computed, so that a reload restores what was typed.
        save();
        run();
    }
    let isReplaced = false;
    function save() {
        if (isReplaced || !into.isConnected) return;
        const isKept = keep(state);
        unkept.hidden = isKept;
    }
    const run = latest(async () => {
        const now = changes;
        const isOld = () => now !== changes || !into.isConnected;
        const patience = window.setTimeout(() => { status.textContent = "Still computing …"; }, PATIENCE);
        try {
            await compute(isOld);
        } catch (error) {
            status.textContent = reason(error);
        }
        clearTimeout(patience);
        into.dataset.runs = String(Number(into.dataset.runs ?? 0) + 1);
        await link();
    });
    async function compiled(isOld: () => boolean) {
        const { files, open, target } = state;
        const call = (targets: string[], keepAll: boolean) =>
            toolchain.call(typed(isOld), "compile", { files, root: open, targets, keepAll });
        const made = await call(target === "composed" ? [] : [target], false);
        const isModule = made.diagnostics.some((one) => one.code === "no-entry-point");
        if (made.ok || !isModule) return { made, target };
        // Other files import it. It has nothing to emit, but a text and maybe mistakes.
        const { diagnostics } = await toolchain.call(typed(isOld), "lint", { files });
        const composed = await call([], true);
        const ok = composed.ok && diagnostics.every((one) => one.severity !== "error");
        return { made: { ...composed, ok, diagnostics }, target: "composed" };
    }
    async function compute(isOld: () => boolean) {
        const start = performance.now();
        const { made, target } = await compiled(isOld);
        const found = `${made.ok ? "no errors" : "errors"}, ${Math.round(performance.now() - start)} ms`;
        mark(made.diagnostics);
        if (made.ok) outputs.replaceChildren(...output(made, target));
        else sketch.suspend("The text has mistakes: values come back once it has none.");
        status.textContent = found;
        const isDrawn = /@fragment|\.frag(\.|$)/.test(`${state.files[state.open]}${state.open}`);
        if (!isDrawn && isEdited) sketch.suspend("The text has changed: open the file of the stage for new values.");
        // Somebody who opens an imported file goes through the same run there.
        sketch.element.hidden = !isDrawn && !last;
        try {
            const number = await toolchain.call(typed(isOld), "evaluate", { files: state.files, expression: state.expression });
            value.textContent = number.value ?? number.diagnostics[0]?.message ?? "";
            status.textContent = found;
        } catch (error) {
            value.textContent = "no value";
            status.textContent = reason(error);
        }
        // Last, so that a picture which takes long does not keep the rest waiting.
        if (made.ok && isDrawn && !isOld()) sketch.draw({ files: state.files, root: state.open }, isOld);
    }
    async function link() {
        const made = await linked(state);
        if (!isReplaced) remember(into, "playground", "", { state: made });
    }
    function mark(found: Diagnostic[]) {
        const length = editor.state.doc.length;
        const marks: Mark[] = found.flatMap((one) => {
            const label = one.labels.find((label) => label.path === state.open);
            if (!label) return [];
            const from = Math.min(label.from.offset, length);
            const to = Math.min(Math.max(label.to.offset, from + 1), length);
            return [{ from, to, severity: one.severity as Mark["severity"], message: `${one.message} [${one.code}]` }];
        });
        editor.dispatch(setDiagnostics(editor.state, marks));
        problems.replaceChildren(...found.map((one) => {
            const label = one.labels[0];
            const where = label ? `${label.path}:${label.from.line}:${label.from.column}: ` : "";
            return h("li", { class: one.severity }, h("code", {}, where), `${one.message} `, h("span", { class: "note" }, one.notes.join(" ")));
        }));
    }
    const files = new Files(state, () => { begin(); place(); changed(); });
    const zipped = () => {
        const link = h("a", { href: URL.createObjectURL(zip(state.files)), download: "shaders.zip" });
        link.click();
        URL.revokeObjectURL(link.href);
    };
    // The page is built again, since every control shows something of the project.
    const replace = async (project: Project) => {
        Object.assign(state, structuredClone(project));
        save();
        isReplaced = true;
        editor.destroy();
        await page(into, state);
    };
    const restart = () => {
        if (confirm("Discard your files, and begin with the first example again?")) replace(FIRST);
    };
    // What somebody typed stays within reach, as if a link had been opened.
    const example: HTMLSelectElement = h("select", {
        onchange: () => {
            const found = EXAMPLES.flatMap(({ examples }) => examples).find(({ name }) => name === example.value);
            if (!found) return;
            keepEarlier(JSON.stringify(state));
            const [open] = Object.keys(found.files);
            replace({ ...FIRST, files: found.files, open, target: state.target, expression: "1.0", look: found.look ?? {} });
        },
    }, h("option", { value: "" }, "choose one"), ...EXAMPLES.map(({ title, examples }) =>
        h("optgroup", { label: title }, ...examples.map(({ name }) => h("option", { value: name }, name)))));
    const share = h("button", {
        onclick: async () => {
            await link();
            try {
                await navigator.clipboard.writeText(location.href);
                share.textContent = "Link copied";
            } catch {
                share.textContent = "Copy the address of this page";
            }
            say(share.textContent);
        },
    }, "Share");
    const layOut = h("button", {
        title: "Shift + Alt + F", onclick: async () => say(await format(editor, state) ? "The text is laid out." : "Nothing to lay out."),
    }, "Format");
    const back = earlier().map((project, index) => h("button", { onclick: () => replace(project) },
        index ? `Back to ${Object.keys(project.files).join(", ")}` : "Back to my files before the link"));
    const expression = h("input", {
        value: state.expression, "aria-label": "Expression", spellcheck: "false",
        oninput: () => { state.expression = expression.value; changed(); },
    });
    const choice = (names: string[]) => choose(
        "output", [...new Set(["composed", ...names])], state.target, (target) => { state.target = target; changed(); },
    );
    // The toolchain knows all targets, and is not loaded yet.
    const languages = choice([state.target]);
    into.replaceChildren(
        h("h1", { class: "quiet" }, "Playground"),
        refused === undefined ? "" : h("p", { class: "wrong refused", role: "alert" }, refused),
        h("div", { class: "columns wide" },
            h("div", {}, files.element, panel, leaving, status, problems),
            h("div", {},
                h("div", { class: "row" },
                    h("label", {}, h("span", {}, "example"), example), languages, share, layOut,
                    h("button", { onclick: zipped }, "Save as zip"), h("button", { onclick: restart }, "Begin again"),
                    ...back),
                unkept, sketch.element, listed.element,
                h("label", { class: "eval" }, h("span", {}, "value of"), expression, value), outputs)),
    );
    begin();
    files.show();
    languages.replaceWith(choice(await toolchain.call(OWN, "targets")));
    await run();
    return () => { if (!isReplaced) editor.destroy(); };
}
