#include "treacle/io/compare/compare_sets.hpp"

#include "nearest_points.hpp"
#include "picture/box.hpp"
#include "relative.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace treacle {
namespace {

double sizeOf(double value) { return std::abs(value); }
double sizeOf(const Vec<3>& value) { return norm(value); }

struct Magnitudes {
  double mean = 0, rms = 0, maximum = 0;
};

/// The magnitudes of size(k) for k in [0, count), count > 0.
template <class Size>
Magnitudes magnitudes(std::size_t count, Size size) {
  Magnitudes m;
  double squares = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = size(k);
    m.mean += x;
    squares += x * x;
    m.maximum = std::max(m.maximum, x);
  }
  m.mean /= static_cast<double>(count);
  m.rms = std::sqrt(squares / static_cast<double>(count));
  if (!std::isfinite(m.rms)) m.maximum = m.rms;  // std::max passes over what is not a number
  return m;
}

template <class T>
Magnitudes magnitudes(const std::vector<T>& values) {
  return magnitudes(values.size(), [&](std::size_t k) { return sizeOf(values[k]); });
}

Vec<3> meanOf(const std::vector<Vec<3>>& values) {
  Vec<3> sum{};
  for (const Vec<3>& value : values) sum += value;
  return sum * (1 / static_cast<double>(values.size()));
}

void requireComparable(const Frame& a, const Frame& b) {
  if (a.dimensions != b.dimensions)
    throw InputError(fmt::format("{} and {} dimensions", a.dimensions, b.dimensions));
  for (const Frame* frame : {&a, &b}) {
    if (frame->position.empty()) throw InputError("no particles in one of them");
    for (const Vec<3>& x : frame->position)
      if (!std::isfinite(norm2(x))) throw InputError("a position is not finite");
  }
}

class SetComparison {
 public:
  SetComparison(const Frame& a, const Frame& b, const Case& reference)
      : a_(a),
        b_(b),
        domain_(reference.domain),
        longestSide_(boundsOf(b.position, reference.spacing / 2).longestSide()) {}

  SetDifference result() {
    const double countA = static_cast<double>(a_.position.size()),
                 countB = static_cast<double>(b_.position.size());
    add("particles", "", countA, countB, countB);
    addPlaces();
    if (hold(&Frame::velocity)) addMotion();
    addDistances();
    d_.nearest.time = b_.time;
    d_.nearest.fields[1] = addField("velocity", "m/s", &Frame::velocity);
    d_.nearest.fields[2] = addField("pressure", "Pa", &Frame::pressure);
    d_.nearest.fields[3] = addField("number_density", "", &Frame::numberDensity);
    d_.nearest.fields[4] = addField("nearest_distance", "", &Frame::nearestDistance);
    return std::move(d_);
  }

 private:
  void add(std::string name, std::string unit, double a, double b, double scale) {
    d_.measures.push_back({std::move(name), std::move(unit), a, b, std::abs(a - b), relativeTo(scale, a - b)});
  }

  /// Adds the components along every axis, or along those that are not periodic.
  void addVector(const std::string& name, const std::string& unit, const Vec<3>& a, const Vec<3>& b, double scale,
                 bool periodicToo) {
    for (int k = 0; k < b_.dimensions; ++k)
      if (periodicToo || !domain_.periodic[k]) add(name + "_" + "xyz"[k], unit, a[k], b[k], scale);
  }

  void addPlaces() {
    const Box boxA = boundsOf(a_.position, 0), boxB = boundsOf(b_.position, 0);
    addVector("min", "m", boxA.min, boxB.min, longestSide_, false);
    addVector("max", "m", boxA.max, boxB.max, longestSide_, false);
    addVector("center", "m", meanOf(a_.position), meanOf(b_.position), longestSide_, false);
  }

  void addMotion() {
    const double speedA = magnitudes(a_.velocity).rms, speedB = magnitudes(b_.velocity).rms;
    addVector("mean_velocity", "m/s", meanOf(a_.velocity), meanOf(b_.velocity), speedB, true);
    const double energyA = speedA * speedA / 2, energyB = speedB * speedB / 2;
    add("kinetic_energy", "J/kg", energyA, energyB, energyB);
  }

  void addDistances() {
    nearestInB_ = nearestPoints(a_.position, b_.position, domain_);
    const Magnitudes a = distances(nearestInB_), b = distances(nearestPoints(b_.position, a_.position, domain_));
    const auto addBoth = [&](const char* name, double fromA, double fromB) {
      d_.measures.push_back({fmt::format("nearest_{}", name), "m", fromA, fromB, std::nullopt,
                             relativeTo(longestSide_, std::max(fromA, fromB))});
    };
    addBoth("mean", a.mean, b.mean), addBoth("rms", a.rms, b.rms), addBoth("max", a.maximum, b.maximum);
    const double rms = std::max(a.rms, b.rms);
    d_.nearest.fields[0] = {std::max(a.maximum, b.maximum), rms, relativeTo(longestSide_, rms)};
  }

  static Magnitudes distances(const std::vector<NearestPoint>& nearest) {
    return magnitudes(nearest.size(), [&](std::size_t k) { return std::sqrt(nearest[k].distance2); });
  }

  template <class T>
  bool hold(std::vector<T> Frame::*field) const {
    return (a_.*field).size() == a_.position.size() && (b_.*field).size() == b_.position.size();
  }

  /// Its measures are rms and maximum.
  template <class T>
  std::optional<FieldDifference> addField(const std::string& name, const std::string& unit,
                                          std::vector<T> Frame::*field) {
    if (!hold(field)) return std::nullopt;
    const auto &x = a_.*field, &y = b_.*field;
    const Magnitudes ofA = magnitudes(x), ofB = magnitudes(y);
    const Magnitudes between =
        magnitudes(x.size(), [&](std::size_t k) { return sizeOf(x[k] - y[nearestInB_[k].index]); });
    const double relative = relativeTo(ofB.rms, between.rms);
    d_.measures.push_back({name + "_rms", unit, ofA.rms, ofB.rms, between.rms, relative});
    d_.measures.push_back({name + "_max", unit, ofA.maximum, ofB.maximum, between.maximum, std::nullopt});
    return FieldDifference{between.maximum, between.rms, relative};
  }

  const Frame &a_, &b_;
  const Domain& domain_;
  double longestSide_;  // of b [m]
  std::vector<NearestPoint> nearestInB_;
  SetDifference d_;
};

}  // namespace

SetDifference compareSets(const Frame& a, const Frame& b, const Case& reference) {
  requireComparable(a, b);
  return SetComparison(a, b, reference).result();
}

void writeSetMeasures(const std::filesystem::path& path, std::span<const SetMeasure> measures) {
  std::string text = "measure,unit,a,b,difference,relative\n";
  for (const SetMeasure& m : measures) {
    text += m.name + ',' + m.unit;
    for (const auto& value : {m.a, m.b, m.difference, m.relative})
      text += value ? fmt::format(",{}", *value) : std::string(",");
    text += '\n';
  }
  writeFile(path, text);
}

}  // namespace treacle
