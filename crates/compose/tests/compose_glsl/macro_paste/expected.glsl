#version 450

int found = 1;

int lightN = 2;

int found = 3;

int e = 4;

int e = 5;

int f = 6;

int a += 1.5;

int x1y;

int v_N_end + 3;
// ---- Fragment; reads: 
