#version 450

float f( float x
    , float y
) {
    return x
        + y
        ;
}

layout(location = 0) out vec4 color;

void main() {
    color = vec4(f(1.0
    , 2.0
    ));
}
// ---- Fragment; reads: quality=2
