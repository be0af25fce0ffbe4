#include "mpi/compare_simulations.hpp"
#include "support/gpu.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

// The same as on the CPU, where each process has a device, or processes share one.

namespace treacle::test {
namespace {

/// Each process computes on the device that has its number, or shares one.
class SharedOnDevices : public testing::Test {
 protected:
  void SetUp() override {
    TREACLE_SKIP_WITHOUT_GPU();
    useOwnDevice();
  }
};

TEST_F(SharedOnDevices, BlockJacobi) {
  compare<2, Cuda>({"dam-break-2d.toml", 4, {"solver.preconditioner=block-jacobi", "solver.tolerance=1e-18"}});
}

TEST_F(SharedOnDevices, DoublePrecision) {
  const std::vector<std::string> keys = {"solver.precision=double", "solver.deflation=0",
                                         "solver.tolerance=1e-16"};
  compare<2, Cuda>({"dam-break-2d.toml", 20, keys});
  compare<2, Cuda>({"published/dam-break-2d.toml", 20, keys});
}

TEST_F(SharedOnDevices, ThinSheets) {
  compare<2, Cuda>({"thin-cup-2d.toml", 10, {"solver.tolerance=1e-22", "solver.deflation=0", "time.step=2e-3"}});
}

TEST_F(SharedOnDevices, ProjectedMultigrid) {
  compare<2, Cuda>({"dam-break-2d.toml", 20, {"solver.tolerance=1e-16"}});
  compare<2, Cuda>({"published/dam-break-2d.toml", 20, {"solver.tolerance=1e-16"}});
  compare<2, Cuda>({"dam-break-2d.toml", 10, {"resolution=2", "output.balance=true", "solver.tolerance=1e-16"}});
}

TEST_F(SharedOnDevices, ThreeDimensions) {
  compare<3, Cuda>({"dam-break-3d.toml", 5, {"solver.tolerance=1e-16"}});
  compare<3, Cuda>({"published/dam-break-3d.toml", 5, {"solver.tolerance=1e-16"}});
}

TEST_F(SharedOnDevices, BucketMultigrid) {
  const std::string buckets = "solver.preconditioner=bucket-multigrid", exact = "solver.tolerance=1e-18";
  compare<2, Cuda>({"published/dam-break-2d.toml", 5, {buckets, exact, "resolution=2"}});
  compare<3, Cuda>({"dam-break-3d.toml", 3, {buckets, exact}});
  compare<2, Cuda>({"../tests/validation/cases/couette.toml", 5, {buckets, exact}});
}

TEST_F(SharedOnDevices, CellMultigrid) {
  const std::string cells = "solver.preconditioner=cell-multigrid", exact = "solver.tolerance=1e-18";
  compare<2, Cuda>({"isph-dam-break-2d.toml", 10, {cells, exact}});
  compare<3, Cuda>({"isph-dam-break.toml", 3, {cells, exact, "width.factor=4"}});  // packed as in one process
}

/// Grids whose nodes the processes divide: in two dimensions the two finest.
TEST_F(SharedOnDevices, DividedGrids) {
  if (job().size() == 1) return;  // there is nothing to divide
  const std::string divided = "solver.divided_nodes=0", exact = "solver.tolerance=1e-16",
                    plain = "solver.deflation=0";
  compare<2, Cuda>({"dam-break-2d.toml", 3, {"resolution=12", divided, exact, plain}});
  compare<2, Cuda>({"dam-break-2d.toml", 3, {"resolution=8", divided, exact, plain, "solver.precision=double"}});
  compare<3, Cuda>({"dam-break-3d.toml", 3, {"resolution=2", divided, exact, plain}});
  compare<2, Cuda>({"../tests/validation/cases/couette.toml", 5, {"resolution=8", divided, exact, plain}});
  compare<3, Cuda>({"isph-dam-break.toml", 3, {divided, exact, "solver.precision=double"}});
}

/// Fluid that goes around periodic ends, and a plate that moves; walls that turn.
TEST_F(SharedOnDevices, MovingWalls) {
  const std::vector<std::string> keys = {"solver.tolerance=1e-20", "solver.deflation=0"};
  compare<2, Cuda>({"../tests/validation/cases/couette.toml", 20, keys});
  compare<2, Cuda>({"../tests/validation/cases/taylor-couette.toml", 10, keys});
}

TEST_F(SharedOnDevices, Isph) {
  compare<2, Cuda>({"isph-dam-break-2d.toml", 20, {"solver.tolerance=1e-16"}});
  compare<2, Cuda>({"isph-dam-break-2d.toml", 10, {"solver.precision=double", "solver.tolerance=1e-16"}});
  compare<2, Cuda>({"isph-dam-break-2d.toml", 3, {"solver.preconditioner=jacobi", "solver.tolerance=1e-18"}});
  compare<3, Cuda>({"isph-dam-break.toml", 4, {"resolution=0.4", "solver.tolerance=1e-16"}});
  compare<2, Cuda>({"isph-sloshing.toml", 10, {"solver.tolerance=1e-16"}});
}

/// Enough particles for four processes to pack the matrix, as one does.
TEST_F(SharedOnDevices, IsphPacked) {
  compare<3, Cuda>({"isph-dam-break.toml", 3, {"width.factor=4", "solver.tolerance=1e-16"}});
}

/// Implicit viscosity and a plate that moves; shifting around periodic ends.
TEST_F(SharedOnDevices, IsphWithoutSurface) {
  compare<2, Cuda>({"../tests/validation/cases/isph-couette.toml", 10, {"solver.tolerance=1e-18"}});
  compare<2, Cuda>({"../tests/validation/cases/isph-taylor-green.toml", 10, {"solver.tolerance=1e-18"}});
}

TEST_F(SharedOnDevices, SameBitsFromRunToRun) {
  expectSameBitsAgain<Cuda>("dam-break-2d.toml");
  expectSameBitsAgain<Cuda>("isph-dam-break-2d.toml");
}

/// The device's way against the CPU's, each shared by all processes.
TEST_F(SharedOnDevices, AsOnTheCpu) {
  const Case c = Settings{"dam-break-2d.toml", 0, {"solver.tolerance=1e-16"}}.read();
  Simulation<2, Cuda> device(c, partOf<2>(c), 0, 0, &job());
  Simulation<2> host(c, partOf<2>(c), 0, 0, &job());
  for (int k = 0; k < 10; ++k) expectSame(c, device.advance(), host.advance(), false);
}

TEST_F(SharedOnDevices, AgreeOnAParticleThatLeaves) { expectAgreementOnAParticleThatLeaves<Cuda>(); }

/// What a link cannot be called is bad input at all processes.
TEST_F(SharedOnDevices, RefuseAnUnknownLink) {
  if (job().size() == 1) return;
  const char* const before = std::getenv("TREACLE_LINK");
  const std::string kept = before ? before : "";
  setenv("TREACLE_LINK", "carrier pigeon", 1);
  const Case c = Settings{"dam-break-2d.toml", 0, {}}.read();
  EXPECT_THROW((Simulation<2, Cuda>(c, partOf<2>(c), 0, 0, &job())), InputError);
  before ? setenv("TREACLE_LINK", kept.c_str(), 1) : unsetenv("TREACLE_LINK");
}

}  // namespace
}  // namespace treacle::test
