#version 450
#define f(a) a*g
#define g(a) f(a)
int t1 = f(2)(9);
#define x x + y
#define y x + 1
int t2 = x; int t3 = y;
#define h(a) h(a + 1)
int t4 = h(h(2));
#define z z[0]
#define w(a) f2(x2 * (a))
#define f2(a) f2(x2 * (a))
int t5 = f2(f2)(z);
#define lparen (
#define q(a) <a>
#define call(m) m lparen 1 )
int t6 = q lparen 1 );
int t7 = call(q);
#define id(a) a
int t8 = id(id)(3);
int t9 = id(id(id(4)));
int t10 = id(q)(5);
#define obj fun
#define fun(a) [a]
int t11 = obj(6) obj fun;
#define two(a, b) a b
int t12 = two(,) two(1,) two(,2);
