//! Runs the validators of all targets on the outputs of random programs.

use std::sync::Arc;

use lamplight::validators;

use super::same::Output;

/// An output that a validator refuses: its index, and the validator's message.
pub type Refusal = (usize, String);

/// The outputs that the validators refuse.
///
/// # Errors
/// The reason why a validator could not be run.
pub fn refused(outputs: &[&Output]) -> Result<Vec<Refusal>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut files = Vec::new();
    for (index, output) in outputs.iter().enumerate() {
        let file = folder.path().join(format!("{index}.{}", output.artifact.extension));
        std::fs::write(&file, &output.artifact.bytes).map_err(|error| error.to_string())?;
        files.push(validators::Output {
            target: output.target,
            stage: output.reflection.stage,
            entry: output.artifact.native.entry_name.clone(),
            file,
            unit: [0; 16],
            reflection: Arc::new(output.reflection.clone()),
            native: output.artifact.native.clone(),
            description: index.to_string(),
        });
    }
    let refusals = validators::validate_outputs(&files, None, &|_, _| ())?;
    let index = |refusal: &validators::Refusal| {
        files.iter().position(|output| output.file == refusal.output.file).unwrap_or_default()
    };
    Ok(refusals.iter().map(|refusal| (index(refusal), refusal.message.clone())).collect())
}
