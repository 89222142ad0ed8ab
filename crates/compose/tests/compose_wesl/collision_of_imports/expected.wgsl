// package::a

fn package_a_go() { help(); }
fn help() {}

// package::b_c::d

fn package_b__c_d_go() { help_me(); }
fn help_me() {}

// package::main

fn main() { package_a_go(); package_b__c_d_go(); }
