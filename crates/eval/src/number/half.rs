//! IEEE 754 binary16, for the packing built-ins.

/// The bits of the nearest half, ties to even. A value that is too large becomes infinity.
pub fn half_from(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let size = value.abs();
    if value.is_nan() {
        return 0x7e00;
    }
    if size >= 65520.0 {
        return sign | 0x7c00;
    }
    let exponent = (((size.to_bits() >> 52) as i32) - 1023).max(-14);
    let mantissa = (size * f64::from(10 - exponent).exp2()).round_ties_even() as u16;
    // The leading one of the mantissa's 11 bits is added to the exponent field.
    sign | ((((exponent + 14) as u16) << 10) + mantissa)
}

/// The value of a half's bits.
pub fn half_to(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let exponent = i32::from(bits >> 10 & 0x1f);
    let mantissa = f64::from(bits & 0x3ff);
    match exponent {
        0 => sign * mantissa * (-24f64).exp2(),
        31 if mantissa == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        _ => sign * (1024.0 + mantissa) * f64::from(exponent - 25).exp2(),
    }
}
