fn a() { c(); }
fn c() {}
fn d() {}
