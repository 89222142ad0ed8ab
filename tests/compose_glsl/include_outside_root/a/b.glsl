#include "../../secret.glsl"
