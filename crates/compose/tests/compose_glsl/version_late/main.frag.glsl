#define A
#version 450
void main() {}
