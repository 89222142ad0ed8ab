#version 450
layout(location = 0) flat in int kind;
layout(location = 1) in vec4 tint;
layout(location = 0) out vec4 color;
layout(location = 1) out uint mark;
int calls = 0;
vec3 start = tint.rgb * 2.0;
bool called(bool value) { calls++; return value; }
float falls(int x) {
    float r = 0.0;
    switch (x) {
    case 0:
        r += 1.0;
    case 1:
        r += 10.0;
        break;
    case 2:
        return 3.0;
    default:
        float extra = 5.0;
        r += extra;
    }
    return r;
}
void main() {
    float w[2][3];
    int i = 0;
    w[1][i++] = falls(kind);
    while (i < 5 && called(kind > 2)) i += 2;
    do { if (i == 6) continue; i++; } while (i < 8);
    float fn = kind > 0 ? falls(i) : 2.0;
    vec4 v = tint;
    v.zx = v.xy = vec2(fn, w[1][0]);
    color = v + vec4(start, 1.0 / 0.0);
    mark = uint(calls);
}
