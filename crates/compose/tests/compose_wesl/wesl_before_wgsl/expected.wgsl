// package::a

const x = 1;

// package::b

const y = 3;

// package::main

const z = x + y;
