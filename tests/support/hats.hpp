#pragma once

#include "treacle/core/pseudo_random.hpp"
#include "treacle/linear/hat_multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace treacle::test {

/// A lattice and which of its points are nodes.
template <int D>
struct HatCase {
  std::string name;
  HatLattice<D> lattice;
  std::vector<std::uint8_t> active;
};

/// Nodes where keep(point) says so.
template <int D, class Keep>
HatCase<D> hatCase(const char* name, Vec<D, int> count, Vec<D, bool> periodic, Keep&& keep) {
  HatCase<D> c{name, {count, periodic}, {}};
  for (std::size_t p = 0; p < c.lattice.points(); ++p) c.active.push_back(keep(c.lattice.at(p)) ? 1 : 0);
  return c;
}

/// All ways in which bodies lie in lattices, about `size` points along each axis.
template <int D>
std::vector<HatCase<D>> hatCases(int size) {
  const auto all = [](const Vec<D, int>&) { return true; };
  const auto counts = [&](int first, int others) {
    Vec<D, int> c = Vec<D, int>::filled(others);
    c[0] = first;
    return c;
  };
  const Vec<D, bool> open{};
  Vec<D, bool> mixed{};
  mixed[0] = true;
  const auto fromSeam = [&](const Vec<D, int>& p) {
    double r2 = std::pow(std::min(p[0], size + 2 - p[0]), 2);
    for (int k = 1; k < D; ++k) r2 += std::pow(p[k] - size / 2.0, 2);
    return std::sqrt(r2);
  };
  std::mt19937 random(5);
  return {
      hatCase<D>("open box", counts(size + 1, size), open, all),
      hatCase<D>("periodic, odd", counts(size | 1, (size | 1) + 2), Vec<D, bool>::filled(true), all),
      hatCase<D>("periodic, even, and open", counts((size | 1) + 1, size), mixed, all),
      hatCase<D>("tiny periodic axis", counts(3, size), mixed, all),
      hatCase<D>("axis of one point", counts(1, size), open, all),
      hatCase<D>("ball across the seam with a hole", counts(size + 2, size + 2), mixed,
                 [&](const Vec<D, int>& p) { return fromSeam(p) > 2 && fromSeam(p) < size / 3.0; }),
      // On coarse levels hats lie across the gap between it and its image, and operators become singular.
      hatCase<D>("ball that nearly touches its image", counts(size + 2, size + 2), mixed,
                 [&](const Vec<D, int>& p) { return fromSeam(p) > 2 && fromSeam(p) < size / 2.0; }),
      hatCase<D>("scattered", counts(size + 3, size), open,
                 [&](const Vec<D, int>&) { return std::bernoulli_distribution(0.1)(random); }),
      hatCase<D>("one node", counts(size, size), open, [&](const Vec<D, int>& p) { return p == counts(1, 3); }),
      hatCase<D>("no node", counts(size, size), open, [](const Vec<D, int>&) { return false; }),
  };
}

/// Steps from p to q, the shortest way around; half way round a periodic axis counts as upwards.
template <int D>
Vec<D> stepsBetween(const HatLattice<D>& lattice, const Vec<D, int>& p, const Vec<D, int>& q) {
  Vec<D> steps{};
  for (int k = 0; k < D; ++k) {
    int d = q[k] - p[k];
    const int n = lattice.count[k];
    if (lattice.periodic[k]) d = 2 * d > n ? d - n : 2 * d <= -n ? d + n : d;
    steps[k] = d;
  }
  return steps;
}

/// Positive definite coupling of two nodes, the same for (i, j) and (j, i). With B = D numbers per node they are
/// tied more firmly along the line between them than across it, so that components couple.
template <int D, int B>
Block<B> hatCoupling(const HatNodes<D>& nodes, std::uint32_t i, std::uint32_t j) {
  const std::uint32_t first = std::min(i, j), second = std::max(i, j);
  const HatLattice<D>& lattice = nodes.lattice;
  const Vec<D> d = stepsBetween<D>(lattice, lattice.at(nodes.point[first]), lattice.at(nodes.point[second]));
  const double strength = (1.5 + pseudoRandom(first * 7919u + second)) * std::pow(norm2(d), -1.5);
  Block<B> block = Block<B>::diagonal(strength);
  if constexpr (B == D) block.addOuter(2 * strength / norm2(d), d, d);
  return block;
}

/// Graph Laplacian of the pattern with positive definite, uneven couplings, and `mass` on the diagonal.
template <int D, int B = 1>
BlockCsr<B> hatLaplacian(const HatNodes<D>& nodes, double mass = 0.01, int reach = hatReach) {
  Context<Cpu> context;
  BlockCsr<B> a;
  hatPattern<D>(context, nodes, a, reach);
  for (std::uint32_t i = 0; i < nodes.count(); ++i) {
    Block<B> sum = Block<B>::diagonal(mass);
    std::uint64_t diagonal = 0;
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k) {
      if (a.column[k] == i) {
        diagonal = k;
        continue;
      }
      const Block<B> coupling = hatCoupling<D, B>(nodes, i, a.column[k]);
      a.value[k] = Block<B>{};
      a.value[k] -= coupling;
      sum += coupling;
    }
    a.value[diagonal] = sum;
  }
  return a;
}

/// Everything that a V-cycle is set up from: one number per node and the widest reach, or B numbers and reach 1.
template <int D, int B = 1>
struct HatProblem {
  static constexpr int reach = B == 1 ? hatReach : 1;
  HatNodes<D> nodes;
  BlockCsr<B> a;

  explicit HatProblem(const HatCase<D>& c, double mass = 0.01) {
    Context<Cpu> context;
    numberNodes<D>(context, c.lattice, c.active, nodes);
    a = hatLaplacian<D, B>(nodes, mass, reach);
  }

  std::size_t unknowns() const { return std::size_t{B} * nodes.count(); }
};

}  // namespace treacle::test
