#pragma once

#include "treacle/io/files/rows.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace treacle {

/// Wall-clock seconds of the phases of a step.
struct HistoryTimings {
  double search = 0, lists = 0, coefficients = 0, coarse = 0, solve = 0, update = 0;  // [s]
};

/// Fluid that has come in or gone out since the start of a case.
struct HistoryFlow {
  std::uint64_t particles = 0;
  double volume = 0, mass = 0;  // [m3; m2 in 2D], [kg; per metre of depth in 2D]
};

/// Gas that the fluid has trapped.
struct HistoryGas {
  std::uint64_t pockets = 0;
  double volume = 0, pressure = 0;  // of all [m3; m2 in 2D], in the largest one above that of the air [Pa]
};

/// One time step in `history.csv`.
struct HistoryRow {
  std::int64_t step = 0;
  double time = 0;      // [s], after the step
  double timeStep = 0;  // [s]; zero, like the densities, if the file, of an earlier version, does not hold them
  int iterations = 0;
  double residual = 0;         // |r|^2 / |b|^2 at the end of the solve
  double kineticEnergy = 0;    // [J; per metre of depth in 2D]
  double potentialEnergy = 0;  // [J; per metre of depth in 2D]
  double frontX = 0;           // largest x of the fluid [m]
  double top = 0;              // largest coordinate of the fluid against gravity [m]
  double maxSpeed = 0;         // [m/s]
  double meanDensity = 0;      // mean of rho / rho_0 over the fluid
  double densityError = 0;     // mean of |rho / rho_0 - 1| away from free surfaces
  double seconds = 0;          // wall-clock time of the step [s]
  int fallbacks = 0;           // of the linear solver; zero if the file, of an earlier version, does not hold them
  std::uint64_t particles = 0;  // of the fluid; zero, like the next two, if the file does not hold them
  HistoryFlow inflow{}, outflow{};
  HistoryGas gas{};
  HistoryTimings timings{};  // zero if the file does not hold them
};

/// Columns that only some histories have.
struct HistoryColumns {
  bool flow = false;     // fluid that comes and goes
  bool gas = false;      // that is trapped
  bool timings = false;  // of the phases
};

/// Appends rows to a new file; numbers read back to the same bits. Errors: those of RowFile.
class HistoryWriter {
 public:
  /// Replaces what the target holds.
  explicit HistoryWriter(RowTarget to, HistoryColumns columns = {});

  void append(const HistoryRow& row);

 private:
  HistoryColumns columns_;
  Rows rows_;
};

/// All rows, with or without timings, also of versions that had fewer columns; an unfinished last line is left
/// out. Errors: InputError with path and line.
std::vector<HistoryRow> readHistory(const std::filesystem::path& path);

}  // namespace treacle
