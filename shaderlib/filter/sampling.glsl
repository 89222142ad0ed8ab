//! How modules take textures: one spelling for separate textures and samplers (Vulkan) and for combined ones (GL, ES).
//!
//! A function declares the pair with `LAMPLIGHT_DEPTH_MAP(map, smp)`, passes it on with `LAMPLIGHT_DEPTH_ARG(map, smp)`
//! and reads it through `LAMPLIGHT_DEPTH_SAMPLER(map, smp)`. Define `LAMPLIGHT_COMBINED_SAMPLERS` before the first
//! include for combined samplers: `smp` then disappears everywhere. A caller written for one of the two needs none of this.

#ifndef LAMPLIGHT_FILTER_SAMPLING_GLSL
#define LAMPLIGHT_FILTER_SAMPLING_GLSL

#ifdef LAMPLIGHT_COMBINED_SAMPLERS

#ifdef GL_ES
// Shadow samplers have no default precision in ES, and depths need more than medium.
precision highp sampler2D;
precision highp sampler2DShadow;
precision highp samplerCubeShadow;
#endif

#define LAMPLIGHT_COLOR_MAP(map, smp) sampler2D map
#define LAMPLIGHT_COLOR_ARG(map, smp) map
#define LAMPLIGHT_COLOR_SAMPLER(map, smp) map
#define LAMPLIGHT_DEPTH_MAP(map, smp) sampler2DShadow map
#define LAMPLIGHT_DEPTH_ARG(map, smp) map
#define LAMPLIGHT_DEPTH_SAMPLER(map, smp) map
#define LAMPLIGHT_DEPTH_CUBE(map, smp) samplerCubeShadow map
#define LAMPLIGHT_CUBE_SAMPLER(map, smp) map

#else

#define LAMPLIGHT_COLOR_MAP(map, smp) texture2D map, sampler smp
#define LAMPLIGHT_COLOR_ARG(map, smp) map, smp
#define LAMPLIGHT_COLOR_SAMPLER(map, smp) sampler2D(map, smp)
#define LAMPLIGHT_DEPTH_MAP(map, smp) texture2D map, samplerShadow smp
#define LAMPLIGHT_DEPTH_ARG(map, smp) map, smp
#define LAMPLIGHT_DEPTH_SAMPLER(map, smp) sampler2DShadow(map, smp)
#define LAMPLIGHT_DEPTH_CUBE(map, smp) textureCube map, samplerShadow smp
#define LAMPLIGHT_CUBE_SAMPLER(map, smp) samplerCubeShadow(map, smp)

#endif

#endif
