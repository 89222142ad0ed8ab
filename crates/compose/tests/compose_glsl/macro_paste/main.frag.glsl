#version 450
#define CAT(a, b) a##b
#define XCAT(a, b) CAT(a, b)
#define N 3
#define light3 found
int CAT(light, 3) = 1;
int CAT(light, N) = 2;
int XCAT(light, N) = 3;
int CAT(, e) = 4; int CAT(e,) = 5; int CAT(,) f = 6;
int a CAT(+, =) CAT(1, .5);
#define CHAIN(a, b, c) a ## b ## c
int CHAIN(x, 1, y);
#define HASH_NAME(n) v_ ## n ## _end + n
int HASH_NAME(N);
