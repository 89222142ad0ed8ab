#version 450
#define CAT(a, b) a##b
#define BAD1 ## x
#define BAD2 x ##
#define STRING(x) #x
int CAT(+, *);
void main() {}
