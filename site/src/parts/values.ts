// Values of a run at the ends of the editor's lines.
import { type Extension, RangeSetBuilder, StateEffect, StateField } from "@codemirror/state";
import { Decoration, type DecorationSet, EditorView, WidgetType } from "@codemirror/view";
import type { Line } from "./lines";
import { ending } from "./listing";

/** The lines that have something, and the line where the run is. */
export type Shown = { lines: Map<number, Line>; now?: number };

const show = StateEffect.define<Shown | undefined>();

class Ending extends WidgetType {
    readonly key: string;

    constructor(readonly line: Line) {
        super();
        this.key = JSON.stringify(line);
    }

    eq(other: Ending) {
        return other.key === this.key;
    }

    toDOM() {
        return ending(this.line);
    }
}

const NOW = Decoration.line({ class: "cm-now" });

function decorations({ doc }: EditorView["state"], { lines, now }: Shown): DecorationSet {
    const builder = new RangeSetBuilder<Decoration>();
    const numbers = new Set([...lines.keys(), ...(now === undefined ? [] : [now])]);
    for (const number of [...numbers].filter((one) => one >= 1 && one <= doc.lines).sort((a, b) => a - b)) {
        const { from, to } = doc.line(number);
        if (number === now) builder.add(from, from, NOW);
        const line = lines.get(number);
        if (line) builder.add(to, to, Decoration.widget({ widget: new Ending(line), side: 1 }));
    }
    return builder.finish();
}

const field = StateField.define<DecorationSet>({
    create: () => Decoration.none,
    update(found, change) {
        // While somebody types, the values move with their lines, until there are new ones.
        let next = found.map(change.changes);
        for (const effect of change.effects) {
            if (effect.is(show)) next = effect.value ? decorations(change.state, effect.value) : Decoration.none;
        }
        return next;
    },
    provide: (own) => EditorView.decorations.from(own),
});

/** The part of an editor that has room for values. */
export const values: Extension = field;

/** Puts values at the ends of lines; or takes them away. Scrolls to the line where the run is. */
export function showValues(editor: EditorView, shown: Shown | undefined) {
    const now = shown?.now !== undefined && shown.now <= editor.state.doc.lines ? editor.state.doc.line(shown.now) : undefined;
    // Only the editor scrolls, and not the page.
    const block = now && editor.lineBlockAt(now.from);
    editor.dispatch({ effects: show.of(shown) });
    if (!block) return;
    const { scrollTop, clientHeight } = editor.scrollDOM;
    if (block.top >= scrollTop && block.bottom <= scrollTop + clientHeight) return;
    editor.scrollDOM.scrollTop = Math.max(0, (block.top + block.bottom - clientHeight) / 2);
}
