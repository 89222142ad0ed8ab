//! Values from outside for `constants::NAME`, where no axis has that name.

/// The most digits of a number.
const LONGEST: usize = 64;

/// Checks that a text is a literal of WGSL, and returns it. A suffix is the type of the literal:
/// `true`, `4`, `4u`, `-4i`, `0.5f`.
///
/// # Errors
/// What is wrong with it.
pub fn parse(text: &str) -> Result<String, String> {
    let wrong = || {
        format!(
            "`{text}` is not a constant: write `true`, `false` or a number, such as `4u` or `0.5`"
        )
    };
    if matches!(text, "true" | "false") {
        return Ok(text.to_owned());
    }
    let digits = text.strip_prefix('-').unwrap_or(text);
    if digits.len() > LONGEST || !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return Err(wrong());
    }
    let fits = integer_fits(text).or_else(|| float_fits(text)).ok_or_else(wrong)?;
    if fits { Ok(text.to_owned()) } else { Err(format!("`{text}` does not fit its type")) }
}

/// Whether an integer fits the type that its suffix names; `None` if the text is not an integer.
fn integer_fits(text: &str) -> Option<bool> {
    let (number, range) = match text.as_bytes().last()? {
        b'u' => (text.strip_suffix('u')?, 0..=i128::from(u32::MAX)),
        b'i' => (text.strip_suffix('i')?, i128::from(i32::MIN)..=i128::from(i32::MAX)),
        _ => (text, i128::from(i64::MIN)..=i128::from(i64::MAX)),
    };
    let (sign, digits) = match number.strip_prefix('-') {
        Some(digits) => (-1, digits),
        None => (1, number),
    };
    let value = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(hexadecimal) => i128::from_str_radix(hexadecimal, 16).ok()?,
        None if digits.len() > 1 && digits.starts_with('0') => return None,
        None if digits.bytes().all(|byte| byte.is_ascii_digit()) => digits.parse().ok()?,
        None => return None,
    };
    Some(range.contains(&(sign * value)))
}

/// Whether a number with a point or an exponent fits its type; `None` if the text is not a number.
fn float_fits(text: &str) -> Option<bool> {
    let (number, most) = match text.strip_suffix('f') {
        Some(number) => (number, f64::from(f32::MAX)),
        None => (text, f64::MAX),
    };
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-');
    if !number.chars().all(is_part) || !number.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let value: f64 = number.parse().ok()?;
    Some(value.is_finite() && value.abs() <= most)
}
