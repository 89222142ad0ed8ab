#version 450
// What naga's GLSL front end reads almost rightly. The expected values follow from GLSL's rules:
// `out` and `inout` are copied in and out.

void add_one(inout float x) {
    x += 1.0;
}

void set_two(out float x) {
    x = 2.0;
}

void both(inout float a, inout float b) {
    a += 1.0;
    b = a * 10.0;
}

struct Lamp {
    vec3 colour;
    float power;
};

// expect: component(3) = 3, 21, 2
vec3 component(float x) {
    vec3 v = vec3(x, 20.0, 0.0);
    add_one(v.y);
    set_two(v.z);
    return v;
}

// expect: element(0) = 3, 2, 3
// expect: element(2) = 1, 2, 5
vec3 element(int i) {
    float w[3] = float[3](1.0, 2.0, 3.0);
    add_one(w[i]);
    add_one(w[i]);
    return vec3(w[0], w[1], w[2]);
}

// expect: member(4) = 1, 2, 1, 5
vec4 member(float x) {
    Lamp lamp = Lamp(vec3(1.0), x);
    add_one(lamp.power);
    add_one(lamp.colour.g);
    return vec4(lamp.colour, lamp.power);
}

// expect: column(7) = 0, 7, 1
vec3 column(float x) {
    mat3 m = mat3(x);
    add_one(m[1][2]);
    return m[1];
}

// expect: parts_of_one(1, 2) = 2, 20
vec2 parts_of_one(float x, float y) {
    vec2 v = vec2(x, y);
    both(v.x, v.y);
    return v;
}

// expect: returned(0) = 1
// expect: returned(1) = 2
// expect: returned(7) = 3
float returned(int i) {
    switch (i) {
        case 0: return 1.0;
        case 1: return 2.0;
        default: return 3.0;
    }
}

// expect: braced(0) = 1
// expect: braced(1) = 12
// expect: braced(2) = 12
// expect: braced(3) = 4
float braced(int i) {
    float x = 0.0;
    switch (i) {
        case 0: { x = 1.0; break; }
        case 1:
        case 2: { if (i > 0) { x = 12.0; break; } else { break; } }
        default: { x = 4.0; }
    }
    return x;
}

// expect: falls(0) = 11
// expect: falls(1) = 10
// expect: falls(2) = 100
float falls(int i) {
    float x = 0.0;
    switch (i) {
        case 0: x += 1.0;
        case 1: { x += 10.0; break; }
        default: x = 100.0;
    }
    return x;
}

void main() {}
