#version 330 core
// Words that later versions keep for themselves.
in vec2 uv;
smooth in float patch;
out vec4 colour;
uniform sampler2D buffer;
struct Patch {
    vec3 sample;
    float precise;
};
vec3 restrict = vec3(0.5);

float shade(vec3 sample, in float precise) {
    return dot(sample, vec3(precise));
}

void main() {
    vec3 sample[9];
    for (int coherent = 0; coherent < 9; coherent++) {
        sample[coherent] = texture(buffer, uv + float(coherent) * 0.01).rgb;
    }
    Patch readonly = Patch(sample[2], patch);
    sample[1] *= 2.0;
    float subroutine = shade(sample[1], readonly.precise);
    subroutine++;
    colour = vec4(readonly.sample * restrict, subroutine);
}
