// package::deep::down::leaf

const value = near + far + topmost;

// package::deep::down::sibling

const near = 1;

// package::deep::uncle

const far = 2;

// package::top

const topmost = 3;

// package::main

const v = value;
