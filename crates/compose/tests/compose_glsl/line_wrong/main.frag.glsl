#version 450
#line
#line x
void main() {}
#line 1 2 3
