// package::a

const one = 1;
const two = 2;

// package::b::c

const three = 3;

// package::four

const four = 4;

// package::main

const sum = one + two + three + four;
