#pragma once

#include "support/isph_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {

/// That fluid which comes and goes does so with the same bits after its state was copied half-way.
template <int D>
void checkContinuedJet(Case c) {
  c.gravity[1] = -2;
  Simulation<D> whole(c, created<D>(c));
  for (int k = 0; k < 45; ++k) whole.advance();
  Simulation<D> rest(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 45; ++k) {
    const StepReport a = whole.advance(), b = rest.advance();
    ASSERT_EQ(a.flow->in, b.flow->in);
    ASSERT_EQ(a.iterations, b.iterations);
  }
  EXPECT_GT(whole.particles().flow.out().particles, 0u);
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(rest)));
  EXPECT_EQ(whole.particles().flow, rest.particles().flow);
}

}  // namespace treacle::test
