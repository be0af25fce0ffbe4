#pragma once

#include "support/equal_blocks.hpp"
#include "treacle/model/particles/particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace treacle::test {

/// All fields, bit by bit, and how old the modes are.
template <int D>
void expectSameBits(const Particles<D>& a, const Particles<D>& b) {
  forEachFieldOf(
      [](const auto& x, const auto& y) {
        ASSERT_EQ(x.size(), y.size());
        const auto p = std::as_bytes(x.span()), q = std::as_bytes(y.span());
        EXPECT_TRUE(std::equal(p.begin(), p.end(), q.begin()));
      },
      a, b);
  EXPECT_EQ(a.modes.age, b.modes.age);
}

}  // namespace treacle::test
