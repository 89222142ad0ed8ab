#version 450

float helper(float x) { return x * float(4); }

/// The wanted one.
float wanted(float x) { return helper(x); }

void main() {}
// ---- Fragment; reads: max_lights=4
