#version 450

// Grüße, 世界
void main() { float ä = 1.0; @ $ ' " \ ` }
// ---- Fragment; reads: 
