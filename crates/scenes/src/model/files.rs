//! The bytes of buffers and images: in the model's own file, in data URIs, and in files beside it.

use std::borrow::Cow;

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::buffer::Source;
use lamplight_files::limits::MODEL_BYTES;

/// Reads a file below the folder of the model, by its path with `/` between its parts.
pub type Files<'f> = dyn Fn(&str) -> Result<Vec<u8>, String> + 'f;

/// The bytes of a buffer, or why there are none.
pub type BufferBytes<'b> = Result<Cow<'b, [u8]>, String>;

/// The bytes of each buffer of a document. `blob` is that of a binary file, which the first buffer has
/// if it names nothing else.
///
/// # Errors
/// Together they are too many.
pub fn buffer_bytes<'b>(
    document: &gltf::Document,
    blob: &'b [u8],
    files: &Files<'_>,
) -> Result<Vec<BufferBytes<'b>>, String> {
    let (mut total, mut all) = (0, Vec::new());
    for buffer in document.buffers() {
        let index = buffer.index();
        let bytes = match buffer.source() {
            Source::Bin if index == 0 => Ok(Cow::Borrowed(blob)),
            Source::Bin => Err(format!("buffer {index} has no bytes")),
            Source::Uri(uri) => {
                let bytes = uri_bytes(uri, files);
                bytes.map(Cow::Owned).map_err(|reason| format!("buffer {index} {reason}"))
            }
        };
        total += bytes.as_ref().map_or(0, |bytes| bytes.len() as u64);
        if total > MODEL_BYTES {
            return Err(format!("buffers[{index}]: all have more bytes than {MODEL_BYTES}"));
        }
        all.push(bytes);
    }
    Ok(all)
}

/// The bytes that a URI stands for.
///
/// # Errors
/// In words that follow the name of what has the URI.
pub fn uri_bytes(uri: &str, files: &Files<'_>) -> Result<Vec<u8>, String> {
    let Some(data) = uri.strip_prefix("data:") else {
        return files(&path_below(uri)?).map_err(|reason| format!("is in another file: {reason}"));
    };
    let (kind, text) = data.split_once(',').ok_or("has a data URI without a comma")?;
    if !kind.ends_with(";base64") {
        return Err("has a data URI that is not in base64".to_owned());
    }
    let padded = DecodePaddingMode::Indifferent;
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(padded);
    let decoded = GeneralPurpose::new(&STANDARD, config).decode(text);
    decoded.map_err(|error| format!("has a data URI that is broken: {error}"))
}

/// The path of a relative URI that stays below the folder of the model.
fn path_below(uri: &str) -> Result<String, String> {
    let path = percent_decoded(uri)?;
    let stays = path.split('/').all(|part| !matches!(part, "" | ".."));
    if !stays || path.contains(['\\', ':', '\0']) {
        return Err(format!("is in another file, `{uri}`, which is not below the model's folder"));
    }
    Ok(path)
}

/// The text with each `%20` and its like as the byte that it stands for.
fn percent_decoded(uri: &str) -> Result<String, String> {
    let broken = || format!("has the URI `{uri}`, whose percent signs stand for no text");
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        rest = after;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let digits = after.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let byte = digits.and_then(|two| u8::from_str_radix(two, 16).ok());
        bytes.push(byte.ok_or_else(broken)?);
        rest = &after[2..];
    }
    String::from_utf8(bytes).map_err(|_| broken())
}

/// How many bytes a document has without its data URIs, which are no structure.
pub fn structure_bytes(json: &[u8]) -> usize {
    const START: &[u8] = b"\"data:";
    let (mut count, mut rest) = (0, json);
    while let Some(at) = rest.iter().position(|byte| *byte == b'"') {
        let text = &rest[at + 1..];
        let end = text.iter().position(|byte| *byte == b'"').unwrap_or(text.len());
        let is_data = rest[at..].starts_with(START);
        count += if is_data { at + 2 } else { at + 1 };
        rest = if is_data { &text[(end + 1).min(text.len())..] } else { text };
    }
    count + rest.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(uri: &str) -> Result<Vec<u8>, String> {
        uri_bytes(uri, &|path| Ok(path.as_bytes().to_vec()))
    }

    #[test]
    fn data_is_decoded() {
        assert_eq!(bytes("data:application/octet-stream;base64,AAEC/w=="), Ok(vec![0, 1, 2, 255]));
        assert_eq!(bytes("data:;base64,AAEC/w"), Ok(vec![0, 1, 2, 255]));
        assert!(bytes("data:;base64,A*").is_err_and(|reason| reason.contains("is broken")));
        assert!(bytes("data:text/plain,hello").is_err_and(|reason| reason.contains("base64")));
    }

    #[test]
    fn paths_stay_below_the_folder() {
        assert_eq!(bytes("a%20b/c.bin"), Ok(b"a b/c.bin".to_vec()));
        for uri in ["/etc/passwd", "../a", "a/%2e%2e/b", "c:a", "http://a/b", "a\\b", "", "a//b"] {
            assert!(bytes(uri).is_err_and(|reason| reason.contains("is not below")), "{uri}");
        }
        for uri in ["a%2", "a%zz", "%ff"] {
            assert!(bytes(uri).is_err_and(|reason| reason.contains("percent")), "{uri}");
        }
    }

    #[test]
    fn data_is_no_structure() {
        assert_eq!(structure_bytes(br#"{"a":"data:xyz","b":1}"#), r#"{"a":"","b":1}"#.len());
        assert_eq!(structure_bytes(br#"{"a":"xyz"}"#), r#"{"a":"xyz"}"#.len());
        assert_eq!(structure_bytes(b"\"data:x"), 2);
    }
}
