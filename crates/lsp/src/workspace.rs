//! The folders that the editor shows, and the packages in them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::place::path_of_address;
use lamplight_compose::project;
use lamplight_files::limits::WORKSPACE_FOLDERS;

/// What the editor said of itself when the session began.
#[derive(Debug, Default)]
pub struct Workspace {
    folders: Vec<PathBuf>,
    /// Whether it tells of changed files, once it is asked to.
    can_watch: bool,
}

/// The packages in the folders of the editor.
#[derive(Debug, Default)]
pub struct WorkspacePackages {
    /// Their root folders.
    pub roots: BTreeSet<PathBuf>,
    /// Whether there are more folders than are searched.
    pub is_cut: bool,
}

impl Workspace {
    /// Reads the parameters of `initialize`.
    pub fn of_editor(parameters: &Value) -> Self {
        let listed = parameters.get("workspaceFolders").and_then(Value::as_array);
        let folders = match listed {
            Some(listed) => listed.iter().filter_map(folder_of).collect(),
            None => real_folder(parameters.get("rootUri")).into_iter().collect(),
        };
        let watching = "/capabilities/workspace/didChangeWatchedFiles/dynamicRegistration";
        let can_watch = parameters.pointer(watching).and_then(Value::as_bool) == Some(true);
        Self { folders, can_watch }
    }

    /// Takes what `workspace/didChangeWorkspaceFolders` says.
    pub fn change_folders(&mut self, parameters: &Value) {
        let listed = |name: &str| {
            let listed = parameters.pointer(name).and_then(Value::as_array).into_iter().flatten();
            listed.filter_map(folder_of).collect::<Vec<PathBuf>>()
        };
        let removed = listed("/event/removed");
        self.folders.retain(|folder| !removed.contains(folder));
        self.folders.extend(listed("/event/added"));
    }

    /// The request by which the editor tells of changed files that are not open; nothing where it
    /// cannot.
    pub fn watch_request(&self) -> Option<Value> {
        let endings = lamplight_lint::EXTENSIONS.join(",");
        let watchers = [
            json!({ "globPattern": format!("**/*.{{{endings}}}") }),
            json!({ "globPattern": "**/{wesl,lamplight}.toml" }),
        ];
        let registration = json!({
            "id": "files",
            "method": "workspace/didChangeWatchedFiles",
            "registerOptions": { "watchers": watchers },
        });
        self.can_watch.then(|| {
            json!({
                "jsonrpc": "2.0",
                "id": "lamplight-files",
                "method": "client/registerCapability",
                "params": { "registrations": [registration] },
            })
        })
    }

    /// The packages that are declared in the folders, as far as these are searched.
    pub fn packages(&self) -> WorkspacePackages {
        let mut found = WorkspacePackages::default();
        let mut open = self.folders.clone();
        let mut seen = BTreeSet::new();
        while let Some(folder) = open.pop() {
            if !seen.insert(folder.clone()) {
                continue;
            }
            if seen.len() > WORKSPACE_FOLDERS {
                found.is_cut = true;
                break;
            }
            let mut is_declared = false;
            for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
                let Ok(name) = entry.file_name().into_string() else { continue };
                is_declared |= [project::MANIFEST, project::WESL_MANIFEST].contains(&&*name);
                let is_skipped = name.starts_with('.') || SKIPPED.contains(&&*name);
                if !is_skipped && entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                    open.push(entry.path());
                }
            }
            if is_declared {
                // A manifest that cannot be read declares no root; the package is there all the same.
                let root = project::package_at(&folder).and_then(|root| root.canonicalize().ok());
                found.roots.insert(root.filter(|root| root.starts_with(&folder)).unwrap_or(folder));
            }
        }
        found
    }
}

/// Folders that have what programs wrote, and no packages of authors.
const SKIPPED: [&str; 2] = ["target", "node_modules"];

fn folder_of(listed: &Value) -> Option<PathBuf> {
    real_folder(listed.get("uri"))
}

fn real_folder(address: Option<&Value>) -> Option<PathBuf> {
    let path = path_of_address(address?.as_str()?)?;
    path.canonicalize().ok().filter(|path: &PathBuf| Path::is_dir(path))
}
