#version 450 core
#pragma optimize(on)
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : enable

void a() {}

precision highp float;

void main() { a(); }
// ---- Fragment; reads: 
