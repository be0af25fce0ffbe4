#pragma once

#include "treacle/core/error.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace treacle {

/// One table of a case: its values are checked one by one, as a visitor of its keys, then together, by the
/// requireSound of the table.
class Checker {
 public:
  Checker(const Case& c, CasePath path) : case_(c), path_(std::move(path)) {}

  template <class Table>
  void check(const Table& table) const {
    keys::visit(*this, table, case_);
    requireSound(*this, table);
  }

  const Case& wholeCase() const { return case_; }

  /// `keys`: the way from this table.
  [[noreturn]] void fail(std::initializer_list<std::string_view> keys, const std::string& text) const {
    throw CaseError(below(keys), text);
  }

  /// Each number larger than the one before.
  void requireRising(std::string_view key, std::string_view what, const std::vector<double>& numbers) const {
    for (std::size_t k = 1; k < numbers.size(); ++k)
      if (!(numbers[k - 1] < numbers[k]))
        fail({key}, fmt::format("expected rising {}, found {} after {}", what, numbers[k], numbers[k - 1]));
  }

  /// A function of time where the run asks for it: from a time on [s].
  void requireFinite(std::initializer_list<std::string_view> keys, const std::optional<TimeFunction>& f,
                     double from = 0) const {
    constexpr int samples = 1000;
    const double end = std::max(from, case_.time.end);
    if (!f || f->expression.empty() || !std::isfinite(end)) return;
    try {
      for (int k = 0; k <= samples; ++k) f->at(from + (end - from) * k / samples);
    } catch (const InputError& e) {
      fail(keys, e.what());
    }
  }
  void requireFinite(std::initializer_list<std::string_view> keys, const TimeVector& functions) const {
    for (const auto& f : functions) requireFinite(keys, f);
  }

  /// Names stand in messages and in names of files.
  void requireName(const std::string& name) const {
    constexpr std::size_t longest = 100;
    if (name.size() > longest)
      fail({"name"}, fmt::format("expected at most {} bytes, found {}", longest, name.size()));
    for (const char c : name)
      if (static_cast<unsigned char>(c) < ' ' || c == 0x7f)
        fail({"name"}, fmt::format("expected no control characters, found one with the code {}", int{c}));
  }

  void requireDirection(std::string_view key, const Vec<3>& v) const {
    if (const double length = norm(v); length == 0 || !std::isfinite(length))
      fail({key}, fmt::format("expected a direction, found a vector of length {}", length));
  }

  void requireOrder(const Vec<3>& min, const Vec<3>& max) const {
    for (int k = 0; k < case_.dimensions; ++k)
      if (!(min[k] < max[k]))
        fail({"max"}, fmt::format("expected more than min on every axis, found {} <= {} along {}", max[k], min[k],
                                  "xyz"[k]));
  }

  void operator()(const Key&, bool) const {}
  void operator()(const Key&, const std::array<bool, 3>&) const {}
  void operator()(const Key&, const OutputFields&) const {}
  void operator()(const Key& key, double x) const { require(key.bound.holds(x), key, expectedNumber(key), x); }
  void operator()(const Key& key, int x) const { require(key.bound.holds(x), key, expectedInteger(key), x); }
  void operator()(const Key& key, const Vec<3>& x) const {
    requireVector(key, x, expectedVector(key, case_.dimensions));
  }
  void operator()(const Key&, const std::vector<std::string>&) const {}
  void operator()(const Key& key, const std::string& text) const {
    if (key.required && text.empty()) fail({key.name}, "missing; expected a string");
    if (key.name == "name") requireName(text);
  }
  void operator()(const Key& key, const std::string& text, keys::ExpressionTag) const {
    if (text.empty()) return;
    try {
      Expression{text, case_.dimensions};
    } catch (const InputError& e) {
      fail({key.name}, e.what());
    }
  }
  void operator()(const Key& key, double x, const std::string& text) const {
    (*this)(key, text, keys::expression);
    if (text.empty()) require(key.bound.holds(x), key, expectedNumber(key, false, true), x);
  }
  void operator()(const Key& key, const std::vector<double>& numbers) const {
    for (const double x : numbers) require(key.bound.holds(x), key, expectedNumbers(key), x);
  }
  void operator()(const Key&, const std::string&, keys::FormulaTag) const {}  // with its material
  void operator()(const Key& key, const std::string& path, keys::FileTag) const { (*this)(key, path); }
  void operator()(const Key& key, const std::vector<Vec<2>>& points) const {
    for (const Vec<2>& x : points)
      for (int k = 0; k < 2; ++k) require(key.bound.holds(x[k]), key, expectedPoints(key), x[k]);
  }
  void operator()(const Key& key, Vec<3> x, const std::array<std::string, 3>& texts) const {
    for (int k = 0; k < case_.dimensions; ++k) {
      const std::string& text = texts[static_cast<std::size_t>(k)];
      (*this)(key, text, keys::expression);
      if (!text.empty()) x[k] = 0;  // does not count
    }
    requireVector(key, x, expectedVector(key, case_.dimensions, true));
  }
  void operator()(const Key& key, int index, keys::MaterialTag) const {
    const std::size_t count = case_.materials.size();
    if (index < 0 || static_cast<std::size_t>(index) >= count)
      fail({key.name}, fmt::format("expected the index of one of {} materials, found {}", count, index));
  }
  void operator()(const Key& key, double x, bool isAuto, keys::OrAutoTag) const {
    if (!isAuto) require(key.bound.holds(x), key, expectedNumber(key, true), x);
  }
  template <class E, class Fits = keys::AllFit>
  requires std::is_enum_v<E>
  void operator()(const Key& key, E value, Fits fits = {}) const {
    const std::string_view word = nameOf(value);
    if (word.empty() || !fits(value)) fail({key.name}, wrongWord(wordsThat<E>(fits), word));
  }

  template <class Table>
  requires std::is_class_v<Table>
  void operator()(const Key& key, const Table& table) const { Checker(case_, below({key.name})).check(table); }
  void operator()(const Key& key, const Oscillation& oscillation) const {
    if (oscillation != Oscillation{}) Checker(case_, below({key.name})).check(oscillation);
  }
  void operator()(const Key& key, const std::optional<TimeFunction>& f) const {
    if (!f) return;
    if (f->isTable()) return requireTable(key, *f);
    if (f->expression.empty()) return require(key.bound.holds(f->value), key, expectedFunction(key), f->value);
    try {
      Expression::ofTime(f->expression);
    } catch (const InputError& e) {
      fail({key.name}, e.what());
    }
  }
  void operator()(const Key& key, const TimeVector& functions) const {
    for (const auto& f : functions) (*this)(key, f);
  }
  void operator()(const Key& key, Vec<3> x, const TimeVector& varying) const {
    (*this)(key, varying);
    for (std::size_t k = 0; k < varying.size(); ++k)
      if (varying[k]) x[static_cast<int>(k)] = 0;  // does not count
    requireVector(key, x, expectedFunction(key));
  }
  template <class Table>
  void operator()(const Key& key, const std::optional<Table>& table) const {
    if (table) (*this)(key, *table);
  }
  template <class Table>
  void operator()(const Key& key, const std::vector<Table>& tables) const {
    if (tables.empty() && key.required)
      fail({key.name}, fmt::format("missing; expected {}", expectedEntries(key)));
    if (tables.size() > key.bound.most)
      fail({key.name}, fmt::format("expected at most {}, found {}", key.bound.most, tables.size()));
    for (std::size_t k = 0; k < tables.size(); ++k) {
      const std::string& name = tables[k].name;
      if (!name.empty() && std::ranges::count(tables, name, &Table::name) > 1)
        fail({key.name}, fmt::format("two [[{}]] are named '{}'", key.name, name));
      Checker(case_, below({key.name, name.empty() ? std::to_string(k) : name})).check(tables[k]);
    }
  }

 private:
  template <class T>
  void require(bool sound, const Key& key, const std::string& expected, T found) const {
    if (!sound) fail({key.name}, mismatch(key, expected, fmt::format("{}", found)));
  }

  void requireTable(const Key& key, const TimeFunction& f) const {
    if (f.values.size() != f.times.size())
      fail({key.name},
           fmt::format("expected as many values as times, {}, found {}", f.times.size(), f.values.size()));
    for (const double x : f.values) require(key.bound.holds(x), key, expectedNumber(key), x);
    for (const double t : f.times)
      if (!std::isfinite(t)) fail({key.name}, fmt::format("expected finite times, found {}", t));
    requireRising(key.name, "times", f.times);
  }

  void requireVector(const Key& key, const Vec<3>& x, const std::string& expected) const {
    for (int k = 0; k < case_.dimensions; ++k) require(key.bound.holds(x[k]), key, expected, x[k]);
    for (int k = case_.dimensions; k < 3; ++k)
      if (x[k] != 0) fail({key.name}, fmt::format("expected 0 along {} in a plane, found {}", "xyz"[k], x[k]));
  }

  CasePath below(std::initializer_list<std::string_view> keys) const {
    CasePath path = path_;
    path.insert(path.end(), keys.begin(), keys.end());
    return path;
  }

  const Case& case_;
  CasePath path_;
};

/// What the values of a table must be together, beside what each must be by itself. Errors: CaseError.
template <class Table>
void requireSound(const Checker&, const Table&) {}
void requireSound(const Checker& at, const Domain& domain);
void requireSound(const Checker& at, const TimeSettings& time);
void requireSound(const Checker& at, const SolverSettings& solver);
void requireSound(const Checker& at, const OutputSettings& output);
void requireSound(const Checker& at, const MethodSettings& method);
void requireSound(const Checker& at, const Width& width);
void requireSound(const Checker& at, const Vent& vent);
void requireSound(const Checker& at, const Case& c);
// sound_materials.cpp
void requireSound(const Checker& at, const Rheology& rheology);
void requireSound(const Checker& at, const ViscosityShift& shift);
void requireSound(const Checker& at, const Freezing& freezing);
void requireSound(const Checker& at, const MaterialState& state);
void requireSound(const Checker& at, const Material& material);
// sound_bodies.cpp
void requireSound(const Checker& at, const Transform& transform);
void requireSound(const Checker& at, const Rotation& rotation);
void requireSound(const Checker& at, const Hinge& hinge);
void requireSound(const Checker& at, const Spring& spring);
void requireSound(const Checker& at, const Nozzle& nozzle);
void requireSound(const Checker& at, const Inflow& inflow);
void requireSound(const Checker& at, const Outflow& outflow);
void requireSound(const Checker& at, const Opening& opening);
void requireSound(const Checker& at, const Body& body);
// sound_probes.cpp
void requireSound(const Checker& at, const ProbeBox& box);
void requireSound(const Checker& at, const Probe& probe);

}  // namespace treacle
