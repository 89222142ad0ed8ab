#version 450
#define highp_
#define PUBLIC
#define WHEN_DEBUG(x)
PUBLIC highp_ float f(highp_ float x
#if QUALITY > 1
    , float y
#endif
) {
    WHEN_DEBUG(x = 1.0;)
    return x
#if QUALITY > 1
        + y
#endif
        ;
}
layout(location = 0) out vec4 color;
void main() {
    color = vec4(f(1.0
#if QUALITY > 1
    , 2.0
#endif
    ));
}
