#version 300

void main() {}
