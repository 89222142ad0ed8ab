// Between the program that runs shaders and the entry points of texts. Code that is generated for
// each text fills parameters and members by their attributes, with these functions.
#pragma once

#include "metal_stdlib"

namespace __lamplight {

/// A buffer, as whatever type the parameter has.
struct any_buffer {
  const void* data;
  template <class T> operator T&() const { return *(T*)data; }
};
/// A texture, as whatever texture the parameter is.
struct any_texture {
  const texture* data;
  template <class T> operator T() const {
    T to;
    to.of = data;
    return to;
  }
};

inline any_buffer buffer(const bindings& from, int slot) { return {from.buffers[slot]}; }
inline any_texture texture_of(const bindings& from, int slot) { return {from.textures[slot]}; }
inline metal::sampler sampler_of(const bindings& from, int slot) {
  return {from.samplers[slot]};
}
inline float4 position(const given& from) {
  return float4{from.position[0], from.position[1], from.position[2], from.position[3]};
}

inline uint3 three_of(const unsigned* from) { return uint3{from[0], from[1], from[2]}; }
inline uint3 local_of(const given& from) { return three_of(from.invocation); }
inline uint3 group_of(const given& from) { return three_of(from.group); }
inline uint3 groups_of(const given& from) { return three_of(from.groups); }
inline uint3 size_of_group(const given& from) { return three_of(from.size); }
inline uint3 global_of(const given& from) {
  return group_of(from) * size_of_group(from) + local_of(from);
}

/// Fills memory of the workgroup with what no shader expects, before its first invocation runs.
template <class T> inline void spoil(const given& from, T& memory) {
  if (from.invocation[3] == 0) __builtin_memset(&memory, 0xa5, sizeof memory);
}

/// A value from the words of a location.
template <class T> inline void take(T& to, const unsigned* words) {
  if constexpr (size_of<T> == 1) {
    to = __builtin_bit_cast(T, words[0]);
  } else {
    for (int i = 0; i < size_of<T>; ++i) to[i] = __builtin_bit_cast(element_of<T>, words[i]);
  }
}
/// The words of a value.
template <class T> inline void give(const T& from, unsigned* words) {
  for (int i = 0; i < size_of<T>; ++i) words[i] = __builtin_bit_cast(unsigned, part(from, i));
}
inline void give_position(float4 from, result& to) {
  for (int i = 0; i < 4; ++i) to.position[i] = from[i];
}

}  // namespace __lamplight
