// package::a::b::c

const d = 1;

// package::main

const x = d;
