#include "treacle/core/work_in_hand.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

TEST(WorkInHand, isTheOneThatBeganLastAndHasNotEnded) {
  EXPECT_FALSE(WorkInHand::look());
  WorkInHand outer("filling", 4);
  outer.add(1);
  {
    const WorkInHand inner("reading");
    EXPECT_EQ(WorkInHand::look()->what, "reading");
    EXPECT_FALSE(WorkInHand::look()->done);
  }
  EXPECT_EQ(WorkInHand::look()->what, "filling");
  outer.add(2);
  EXPECT_EQ(WorkInHand::look()->done, 0.75);
}

}  // namespace
}  // namespace treacle::test
