#version 450
#include "a.glsl" // for a
#  include /* why */ <a.glsl> /* not */
void main() { a(); }
