#pragma once

#include "key_catalogue.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/kind_key.hpp"

#include <functional>
#include <string>
#include <vector>

namespace treacle {

template <class E>
std::vector<std::string> allWords() {
  std::vector<std::string> words;
  for (const Named<E>& n : namesOf<E>) words.emplace_back(n.name);
  return words;
}

/// A key of a table T that decides on its other keys or on their defaults.
template <class T>
struct OwnAxis {
  KeyAxis axis;
  std::function<void(T&, std::size_t)> set;  // to a value of the axis
};

template <class E, class T, class Set>
OwnAxis<T> wordAxis(const char* key, Set set) {
  return {{key, allWords<E>()}, [set](T& table, std::size_t value) { set(table, namesOf<E>[value].value); }};
}

/// The axes of a table. Most tables have none.
template <class T>
struct OwnAxes {
  static std::vector<OwnAxis<T>> of() { return {}; }
};
template <HasKind T>
struct OwnAxes<T> {
  static std::vector<OwnAxis<T>> of() {
    constexpr auto key = kindKey(static_cast<const T*>(nullptr));
    return {wordAxis<KindOf<T>, T>(key.name.data(), [](T& table, KindOf<T> kind) { table.*(key.member) = kind; })};
  }
};
template <>
struct OwnAxes<MethodSettings> {
  static std::vector<OwnAxis<MethodSettings>> of() {
    return {wordAxis<SchemeKind, MethodSettings>("scheme", [](MethodSettings& m, SchemeKind scheme) {
      const MethodKind kind = m.kind;
      m = defaultMethod(scheme), m.kind = kind;
    })};
  }
};
template <>
struct OwnAxes<SolverSettings> {
  static std::vector<OwnAxis<SolverSettings>> of() {
    return {wordAxis<PreconditionerKind, SolverSettings>(
        "preconditioner", [](SolverSettings& s, PreconditionerKind kind) { s.preconditioner = kind; })};
  }
};
template <>
struct OwnAxes<TimeSettings> {
  static std::vector<OwnAxis<TimeSettings>> of() {
    return {{{"step", {"number", "auto"}},
             [](TimeSettings& t, std::size_t value) { t.automatic = value == 1, t.step = 0; }}};
  }
};
template <>
struct OwnAxes<Material> {
  static std::vector<OwnAxis<Material>> of() {
    return {{{"rheology", {"without", "with"}}, [](Material& m, std::size_t value) {
               m.rheology.reset();
               if (value == 1) m.rheology.emplace();
             }}};
  }
};
template <>
struct OwnAxes<Body> {
  static std::vector<OwnAxis<Body>> of() {
    return {wordAxis<BodyKind, Body>("type", [](Body& b, BodyKind kind) { b.kind = kind; }),
            wordAxis<ShapeKind, Body>("shape", [](Body& b, ShapeKind kind) { b.shape.kind = kind; }),
            {{"file_temperatures", {"false", "true"}},
             [](Body& b, std::size_t value) { b.fileTemperatures = value == 1; }}};
  }
};

/// What a table of a case is before its keys are read; false: there is no such one.
template <class T>
inline bool prepare(T&, const Case&) {
  return true;
}
inline bool prepare(MethodSettings& m, const Case& c) {
  m.kind = c.method.kind;
  return c.method.kind == MethodKind::MphI || m.scheme == SchemeKind::Accurate;
}
inline bool prepare(SolverSettings& s, const Case& c) {
  if (!keys::fits(s.preconditioner, c.method.kind)) return false;
  s = defaultSolver(c.method.kind, s.preconditioner);
  return true;
}
inline bool prepare(TimeSettings& t, const Case& c) { return !t.automatic || c.method.kind == MethodKind::MphI; }
inline bool prepare(Body& b, const Case& c) {
  return !b.fileTemperatures || (c.heat && b.kind == BodyKind::Fluid && b.shape.kind == ShapeKind::Particles);
}
inline bool prepare(Material& m, const Case& c) { return !m.rheology || c.method.kind == MethodKind::MphI; }

}  // namespace treacle
