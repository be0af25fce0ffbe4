#include "mph_files.hpp"
#include "mph_lines.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/body.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace treacle {
namespace {

class CuboidReader {
 public:
  CuboidReader(const std::string& path, std::string_view content) : lines_(path, content) { g_.path = path; }

  MphGeometry geometry() {
    while (lines_.next()) {
      const std::string key = lines_.key();
      if (key == "StartCuboid")
        readCuboid();
      else
        readDomain(key);
    }
    requireKeys(keys_, {"ParticleDistance", "LowerDomain", "UpperDomain"}, "the file");
    if (g_.cuboids.empty()) lines_.fail("the file has no cuboid; expected 'StartCuboid'");
    return std::move(g_);
  }

 private:
  void readDomain(const std::string& key) {
    requireNew(keys_, key);
    if (key == "ParticleDistance") {
      lines_.requireValues(1, key);
      g_.spacing = lines_.positive(1);
    } else if (key == "LowerDomain" || key == "UpperDomain") {
      lines_.requireValues(3, key);
      (key == "LowerDomain" ? g_.lower : g_.upper) = lines_.vector(1);
      if (keys_.contains("LowerDomain") && keys_.contains("UpperDomain"))
        requireOrder("LowerDomain", g_.lower, "UpperDomain", g_.upper);
    } else {
      lines_.fail(fmt::format(
          "expected 'ParticleDistance', 'LowerDomain', 'UpperDomain' or 'StartCuboid', found '{:.40}'", key));
    }
  }

  void readCuboid() {
    lines_.requireValues(0, "StartCuboid");
    requireKeys(keys_, {"ParticleDistance"}, "what stands before the first cuboid");
    if (g_.cuboids.size() == maxBodies)
      lines_.fail(
          fmt::format("expected at most {} cuboids, found more; the particles that are made of them (.grid) "
                      "can be imported",
                      maxBodies));
    MphCuboid cuboid;
    cuboid.line = lines_.line();
    std::set<std::string> found;
    while (true) {
      if (!lines_.next()) lines_.fail(fmt::format("the file ends in the cuboid of line {}", cuboid.line));
      const std::string key = lines_.key();
      if (key == "EndCuboid") break;
      requireNew(found, key);
      readKey(key, cuboid);
    }
    lines_.requireValues(0, "EndCuboid");
    requireKeys(found, {"Spacing", "Type", "Lower", "Upper", "Velocity"}, "the cuboid");
    requireOrder("Lower", cuboid.lower, "Upper", cuboid.upper);
    g_.cuboids.push_back(cuboid);
  }

  void readKey(const std::string& key, MphCuboid& cuboid) {
    if (key == "Spacing") {
      lines_.requireValues(1, key);
      if (const double spacing = lines_.positive(1); std::abs(spacing - g_.spacing) > 1e-9 * g_.spacing)
        lines_.fail(
            fmt::format("expected the Spacing to be the ParticleDistance, {}, found {}; the particles that "
                        "are made of the cuboids (.grid) can be imported",
                        g_.spacing, spacing));
    } else if (key == "Type") {
      lines_.requireValues(1, key);
      cuboid.type = lines_.type(1);
    } else if (key == "Lower" || key == "Upper" || key == "Velocity") {
      lines_.requireValues(3, key);
      (key == "Lower" ? cuboid.lower : key == "Upper" ? cuboid.upper : cuboid.velocity) = lines_.vector(1);
    } else {
      lines_.fail(fmt::format(
          "expected 'Spacing', 'Type', 'Lower', 'Upper', 'Velocity' or 'EndCuboid', found '{:.40}'", key));
    }
  }

  void requireNew(std::set<std::string>& keys, const std::string& key) const {
    if (!keys.insert(key).second) lines_.fail(fmt::format("'{:.40}' stands twice; expected it once", key));
  }

  void requireKeys(const std::set<std::string>& keys, std::initializer_list<const char*> expected,
                   std::string_view where) const {
    for (const char* key : expected)
      if (!keys.contains(key)) lines_.fail(fmt::format("expected '{}' in {}, which ends without it", key, where));
  }

  void requireOrder(std::string_view lowerKey, const Vec<3>& lower, std::string_view upperKey,
                    const Vec<3>& upper) const {
    for (int k = 0; k < 3; ++k)
      if (!(lower[k] < upper[k]))
        lines_.fail(fmt::format("expected the {0} of {1} to be less than that of {2}, found {3} and {4}", "xyz"[k],
                                lowerKey, upperKey, lower[k], upper[k]));
  }

  MphLines lines_;
  MphGeometry g_;
  std::set<std::string> keys_;  // outside of cuboids
};

}  // namespace

MphGeometry readMphCuboids(const std::string& path, std::string_view content) {
  return CuboidReader(path, content).geometry();
}

}  // namespace treacle
