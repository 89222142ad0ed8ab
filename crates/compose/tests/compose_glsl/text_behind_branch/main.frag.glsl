#version 450

#if 1
float a = 1.0;
#else behind
float a = 2.0;
#endif 3.0 // not a comment alone

void main() {}
