#version 450
float f() { return 1.0; }
float g() { return 1.0; }
void main() { f(); }
