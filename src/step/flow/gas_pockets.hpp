#pragma once

#include "gas_grid.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/state/gas_state.hpp"
#include "treacle/step/flow/gas_contact.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace treacle {

/// Finds the gas that fluid and walls enclose, on a grid of cells as wide as particles are apart (docs/gas.md). A
/// cell is empty if no particle is within a spacing of its centre. Empty cells that hang together and reach
/// neither an end of the domain nor a vent are a pocket.
template <int D>
class GasPockets {
 public:
  explicit GasPockets(const Case& c);

  /// Of the particles at these places, of which so many are fluid and the others walls; several processes come
  /// each with particles of its own. `state`: that of the step before; what it says of pockets goes on in those
  /// that have their cells. Returns whether the pockets are other ones than before. Collective. Errors:
  /// std::bad_alloc.
  bool find(const Processes& processes, std::span<const Vec<D>> position, std::uint32_t fluid, GasState& state);
  /// Of the process's own particles, in their order.
  std::span<const GasContact<D>> contacts() const { return contacts_; }

  /// Pressure above that of the air in a pocket of this volume [Pa].
  double pressure(const GasState::Pocket& pocket, double volume) const;

  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t air = 0xffffffff, nobody = 0xfffffffe;  // among labels
  static constexpr int rim = 2;     // how many cells around a pocket count for its volume
  static constexpr int reach = 5;   // and, beside the layers, for its force
  static constexpr int layers = 3;  // of fluid that the force of a high pressure does not act on

  void sort(std::span<const Vec<D>> position);
  void findEmpty(const Processes& processes, std::span<const Vec<D>> position);
  void spread(std::vector<std::size_t> from, std::uint32_t label);
  std::vector<std::vector<std::size_t>> components();
  bool inherit(const std::vector<std::vector<std::size_t>>& found, GasState& state);
  void setDepths(const GasState& state);
  void widen(const std::vector<std::vector<std::size_t>>& found);
  void measure(const Processes& processes, std::span<const Vec<D>> position, std::uint32_t fluid);
  void setVolumes(GasState& state) const;
  template <class F>
  std::vector<double> mean(F&& value) const;
  void smooth(std::vector<double>& field) const;
  void shareFluid(double factor);
  void share();
  void deepen();
  void meet(std::span<const Vec<D>> position, std::uint32_t fluid);

  GasSettings gas_;
  double spacing_;                   // l [m]
  double particle_, cell_;           // volumes of a particle and of a cell [m3; m2 in 2D]
  std::optional<double> rowWeight_;  // of fluid, over its area; nothing: no layers [Pa]
  GasGrid<D> grid_;
  std::vector<std::uint8_t> empty_;           // per cell
  std::vector<std::uint32_t> label_;          // per cell: its pocket, air or nobody
  std::vector<std::uint32_t> start_, items_;  // particles of cells
  std::vector<std::uint32_t> near_;           // cells of pockets and around them, by rings
  std::vector<std::uint32_t> rings_;          // where rings begin in near_
  std::vector<double> filled_, walls_;        // per cell: the part of it that particles fill, and walls alone
  std::vector<double> open_;                  // per cell, where a pocket is near: the part without walls, smoothed
  std::vector<double> ofFluid_, ofWalls_;     // per cell: I, for particles of each kind
  std::vector<double> depth_;                 // of each pocket: the part of its force that acts behind the layers
  double deepest_ = 0;                        // the largest of them
  std::vector<GasContact<D>> contacts_;
};

extern template class GasPockets<2>;
extern template class GasPockets<3>;

}  // namespace treacle
