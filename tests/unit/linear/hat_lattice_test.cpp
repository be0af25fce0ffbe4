#include "treacle/linear/hat_lattice.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>
#include <utility>

namespace treacle::test {
namespace {

/// f(lattice) for all sorts of short axes, open and periodic.
template <int D, class F>
void forEachLattice(F&& f) {
  const auto axis = [](HatLattice<D>& lattice, int k, int choice) {
    lattice.count[k] = choice % 9 + 1;
    lattice.periodic[k] = choice >= 9;
  };
  for (int first = 0; first < 18; ++first)
    for (int second = 0; second < 18; ++second) {
      HatLattice<D> lattice;
      axis(lattice, 0, first);
      axis(lattice, 1, second);
      if (D == 3) axis(lattice, 2, (5 * first + 7 * second) % 18);
      SCOPED_TRACE(testing::Message() << D << "-D, axes " << first << ", " << second);
      f(lattice);
    }
}

template <int D>
void checkTransfers() {
  forEachLattice<D>([](const HatLattice<D>& fine) {
    using Weights = std::map<std::pair<std::size_t, std::size_t>, double>;
    const HatLattice<D> coarse = fine.coarser();
    Weights byFine, byCoarse;
    for (std::size_t p = 0; p < fine.points(); ++p) {
      ASSERT_EQ(fine.linear(fine.at(p)), p);
      double sum = 0;
      forEachCoarse(fine, fine.at(p), [&](const Vec<D, int>& c, double weight) {
        for (int k = 0; k < D; ++k) ASSERT_TRUE(c[k] >= 0 && c[k] < coarse.count[k]);
        byFine[{p, coarse.linear(c)}] += weight;
        sum += weight;
      });
      EXPECT_EQ(sum, 1);
    }
    for (std::size_t c = 0; c < coarse.points(); ++c)
      forEachFine(fine, coarse, coarse.at(c), [&](const Vec<D, int>& p, double weight) {
        for (int k = 0; k < D; ++k) ASSERT_TRUE(p[k] >= 0 && p[k] < fine.count[k]);
        byCoarse[{fine.linear(p), c}] += weight;
      });
    EXPECT_EQ(byFine, byCoarse);
  });
}

TEST(HatLattice, RestrictionIsTheTransposeOfInterpolation) {
  checkTransfers<2>();
  checkTransfers<3>();
}

TEST(HatLattice, CoarsePointsStandOnEverySecondPoint) {
  const HatLattice<2> fine{{9, 8}, {false, true}};
  const HatLattice<2> coarse = fine.coarser();
  EXPECT_EQ(coarse.count, (Vec<2, int>{5, 4}));
  forEachCoarse(fine, {6, 2}, [&](const Vec<2, int>& c, double weight) {
    EXPECT_EQ(c, (Vec<2, int>{3, 1}));
    EXPECT_EQ(weight, 1);
  });
  std::map<std::size_t, double> corner;
  forEachCoarse(fine, {7, 7}, [&](const Vec<2, int>& c, double weight) { corner[coarse.linear(c)] += weight; });
  const std::map<std::size_t, double> expected{{3, 0.25}, {4, 0.25}, {18, 0.25}, {19, 0.25}};
  EXPECT_EQ(corner, expected);
  EXPECT_EQ((HatLattice<2>{{9, 8}, {true, false}}.coarser().count), (Vec<2, int>{5, 5}));
  EXPECT_EQ((HatLattice<2>{{1, 2}, {true, false}}.coarser().count), (Vec<2, int>{1, 2}));
}

template <int D>
void checkNear(int reach) {
  SCOPED_TRACE(testing::Message() << "reach " << reach);
  forEachLattice<D>([reach](const HatLattice<D>& lattice) {
    for (std::size_t p = 0; p < lattice.points(); ++p) {
      const Vec<D, int> point = lattice.at(p);
      std::set<std::size_t> found, expected;
      const HatBox<D> box = HatBox<D>::around(lattice, point, reach);
      int place = 0;
      forEachNear(lattice, point, reach, [&](const Vec<D, int>& q) {
        EXPECT_TRUE(found.insert(lattice.linear(q)).second) << "twice";
        EXPECT_EQ(box.placeOf(q), place++);
      });
      for (std::size_t q = 0; q < lattice.points(); ++q) {
        bool near = true;
        for (int k = 0; k < D; ++k) {
          int d = std::abs(point[k] - lattice.at(q)[k]);
          if (lattice.periodic[k]) d = std::min(d, lattice.count[k] - d);
          near = near && d <= reach;
        }
        if (near)
          expected.insert(q);
        else
          EXPECT_EQ(box.placeOf(lattice.at(q)), -1);
      }
      ASSERT_EQ(found, expected);
    }
  });
}

TEST(HatLattice, VisitsEachPointWithinReachOnce) {
  for (int reach : {1, 2, 3}) {
    checkNear<2>(reach);
    checkNear<3>(reach);
  }
}

}  // namespace
}  // namespace treacle::test
