#pragma once

#include "treacle/linear/block_csr.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_particles.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/weight.hpp"

#include <span>
#include <type_traits>
#include <utility>

namespace treacle {

/// The linear system A u = b of one step [K23 eq. (16)], walls at rest, with all that solvers start from.
template <int D, class Backend>
class StudiedSystem {
 public:
  StudiedSystem(const Case& theCase, Particles<D> state) : c(theCase), neighbourhood_(c) {
    if constexpr (std::is_same_v<Backend, Cuda>)
      copyToDevice(context, state, particles);
    else
      particles = std::move(state);
    neighbourhood_.sort(context, particles);
    neighbourhood_.buildLists(context, particles);
    wallBlock_.resize(context, fluidCount());
    wallGradient_.resize(context, fluidCount());
    wallTerms<D>(context, pairs(), terms());
    computeRightHandSide();
  }
  StudiedSystem(const StudiedSystem&) = delete;

  std::uint32_t fluidCount() const { return particles.fluidCount; }
  const MphPairs<D>& pairs() const { return neighbourhood_.pairs(); }
  const CellRanges<Backend>& ranges() const { return neighbourhood_.ranges(); }
  WallTerms<D> terms() { return {wallBlock_.span(), wallGradient_.span()}; }
  std::span<const Vec<D>> rightHandSide() const { return rhs_; }
  /// The last velocity.
  std::span<const Vec<D>> firstGuess() const { return particles.velocity.span().first(fluidCount()); }

  /// A as a matrix of blocks.
  void assembleMatrix() {
    gradientRows(context, pairs(), rows_);
    assemble(context, pairs(), terms(), rows_, matrix);
  }
  void dropMatrix() {
    matrix = {};
    rows_ = {};
  }

  Case c;
  Context<Backend> context;  // before all that lives in its memory
  Particles<D, Backend> particles;
  BlockCsr<D, double, Backend> matrix;  // empty until assembleMatrix()

 private:
  void computeRightHandSide() {
    Buffer<double, Backend> density, elastic;
    density.resize(context, pairs().activeCount);
    elastic.resize(context, pairs().activeCount);
    rhs_.resize(context, fluidCount());
    numberDensity<D>(context, pairs(), density);
    elasticPressure<D>(context, pairs(), density, {}, elastic);
    inertiaAndGravity<D>(context, pairs(), firstGuess(), {.gravity = resized<D>(c.gravity)}, rhs_);
    addPressureGradient<D>(context, pairs(), elastic, -1.0, rhs_);
  }

  MphNeighbourhood<D, Backend> neighbourhood_;
  Buffer<Block<D>, Backend> wallBlock_;
  Buffer<Vec<D>, Backend> wallGradient_, rhs_;
  GradientRows<D, Backend> rows_;
};

}  // namespace treacle
