const c1 = 1;
const c3 = 3;
const c4 = 4;
const c5 = 5;
const c6 = 6;
