// What kernels use besides: atomics, barriers, functions over a simdgroup. The invocations of a
// workgroup take turns at barriers only, so that atomic functions are plain ones. Functions over a
// simdgroup are declared for the validator; nothing runs them here.
#pragma once

#include "runtime.h"
#include "types.h"

namespace __lamplight {

template <class T> struct atomic {
  T value;
};
template <class T> struct itself {
  using type = T;
};
template <class T> using same_as = typename itself<T>::type;

}  // namespace __lamplight

namespace metal {

typedef __lamplight::atomic<int> atomic_int;
typedef __lamplight::atomic<unsigned int> atomic_uint;
typedef __lamplight::atomic<float> atomic_float;

enum memory_order { memory_order_relaxed };

template <class T> T atomic_load_explicit(const __lamplight::atomic<T>* at, memory_order) {
  return at->value;
}
template <class T>
void atomic_store_explicit(__lamplight::atomic<T>* at, __lamplight::same_as<T> value,
                           memory_order) {
  at->value = value;
}
template <class T>
bool atomic_compare_exchange_weak_explicit(__lamplight::atomic<T>* at, T* wanted,
                                           __lamplight::same_as<T> value, memory_order,
                                           memory_order) {
  const bool is_it = at->value == *wanted;
  *wanted = at->value;
  if (is_it) at->value = value;
  return is_it;
}
#define __LL_ATOMIC(name, changed)                                                            \
  template <class T>                                                                          \
  T atomic_##name##_explicit(__lamplight::atomic<T>* at, __lamplight::same_as<T> value,       \
                             memory_order) {                                                  \
    const T old = at->value;                                                                  \
    at->value = changed;                                                                      \
    return old;                                                                               \
  }
__LL_ATOMIC(exchange, value)
__LL_ATOMIC(fetch_add, old + value)
__LL_ATOMIC(fetch_sub, old - value)
__LL_ATOMIC(fetch_and, old & value)
__LL_ATOMIC(fetch_or, old | value)
__LL_ATOMIC(fetch_xor, old ^ value)
__LL_ATOMIC(fetch_min, value < old ? value : old)
__LL_ATOMIC(fetch_max, value > old ? value : old)
#undef __LL_ATOMIC

enum class mem_flags { mem_none, mem_device, mem_threadgroup, mem_texture };
inline void threadgroup_barrier(mem_flags) { __lamplight::barrier(); }
void simdgroup_barrier(mem_flags);

struct simd_vote {
  explicit operator uint64_t() const;
};
simd_vote simd_ballot(bool);
bool simd_all(bool);
bool simd_any(bool);
#define __LL_SIMD(name) template <class T> T simd_##name(T);
__LL_SIMD(sum)
__LL_SIMD(product)
__LL_SIMD(max)
__LL_SIMD(min)
__LL_SIMD(and)
__LL_SIMD(or)
__LL_SIMD(xor)
__LL_SIMD(prefix_exclusive_sum)
__LL_SIMD(prefix_exclusive_product)
__LL_SIMD(prefix_inclusive_sum)
__LL_SIMD(prefix_inclusive_product)
__LL_SIMD(broadcast_first)
#undef __LL_SIMD
template <class T> T simd_broadcast(T, ushort);
template <class T> T simd_shuffle(T, ushort);
template <class T> T simd_shuffle_down(T, ushort);
template <class T> T simd_shuffle_up(T, ushort);
template <class T> T simd_shuffle_xor(T, ushort);
template <class T> T quad_broadcast(T, ushort);
template <class T> T quad_shuffle_xor(T, ushort);

}  // namespace metal
