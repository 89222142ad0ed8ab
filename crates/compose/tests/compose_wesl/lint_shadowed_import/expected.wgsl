const a = 2;
const x = a;
