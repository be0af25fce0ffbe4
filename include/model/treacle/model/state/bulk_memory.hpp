#pragma once

namespace treacle {

/// How far a run has raised the bulk constants that its case leaves open (adaptBulkConstants()).
struct BulkMemory {
  double viscosity = 1, modulus = 1;  // over those at first [-]
  double turning = 1;                 // by which kappa is larger still while fluid folds fast [-]
  // Since the last time: how much too dense the fluid was [-], and how long it may stay so [s].
  double excess = 0, rest = 0;

  double modulusOfAll() const { return modulus * turning; }

  bool operator==(const BulkMemory&) const = default;
};

}  // namespace treacle
