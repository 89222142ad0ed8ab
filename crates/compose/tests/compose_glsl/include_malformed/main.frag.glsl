#version 450
#include
#include foo
#include "open
#include ""
#include "a.glsl" extra
void main() {}
