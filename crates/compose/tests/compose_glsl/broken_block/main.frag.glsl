#version 450
void main() {}
layout(std140) uniform U {