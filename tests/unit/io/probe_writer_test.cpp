#include "treacle/io/tables/probe_writer.hpp"

#include "limited_files.hpp"
#include "support/temporary_directory.hpp"

using namespace treacle;
using namespace treacle::test;

namespace {

/// The row of a region that holds so much of one particle [m2], of 1000 kg/m3 and at a place.
std::string rowOf(const Probe& region, double volume, const Vec<3>& place) {
  TemporaryDirectory directory;
  Case c;
  c.dimensions = 2, c.spacing = 1;
  PartSums sums;
  sums.volume = volume, sums.mass = 1000 * volume, sums.moment = sums.mass * place;
  sums.pressure = 2 * volume;
  ProbeWriter(directory / "probe.csv", c, region).append(0.5, region, sums);
  const std::string text = content(directory / "probe.csv");
  return text.substr(text.find('\n') + 1);
}

}  // namespace

TEST(ProbeWriter, ACentreIsInItsRegion) {
  Probe region;
  region.kind = ProbeKind::Region;
  region.box.emplace();
  region.box->max = {4, 4, 0};
  EXPECT_EQ(rowOf(region, 0.25, {4.25, 2, 0}), "0.5,0.25,250,4,2,0,0,2,0\n");
  EXPECT_EQ(rowOf(region, 0.25, {3.5, 2, 0}), "0.5,0.25,250,3.5,2,0,0,2,0\n");
  region.box.reset();
  region.normal = {0, 2, 0}, region.point = {0, 3, 0};
  EXPECT_EQ(rowOf(region, 0.25, {8, 3.25, 0}), "0.5,0.25,250,8,3,0,0,2,0\n");
  EXPECT_EQ(rowOf(region, 0.25, {8, 1.25, 0}), "0.5,0.25,250,8,1.25,0,0,2,0\n");
}

TEST(ProbeWriter, TheRoundingOfASurfaceIsNoFluid) {
  Probe region;
  region.kind = ProbeKind::Region;
  EXPECT_EQ(rowOf(region, 0x1p-50, {1, 2, 0}),
            "0.5,8.881784197001252e-16,8.881784197001252e-13,nan,nan,nan,nan,nan,nan\n");
}
