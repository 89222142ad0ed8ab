// package::a

const even = odd + one;
const one = 1;

// package::b

const odd = one;

// package::main

const x = even;
