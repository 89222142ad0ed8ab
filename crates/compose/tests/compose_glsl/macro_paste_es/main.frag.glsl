#version 300 es
#define CAT(a, b) a##b
int CAT(a, b);
void main() {}
