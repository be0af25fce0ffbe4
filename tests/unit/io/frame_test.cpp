#include "treacle/io/frames/frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace treacle;

namespace {

/// Ids shuffled within fluid and walls; every field of a particle follows from its id.
template <int D>
Particles<D> shuffledParticles(std::uint32_t fluid, std::uint32_t walls) {
  Particles<D> particles;
  particles.resize({fluid, walls, 0, 0, 0, {true, true}});
  std::iota(particles.id.begin(), particles.id.end(), 0u);
  std::mt19937 generator(7);
  std::shuffle(particles.id.begin(), particles.id.begin() + fluid, generator);
  std::shuffle(particles.id.begin() + fluid, particles.id.end(), generator);
  for (std::uint32_t i = 0; i < particles.count; ++i) {
    const double id = particles.id[i];
    for (int k = 0; k < D; ++k) particles.position[i][k] = id + 0.1 * k, particles.velocity[i][k] = -id - 0.1 * k;
    particles.pressure[i] = 2 * id;
    if (i < fluid) particles.shearRate[i] = 4 * id, particles.temperature[i] = 300 + id;
    particles.numberDensity[i] = 3 * id;
    particles.material[i] = static_cast<std::uint8_t>(particles.id[i] % 200);
    particles.body[i] = static_cast<std::uint8_t>(particles.id[i] % 255);
  }
  return particles;
}

template <int D>
void expectSortedCopy(std::uint32_t begin, std::uint32_t end) {
  const Frame frame = makeFrame(shuffledParticles<D>(1000, 500), begin, end, 0.25);
  ASSERT_EQ(frame.id.size(), end - begin);
  EXPECT_EQ(frame.dimensions, D);
  EXPECT_EQ(frame.time, 0.25);
  for (std::uint32_t i = 0; i < end - begin; ++i) {
    const double id = begin + i;
    ASSERT_EQ(frame.id[i], begin + i);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(frame.position[i][k], k < D ? id + 0.1 * k : 0);
      EXPECT_EQ(frame.velocity[i][k], k < D ? -id - 0.1 * k : 0);
    }
    EXPECT_EQ(frame.pressure[i], 2 * id);
    EXPECT_EQ(frame.numberDensity[i], 3 * id);
    if (end <= 1000) {
      EXPECT_EQ(frame.shearRate[i], 4 * id);
      EXPECT_EQ(frame.temperature[i], 300 + id);
    }
    EXPECT_EQ(frame.material[i], static_cast<std::int32_t>((begin + i) % 200));
    EXPECT_EQ(frame.body[i], static_cast<std::int32_t>((begin + i) % 255));
  }
}

TEST(Frame, HasViscositiesOfShearRates) {
  Frame frame = makeFrame(shuffledParticles<2>(5, 0), 0, 5, 0);
  Case c;
  std::vector<Material>& materials = c.materials;
  materials.resize(5);
  for (Material& m : materials) m.dynamicViscosity = 7;
  materials[2].rheology =
      Rheology{.model = RheologyModel::Bingham, .yieldStress = 8, .plasticViscosity = 3, .regularisation = 1e3};
  addViscosities(c, frame);
  EXPECT_EQ(frame.dynamicViscosity, (std::vector<double>{7, 7, 3 + 8 / 8.0, 7, 7}));
  materials[3].viscosityShift =
      ViscosityShift{.model = ShiftModel::Table, .temperatures = {302, 304}, .factors = {4, 1}};
  addViscosities(c, frame);
  EXPECT_NEAR(frame.dynamicViscosity[3], 7 * 2, 1e-12);  // at 303 K
  frame.viscosityFactor = {1, 2, 0.5, 1, 1};
  addViscosities(c, frame);
  EXPECT_EQ(frame.dynamicViscosity[1], 14);
  EXPECT_EQ(frame.dynamicViscosity[2], 2);
  materials[1].states = {{.name = "cure", .rate = "0"}};
  materials[1].viscosityFactor = "1 + cure";
  frame.states = {{"", {5, 6, 7, 8, 9}}};
  addViscosities(c, frame);
  EXPECT_EQ(frame.states[0].name, "cure");
  EXPECT_EQ(frame.dynamicViscosity[1], 7 * 14);
  EXPECT_EQ(frame.dynamicViscosity[2], 2);  // another material
  frame.states.clear(), materials[1].states.clear(), materials[1].viscosityFactor.clear();
  Frame newtonian;
  newtonian.material = {0};
  addViscosities(c, newtonian);
  EXPECT_TRUE(newtonian.dynamicViscosity.empty());
}

}  // namespace

TEST(MakeFrame, CopiesAGroupInTheOrderOfIds) {
  expectSortedCopy<2>(0, 1000);
  expectSortedCopy<3>(1000, 1500);
}

TEST(MakeFrame, EmptyGroup) {
  const Frame frame = makeFrame(shuffledParticles<2>(5, 0), 5, 5, 0);
  EXPECT_TRUE(frame.position.empty());
}
