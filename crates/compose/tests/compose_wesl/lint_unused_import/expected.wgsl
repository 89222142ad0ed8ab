// package::m

const a = 1;

// package::main

const x = a;
