#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
float count = 0.0;
bool hit() { count += 1.0; return true; }
bool twice() { return hit(); }
bool near(float x) { float d = x; d *= d; return d < 1.0; }
void main() {
    bool harmless = v.x > 0.0 && near(v.y);
    bool called = harmless && twice();
    int i = 0;
    bool counted = called || i++ > 0;
    c = vec4(count, float(counted), 0.0, 1.0);
}
