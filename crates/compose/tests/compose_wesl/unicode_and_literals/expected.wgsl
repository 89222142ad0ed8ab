// package::größe

const Δ = 1.0;

// package::main

const a = 0x1.8p+3f + 1e-5f + .5 + 1. + 0x1P2 + 1.5e+3 + Δ;
const b = 0xFFu + 12u;
/* nested /* comment */ still */
const c = 1>0;
