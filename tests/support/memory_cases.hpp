#pragma once

#include "treacle/io/case_reader.hpp"
#include "treacle/model/create.hpp"
#include "treacle/step/any_simulation.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace treacle::test {

/// A case with what decides on the memory of its solver.
struct MemoryCase {
  const char* file;
  std::vector<std::string> settings;

  Case read() const { return readCase(std::string(TREACLE_CASES) + "/" + file, settings); }
  std::string name() const {
    std::string text = file;
    for (const std::string& s : settings) text += " " + s;
    return text;
  }
};

inline std::vector<MemoryCase> memoryCases() {
  std::vector<MemoryCase> all;
  for (const char* file :
       {"dam-break-2d.toml", "published/dam-break-2d.toml", "dam-break-3d.toml", "published/dam-break-3d.toml"}) {
    const bool flat = std::string_view(file).ends_with("2d.toml");
    const std::string resolution = flat ? "resolution=2" : "resolution=0.5";
    // Modes, which plans have room for, are taken in some runs and not before the third step.
    all.push_back({file, {resolution, "solver.deflation=0"}});
    all.push_back({file, {resolution, "solver.deflation=0", "output.balance=true", "solver.precision=double"}});
    all.push_back({file, {resolution, "solver.deflation=0", "solver.operator=assembled"}});
    all.push_back({file, {resolution, "solver.preconditioner=bucket-multigrid"}});
    all.push_back({file,
                   {resolution, "solver.preconditioner=bucket-multigrid",
                    "solver.multigrid.particle_diagonal=extended-jacobi"}});
  }
  // So stiff that a CPU's S' has no elements in few bits.
  all.push_back({"dam-break-3d.toml", {"resolution=0.5", "fluid.bulk_viscosity=1e5"}});
  all.push_back({"glass-gob-2d.toml", {"resolution=2", "solver.deflation=0"}});
  all.push_back({"honey-and-syrup-2d.toml", {"solver.deflation=0"}});
  all.push_back({"merging-drops-2d.toml", {"solver.deflation=0"}});
  all.push_back({"isph-dam-break-2d.toml", {}});
  all.push_back({"isph-dam-break-2d.toml", {"solver.preconditioner=cell-multigrid"}});
  all.push_back({"isph-dam-break-2d.toml", {"method.viscosity=implicit", "water.dynamic_viscosity=1"}});
  all.push_back({"isph-floating-block-2d.toml", {}});
  all.push_back({"isph-dam-break.toml", {"width.factor=0.5"}});
  return all;
}

}  // namespace treacle::test
