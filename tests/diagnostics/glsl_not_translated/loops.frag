#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
void main() {
    int i = 0;
    c = vec4(0.0);
    do {
        i++;
        if (i == 2) continue;
        for (int k = 0; k < 2; k++) { if (k == 1) continue; c.x += 1.0; }
    } while (i < 2);
}
