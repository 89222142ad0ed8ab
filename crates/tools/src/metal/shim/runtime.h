// What the headers ask of the program that runs shaders, lookups in textures and the other
// fragments of a quad, and what it asks of an entry point. `runtime.cpp` answers; a validator needs
// the declarations only.
#pragma once

namespace __lamplight {

struct texture;
struct sampler_state;

/// Where the level of detail of a lookup comes from.
enum class detail { automatic, biased, exact, graded };

/// One lookup with a sampler.
struct lookup {
  float at[3];
  int layer;
  int offset[3];
  detail level;
  /// The bias or the level itself.
  float lod;
  float slopes[2][3];
  bool compares;
  float reference;
  /// Component of the four texels around that is wanted; -1 where the value is filtered.
  int component;
};

/// The four words that a lookup gives.
void sample(const texture* of, const sampler_state* with, const lookup& how, unsigned* words);
/// The four words of a texel; z is the layer or the slice.
void read(const texture* of, const unsigned at[3], unsigned level, unsigned* words);
void write(const texture* of, const unsigned at[3], const unsigned* words);
unsigned width(const texture* of, unsigned level);
unsigned height(const texture* of, unsigned level);
unsigned depth(const texture* of, unsigned level);
unsigned layers(const texture* of);
unsigned levels(const texture* of);

/// Waits for the other invocations of the workgroup.
void barrier();

/// How numbers change to the neighbour in x (axis 0) or y (axis 1).
void slope(const float* values, int count, int axis, float* to);

/// The fragment gives no output.
void discard();

/// Buffers, textures, samplers, locations: as many as there may be of each.
constexpr int SLOTS = 32;

/// What is bound.
struct bindings {
  const void* buffers[SLOTS];
  const texture* textures[SLOTS];
  const sampler_state* samplers[SLOTS];
};

/// What one vertex or fragment is given: words of its locations, and built-ins.
struct given {
  /// In a compute stage: the position in the group, and the index there.
  unsigned invocation[4];
  /// The position of the group, how many groups there are, and their size.
  unsigned group[3];
  unsigned groups[3];
  unsigned size[3];
  const unsigned (*locations)[4];
  float position[4];
  unsigned front;
  unsigned vertex_index;
  unsigned instance_index;
};

/// What one vertex or fragment gives: the words of each location, and built-ins.
struct result {
  unsigned locations[SLOTS][4];
  float position[4];
  float depth;
};

/// An entry point of a text.
struct entry {
  void (*run)(const bindings&, const given&, result&);
};
extern const entry entries[];

}  // namespace __lamplight
