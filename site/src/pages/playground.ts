import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { type Diagnostic as Mark, lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import type { Diagnostic } from "@lamplight/toolchain";
import { OWN, TYPED, toolchain } from "../client";
import { choose, h, remember, route } from "../dom";
import { output } from "../output";
import { packed, unpacked, zip } from "../pack";

const FIRST = {
    files: {
        "lit.wesl": `import lamplight::brdf::diffuse::lambert;
import lamplight::brdf::specular::blinn_phong;
import package::lamp::falloff;

@fragment
fn fs_main(@location(0) normal: vec3f, @location(1) to_light: vec3f) -> @location(0) vec4f {
    let n = normalize(normal);
    let l = normalize(to_light);
    let light = lambert(n, l) + blinn_phong(n, l, vec3f(0.0, 0.0, 1.0), 32.0);
    return vec4f(vec3f(light * falloff(length(to_light))), 1.0);
}
`,
        "lamp.wesl": `import lamplight::lighting::attenuation::inverse_square;

fn falloff(distance: f32) -> f32 {
    return inverse_square(distance * distance, 0.01);
}
`,
        "lit.frag.glsl": `#version 450
#include <lamplight/brdf/diffuse.glsl>

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(lambert(normalize(normal), vec3(0.0, 1.0, 0.0)));
}
`,
    } as Record<string, string>,
    open: "lit.wesl", target: "wgsl", expression: "package::lamp::falloff(2.0)",
};

const KEPT = "lamplight-playground";

export async function page(into: HTMLElement) {
    const given = route().query.get("state");
    const kept = localStorage.getItem(KEPT);
    const state: typeof FIRST = structuredClone(FIRST);
    try {
        Object.assign(state, given ? JSON.parse(await unpacked(given)) : kept ? JSON.parse(kept) : {});
    } catch {
        // A link that was cut short opens the first example.
    }
    const tabs = h("div", { class: "tabs", role: "tablist", "aria-label": "Files" });
    const outputs = h("div", { class: "texts" });
    const problems = h("ul", { class: "problems", "aria-label": "Diagnostics", "aria-live": "polite" });
    const told = h("p", { role: "status", class: "status" });
    const value = h("output", {});
    const editor = new EditorView({ parent: h("div", { class: "editor" }) });

    const begin = () => editor.setState(EditorState.create({
        doc: state.files[state.open] ?? "",
        extensions: [
            lineNumbers(), history(), drawSelection(), highlightActiveLine(), lintGutter(), EditorView.lineWrapping,
            EditorView.contentAttributes.of({ "aria-label": `Text of ${state.open}` }),
            keymap.of([...defaultKeymap, ...historyKeymap, indentWithTab]),
            EditorView.updateListener.of((update) => {
                if (!update.docChanged) return;
                state.files[state.open] = update.state.doc.toString();
                changed();
            }),
        ],
    }));
    function changed() {
        // Saved before anything is computed, so that a reload restores what was typed.
        localStorage.setItem(KEPT, JSON.stringify(state));
        run();
    }
    let busy = false;
    let again = false;
    async function run() {
        if (busy) { again = true; return; }
        busy = true;
        try {
            const start = performance.now();
            const made = await toolchain.call(TYPED, "compile", {
                files: state.files, root: state.open, targets: state.target === "composed" ? [] : [state.target],
            });
            mark(made.diagnostics);
            if (made.ok) outputs.replaceChildren(...output(made, state.target));
            told.textContent = `${made.ok ? "no errors" : "errors"}, ${Math.round(performance.now() - start)} ms`;
            const number = await toolchain.call(TYPED, "evaluate", { files: state.files, expression: state.expression });
            value.textContent = number.value ?? number.diagnostics[0]?.message ?? "";
        } catch (error) {
            told.textContent = error instanceof Error ? error.message : String(error);
        }
        into.dataset.runs = String(Number(into.dataset.runs ?? 0) + 1);
        remember("playground", "", { state: await packed(JSON.stringify(state)) });
        busy = false;
        if (again) { again = false; run(); }
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
    function files() {
        tabs.replaceChildren(...Object.keys(state.files).map((name) => h("button", {
            role: "tab", "aria-selected": String(name === state.open), onclick: () => { state.open = name; begin(); files(); changed(); },
        }, name)), h("button", { onclick: add, "aria-label": "Add a file" }, "+"));
    }
    function add() {
        const name = prompt("Name of the file", "more.wesl");
        if (!name || name in state.files || !/^[\w./-]+$/.test(name)) return;
        state.files[name] = "";
        state.open = name;
        begin(); files(); changed();
    }
    const save = () => {
        const link = h("a", { href: URL.createObjectURL(zip(state.files)), download: "shaders.zip" });
        link.click();
        URL.revokeObjectURL(link.href);
    };
    const restart = () => {
        if (!confirm("Discard your files, and begin with the first example again?")) return;
        Object.assign(state, structuredClone(FIRST));
        begin(); files(); changed();
    };
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
        h("div", { class: "columns wide" },
            h("div", {}, tabs, editor.dom.parentElement ?? editor.dom, told, problems),
            h("div", {},
                h("div", { class: "row" },
                    languages,
                    h("button", { onclick: save }, "Save as zip"), h("button", { onclick: restart }, "Begin again")),
                h("label", { class: "eval" }, h("span", {}, "value of"), expression, value), outputs)),
    );
    begin();
    files();
    languages.replaceWith(choice(await toolchain.call(OWN, "targets")));
    await run();
    return () => editor.destroy();
}
