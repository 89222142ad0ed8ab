#version 450

}

float f( { return 1.0; }
void main() { f();
// ---- Fragment; reads: 
