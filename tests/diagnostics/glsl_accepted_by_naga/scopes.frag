#version 450

layout(location = 0) out vec4 lit;

struct Lamp {
    float power;
    float power;
};

void main() {
    Lamp lamp;
    lamp.power = 0.0;
    for (int i = 0; i < 3; i++) {
        float i = 1.0;
        lamp.power += i;
    }
    lit = vec4(vec3(vec4(lamp.power), 1.0), 1.0);
}
