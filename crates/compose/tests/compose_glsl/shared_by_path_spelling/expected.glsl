#version 450

void x() {}

void main() { x(); }
// ---- Fragment; reads: 
