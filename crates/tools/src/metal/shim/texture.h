// Textures, samplers, derivatives.
#pragma once

#include "math.h"
#include "runtime.h"

// The runtime knows where a fragment waits for its neighbours by the address of the call. Each use in
// a shader has an address of its own only if these functions are inlined.
#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)

namespace metal {

enum class access { sample, read, write, read_write };
enum class component { x, y, z, w };

struct sampler {
  const __lamplight::sampler_state* state;
};

struct bias {
  float value;
  explicit bias(float value) : value(value) {}
};
struct level {
  float value;
  explicit level(float value) : value(value) {}
};
#define __LL_GRADIENT(name, V)                \
  struct name {                               \
    V x, y;                                   \
    name(V x, V y) : x(x), y(y) {}            \
  };
__LL_GRADIENT(gradient2d, float2)
__LL_GRADIENT(gradient3d, float3)
__LL_GRADIENT(gradientcube, float3)
#undef __LL_GRADIENT

}  // namespace metal

namespace __lamplight {

/// Textures that take no offset.
struct nothing {};

template <class V> inline void set(float to[3], V from) {
  for (int i = 0; i < size_of<V>; ++i) to[i] = part(from, i);
}
inline void move(lookup&, nothing) {}
inline void move(lookup& to, int2 by) { to.offset[0] = by.x, to.offset[1] = by.y; }
inline void move(lookup& to, int3 by) {
  to.offset[0] = by.x, to.offset[1] = by.y, to.offset[2] = by.z;
}

template <class V, class Offset> inline lookup look(V at, unsigned layer, Offset offset) {
  lookup to = {};
  set(to.at, at);
  to.layer = int(layer);
  to.component = -1;
  move(to, offset);
  return to;
}

inline lookup with(lookup to, metal::bias bias) {
  to.level = detail::biased, to.lod = bias.value;
  return to;
}
inline lookup with(lookup to, metal::level level) {
  to.level = detail::exact, to.lod = level.value;
  return to;
}
template <class Gradient> inline lookup with(lookup to, Gradient gradient) {
  to.level = detail::graded;
  set(to.slopes[0], gradient.x);
  set(to.slopes[1], gradient.y);
  return to;
}
inline lookup compared(lookup to, float reference) {
  to.compares = true, to.reference = reference;
  return to;
}
inline lookup gathered(lookup to, metal::component component) {
  to.component = int(component);
  return to;
}

template <class T> struct four_of;
template <> struct four_of<float> { using type = float4; };
template <> struct four_of<int> { using type = int4; };
template <> struct four_of<unsigned int> { using type = uint4; };
template <class T> using four = typename four_of<T>::type;

template <class T, metal::access Access> struct image {
  const texture* of;

  unsigned get_width(unsigned level = 0) const { return width(of, level); }
  unsigned get_num_mip_levels() const { return levels(of); }

 protected:
  four<T> sampled(metal::sampler with, const lookup& how) const {
    static_assert(Access == metal::access::sample, "this texture is not for sampling");
    unsigned words[4];
    __lamplight::sample(of, with.state, how, words);
    return from(words);
  }
  four<T> loaded(unsigned x, unsigned y, unsigned z, unsigned level) const {
    static_assert(Access != metal::access::write, "this texture is not for reading");
    const unsigned at[3] = {x, y, z};
    unsigned words[4];
    __lamplight::read(of, at, level, words);
    return from(words);
  }
  void stored(four<T> value, unsigned x, unsigned y, unsigned z) const {
    static_assert(Access == metal::access::write || Access == metal::access::read_write,
                  "this texture is not for writing");
    const unsigned at[3] = {x, y, z};
    unsigned words[4];
    for (int i = 0; i < 4; ++i) words[i] = __builtin_bit_cast(unsigned, value[i]);
    __lamplight::write(of, at, words);
  }

 private:
  static four<T> from(const unsigned* words) {
    four<T> to = {};
    for (int i = 0; i < 4; ++i) to[i] = __builtin_bit_cast(element_of<four<T>>, words[i]);
    return to;
  }
};

}  // namespace __lamplight

namespace metal {

// Members of textures. R is what a lookup gives, `part` how it is made of four components, O the
// type of the offset, G that of the gradient; the rest are the parameters that say where: `at`,
// and `layer` where there are layers.
#define __LL_SAMPLE(R, part, O, G, layer, ...)                                            \
  R sample(sampler s, __VA_ARGS__, O offset = {}) const {                                 \
    return part(this->sampled(s, __lamplight::look(at, layer, offset)));                  \
  }                                                                                       \
  R sample(sampler s, __VA_ARGS__, metal::bias option, O offset = {}) const {             \
    using namespace __lamplight;                                                          \
    return part(this->sampled(s, with(look(at, layer, offset), option)));                 \
  }                                                                                       \
  R sample(sampler s, __VA_ARGS__, metal::level option, O offset = {}) const {            \
    using namespace __lamplight;                                                          \
    return part(this->sampled(s, with(look(at, layer, offset), option)));                 \
  }                                                                                       \
  R sample(sampler s, __VA_ARGS__, G option, O offset = {}) const {                       \
    using namespace __lamplight;                                                          \
    return part(this->sampled(s, with(look(at, layer, offset), option)));                 \
  }
#define __LL_COMPARE(O, layer, ...)                                                        \
  float sample_compare(sampler s, __VA_ARGS__, float reference, O offset = {}) const {     \
    using namespace __lamplight;                                                           \
    return this->sampled(s, compared(look(at, layer, offset), reference)).x;               \
  }                                                                                        \
  float sample_compare(sampler s, __VA_ARGS__, float reference, metal::level option,       \
                       O offset = {}) const {                                              \
    using namespace __lamplight;                                                           \
    return this->sampled(s, with(compared(look(at, layer, offset), reference), option)).x; \
  }                                                                                        \
  float4 gather_compare(sampler s, __VA_ARGS__, float reference, O offset = {}) const {    \
    using namespace __lamplight;                                                           \
    return this->sampled(s, gathered(compared(look(at, layer, offset), reference),         \
                                     component::x));                                       \
  }
#define __LL_GATHER(layer, ...)                                                          \
  __lamplight::four<T> gather(sampler s, __VA_ARGS__, int2 offset = {},                  \
                              component c = component::x) const {                        \
    using namespace __lamplight;                                                         \
    return this->sampled(s, gathered(look(at, layer, offset), c));                       \
  }
#define __LL_GATHER_CUBE(layer, ...)                                                     \
  __lamplight::four<T> gather(sampler s, __VA_ARGS__, component c = component::x) const { \
    using namespace __lamplight;                                                         \
    return this->sampled(s, gathered(look(at, layer, nothing()), c));                    \
  }
#define __LL_HEIGHT \
  unsigned get_height(unsigned level = 0) const { return __lamplight::height(this->of, level); }
#define __LL_DEPTH \
  unsigned get_depth(unsigned level = 0) const { return __lamplight::depth(this->of, level); }
#define __LL_LAYERS \
  unsigned get_array_size() const { return __lamplight::layers(this->of); }
#define __LL_READ2(R, part)                                                 \
  R read(uint2 at, unsigned level = 0) const {                              \
    return part(this->loaded(at.x, at.y, 0, level));                        \
  }
#define __LL_READ2_LAYER(R, part)                                           \
  R read(uint2 at, unsigned layer, unsigned level = 0) const {              \
    return part(this->loaded(at.x, at.y, layer, level));                    \
  }
#define __LL_SAMPLES(R, part)                                                       \
  R read(uint2 at, unsigned) const { return part(this->loaded(at.x, at.y, 0, 0)); } \
  unsigned get_num_samples() const { return 1; }

#define __LL_TEXTURE(name, ...)                                                        \
  template <class T, access Access = access::sample>                                   \
  struct name : __lamplight::image<T, Access> {                                        \
    using four = __lamplight::four<T>;                                                 \
    __VA_ARGS__                                                                        \
  };
#define __LL_DEPTH_TEXTURE(name, ...)                                                  \
  template <class T, access Access = access::sample>                                   \
  struct name : __lamplight::image<T, Access> {                                        \
    static_assert(__lamplight::same<T, float>, "depths are of type `float`");          \
    static T first(float4 v) { return v.x; }                                           \
    __VA_ARGS__                                                                        \
  };

__LL_TEXTURE(texture1d,
  four sample(sampler s, float at) const {
    return this->sampled(s, __lamplight::look(at, 0, __lamplight::nothing()));
  }
  four read(unsigned at, unsigned = 0) const { return this->loaded(at, 0, 0, 0); }
  void write(four v, unsigned at) const { this->stored(v, at, 0, 0); })
__LL_TEXTURE(texture1d_array,
  four sample(sampler s, float at, unsigned layer) const {
    return this->sampled(s, __lamplight::look(at, layer, __lamplight::nothing()));
  }
  four read(unsigned at, unsigned layer, unsigned = 0) const {
    return this->loaded(at, 0, layer, 0);
  }
  void write(four v, unsigned at, unsigned layer) const { this->stored(v, at, 0, layer); }
  __LL_LAYERS)
__LL_TEXTURE(texture2d,
  __LL_SAMPLE(four, , int2, gradient2d, 0, float2 at)
  __LL_GATHER(0, float2 at)
  __LL_READ2(four, )
  void write(four v, uint2 at) const { this->stored(v, at.x, at.y, 0); }
  __LL_HEIGHT)
__LL_TEXTURE(texture2d_array,
  __LL_SAMPLE(four, , int2, gradient2d, layer, float2 at, unsigned layer)
  __LL_GATHER(layer, float2 at, unsigned layer)
  __LL_READ2_LAYER(four, )
  void write(four v, uint2 at, unsigned layer) const { this->stored(v, at.x, at.y, layer); }
  __LL_HEIGHT __LL_LAYERS)
__LL_TEXTURE(texture3d,
  __LL_SAMPLE(four, , int3, gradient3d, 0, float3 at)
  four read(uint3 at, unsigned level = 0) const {
    return this->loaded(at.x, at.y, at.z, level);
  }
  void write(four v, uint3 at) const { this->stored(v, at.x, at.y, at.z); }
  __LL_HEIGHT __LL_DEPTH)
__LL_TEXTURE(texturecube,
  __LL_SAMPLE(four, , __lamplight::nothing, gradientcube, 0, float3 at)
  __LL_GATHER_CUBE(0, float3 at)
  __LL_READ2_LAYER(four, )
  __LL_HEIGHT)
__LL_TEXTURE(texturecube_array,
  __LL_SAMPLE(four, , __lamplight::nothing, gradientcube, layer, float3 at, unsigned layer)
  __LL_GATHER_CUBE(layer, float3 at, unsigned layer)
  __LL_HEIGHT __LL_LAYERS)
__LL_TEXTURE(texture2d_ms, __LL_SAMPLES(four, ) __LL_HEIGHT)
__LL_DEPTH_TEXTURE(depth2d,
  __LL_SAMPLE(T, first, int2, gradient2d, 0, float2 at)
  __LL_COMPARE(int2, 0, float2 at)
  __LL_GATHER(0, float2 at)
  __LL_READ2(T, first)
  __LL_HEIGHT)
__LL_DEPTH_TEXTURE(depth2d_array,
  __LL_SAMPLE(T, first, int2, gradient2d, layer, float2 at, unsigned layer)
  __LL_COMPARE(int2, layer, float2 at, unsigned layer)
  __LL_GATHER(layer, float2 at, unsigned layer)
  __LL_READ2_LAYER(T, first)
  __LL_HEIGHT __LL_LAYERS)
__LL_DEPTH_TEXTURE(depthcube,
  __LL_SAMPLE(T, first, __lamplight::nothing, gradientcube, 0, float3 at)
  __LL_COMPARE(__lamplight::nothing, 0, float3 at)
  __LL_GATHER_CUBE(0, float3 at)
  __LL_READ2_LAYER(T, first)
  __LL_HEIGHT)
__LL_DEPTH_TEXTURE(depthcube_array,
  __LL_SAMPLE(T, first, __lamplight::nothing, gradientcube, layer, float3 at, unsigned layer)
  __LL_COMPARE(__lamplight::nothing, layer, float3 at, unsigned layer)
  __LL_GATHER_CUBE(layer, float3 at, unsigned layer)
  __LL_HEIGHT __LL_LAYERS)
__LL_DEPTH_TEXTURE(depth2d_ms, __LL_SAMPLES(T, first) __LL_HEIGHT)

// How values change from a fragment to the next.
#define __LL_SLOPES(V)                                                         \
  inline V dfdx(V v) {                                                         \
    float of[4] = {}, to[4] = {};                                              \
    for (int i = 0; i < __lamplight::size_of<V>; ++i) of[i] = v[i];            \
    __lamplight::slope(of, __lamplight::size_of<V>, 0, to);                    \
    for (int i = 0; i < __lamplight::size_of<V>; ++i) v[i] = to[i];            \
    return v;                                                                  \
  }                                                                            \
  inline V dfdy(V v) {                                                         \
    float of[4] = {}, to[4] = {};                                              \
    for (int i = 0; i < __lamplight::size_of<V>; ++i) of[i] = v[i];            \
    __lamplight::slope(of, __lamplight::size_of<V>, 1, to);                    \
    for (int i = 0; i < __lamplight::size_of<V>; ++i) v[i] = to[i];            \
    return v;                                                                  \
  }                                                                            \
  inline V fwidth(V v) { return abs(dfdx(v)) + abs(dfdy(v)); }
__LL_SLOPES(float2)
__LL_SLOPES(float3)
__LL_SLOPES(float4)
inline float dfdx(float v) {
  float to;
  __lamplight::slope(&v, 1, 0, &to);
  return to;
}
inline float dfdy(float v) {
  float to;
  __lamplight::slope(&v, 1, 1, &to);
  return to;
}
inline float fwidth(float v) { return abs(dfdx(v)) + abs(dfdy(v)); }

inline void discard_fragment() { __lamplight::discard(); }

}  // namespace metal

#pragma clang attribute pop
