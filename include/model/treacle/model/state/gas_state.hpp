#pragma once

#include <cstdint>
#include <vector>

namespace treacle {

/// At most so many pockets of gas have a pressure, the largest ones.
inline constexpr std::uint32_t mostGasPockets = 32;

/// What a run remembers of the gas that its fluid has trapped (docs/gas.md); empty where there is none.
struct GasState {
  struct Pocket {
    double content = 0;   // p^(1/k) V, which stays the same as it is compressed [Pa^(1/k) m3; m2 in 2D]
    double volume = 0;    // V [m3; m2 in 2D]
    double pressure = 0;  // above that of the air [Pa]

    bool operator==(const Pocket&) const = default;
  };

  std::vector<Pocket> pockets{};
  std::vector<double> cells{};   // of the grid that are in a pocket, ascending
  std::vector<double> labels{};  // of these: which pocket

  bool operator==(const GasState&) const = default;
};

}  // namespace treacle
