#version 450
#line
#line x
void main() {}
