#version 450
#define HERE __LINE__, /*
    */ __LINE__
#define TWO(a) HERE, a
void main() {
    ivec3 b = ivec3(TWO(
        __LINE__
    ));
    int c = __LINE__;
}
