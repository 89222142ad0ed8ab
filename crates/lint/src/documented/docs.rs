//! What the comment above a function says of its parameters, in the form of the library:
//! `/// Parameters: `c` cosine of the angle, [-1, 1]; `n`, `l` unit, one space.`

/// What is said of one parameter.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Documented {
    /// The words, as they stand.
    pub words: String,
    pub range: Option<Range>,
    /// A vector of length 1.
    pub is_unit: bool,
    pub unit: Option<Unit>,
    /// The name of a parameter that it must be above.
    pub above: Option<String>,
}

/// The values that a parameter has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub least: f64,
    pub most: f64,
    /// Whether the least value is outside itself.
    pub is_open: bool,
}

impl Range {
    pub fn has(self, value: f64) -> bool {
        let is_above = if self.is_open { value > self.least } else { value >= self.least };
        is_above && value <= self.most
    }

    /// As a sentence goes on after "the range is".
    pub fn text(self) -> String {
        match (self.most.is_finite(), self.is_open) {
            (true, _) => format!("[{}, {}]", self.least, self.most),
            (false, true) => format!("above {}", self.least),
            (false, false) => format!("at least {}", self.least),
        }
    }
}

/// What a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    Cosine,
    Radians,
    Degrees,
    Distance,
    SquaredDistance,
}

/// What a comment says of a parameter.
pub fn documented(comment: &str, parameter: &str) -> Option<Documented> {
    let section = parameters_section(comment)?;
    let mut entries: Vec<String> = Vec::new();
    for piece in section.trim_end_matches('.').split("; ") {
        match entries.last_mut() {
            Some(entry) if !piece.starts_with('`') => *entry += &format!("; {piece}"),
            _ => entries.push(piece.to_owned()),
        }
    }
    let own = entries.iter().map(|entry| split_names(entry));
    let (_, words) = own.into_iter().find(|(names, _)| names.contains(&parameter))?;
    Some(read_words(words, parameter))
}

/// The text of the section, on one line.
fn parameters_section(comment: &str) -> Option<String> {
    const OTHERS: [&str; 4] = ["Returns:", "Source:", "Edges:", "Error model:"];
    let lines = comment.lines().map(|line| line.trim().trim_start_matches('/').trim());
    let own = lines
        .skip_while(|line| !line.starts_with("Parameters:"))
        .take_while(|line| !line.is_empty() && !OTHERS.iter().any(|other| line.starts_with(other)));
    let text = own.collect::<Vec<_>>().join(" ");
    text.strip_prefix("Parameters:").map(|rest| rest.trim().to_owned())
}

/// The names in backticks at the start of an entry, and what is said of them.
fn split_names(entry: &str) -> (Vec<&str>, &str) {
    let (mut names, mut rest) = (Vec::new(), entry.trim());
    while let Some((name, after)) = rest.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
        names.push(name);
        let next = after.trim_start().trim_start_matches(',').trim_start();
        rest = next.strip_prefix("and ").filter(|next| next.starts_with('`')).unwrap_or(next);
    }
    (names, rest)
}

fn read_words(words: &str, parameter: &str) -> Documented {
    // What comes behind a colon or in brackets explains, and is not the first thing that is said.
    let head = words.split([':', '(']).next().unwrap_or(words);
    let starts = |word: &str| head.starts_with(word);
    let is_length = |word: &str| {
        head == word
            || head.strip_prefix(word).is_some_and(|rest| rest.starts_with([' ', ',', 's']))
    };
    let unit = if starts("cosine") {
        Some(Unit::Cosine)
    } else if head.split([',', ' ']).any(|word| word == "radians") {
        Some(Unit::Radians)
    } else if head.split([',', ' ']).any(|word| word == "degrees") {
        Some(Unit::Degrees)
    } else if starts("squared distance") {
        Some(Unit::SquaredDistance)
    } else if is_length("distance") {
        Some(Unit::Distance)
    } else {
        None
    };
    let above = head.split_once(&format!("`{parameter}` above `"));
    Documented {
        words: words.to_owned(),
        range: written_range(head),
        is_unit: is_length("unit") && !starts("units"),
        unit,
        above: above.and_then(|(_, rest)| rest.split('`').next()).map(str::to_owned),
    }
}

/// `[0, 1]`, `at least 0`, `above 0`.
fn written_range(words: &str) -> Option<Range> {
    if let Some((_, rest)) = words.split_once('[') {
        let (least, most) = rest.split_once(']')?.0.split_once(',')?;
        let (least, most) = (least.trim().parse().ok()?, most.trim().parse().ok()?);
        return Some(Range { least, most, is_open: false });
    }
    // The number is the end of what is said: `above 0 where it is used` says more.
    let number = |before: &str| {
        let (_, rest) = words.split_once(before)?;
        let text = rest.split([',', ';', ' ']).next()?;
        text.trim_end_matches('.').parse::<f64>().ok()
    };
    let of = |least, is_open| Range { least, most: f64::INFINITY, is_open };
    number("at least ")
        .map(|least| of(least, false))
        .or(number("above ").map(|least| of(least, true)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMENT: &str = "/// A cone.\n///\n/// Parameters: `n`, `l` unit, one space; `c` cosine of the \
        angle, [-1, 1]; `inner` and `outer` cosines of the half angles, `inner` above `outer`; `d2` \
        squared distance to the light, at least 0; `sigma` deviation of the slope, radians, at least \
        0; `w` wrap, [0, 1]: 0 is Lambert; `d` distance to the light.\n/// Returns: 0 or 1.";

    fn of(name: &str) -> Documented {
        documented(COMMENT, name).unwrap_or_default()
    }

    #[test]
    fn parameters_are_read() {
        assert!(of("n").is_unit && of("l").is_unit && !of("c").is_unit);
        assert_eq!(of("c").unit, Some(Unit::Cosine));
        assert_eq!(of("c").range.map(Range::text).as_deref(), Some("[-1, 1]"));
        assert_eq!(of("inner").above.as_deref(), Some("outer"));
        assert_eq!(of("outer").above, None);
        assert_eq!(of("d2").unit, Some(Unit::SquaredDistance));
        assert_eq!(of("d").unit, Some(Unit::Distance));
        assert_eq!(of("sigma").unit, Some(Unit::Radians));
        assert_eq!(of("sigma").range.map(Range::text).as_deref(), Some("at least 0"));
        assert!(documented(COMMENT, "x").is_none() && documented("/// A cone.", "n").is_none());
    }

    #[test]
    fn ranges_have_values() {
        let range = Range { least: 0.0, most: 1.0, is_open: false };
        assert!(range.has(0.0) && range.has(1.0) && !range.has(1.5) && !range.has(-0.1));
        let open = Range { least: 0.0, most: f64::INFINITY, is_open: true };
        assert!(!open.has(0.0) && open.has(1e9) && open.text() == "above 0");
    }
}
