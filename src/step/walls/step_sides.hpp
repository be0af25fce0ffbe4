#pragma once

#include "run/flow_state.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/model/geometry/side_map.hpp"
#include "treacle/search/sheet_sides.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The thin sheets of a case, and which particles are on which side of them.
template <int D, class Backend>
class StepSides {
 public:
  /// Errors: those of makeSideMap.
  explicit StepSides(const FlowState<D, Backend>& state) {
    for (std::size_t b = 0; b < state.theCase.bodies.size(); ++b) {
      const Body& body = state.theCase.bodies[b];
      if (!body.shape.isThinSheet()) continue;
      Sheet sheet{b, makeSideMap<D>(state.theCase, body), {}};
      fromHost(state.context, std::span<const std::int8_t>(sheet.map.height), sheet.height);
      sheet.map.height = {};
      sheets_.push_back(std::move(sheet));
    }
  }

  /// For particles that are where walls are at `time` [s].
  void update(FlowState<D, Backend>& state, double time) {
    if (sheets_.empty()) return;
    std::vector<PlacedSheet<D>> placed;
    for (const Sheet& sheet : sheets_)
      placed.push_back(
          placedSheet<D>(state.theCase, state.theCase.bodies[sheet.body], sheet.map, sheet.height.data(), time));
    fromHost(state.context, std::span<const PlacedSheet<D>>(placed), placed_);
    updateSides<D>(state.context, placed_.span(), state.particles.position, state.particles.side.span());
  }

  std::size_t bytes() const {
    std::size_t sum = placed_.bytes();
    for (const Sheet& sheet : sheets_) sum += sheet.height.bytes();
    return sum;
  }

 private:
  struct Sheet {
    std::size_t body;
    SideMap<D> map;  // without its heights
    Buffer<std::int8_t, Backend> height;
  };

  std::vector<Sheet> sheets_;
  Buffer<PlacedSheet<D>, Backend> placed_;
};

}  // namespace treacle
