#include "treacle/mph/conduction.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"
#include "treacle/model/materials/enthalpy.hpp"
#include "treacle/mph/free_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace treacle::test {
namespace {

/// |found - expected| over |expected|, of all numbers together.
template <class T>
double difference(const Context<Cuda>& context, const Buffer<T>& expected, const Buffer<T, Cuda>& found) {
  const Buffer<T> onHost = copyToHost(context, found);
  const auto *e = reinterpret_cast<const double*>(expected.data()),
             *f = reinterpret_cast<const double*>(onHost.data());
  double error = 0, size = 1e-300;
  for (std::size_t k = 0; k < expected.span().size_bytes() / sizeof(double); ++k)
    error += (e[k] - f[k]) * (e[k] - f[k]), size += e[k] * e[k];
  return std::sqrt(error / size);
}

template <int D>
void compareConduction(bool lists, SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.seed = 3, .scheme = scheme});
  DeviceScene<D> d(s);
  if (!lists) d.pairs.fluidList.offset = d.pairs.wallList.offset = nullptr;
  s.c.materials[0].conductivity = 2, s.c.materials[1].conductivity = 0.5;
  const std::uint32_t n = s.n();
  const std::vector<WallHeat> walls{{400, 2e-4}};
  const auto wallsDevice = copyToDevice<WallHeat>(d.context, walls);
  const auto body = copyToDevice<std::uint8_t>(d.context, s.particles.body.span());
  Conduction host{HeatTable::make(s.c), walls.data(), s.particles.body.data(), nullptr};
  Conduction device{host.table, wallsDevice.data(), body.data(), nullptr};

  Buffer<double> scale(n), ofFluid(n), y(n), area(n);
  Buffer<HeatExchange> ofWalls(n);
  Buffer<double, Cuda> scaleFound(d.context, n), ofFluidFound(d.context, n), yFound(d.context, n),
      areaFound(d.context, n);
  Buffer<HeatExchange, Cuda> ofWallsFound(d.context, n);
  conductionScale<D>(s.context, s.pairs(), host, scale);
  conductionScale<D>(d.context, d.pairs, device, scaleFound);
  EXPECT_LE(difference(d.context, scale, scaleFound), kernelTolerance);

  host.scale = scale.data(), device.scale = scaleFound.data();
  conductionDiagonal<D>(s.context, s.pairs(), host, ofFluid, ofWalls);
  conductionDiagonal<D>(d.context, d.pairs, device, ofFluidFound, ofWallsFound);
  EXPECT_LE(difference(d.context, ofFluid, ofFluidFound), kernelTolerance);
  EXPECT_LE(difference(d.context, ofWalls, ofWallsFound), kernelTolerance);

  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> T(n), extra(n);
  for (std::uint32_t i = 0; i < n; ++i) T[i] = unit(random), extra[i] = 1e5 * unit(random);
  conduct<D>(s.context, s.pairs(), host, extra, T, y);
  conduct<D>(d.context, d.pairs, device, copyToDevice<double>(d.context, extra),
             copyToDevice<double>(d.context, T), yFound);
  EXPECT_LE(difference(d.context, y, yFound), kernelTolerance);

  // The same where material 0 freezes. Means over temperatures that are next to each other lose digits.
  constexpr double ofMeans = 1e-9;
  s.c.materials[0].freezing = Freezing{.solidus = 320, .liquidus = 330, .solidConductivity = 6};
  const EnthalpyTable table = EnthalpyTable::make(s.c.materials);
  std::vector<double> k(n), conducted(n), atWalls;
  for (std::uint32_t i = 0; i < n; ++i) {
    T[i] = 300 + 50 * T[i];
    const Enthalpy& h = table.of[s.particles.material[i]];
    k[i] = h.conductivity(T[i]), conducted[i] = h.conducted(T[i]);
  }
  for (const Enthalpy& h : table.of) atWalls.push_back(h.conducted(400));
  const auto tDevice = copyToDevice<double>(d.context, T), kDevice = copyToDevice<double>(d.context, k),
             conductedDevice = copyToDevice<double>(d.context, conducted),
             atWallsDevice = copyToDevice<double>(d.context, atWalls);
  host.own = {T.data(), k.data(), conducted.data(), atWalls.data()};
  device.own = {tDevice.data(), kDevice.data(), conductedDevice.data(), atWallsDevice.data()};
  conductionDiagonal<D>(s.context, s.pairs(), host, ofFluid, ofWalls);
  conductionDiagonal<D>(d.context, d.pairs, device, ofFluidFound, ofWallsFound);
  EXPECT_LE(difference(d.context, ofFluid, ofFluidFound), ofMeans);
  EXPECT_LE(difference(d.context, ofWalls, ofWallsFound), ofMeans);
  conduct<D>(s.context, s.pairs(), host, extra, T, y);
  conduct<D>(d.context, d.pairs, device, copyToDevice<double>(d.context, extra), tDevice, yFound);
  EXPECT_LE(difference(d.context, y, yFound), ofMeans);

  const SurfaceColour<D> colour = SurfaceColour<D>::make(s.pairs());
  surfaceArea<D>(s.context, s.pairs(), colour, area);
  surfaceArea<D>(d.context, d.pairs, colour, areaFound);
  EXPECT_LE(difference(d.context, area, areaFound), kernelTolerance);
}

TEST(ConductionTwin, SumsEqualThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const bool lists : {true, false})
    for (const SchemeKind scheme : bothSchemes) {
      compareConduction<2>(lists, scheme);
      compareConduction<3>(lists, scheme);
    }
}

}  // namespace
}  // namespace treacle::test
