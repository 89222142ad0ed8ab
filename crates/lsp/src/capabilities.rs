//! The capabilities that the server announces to an editor.

use serde_json::{Value, json};

use super::{choose, format};

pub fn server_capabilities() -> Value {
    json!({
        "capabilities": {
            "textDocumentSync": { "openClose": true, "change": 2, "save": true },
            "hoverProvider": true,
            "signatureHelpProvider": { "triggerCharacters": ["(", ","] },
            "definitionProvider": true,
            "referencesProvider": true,
            "renameProvider": { "prepareProvider": true },
            "documentSymbolProvider": true,
            "workspaceSymbolProvider": true,
            "completionProvider": { "triggerCharacters": [":", ".", "(", "@"] },
            "codeActionProvider": { "codeActionKinds": ["quickfix"] },
            "codeLensProvider": {},
            "documentFormattingProvider": true,
            "documentRangeFormattingProvider": true,
            "documentOnTypeFormattingProvider": {
                "firstTriggerCharacter": format::TYPED[0],
                "moreTriggerCharacter": format::TYPED[1..],
            },
            "inlayHintProvider": true,
            "semanticTokensProvider": {
                "legend": { "tokenTypes": ["comment"], "tokenModifiers": [] },
                "full": true,
            },
            "workspace": {
                "workspaceFolders": { "supported": true, "changeNotifications": true },
            },
            "executeCommandProvider": { "commands": choose::COMMANDS },
        },
        "serverInfo": { "name": "lamplight", "version": env!("CARGO_PKG_VERSION") },
    })
}
