#pragma once

#include "isph_matrix.hpp"
#include "isph_traffic.hpp"
#include "method/isph_step.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/particles/particles_copy.hpp"

#include <span>

namespace treacle {

/// The pressure equation A p = b of one step [O23 eq. (11)] with all that solvers start from.
template <int D>
class IsphPressureSystem {
 public:
  /// `state`: the particles at the start of the step. Errors: InputError for walls that oscillate or rotate, whose
  /// motion a simulation prescribes.
  IsphPressureSystem(const Case& c, const Particles<D>& state, double timeStep) : flow_(c, 0, 0), method_(flow_) {
    for (const Body& body : c.bodies)
      if (body.oscillation.period > 0 || body.rotation || body.kind == BodyKind::Rigid)
        throw InputError("walls that oscillate or rotate, and rigid bodies, are not compared");
    copyToDevice(flow_.context, state, flow_.particles);
    flow_.timeStep = timeStep;
    method_.sortParticles();
    method_.findNeighbours();
    flow_.phases.start(flow_.context);
    method_.predict();
    method_.prepareSystem();
    guess_.resize(context(), fluidCount());
    copyValues(context(), std::span<const double>(flow_.particles.pressure).first(fluidCount()), guess_.data());
    clearKnown(context(), row(), guess_.span());
  }
  IsphPressureSystem(const IsphPressureSystem&) = delete;

  Context<Cuda>& context() const { return flow_.context; }
  std::uint32_t fluidCount() const { return flow_.particles.fluidCount; }
  const IsphPairs<D>& pairs() const { return method_.pairs(); }
  const CellRanges<Cuda>& ranges() const { return method_.ranges(); }
  PressureRow<D> row() const { return method_.row(); }
  std::span<const double> rightHandSide() const { return method_.source(); }
  /// The last pressure, zero where that is prescribed.
  std::span<const double> firstGuess() const { return guess_.span(); }

  PressureSizes sizes() const {
    const double near = IsphStep<D, Cuda>::nearShare * pairs().kernel.radius();
    return {D, fluidCount(), countPairs(context(), pairs(), near), gridSizes(context(), pairs())};
  }

 private:
  FlowState<D, Cuda> flow_;
  IsphStep<D, Cuda> method_;
  Buffer<double, Cuda> guess_;
};

}  // namespace treacle
