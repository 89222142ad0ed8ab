#version 450

void a() {}

void main() { a(); }
// ---- Fragment; reads: 
