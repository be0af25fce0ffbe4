#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <gtest/gtest.h>

namespace treacle {
namespace {

/// The viscosities of paste that yields below a nozzle change from step to step. A smoother that is scaled by the
/// largest eigenvalue of some steps before breaks down in it, three times in these steps.
TEST(PrintedLayers, AreSolvedInTheFirstStage) {
  const Case c = readCase(std::string(TREACLE_CASES) + "/printed-layers-2d.toml", {});
  std::vector<std::string> notes;
  AnySimulation simulation(c, createParticles(c, notes));
  int fallbacks = 0;
  for (int k = 0; k < 25; ++k) fallbacks += simulation.advance().fallbacks;
  EXPECT_EQ(fallbacks, 0);
}

}  // namespace
}  // namespace treacle
