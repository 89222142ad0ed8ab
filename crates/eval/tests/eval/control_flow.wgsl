// expect: sign_by_if(-2) = -1
// expect: sign_by_if(0) = 0
// expect: sign_by_if(3) = 1
fn sign_by_if(x: f32) -> i32 {
    if x < 0.0 {
        return -1;
    } else if x > 0.0 {
        return 1;
    }
    return 0;
}

// expect: sum(10) = 45
// expect: sum(0) = 0
fn sum(n: i32) -> i32 {
    var total = 0;
    for (var i = 0; i < n; i++) {
        total += i;
    }
    return total;
}

// expect: odd_sum(9) = 16
fn odd_sum(n: i32) -> i32 {
    var total = 0;
    var i = 0;
    loop {
        if i >= n { break; }
        if i % 2 == 0 { continue; }
        total += i;
        continuing {
            i++;
        }
    }
    return total;
}

// expect: at_least_once(5) = 1
// expect: at_least_once(0) = 4
fn at_least_once(start: i32) -> i32 {
    var i = start;
    var trips = 0;
    loop {
        trips++;
        continuing {
            i++;
            break if i > 3;
        }
    }
    return trips;
}

// expect: choose(1) = 10
// expect: choose(2) = 20
// expect: choose(3) = 20
// expect: choose(7) = -1
fn choose(i: i32) -> i32 {
    var r = 0;
    switch i {
        case 1: { r = 10; }
        case 2, 3: { r = 20; }
        default: { r = -1; }
    }
    return r;
}

// expect: switch_in_loop(6) = 9
fn switch_in_loop(n: i32) -> i32 {
    var r = 0;
    for (var i = 0; i < n; i++) {
        switch i {
            case 0: { continue; }
            case 2: { break; }
            case 5: { r += 5; }
            default: { if i == 4 { break; } r += i; }
        }
    }
    return r;
}

// expect: nested(3, 4) = 12
fn nested(a: i32, b: i32) -> i32 {
    var n = 0;
    for (var i = 0; i < a; i++) {
        for (var j = 0; j < 100; j++) {
            if j == b { break; }
            n++;
        }
    }
    return n;
}

// expect: reset_each_trip(3) = 3
fn reset_each_trip(n: i32) -> i32 {
    var last = 0;
    var count = 0;
    for (var i = 0; i < n; i++) {
        var x: i32;
        x += 1;
        last = x;
        count += last;
    }
    return count;
}

// error: endless(1) = eval-loop-limit
// expect: endless(0) = 0
fn endless(x: f32) -> f32 {
    var y = x;
    while y > 0.0 { y = y + 1.0; }
    return y;
}

fn square(x: f32) -> f32 { return x * x; }
fn quartic(x: f32) -> f32 { return square(square(x)) + square(1.0); }

// expect: quartic(2) = 17

// expect: short_circuit(0) = false
// expect: short_circuit(2) = true
var<private> calls: i32;
fn touched(x: i32) -> bool { calls++; return x > 1; }
fn short_circuit(x: i32) -> bool { return x > 0 && touched(x); }

// expect: count_calls(0) = 0
// expect: count_calls(5) = 1
fn count_calls(x: i32) -> i32 {
    let unused = x > 0 && touched(x);
    return calls;
}

// expect: private_start() = 7 1 2
var<private> seed: i32 = 7;
var<private> pair: vec2f = vec2f(1.0, 2.0);
fn private_start() -> vec3f {
    seed += 0;
    let result = vec3f(f32(seed), pair);
    seed += 1;
    pair = vec2f(0.0);
    return result;
}
