#version 450
#if LEVEL == 0
int a = 0;
#elif LEVEL == 1
int a = 1;
#elif LEVEL == 2
  #ifdef NOPE
int b = 0;
  #elif !defined NOPE && defined(LEVEL)
int b = 1;
  #else
int b = 2;
  #endif
int a = 2;
#elif 1 / 0
int a = 3;
#else
int a = 4;
#endif
#ifndef NOPE
int c = 5;
#endif
#if 0
#bogus
#error never
#if 1
int d;
#else
int e;
#endif
#else
int f = 6;
#endif
void main() {}
