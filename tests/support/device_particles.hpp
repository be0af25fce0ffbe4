#pragma once

#include "support/equal_blocks.hpp"
#include "treacle/model/particles/particles_copy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace treacle::test {

template <int D>
Particles<D, Cuda> onDevice(const Context<Cuda>& context, const Particles<D>& particles) {
  Particles<D, Cuda> copy;
  copyToDevice(context, particles, copy);
  return copy;
}

/// Fails unless device memory holds the same bits.
template <class T>
void expectSameBits(const Context<Cuda>& context, const Buffer<T>& host, const Buffer<T, Cuda>& device) {
  const Buffer<T> copy = copyToHost(context, device);
  ASSERT_EQ(copy.size(), host.size());
  const std::span expected = std::as_bytes(host.span()), found = std::as_bytes(copy.span());
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), found.begin()));
}

}  // namespace treacle::test
