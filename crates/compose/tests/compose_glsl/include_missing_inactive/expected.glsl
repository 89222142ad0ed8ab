#version 450

void main() {}
// ---- Fragment; reads: fancy=false
