#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
void main() {
    switch (ivec2(v.xy)) {
        case 0: c = vec4(1.0); break;
        default: c = vec4(0.0);
    }
}
