// The program that runs shaders: it answers requests on standard input until there are no more.
//
// Words of 32 bits, in the order of the machine. A request is the number of its words, then
//   entry, stage (0 vertex, 1 fragment, 2 compute), words of locations each way,
//   buffers:  n, then slot, bytes, and the bytes, filled up to whole words
//   textures: n, then slot, shape, format, levels; of each level width, height, layers and texels,
//             four words each
//   samplers: n, then slot, address of u, v, w, filters mag, min, mip, levels from and to, compare
//   vertices: n, then index, instance, words of locations
//   quads:    n, then for each of four fragments position, whether it is of a front face, words of
//             locations
//   compute:  size of a workgroup and number of them, each in x, y and z
// and the answer, for each vertex or fragment: position (of a vertex), or depth, whether it was
// discarded, 0, 0; then the words of its locations. That of a compute stage has the bytes of all
// buffers, each filled up to whole words. `compiled/mod.rs` is the other end.
//
// Textures are read as `crates/eval/src/machine/texture.rs` reads them; change both or none.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <ucontext.h>
#include <unistd.h>

#include "runtime.h"

namespace __lamplight {

/// Longest time for a request, in seconds: a hundred times what the largest takes.
constexpr unsigned PATIENCE = 60;
constexpr size_t STACK = 1 << 20;

typedef unsigned word;

// ---- quads: four fragments in step --------------------------------------------------------

/// A fragment of the quad. It runs by itself until it asks how something changes to its
/// neighbours, and waits there for them.
struct lane {
  ucontext_t context;
  given in;
  result out;
  bool running;
  bool discarded;
  /// Where it waits: the place in the code, and how deep the calls are.
  const void* place;
  long depth;
  const float* values;
  int count;
  double slopes[2][4];
};

static lane lanes[4];
static int current = -1;
static ucontext_t scheduler;
static const entry* running;
static bindings bound;

static void live() {
  for (;;) {
    lane& self = lanes[current];
    running->run(bound, self.in, self.out);
    self.running = false;
    swapcontext(&self.context, &scheduler);
  }
}

static void start() {
  for (lane& lane : lanes) {
    getcontext(&lane.context);
    lane.context.uc_stack.ss_sp = malloc(STACK);
    lane.context.uc_stack.ss_size = STACK;
    makecontext(&lane.context, live, 0);
  }
}

/// Waits for the neighbours; then `slopes` of the lane are known.
static lane* wait(const void* place, const float* values, int count) {
  if (current < 0) return nullptr;
  lane& self = lanes[current];
  self.place = place;
  self.depth = (char*)__builtin_frame_address(0) - (char*)self.context.uc_stack.ss_sp;
  self.values = values;
  self.count = count;
  swapcontext(&self.context, &scheduler);
  return &self;
}

static bool together(const lane& a, const lane& b) {
  return a.running && a.place == b.place && a.depth == b.depth;
}

/// Those that are furthest behind go on; the others may wait where they arrive.
static lane* furthest_behind() {
  lane* first = nullptr;
  for (lane& lane : lanes) {
    if (lane.running && (!first || lane.place < first->place)) first = &lane;
  }
  return first;
}

static void exchange(const bool in_group[4]) {
  for (int index = 0; index < 4; ++index) {
    if (!in_group[index]) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const int low = axis == 0 ? index & 2 : index & 1;
      const int high = axis == 0 ? index | 1 : index | 2;
      const bool known = in_group[low] && in_group[high];
      for (int i = 0; i < lanes[index].count; ++i) {
        lanes[index].slopes[axis][i] =
            known ? double(lanes[high].values[i]) - double(lanes[low].values[i]) : 0.0;
      }
    }
  }
}

static void run_quad() {
  bool go_on[4] = {true, true, true, true};
  for (lane& lane : lanes) lane.running = true, lane.discarded = false;
  for (;;) {
    for (current = 0; current < 4; ++current) {
      if (go_on[current]) swapcontext(&scheduler, &lanes[current].context);
    }
    current = -1;
    const lane* first = furthest_behind();
    if (!first) return;
    for (int index = 0; index < 4; ++index) go_on[index] = together(lanes[index], *first);
    exchange(go_on);
  }
}

void discard() {
  if (current >= 0) lanes[current].discarded = true;
}

__attribute__((noinline)) void slope(const float* values, int count, int axis, float* to) {
  const lane* self = wait(__builtin_return_address(0), values, count);
  for (int i = 0; i < count; ++i) to[i] = self ? float(self->slopes[axis][i]) : 0.0f;
}

// ---- workgroups: invocations that take turns at barriers -----------------------------------

/// An invocation of a workgroup. It runs by itself until a barrier, and waits there for the others.
struct invocation {
  ucontext_t context;
  given in;
  bool running;
};

/// As many as the largest workgroup so far had. They stay where they are.
static invocation* invocations[1024];
static int invocation_count = 0;
static int current_invocation = -1;

static void work() {
  for (;;) {
    invocation& self = *invocations[current_invocation];
    result unused = {};
    running->run(bound, self.in, unused);
    self.running = false;
    swapcontext(&self.context, &scheduler);
  }
}

static void employ(int count) {
  for (; invocation_count < count; ++invocation_count) {
    invocation* made = (invocation*)calloc(1, sizeof(invocation));
    getcontext(&made->context);
    made->context.uc_stack.ss_sp = malloc(STACK);
    made->context.uc_stack.ss_size = STACK;
    makecontext(&made->context, work, 0);
    invocations[invocation_count] = made;
  }
}

void barrier() {
  if (current_invocation < 0) return;
  swapcontext(&invocations[current_invocation]->context, &scheduler);
}

/// Runs all invocations until the next barrier, or until they end. Gives how many still run.
static int run_to_barrier(int count) {
  int left = 0;
  for (current_invocation = 0; current_invocation < count; ++current_invocation) {
    invocation& self = *invocations[current_invocation];
    if (!self.running) continue;
    swapcontext(&scheduler, &self.context);
    left += self.running;
  }
  current_invocation = -1;
  return left;
}

static bool run_workgroup(const given& first, int count) {
  for (int index = 0; index < count; ++index) {
    invocation& self = *invocations[index];
    const unsigned x = first.size[0], y = first.size[1];
    self.in = first;
    self.in.invocation[0] = unsigned(index) % x;
    self.in.invocation[1] = unsigned(index) / x % y;
    self.in.invocation[2] = unsigned(index) / x / y;
    self.in.invocation[3] = unsigned(index);
    self.running = true;
  }
  for (;;) {
    const int left = run_to_barrier(count);
    if (left == 0) return true;
    if (left != count) return false;
  }
}

// ---- textures -----------------------------------------------------------------------------

enum { CLAMP, REPEAT, MIRROR };
enum { NEAREST, LINEAR };
enum { ONE = 1, TWO = 2, THREE = 3, CUBE = 6 };
enum { FLOATS, SIGNED, UNSIGNED };

struct image_level {
  unsigned width, height, layers;
  const word* texels;
};
struct texture {
  unsigned shape, format, count;
  image_level* levels;
};
struct sampler_state {
  unsigned address[3];
  unsigned mag, min, mip;
  float from, to;
  unsigned compare;
};

/// Texels as numbers, and their components.
struct color {
  double of[4];
};

static const unsigned* texel_words(const image_level& level, long x, long y, long z) {
  const bool inside = x >= 0 && y >= 0 && z >= 0 && x < long(level.width) &&
                      y < long(level.height) && z < long(level.layers);
  return inside ? level.texels + 4 * ((z * level.height + y) * level.width + x) : nullptr;
}

static color number_of(const texture& of, const word* words) {
  color to = {};
  for (int i = 0; words && i < 4; ++i) {
    float value;
    memcpy(&value, &words[i], 4);
    // Each of them as a number: chosen from by `?:`, an `int` would become unsigned first.
    const double numbers[] = {double(value), double(int(words[i])), double(words[i])};
    to.of[i] = numbers[of.format];
  }
  return to;
}

static void words_of(const texture& of, const color& from, word* words) {
  for (int i = 0; i < 4; ++i) {
    const float value = float(from.of[i]);
    if (of.format == FLOATS) {
      memcpy(&words[i], &value, 4);
    } else {
      words[i] = of.format == SIGNED ? word(int(from.of[i])) : word(from.of[i]);
    }
  }
}

/// A place in a texture: coordinates in [0, 1] on a face.
struct spot {
  double at[3];
  int face;
};

/// Major axis and its sign, and axes and signs of s and t of each face: +x, -x, +y, -y, +z, -z.
struct side {
  int major;
  double sign;
  int s;
  double s_sign;
  int t;
  double t_sign;
};
static const side SIDES[6] = {
    {0, 1, 2, -1, 1, -1}, {0, -1, 2, 1, 1, -1}, {1, 1, 0, 1, 2, 1},
    {1, -1, 0, 1, 2, -1}, {2, 1, 0, 1, 1, -1},  {2, -1, 0, -1, 1, -1},
};

static spot project(const texture& of, const double at[3]) {
  if (of.shape != CUBE) return {{at[0], at[1], at[2]}, 0};
  const double x = fabs(at[0]), y = fabs(at[1]), z = fabs(at[2]);
  const int major = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  const int face = 2 * major + (at[major] < 0.0);
  const side& side = SIDES[face];
  const double size = fabs(at[major]);
  return {{0.5 * (side.s_sign * at[side.s] / size + 1.0),
           0.5 * (side.t_sign * at[side.t] / size + 1.0), 0.0},
          face};
}

/// How a place on a face moves when the direction moves.
static void slope_on_face(int face, const double at[3], const double step[3], double to[3]) {
  const side& side = SIDES[face];
  const double size = fabs(at[side.major]);
  const int axes[2] = {side.s, side.t};
  const double signs[2] = {side.s_sign, side.t_sign};
  for (int i = 0; i < 2; ++i) {
    const double moved =
        step[axes[i]] * size - at[axes[i]] * step[side.major] * side.sign;
    to[i] = 0.5 * signs[i] * moved / (size * size);
  }
  to[2] = 0.0;
}

static long at_least(long a, long b) { return a > b ? a : b; }
static long at_most(long a, long b) { return a < b ? a : b; }

static long wrapped(unsigned address, long at, long size) {
  if (address == REPEAT) return ((at % size) + size) % size;
  if (address == MIRROR) {
    const long folded = ((at % (2 * size)) + 2 * size) % (2 * size);
    return at_most(folded, 2 * size - 1 - folded);
  }
  return at_most(at_least(at, 0), size - 1);
}

/// One lookup within one level.
struct footprint {
  const texture& of;
  const sampler_state& with;
  const lookup& how;
  const image_level& level;
  spot place;

  /// Size in a filtered direction; 0 where there is none.
  double size(int axis) const {
    if (axis == 0) return level.width;
    if (axis == 1) return of.shape == ONE ? 0 : level.height;
    return of.shape == THREE ? level.layers : 0;
  }

  color texel(const long at[3]) const {
    const long x = at[0] + how.offset[0], y = at[1] + how.offset[1], z = at[2] + how.offset[2];
    if (of.shape == CUBE) return around(x, y);
    const long layer = at_most(at_least(how.layer, 0), long(level.layers) - 1);
    const word* words = texel_words(
        level, wrapped(with.address[0], x, level.width), wrapped(with.address[1], y, level.height),
        of.shape == THREE ? wrapped(with.address[2], z, level.layers) : layer);
    return number_of(of, words);
  }

  /// A texel of a cube; beyond the edge of its face it lies on the neighbouring one.
  color around(long x, long y) const {
    const double side = level.width;
    const struct side& here = SIDES[place.face];
    double direction[3] = {};
    direction[here.major] = here.sign;
    direction[here.s] = here.s_sign * (2.0 * (double(x) + 0.5) / side - 1.0);
    direction[here.t] = here.t_sign * (2.0 * (double(y) + 0.5) / side - 1.0);
    const spot found = project(of, direction);
    long at[2];
    for (int i = 0; i < 2; ++i) {
      at[i] = at_most(at_least(long(floor(found.at[i] * side)), 0), long(level.width) - 1);
    }
    const long cube = at_most(at_least(how.layer, 0), long(level.layers) / 6 - 1);
    return number_of(of, texel_words(level, at[0], at[1], 6 * cube + found.face));
  }

  color compared(const color& texel) const {
    if (!how.compares || with.compare == 0) return texel;
    const double reference = how.reference, depth = texel.of[0];
    const bool results[] = {false,
                            false,
                            reference < depth,
                            reference <= depth,
                            reference > depth,
                            reference >= depth,
                            reference == depth,
                            reference != depth,
                            true};
    const double passes = results[with.compare] ? 1.0 : 0.0;
    return {{passes, passes, passes, passes}};
  }

  void add(color& sum, const long at[3], double weight) const {
    const color found = compared(texel(at));
    for (int i = 0; i < 4; ++i) sum.of[i] += weight * found.of[i];
  }

  /// Beyond the corner of a cube there is no texel: its weight goes to the three that meet there.
  void tap(color& sum, const long at[3], double weight) const {
    const long inside[2] = {at_most(at_least(at[0], 0), long(level.width) - 1),
                            at_most(at_least(at[1], 0), long(level.width) - 1)};
    if (of.shape != CUBE || inside[0] == at[0] || inside[1] == at[1]) return add(sum, at, weight);
    const long corners[3][3] = {
        {inside[0], inside[1], 0}, {at[0], inside[1], 0}, {inside[0], at[1], 0}};
    for (const auto& corner : corners) add(sum, corner, weight / 3.0);
  }

  void base(long to[3], double shares[3]) const {
    for (int i = 0; i < 3; ++i) {
      const double placed = place.at[i] * size(i) - 0.5;
      to[i] = size(i) == 0.0 ? 0 : long(floor(placed));
      shares[i] = size(i) == 0.0 ? 0.0 : placed - double(to[i]);
    }
  }

  color linear() const {
    long first[3];
    double shares[3];
    base(first, shares);
    color sum = {};
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      long at[3];
      for (int i = 0; i < 3; ++i) {
        const int bit = corner >> i & 1;
        weight *= bit ? shares[i] : 1.0 - shares[i];
        at[i] = first[i] + bit;
      }
      if (weight != 0.0) tap(sum, at, weight);
    }
    return sum;
  }

  color nearest() const {
    long at[3];
    for (int i = 0; i < 3; ++i) at[i] = long(floor(place.at[i] * size(i)));
    return compared(texel(at));
  }

  /// One component of the texels (0, 1), (1, 1), (1, 0), (0, 0).
  color gathered() const {
    static const int ORDER[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    long first[3];
    double shares[3];
    base(first, shares);
    color to = {};
    for (int i = 0; i < 4; ++i) {
      const long at[3] = {first[0] + ORDER[i][0], first[1] + ORDER[i][1], first[2]};
      to.of[i] = compared(texel(at)).of[how.component];
    }
    return to;
  }
};

/// Level of detail: log2 of the longer step over texels.
static double detail_of(const texture& of, const double at[3], const double slopes[2][3]) {
  const image_level& first = of.levels[0];
  const double size[3] = {double(first.width), double(first.height),
                          of.shape == THREE ? double(first.layers) : 0.0};
  const int face = project(of, at).face;
  double longest = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    double moved[3] = {slopes[axis][0], slopes[axis][1], slopes[axis][2]};
    if (of.shape == CUBE) slope_on_face(face, at, slopes[axis], moved);
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += moved[i] * size[i] * moved[i] * size[i];
    longest = fmax(longest, sqrt(sum));
  }
  return log2(longest);
}

static color between_levels(const texture& of, const sampler_state& with, const lookup& how,
                            const spot& place, double level) {
  const double last = of.count - 1, low = with.from, high = fmax(with.to, with.from);
  level = level != level ? 0.0 : fmin(fmax(level, low), high);
  const unsigned filter = level <= 0.0 ? with.mag : with.min;
  level = fmin(fmax(level, 0.0), last);
  auto at = [&](double level) {
    const footprint found = {of, with, how, of.levels[unsigned(level)], place};
    return filter == LINEAR ? found.linear() : found.nearest();
  };
  const double share = level - floor(level);
  if (with.mip == NEAREST || share == 0.0) return at(fmin(floor(level + 0.5), last));
  const color fine = at(floor(level)), coarse = at(floor(level) + 1.0);
  color to;
  for (int i = 0; i < 4; ++i) to.of[i] = fine.of[i] * (1.0 - share) + coarse.of[i] * share;
  return to;
}

/// Whether the neighbours decide on the level that is looked at, or on the filter.
static bool asks_neighbours(const texture& of, const sampler_state& with, const lookup& how) {
  const bool by_itself = how.level == detail::exact || how.level == detail::graded;
  return how.component < 0 && !by_itself && (of.count > 1 || with.mag != with.min);
}

__attribute__((noinline)) void sample(const texture* of, const sampler_state* with,
                                      const lookup& how, unsigned* words) {
  const double at[3] = {how.at[0], how.at[1], how.at[2]};
  const spot place = project(*of, at);
  if (how.component >= 0) {
    const footprint found = {*of, *with, how, of->levels[0], place};
    return words_of(*of, found.gathered(), words);
  }
  double slopes[2][3] = {};
  if (asks_neighbours(*of, *with, how)) {
    const lane* self = wait(__builtin_return_address(0), how.at, 3);
    for (int i = 0; self && i < 6; ++i) slopes[i / 3][i % 3] = self->slopes[i / 3][i % 3];
  } else {
    for (int i = 0; i < 6; ++i) slopes[i / 3][i % 3] = how.slopes[i / 3][i % 3];
  }
  double level = how.lod;
  if (how.level != detail::exact) level = detail_of(*of, at, slopes) + how.lod;
  words_of(*of, between_levels(*of, *with, how, place, level), words);
}

void read(const texture* of, const unsigned at[3], unsigned level, unsigned* words) {
  const word* found =
      level < of->count ? texel_words(of->levels[level], at[0], at[1], at[2]) : nullptr;
  for (int i = 0; i < 4; ++i) words[i] = found ? found[i] : 0;
}

void write(const texture*, const unsigned*, const unsigned*) {
  fputs("textures are not written to here\n", stderr);
  exit(1);
}

static const image_level& level_of(const texture* of, unsigned level) {
  return of->levels[level < of->count ? level : of->count - 1];
}
unsigned width(const texture* of, unsigned level) { return level_of(of, level).width; }
unsigned height(const texture* of, unsigned level) { return level_of(of, level).height; }
unsigned depth(const texture* of, unsigned level) { return level_of(of, level).layers; }
unsigned layers(const texture* of) {
  return of->levels[0].layers / (of->shape == CUBE ? 6 : 1);
}
unsigned levels(const texture* of) { return of->count; }

// ---- requests -----------------------------------------------------------------------------

[[noreturn]] static void fail(const char* reason) {
  fprintf(stderr, "%s\n", reason);
  exit(1);
}

/// The words of a request, taken from the front.
struct reader {
  const word* at;
  const word* end;

  const word* some(size_t count) {
    if (size_t(end - at) < count) fail("the request ends too early");
    const word* here = at;
    at += count;
    return here;
  }
  word one() { return *some(1); }
  float number() {
    float value;
    memcpy(&value, some(1), 4);
    return value;
  }
  unsigned slot() {
    const word slot = one();
    if (slot >= SLOTS) fail("a slot is too large");
    return slot;
  }
};

static texture textures[SLOTS];
static sampler_state samplers[SLOTS];

static void read_buffers(reader& from, unsigned sizes[SLOTS]) {
  for (word left = from.one(); left > 0; --left) {
    const unsigned slot = from.slot();
    const word bytes = from.one();
    // Structures may be aligned to 16 bytes.
    void* data = aligned_alloc(16, (size_t(bytes) + 31) / 16 * 16);
    memcpy(data, from.some((size_t(bytes) + 3) / 4), bytes);
    bound.buffers[slot] = data;
    sizes[slot] = bytes;
  }
}

static void read_textures(reader& from) {
  for (word left = from.one(); left > 0; --left) {
    const unsigned slot = from.slot();
    texture& to = textures[slot];
    to.shape = from.one(), to.format = from.one(), to.count = from.one();
    if (to.count == 0 || to.format > UNSIGNED) fail("a texture is not well formed");
    to.levels = (image_level*)calloc(to.count, sizeof(image_level));
    for (unsigned i = 0; i < to.count; ++i) {
      image_level& level = to.levels[i];
      level.width = from.one(), level.height = from.one(), level.layers = from.one();
      level.texels = from.some(size_t(4) * level.width * level.height * level.layers);
    }
    bound.textures[slot] = &to;
  }
}

static void read_samplers(reader& from) {
  for (word left = from.one(); left > 0; --left) {
    const unsigned slot = from.slot();
    sampler_state& to = samplers[slot];
    for (unsigned& address : to.address) address = from.one();
    to.mag = from.one(), to.min = from.one(), to.mip = from.one();
    to.from = from.number(), to.to = from.number();
    to.compare = from.one();
    if (to.compare > 8) fail("there is no such comparison");
    bound.samplers[slot] = &to;
  }
}

static void forget() {
  for (int slot = 0; slot < SLOTS; ++slot) {
    free((void*)bound.buffers[slot]);
    if (bound.textures[slot]) free(textures[slot].levels);
  }
  bound = {};
}

static void answer(const void* words, size_t count) {
  if (fwrite(words, 4, count, stdout) != count) exit(1);
}

static void run_vertices(reader& from, size_t in, size_t out) {
  for (word left = from.one(); left > 0; --left) {
    given given = {};
    given.vertex_index = from.one(), given.instance_index = from.one();
    given.locations = (const word(*)[4])from.some(4 * in);
    result result = {};
    running->run(bound, given, result);
    answer(result.position, 4);
    answer(result.locations, 4 * out);
  }
}

static void run_quads(reader& from, size_t in, size_t out) {
  for (word left = from.one(); left > 0; --left) {
    for (lane& lane : lanes) {
      lane.out = {};
      for (float& component : lane.in.position) component = from.number();
      lane.in.front = from.one();
      lane.in.locations = (const word(*)[4])from.some(4 * in);
    }
    run_quad();
    for (const lane& lane : lanes) {
      word head[4] = {0, lane.discarded, 0, 0};
      memcpy(head, &lane.out.depth, 4);
      answer(head, 4);
      answer(lane.out.locations, 4 * out);
    }
  }
}

static void run_grid(reader& from, const unsigned bytes[SLOTS]) {
  given first = {};
  for (unsigned& size : first.size) size = from.one();
  for (unsigned& count : first.groups) count = from.one();
  const size_t count = size_t(first.size[0]) * first.size[1] * first.size[2];
  if (count == 0 || count > 1024) fail("a workgroup has no such size");
  employ(int(count));
  unsigned* at = first.group;
  for (at[2] = 0; at[2] < first.groups[2]; ++at[2]) {
    for (at[1] = 0; at[1] < first.groups[1]; ++at[1]) {
      for (at[0] = 0; at[0] < first.groups[0]; ++at[0]) {
        if (!run_workgroup(first, int(count))) fail("not all invocations reach a barrier");
      }
    }
  }
  for (int slot = 0; slot < SLOTS; ++slot) {
    if (bound.buffers[slot]) answer(bound.buffers[slot], (size_t(bytes[slot]) + 3) / 4);
  }
}

static void serve(reader from) {
  running = &entries[from.one()];
  const word stage = from.one(), in = from.one(), out = from.one();
  if (out > SLOTS) fail("there are too many locations");
  unsigned bytes[SLOTS] = {};
  read_buffers(from, bytes);
  read_textures(from);
  read_samplers(from);
  if (stage == 0) {
    run_vertices(from, in, out);
  } else if (stage == 2) {
    run_grid(from, bytes);
  } else {
    run_quads(from, in, out);
  }
  fflush(stdout);
  forget();
}

}  // namespace __lamplight

int main() {
  __lamplight::start();
  unsigned count;
  while (fread(&count, 4, 1, stdin) == 1) {
    unsigned* words = (unsigned*)malloc(size_t(4) * count);
    if (!words || fread(words, 4, count, stdin) != count) return 1;
    alarm(__lamplight::PATIENCE);
    __lamplight::serve({words, words + count});
    alarm(0);
    free(words);
  }
  return 0;
}
