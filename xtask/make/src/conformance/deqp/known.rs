//! Cases that dEQP wants refused, and that are accepted on purpose.

/// One line for each: how the names of the cases begin, `|`, and the reason. `*` stands for any
/// letters. A comment begins with `#`.
const KNOWN: &str = include_str!("known.txt");

/// Why a case is accepted that the suite wants refused, if that is known.
pub fn reason_of(name: &str) -> Option<&'static str> {
    let lines = KNOWN.lines().filter(|line| !line.starts_with('#'));
    let known = lines.filter_map(|line| line.split_once('|'));
    let mut known = known.filter(|(pattern, _)| begins_with(name, pattern.trim()));
    known.next().map(|(_, reason)| reason.trim())
}

/// Whether a name begins with a pattern.
fn begins_with(name: &str, pattern: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| name.strip_prefix(first)) else {
        return false;
    };
    for part in parts {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns() {
        assert!(begins_with("data.gles3.keywords.half:frag", "data.gles3.keywords.half:"));
        assert!(begins_with("data.gles3.keywords.half:frag", "data.*.keywords.*:frag"));
        assert!(!begins_with("data.gles3.keywords.half:frag", "data.*.keywords.*:vert"));
        assert!(!begins_with("other.data", "data"));
    }

    #[test]
    fn every_line_has_a_reason() {
        for line in KNOWN.lines().filter(|line| !line.starts_with('#')) {
            let reason = line.split_once('|').map(|(_, reason)| reason.trim());
            assert!(reason.is_some_and(|reason| !reason.is_empty()), "{line}");
        }
    }
}
