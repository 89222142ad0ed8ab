#version 450

float a() { return 1.0; }

float f() { return a(); }

float g() { return 1.0; }
// ---- Fragment; reads: 
