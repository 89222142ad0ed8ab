#version 450
#if MAX_LIGHTS > 10
#error at most 10 lights, it's said (see "limits")
#endif
#error
void main() {}
