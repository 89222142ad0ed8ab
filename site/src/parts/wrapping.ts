import { type EditorState, StateField, type Transaction } from "@codemirror/state";
import { EditorView } from "@codemirror/view";

/** Letters of a line from which on CodeMirror draws a part of it. */
const LONG = 20_000;

function hasLong({ doc }: EditorState, first = 1, last = doc.lines) {
    if (doc.length <= LONG) return false;
    for (const line of doc.iterLines(first, last + 1)) if (line.length > LONG) return true;
    return false;
}

/** Whether one of the lines that a change touches is long. */
function hasNewLong({ changes, state }: Transaction) {
    const line = (at: number) => state.doc.lineAt(at).number;
    let found = false;
    changes.iterChangedRanges((_from, _to, start, end) => { found ||= hasLong(state, line(start), line(end)); });
    return found;
}

/**
 * Lines are wrapped, except in a text with a long one. There CodeMirror 6.43 measures the gap after the
 * part that it draws as one row, takes the whole line to be visible, and lays all of it out.
 */
export const wrapping = StateField.define<boolean>({
    create: hasLong,
    update: (isLong, change) => {
        if (!change.docChanged) return isLong;
        return isLong ? hasLong(change.state) : hasNewLong(change);
    },
    provide: (field) => EditorView.contentAttributes.from(field, (isLong): Record<string, string> => isLong ? {} : { class: "cm-lineWrapping" }),
});
