// Words computed by hand from the definitions of the WGSL specification.

// expect: to_unorm8(0, 0.5, 1, 2) = 0xffff8000
// expect: to_unorm8(0.1, 0.2, 0.3, -0.4) = 0x004d331a
fn to_unorm8(v: vec4f) -> u32 { return pack4x8unorm(v); }
// expect: to_snorm8(0, 0.5, 1, -2) = 0x817f4000
fn to_snorm8(v: vec4f) -> u32 { return pack4x8snorm(v); }
// expect: to_unorm16(0, 1) = 0xffff0000
// expect: to_unorm16(0.5, 0.25) = 0x40008000
fn to_unorm16(v: vec2f) -> u32 { return pack2x16unorm(v); }
// expect: to_snorm16(1, -1) = 0x80017fff
fn to_snorm16(v: vec2f) -> u32 { return pack2x16snorm(v); }
// expect: to_half(1, -2) = 0xc0003c00
// expect: to_half(65504, 0.333251953125) = 0x35557bff
// expect: to_half(0.000000059604645, 0.00006103515625) = 0x04000001
fn to_half(v: vec2f) -> u32 { return pack2x16float(v); }
// expect: from_half(0xc0003c00) = 1 -2
// expect: from_half(0x04000001) = 0.000000059604645 0.00006103515625
fn from_half(w: u32) -> vec2f { return unpack2x16float(w); }
// expect: from_unorm8(0xff003380) = 0.50196078431 0.2 0 1
fn from_unorm8(w: u32) -> vec4f { return unpack4x8unorm(w); }
// expect: from_snorm8(0x80817f40) = 0.503937007874 1 -1 -1
fn from_snorm8(w: u32) -> vec4f { return unpack4x8snorm(w); }
// expect: from_snorm16(0x80017fff) = 1 -1
fn from_snorm16(w: u32) -> vec2f { return unpack2x16snorm(w); }
// expect: from_unorm16(0x0000ffff) = 1 0
fn from_unorm16(w: u32) -> vec2f { return unpack2x16unorm(w); }
// expect: extract(0xff00ff00, 8, 8) = 255 -1
// expect: extract(0xff00ff00, 4, 8) = 240 -16
// expect: extract(0xff00ff00, 24, 30) = 255 -1
// expect: extract(0xff00ff00, 40, 8) = 0 0
fn extract(w: u32, offset: u32, count: u32) -> vec2i {
    return vec2i(i32(extractBits(w, offset, count)), extractBits(i32(w), offset, count));
}
// expect: insert(0, 255, 4, 8) = 0xff0
// expect: insert(0xffffffff, 0, 28, 8) = 0x0fffffff
fn insert(w: u32, piece: u32, offset: u32, count: u32) -> u32 { return insertBits(w, piece, offset, count); }
// expect: byte_dots(0x01020304, 0xff020304) = 28 284
fn byte_dots(a: u32, b: u32) -> vec2i { return vec2i(dot4I8Packed(a, b), i32(dot4U8Packed(a, b))); }
// expect: bytes(1, -1, 300, -300) = 0x2cffff01 0x7fff01
fn bytes(a: i32, b: i32, c: i32, d: i32) -> vec2u {
    return vec2u(pack4xI8(vec4i(a, b, b, c)), pack4xI8Clamp(vec4i(a, b, c, 0)));
}
// expect: from_bytes(0xff01807f) = 127 -128 1 -1
fn from_bytes(w: u32) -> vec4i { return unpack4xI8(w); }
