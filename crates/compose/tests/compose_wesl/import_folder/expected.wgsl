// package::math::consts

const pi = 3.14159;

// package::main

const x = pi;
