#pragma once

#include "treacle/search/cell_sort.hpp"
#include "treacle/search/cluster_list.hpp"
#include "treacle/search/particle_sort.hpp"

#include <random>

namespace treacle::test {

/// Particles at random places of a box, the first axis periodic and the last open, before any sort.
template <int D>
struct RandomParticles {
  Context<Cpu> context;
  Particles<D> particles;
  double radius = 0;
  CellGrid<D> grid;
  CellRanges<> ranges;
  SortWorkspace<> workspace;

  RandomParticles(std::uint32_t fluid, std::uint32_t wall, unsigned seed) {
    // About ten neighbours each; at least three cells along the periodic axes.
    radius = std::min(0.3, std::pow(10.0 / (fluid + wall), 1.0 / D));
    Vec<D, bool> periodic{};
    for (int k = 0; k + 1 < D; ++k) periodic[k] = true;
    grid = CellGrid<D>::make(Vec<D>{}, Vec<D>::filled(1), periodic, radius);
    particles.resize({fluid,
                      wall,
                      seed % 3,
                      seed % 2 * wall,
                      0,
                      {seed % 2 > 0, seed % 2 > 0, seed % 2 > 0, static_cast<std::uint8_t>(seed % 5),
                       static_cast<std::uint8_t>(seed % 3)}});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::uint32_t i = 0; i < particles.count; ++i) {
      for (int k = 0; k < D; ++k) {
        particles.position[i][k] = unit(random);
        particles.velocity[i][k] = unit(random);
      }
      if (i < fluid) {
        particles.position[i][D - 1] *= 0.5;  // leaves walls without fluid near them
        particles.acceleration[i] = -particles.position[i];
        particles.jerk[i] = -particles.velocity[i];
        if (particles.has.shearRates) particles.shearRate[i] = i + 0.5;
        if (particles.has.temperatures) particles.temperature[i] = 300.25 + i;
        if (particles.has.viscosityFactors) particles.viscosityFactor[i] = 0.25 + i;
        for (std::size_t k = 0; k < particles.has.states; ++k) particles.states[k][i] = 0.125 * (k + 1) + i;
        for (std::size_t k = 0; k < particles.has.elasticModes; ++k)
          particles.conformation[k][i] = (1.0 + 0.25 * (k + 1) + i) * SymmetricBlock<D>::identity();
        for (std::uint32_t m = 0; m < particles.modeCount(); ++m)
          particles.modes.vectors[std::size_t{m} * fluid + i] =
              Vec<D, float>::filled(static_cast<float>(i + 0.25 * m));
      }
      if (i >= fluid && !particles.wallSurface.empty())
        particles.wallSurface[i - fluid] = {converted<float>(particles.position[i]), {}};
      particles.pressure[i] = particles.numberDensity[i] = particles.heldPressure[i] = 0;
      particles.material[i] = 0;
      particles.body[i] = static_cast<std::uint8_t>(i % 7);
      particles.id[i] = i;
    }
  }

  /// Thin sheets: random sides of two of them, and some walls that belong to one.
  void addSides(unsigned seed) {
    std::mt19937 random(seed);
    particles.has.sides = true;
    particles.side.resize(particles.count);
    for (std::uint32_t i = 0; i < particles.count; ++i) {
      particles.side[i] = static_cast<std::uint32_t>(random() % 3 | random() % 3 << 2);
      if (i >= particles.fluidCount && random() % 2)
        particles.side[i] = sides::sheetParticle(0, 1 + static_cast<std::uint32_t>(random() % 2));
    }
  }

  /// Makes a rigid body, 3, of the walls in a box above the fluid, and one other body of all other walls.
  void addRigidBody() {
    particles.rigid.bodies.resize(4);
    particles.rigid.bodies[3].mass = 1;
    for (std::uint32_t i = particles.fluidCount; i < particles.count; ++i) {
      const Vec<D>& x = particles.position[i];
      particles.body[i] = std::abs(x[0] - 0.5) < 0.1 && std::abs(x[D - 1] - 0.85) < 0.1 ? 3 : 1;
    }
  }

  /// Of these particles, here or on a device, once they are sorted.
  template <class Backend>
  SortedParticles<D> sorted(const Particles<D, Backend>& p, const CellRanges<Backend>& r) const {
    SortedParticles<D> s;
    s.grid = grid;
    placeSorted(p, r, s);
    return s;
  }

  double distance(const Vec<D>& a, const Vec<D>& b) const {
    Vec<D> d = b - a;
    for (int k = 0; k < D; ++k)
      if (grid.periodic[k]) d[k] -= grid.length[k] * std::round(d[k] / grid.length[k]);
    return norm(d);
  }
};

}  // namespace treacle::test
