#version 450

int b = 1;

int a = 2;

int c = 5;

int f = 6;

void main() {}
// ---- Fragment; reads: level=2
