#version 450

void main() {
    ivec3 b = ivec3(8, 8, 7);
    int c = 9;
}
// ---- Fragment; reads: 
