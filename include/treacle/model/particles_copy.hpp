#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/particles.hpp"

namespace treacle {

/// All fields and counts; they wait until the data are there. Errors: std::bad_alloc.
template <int D>
void copyToDevice(const Context<Cuda>& context, const Particles<D>& host, Particles<D, Cuda>& device) {
  device.resize(context, host.numbers());
  device.copyNumbers(host);
  const auto copy = [&]<class T>(const Buffer<T>& from, Buffer<T, Cuda>& to) {
    copyBytesToDevice(context, from.data(), to.data(), from.size() * sizeof(T));
  };
  forEachFieldOf(copy, host, device);
}
template <int D>
void copyToHost(const Context<Cuda>& context, const Particles<D, Cuda>& device, Particles<D>& host) {
  host.resize(device.numbers());
  host.copyNumbers(device);
  const auto copy = [&]<class T>(const Buffer<T, Cuda>& from, Buffer<T>& to) {
    copyBytesToHost(context, from.data(), to.data(), from.size() * sizeof(T));
  };
  forEachFieldOf(copy, device, host);
}

}  // namespace treacle
