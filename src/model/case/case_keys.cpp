#include "treacle/model/case/case_keys.hpp"

#include <fmt/format.h>
#include <cmath>

namespace treacle {
namespace {

std::string withUnit(const std::string& text, const Key& key) {
  return key.unit.empty() ? text : fmt::format("{} [{}]", text, key.unit);
}

std::string numberText(const Bound& b) {
  const bool bounded = std::isfinite(b.most);
  if (b.open) return bounded ? fmt::format("a number between {} and {}", b.least, b.most) : "a positive number";
  if (bounded) return fmt::format("a number from {} to {}", b.least, b.most);
  return std::isfinite(b.least) ? fmt::format("a number not less than {}", b.least) : "a finite number";
}

}  // namespace

bool Bound::holds(double x) const {
  return std::isfinite(x) && (open ? least < x && x < most : least <= x && x <= most);
}

std::string expectedNumber(const Key& key, bool orAuto, bool orExpression) {
  return withUnit(numberText(key.bound), key) + (orAuto ? " or \"auto\"" : "") +
         (orExpression ? " or an expression" : "");
}

std::string expectedNumbers(const Key& key) {
  return withUnit(key.bound.open ? "an array of positive numbers" : "an array of finite numbers", key);
}

std::string expectedFunction(const Key& key) {
  return withUnit(numberText(key.bound), key) + ", an expression in t [s] or {times = [...], values = [...]}";
}

std::string expectedInteger(const Key& key) {
  const Bound& b = key.bound;
  if (!std::isfinite(b.most)) return fmt::format("a whole number of at least {}", b.least);
  if (b.most == b.least + 1) return fmt::format("{} or {}", b.least, b.most);
  return fmt::format("a whole number from {} to {}", b.least, b.most);
}

std::string expectedVector(const Key& key, int dimensions, bool orExpressions) {
  return withUnit(
      fmt::format("an array of {} finite numbers{}", dimensions, orExpressions ? " or expressions" : ""), key);
}

std::string expectedPoints(const Key& key) {
  return withUnit("an array of points, each of 2 finite numbers", key);
}

std::string expectedEntries(const Key& key) { return fmt::format("at least one [[{}]]", key.name); }

std::string mismatch(const Key& key, const std::string& expected, const std::string& found) {
  return fmt::format("expected {}, found {}{}{}", expected, found, key.bound.reason.empty() ? "" : ": ",
                     key.bound.reason);
}

MethodSettings defaultMethod(SchemeKind scheme) {
  MethodSettings method;
  if (scheme == SchemeKind::Accurate) return method;
  method.scheme = scheme;  // [K23 Table 1] for the radii
  method.pressureRadius = 1.75;
  method.densityRadius = 0;
  method.viscosityRadius = 3.5;
  method.viscosityCorrection = 0;
  return method;
}

SolverSettings defaultSolver(MethodKind method) {
  SolverSettings solver;
  if (method == MethodKind::MphI) return solver;
  solver.preconditioner = PreconditionerKind::HatMultigrid;
  solver.firstGuess = FirstGuess::Last;
  return solver;
}

SolverSettings defaultSolver(MethodKind method, PreconditionerKind preconditioner) {
  SolverSettings solver = defaultSolver(method);
  solver.preconditioner = preconditioner;
  // With the other preconditioners MPH-I is solved as its authors do.
  if (method == MethodKind::MphI && preconditioner != PreconditionerKind::ProjectedMultigrid)
    solver.krylov = KrylovKind::Cr, solver.precision = Precision::Double;
  return solver;
}

}  // namespace treacle
