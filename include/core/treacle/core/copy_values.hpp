#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"

#include <algorithm>
#include <span>

namespace treacle {

/// Copies and zeros within a backend's memory.
template <class T>
void copyValues(Context<Cpu>&, std::span<const T> from, T* to) {
  std::copy(from.begin(), from.end(), to);
}
template <class T>
void copyValues(Context<Cuda>& context, std::span<const T> from, T* to) {
  if (!from.empty()) copyBytesOnDevice(context, from.data(), to, from.size_bytes());
}
template <class T>
void clearValues(Context<Cpu>&, std::span<T> values) {
  std::fill(values.begin(), values.end(), T{});
}
template <class T>
void clearValues(Context<Cuda>& context, std::span<T> values) {
  if (!values.empty()) clearBytes(context, values.data(), values.size_bytes());
}
/// From the host's memory, and to it.
template <class T>
void copyFromHost(const Context<Cpu>&, std::span<const T> host, T* to) {
  std::copy(host.begin(), host.end(), to);
}
template <class T>
void copyFromHost(const Context<Cuda>& context, std::span<const T> host, T* to) {
  if (!host.empty()) copyBytesToDevice(context, host.data(), to, host.size_bytes());
}
template <class T>
void copyToHost(const Context<Cpu>&, std::span<const T> from, T* host) {
  std::copy(from.begin(), from.end(), host);
}
template <class T>
void copyToHost(const Context<Cuda>& context, std::span<const T> from, T* host) {
  if (!from.empty()) copyBytesToHost(context, from.data(), host, from.size_bytes());
}
template <class T>
T valueOnHost(const Context<Cpu>&, const T* value) {
  return *value;
}
/// All that is there, to a buffer that gets its size. Errors: std::bad_alloc.
template <class T, class Backend>
void fromHost(const Context<Backend>& context, std::span<const T> host, Buffer<T, Backend>& to) {
  to.resize(context, host.size());
  copyFromHost(context, host, to.data());
}

}  // namespace treacle
