#version 450

float g() { return 1.0; }

float f() { return 1.0; }

void main() {}
// ---- Fragment; reads: 
