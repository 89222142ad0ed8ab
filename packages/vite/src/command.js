// Runs the command `lamplight`, and makes errors of Vite of its diagnostics.

import { spawn } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import path from "node:path";

const INSTALL =
  "cargo install --git https://github.com/lamplight-shaders/lamplight lamplight";

/** Lines before and after the one of a diagnostic. */
const AROUND = 2;

/** The program to run: that of the option, of the variable `LAMPLIGHT`, or the one of the path. */
function programOf(option) {
  if (option) return { program: option, from: "the plugin's option `command`" };
  const { LAMPLIGHT } = process.env;
  if (LAMPLIGHT) return { program: LAMPLIGHT, from: "the variable `LAMPLIGHT`" };
  return { program: "lamplight", from: "`PATH`" };
}

function missing({ program, from }, error) {
  const text = `the command \`${program}\` cannot be run (${error.code ?? error.message}); its name is from ${from}`;
  const help = "name it by the plugin's option `command` or by the variable `LAMPLIGHT`";
  const told = new Error(`${text}\nhelp: install it with: ${INSTALL}\nhelp: or ${help}`);
  told.stack = "";
  return told;
}

/** Runs the command in a folder. Gives its exit code and what it printed. */
export function runCommand(option, folder, words) {
  const chosen = programOf(option);
  return new Promise((resolve, reject) => {
    const child = spawn(chosen.program, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
    const printed = { stdout: "", stderr: "" };
    for (const stream of ["stdout", "stderr"]) {
      child[stream].setEncoding("utf8").on("data", (text) => (printed[stream] += text));
    }
    child.on("error", (error) => reject(missing(chosen, error)));
    child.on("close", (code) => resolve({ code, ...printed }));
  });
}

function parseLine(line) {
  try {
    const read = JSON.parse(line);
    return read?.message ? read : { message: line };
  } catch {
    return { message: line };
  }
}

/** The place of a diagnostic in a file that is on the disk. */
function placeOf({ labels = [] }, folder) {
  const [label] = labels;
  const file = label && path.resolve(folder, label.file);
  return file && existsSync(file) ? { file, line: label.line, column: label.column, label } : undefined;
}

/** The lines around a place, with a mark below what is meant. */
function excerpt({ file, line, column, label }) {
  const lines = readFileSync(file, "utf8").split(/\r?\n/);
  const first = Math.max(1, line - AROUND), last = Math.min(lines.length, line + AROUND);
  const width = String(last).length;
  const rows = [];
  for (let number = first; number <= last; number++) {
    rows.push(`${String(number).padStart(width)} | ${lines[number - 1]}`);
    if (number !== line) continue;
    const length = label.end_line === line ? Math.max(1, label.end_column - column) : 1;
    const mark = " ".repeat(column - 1) + "^".repeat(length);
    rows.push(`${" ".repeat(width)} | ${mark} ${label.message}`.trimEnd());
  }
  return rows.join("\n");
}

function sentence(diagnostic, folder) {
  const [label] = diagnostic.labels ?? [];
  const place = label ? `${path.relative(process.cwd(), path.resolve(folder, label.file))}:${label.line}:${label.column}: ` : "";
  const code = diagnostic.code ? `[${diagnostic.code}] ` : "";
  return [`${place}${code}${diagnostic.message}`, ...(diagnostic.notes ?? [])].join("\n  ");
}

/** What a run said on standard error, as one error with the place of its first error. */
export function errorOf({ code, stderr }, folder) {
  const said = stderr.split("\n").filter((line) => line.trim()).map(parseLine);
  const errors = said.filter(({ severity = "error" }) => severity === "error");
  const shown = errors.length ? errors : [{ message: `lamplight ended with exit code ${code}` }];
  const error = new Error(shown.map((diagnostic) => sentence(diagnostic, folder)).join("\n"));
  error.files = shown.flatMap(({ labels = [] }) => labels.map(({ file }) => path.resolve(folder, file)));
  const place = shown.map((diagnostic) => placeOf(diagnostic, folder)).find(Boolean);
  if (place) {
    const { file, line, column } = place;
    Object.assign(error, { id: file, loc: { file, line, column }, frame: excerpt(place) });
  }
  error.stack = "";
  return error;
}

/** The warnings of a run, as texts. */
export function warningsOf({ stderr }, folder) {
  const said = stderr.split("\n").filter((line) => line.trim()).map(parseLine);
  return said.filter(({ severity }) => severity === "warning").map((one) => sentence(one, folder));
}
