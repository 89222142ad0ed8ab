#version 450

int t1 = 2*9*g;

int t2 = x + x + 1;

int t3 = x + y + 1;

int t4 = h(h(2 + 1) + 1);

int t5 = f2(x2 * (f2))(z[0]);

int t6 = q ( 1 );

int t7 = q ( 1 );

int t8 = id(3);

int t9 = 4;

int t10 = <5>;

int t11 = [6] fun fun;

int t12 = 1 2;
// ---- Fragment; reads: 
