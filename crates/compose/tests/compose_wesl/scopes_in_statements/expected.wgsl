// package::n

const package_n_i = 1;
const package_n_j = 2;
const package_n_k = 3;
fn package_n_sum() -> i32 { return 0; }

// package::main

fn main() -> i32 {
    var total = package_n_i;
    for (var i = 0; i < 4; i++) { total += i; let j = i; total += j; }
    total += package_n_i + package_n_j;
    loop { let k = total; if k > 3 { break; } continuing { total += k; break if total > k; } }
    total += package_n_k;
    switch total { case 1 { let sum = 2; total = sum; } default { total = package_n_sum(); } }
    while total < package_n_i { let i = package_n_j; total += i; }
    { let i = 1; { let j = i; total += j; } total += package_n_j; }
    total += package_n_i;
    var sum = package_n_sum();
    return sum + total;
}
