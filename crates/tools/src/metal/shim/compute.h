// What kernels use besides: atomics, barriers, functions over a simdgroup. They are declared for
// the validator; nothing runs them here.
#pragma once

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

template <class T> T atomic_load_explicit(const __lamplight::atomic<T>*, memory_order);
template <class T>
void atomic_store_explicit(__lamplight::atomic<T>*, __lamplight::same_as<T>, memory_order);
template <class T>
bool atomic_compare_exchange_weak_explicit(__lamplight::atomic<T>*, T*, __lamplight::same_as<T>,
                                           memory_order, memory_order);
#define __LL_ATOMIC(name)                                                                     \
  template <class T>                                                                          \
  T atomic_##name##_explicit(__lamplight::atomic<T>*, __lamplight::same_as<T>, memory_order);
__LL_ATOMIC(exchange)
__LL_ATOMIC(fetch_add)
__LL_ATOMIC(fetch_sub)
__LL_ATOMIC(fetch_and)
__LL_ATOMIC(fetch_or)
__LL_ATOMIC(fetch_xor)
__LL_ATOMIC(fetch_min)
__LL_ATOMIC(fetch_max)
#undef __LL_ATOMIC

enum class mem_flags { mem_none, mem_device, mem_threadgroup, mem_texture };
void threadgroup_barrier(mem_flags);
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
