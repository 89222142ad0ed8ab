#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;

void add_one(inout float x) {
    x += 1.0;
}

void both(inout float a, inout float b) {
    a += 1.0;
    b = a * 10.0;
}

float chosen(int i) {
    switch (i) {
        case 0: return 1.0;
        case 1: { return 2.0; }
        default: return 3.0;
    }
}

void main() {
    float w[2] = float[2](v.x, v.y);
    vec3 k = v.xyz;
    mat3 m = mat3(1.0);
    add_one(k.y);
    add_one(w[int(v.x)]);
    add_one(m[1][2]);
    both(k.x, k.x);
    switch (int(v.y)) {
        case 0: { k.x += 1.0; break; }
        case 1: { k.y += 1.0; break; }
        default: { k.z += 1.0; }
    }
    c = vec4(k, w[0] + m[1][2] + chosen(int(v.z)));
}
