diagnostic(off, derivative_uniformity);

// package::m

const a = 1;

// package::main

const foo = a;
override o1 = 10;
var<private> v1 = 10;
alias T = f32;
const_assert 0 < 1;
struct S {
    x: u32,
    @size(16) w: u32
}
fn params(foo: u32, baz: u32) {}
fn statements() -> i32 {
    let a = 1;
    if foo > 0 { let a = 2; } else if foo < 0 { } else { }
    switch foo { default { let a = 3; } }
    switch foo { case 1 { let a = 4; } default { } }
    loop { break; continuing { break if true; } }
    for (var i = 0; i < 10; i++) {}
    while foo < 0 { continue; }
    params(1u, 2u);
    const_assert 0 < 1;
    var x = 0;
    x = 1;
    x++;
    _ = x;
    return x;
}
@fragment fn frag() { _ = statements(); var t: T; var s: S; v1 += o1; }
