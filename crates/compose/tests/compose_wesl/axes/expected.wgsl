const a = 1;
const b = 2;
const c = 3;
const e = 5;
const f = 6;
const h = 8;
