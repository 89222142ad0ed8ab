// constants

const constants_n = 4;

// package::main

const n = 1;
const s = n + constants_n;
