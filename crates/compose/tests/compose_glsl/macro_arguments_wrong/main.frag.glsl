#version 450
#define F(a, b) a + b
#define G() 1
int a = F(1);
int b = F(1, 2, 3);
int c = G(1);
int d = F(1,
#if 1
    2);
#endif
void main() {}
