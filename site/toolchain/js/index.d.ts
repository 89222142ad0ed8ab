import type * as raw from "./toolchain.js";

export type * from "./toolchain.js";

/** Where the WebAssembly comes from: an address, its bytes, or a module that is compiled. */
export type Source = URL | string | BufferSource | WebAssembly.Module;

/** The functions of the toolchain. Inputs are never changed. */
export interface Toolchain {
    version: typeof raw.version;
    targets: typeof raw.targets;
    library: typeof raw.library;
    search: typeof raw.search;
    written: typeof raw.written;
    files: typeof raw.files;
    file: typeof raw.file;
    programs: typeof raw.programs;
    point: typeof raw.point;
    compose: typeof raw.compose;
    compile: typeof raw.compile;
    lint: typeof raw.lint;
    evaluate: typeof raw.evaluate;
    curves: typeof raw.curves;
    reference: typeof raw.reference;
    studio: typeof raw.studio;
    pictureStart: typeof raw.pictureStart;
    pictureFrames: typeof raw.pictureFrames;
    pictureControls: typeof raw.pictureControls;
    sketchStart: typeof raw.sketchStart;
    sketchControls: typeof raw.sketchControls;
    costs: typeof raw.costs;
    sketchPixel: typeof raw.sketchPixel;
    picturePixel: typeof raw.picturePixel;
    markKinds: typeof raw.markKinds;
    sketchMarks: typeof raw.sketchMarks;
    pictureMarks: typeof raw.pictureMarks;
    marksStep: typeof raw.marksStep;
    keepImage: typeof raw.keepImage;
    editor: typeof raw.editor;
}

/** An input stopped the toolchain. The next call finds it restarted. */
export declare class Stopped extends Error {}

/** Loads the toolchain. Without a source, it loads the WebAssembly beside this file. */
export declare function load(source?: Source): Promise<Toolchain>;
