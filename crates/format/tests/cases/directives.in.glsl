/* A comment
   over lines. */
float f(float x) {
#ifdef FAST
    if (x > 0.0) {
#else
    if (x > 1.0) {
#endif
        x *= 2.0;
    }
    #ifdef SLOW
  x = g(x,
#if A
  1.0,
#endif
      2.0) ;
    #endif
  return x; // the value
}
#define TWICE(x) \
    ((x) +   \
     (x))
TWICE(float)
float   y = TWICE( 2.0 ) ;
