//! Runs the judges of all targets on the outputs of random programs.

use lamplight::judge;

use super::judge::Output;

/// An output that a judge refuses: its index, and the judge's message.
pub type Refusal = (usize, String);

/// The outputs that the judges refuse.
///
/// # Errors
/// The reason why a judge could not be run.
pub fn refused(outputs: &[&Output]) -> Result<Vec<Refusal>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut files = Vec::new();
    for (index, output) in outputs.iter().enumerate() {
        let file = folder.path().join(format!("{index}.{}", output.artifact.extension));
        std::fs::write(&file, &output.artifact.bytes).map_err(|error| error.to_string())?;
        files.push(judge::Output {
            target: output.target,
            stage: output.reflection.stage,
            entry: output.artifact.native.entry_name.clone(),
            file,
            unit: [0; 16],
        });
    }
    let refusals = judge::judge(&files, None, &|_, _| ())?;
    let index = |refusal: &judge::Refusal| {
        files.iter().position(|output| output.file == refusal.output.file).unwrap_or_default()
    };
    Ok(refusals.iter().map(|refusal| (index(refusal), refusal.words.clone())).collect())
}
