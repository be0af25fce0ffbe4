#pragma once

#include "gpu_record.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <cusparse.h>

#include <sstream>
#include <string>
#include <vector>

namespace treacle {

/// MGCG(m, n) by the libraries, or plain CG.
struct IsphLibraryVariant {
  const char* name;
  bool preconditioned;
  int levels, sweeps;  // m (0: all) and n
  cusparseSpMVAlg_t algorithm;
};
inline constexpr IsphLibraryVariant libraryVariants[] = {
    {"libraries: cg", false, 0, 0, CUSPARSE_SPMV_CSR_ALG1},
    {"libraries: cg, SpMV ALG2", false, 0, 0, CUSPARSE_SPMV_CSR_ALG2},
    {"libraries: MGCG(1,4)", true, 1, 4, CUSPARSE_SPMV_CSR_ALG1},
    {"libraries: MGCG(1,4), SpMV ALG2", true, 1, 4, CUSPARSE_SPMV_CSR_ALG2},
    {"libraries: MGCG(2,4)", true, 2, 4, CUSPARSE_SPMV_CSR_ALG1},
    {"libraries: MGCG(2,4), SpMV ALG2", true, 2, 4, CUSPARSE_SPMV_CSR_ALG2},
    {"libraries: MGCG(all,4)", true, 0, 4, CUSPARSE_SPMV_CSR_ALG1},
    {"libraries: MGCG(all,4), SpMV ALG2", true, 0, 4, CUSPARSE_SPMV_CSR_ALG2},
};

/// Settings of treacle's own solver, as case files have them under [solver].
inline const std::vector<std::string> defaultSolvers = {
    "preconditioner=none precision=double",
    "preconditioner=jacobi precision=double",
    "preconditioner=cell-multigrid precision=double cells.levels=1 cells.sweeps=4",
    "preconditioner=cell-multigrid precision=double cells.levels=2 cells.sweeps=4",
    "preconditioner=cell-multigrid precision=double cells.levels=0 cells.sweeps=4",
    "preconditioner=hat-multigrid precision=double",
    "preconditioner=hat-multigrid precision=mixed",
};

/// "treacle: hat-multigrid mixed": the common keys go without saying.
inline std::string solverName(const std::string& settings) {
  std::string name = "treacle:";
  std::istringstream words(settings);
  for (std::string word; words >> word;) {
    for (const std::string key : {"preconditioner=", "precision=", "cells."})
      if (word.starts_with(key)) word.erase(0, key.size());
    name += " " + word;
  }
  return name;
}

struct IsphOptions : BenchmarkOptions {
  std::string caseFile, checkpoint;
  std::vector<std::string> settings;  // as --set of treacle
  std::vector<double> widths;         // factors of [width]; empty: as the case has it
  std::vector<std::string> solvers;   // settings of treacle's solver; empty: the default list
  double particles = 0;               // steps alone with so many fluid particles; 0: no
  int steps = 100;                    // that are made before the system is taken
  int timedSteps = 20;                // of which the phases are timed
  int repetitions = 3;
  int maxIterations = 20000;  // of all methods

  /// The case at a width; 0: as it is. Errors: InputError.
  Case readCaseAt(double width, std::vector<std::string> more = {}) const {
    std::vector<std::string> overrides = settings;
    if (width > 0) overrides.push_back(fmt::format("width.factor={}", width));
    overrides.insert(overrides.end(), more.begin(), more.end());
    return readCase(caseFile, overrides);
  }
  /// |r|^2 / |b|^2 at which all methods stop.
  double tolerance() const { return readCaseAt(0).solver.tolerance; }
  /// Settings of one way to solve, without those that it would fall back to.
  SolverSettings solverOf(const std::string& words) const {
    std::vector<std::string> overrides;
    std::istringstream stream(words);
    for (std::string word; stream >> word;) overrides.push_back("solver." + word);
    SolverSettings stage = solveStages(readCaseAt(0, overrides)).front();
    stage.maxIterations = maxIterations;
    return stage;
  }
};

}  // namespace treacle
