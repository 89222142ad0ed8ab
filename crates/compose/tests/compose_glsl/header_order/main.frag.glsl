#version 450 core
#pragma optimize(on)
#include "a.glsl"
#extension GL_EXT_control_flow_attributes : enable
#extension GL_GOOGLE_include_directive : enable
#extension GL_EXT_control_flow_attributes : enable
precision highp float;
void main() { a(); }
