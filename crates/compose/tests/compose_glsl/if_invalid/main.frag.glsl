#version 450
#define F(x) x
#if
#endif
#if 1 +
#endif
#if 1 2
#endif
#if (1
#endif
#if 1.5 > 1
#endif
#if 5 / 0
#endif
#if 5 % (3 - 3)
#endif
#if F == 1
#endif
#if defined
#endif
#if defined(F
#endif
#if 99999999999
#endif
#if a = 3
#endif
#if 1 ? 2 : 3
#endif
#if 0
#elif
#endif
#ifdef
#endif
#ifdef A B
#endif
void main() {}
