#include "mph_files.hpp"
#include "mph_lines.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace treacle {
namespace {

/// Rows without which nothing can be computed.
constexpr std::string_view requiredRows[] = {"Dt",      "EndTime",     "RadiusRatioP",  "RadiusRatioV",
                                             "Density", "BulkModulus", "BulkViscosity", "ShearViscosity",
                                             "Gravity"};

class ParameterReader {
 public:
  ParameterReader(const std::string& path, std::string_view content) : lines_(path, content) { p_.path = path; }

  MphParameters parameters() {
    while (lines_.next()) {
      const std::string key = lines_.key();
      const auto [entry, isNew] = p_.lines.try_emplace(key, lines_.line());
      if (!isNew)
        lines_.fail(fmt::format("{} stands twice, first in line {}; expected it once", key, entry->second));
      if (!readNumber(key) && !readType(key) && !readVector(key) && !readWall(key)) {
        p_.lines.erase(entry);
        p_.warnings.push_back(fmt::format("{}:{}: '{:.40}' is not a row that is known, and is left out", p_.path,
                                          lines_.line(), key));
      }
    }
    std::string missing;
    for (const std::string_view row : requiredRows)
      if (!p_.lines.contains(std::string(row))) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", row);
    if (!missing.empty())
      lines_.fail(fmt::format("the file ends without the row{} {}; expected a file of parameters (.data) with {}",
                              missing.find(',') == missing.npos ? "" : "s", missing,
                              fmt::join(requiredRows, ", ")));
    return std::move(p_);
  }

 private:
  bool readNumber(const std::string& key) {
    const std::pair<std::string_view, double*> positive[] = {{"Dt", &p_.step},
                                                             {"EndTime", &p_.end},
                                                             {"RadiusRatioP", &p_.pressureRatio},
                                                             {"RadiusRatioV", &p_.viscosityRatio}};
    const std::pair<std::string_view, double*> others[] = {{"OutputInterval", &p_.profileInterval},
                                                           {"VtkOutputInterval", &p_.pictureInterval},
                                                           {"RadiusRatioA", &ignored_}};
    for (const auto& [name, value] : positive)
      if (key == name) return lines_.requireValues(1, key), *value = lines_.positive(1), true;
    for (const auto& [name, value] : others)
      if (key == name) return lines_.requireValues(1, key), *value = notNegative(1), true;
    return false;
  }

  bool readType(const std::string& key) {
    const std::pair<std::string_view, double MphType::*> constants[] = {
        {"Density", &MphType::density},
        {"BulkModulus", &MphType::bulkModulus},
        {"BulkViscosity", &MphType::bulkViscosity},
        {"ShearViscosity", &MphType::shearViscosity}};
    for (const auto& [name, member] : constants) {
      if (key != name) continue;
      requireTypes(key);
      for (std::size_t k = 0; k < mphTypes; ++k) p_.types[k].*member = notNegative(k + 1);
      return true;
    }
    if (key == "SurfaceTension") {
      requireTypes(key);
      for (std::size_t k = 0; k < mphTypes; ++k) p_.types[k].surfaceTension = lines_.number(k + 1);
      return true;
    }
    for (std::size_t type = 0; type < mphTypes; ++type)
      if (key == fmt::format("InteractionRatio(Type{})", type)) {
        requireTypes(key);
        for (std::size_t k = 0; k < mphTypes; ++k) p_.types[type].interactionRatio[k] = lines_.number(k + 1);
        return true;
      }
    return false;
  }

  bool readVector(const std::string& key) {
    if (key != "Gravity") return false;
    lines_.requireValues(3, key);
    p_.gravity = lines_.vector(1);
    return true;
  }

  bool readWall(const std::string& key) {
    for (std::size_t k = 0; k < p_.walls.size(); ++k) {
      if (key != fmt::format("Wall{}", k + firstMphWall)) continue;
      const auto& words = lines_.words();
      if (words.size() != 13 || words[1] != "Center" || words[5] != "Velocity" || words[9] != "Omega")
        lines_.fail(fmt::format(
            "{}: expected 'Center' with 3 numbers, 'Velocity' with 3 and 'Omega' with 3, in this order", key));
      p_.walls[k] = {lines_.vector(2), lines_.vector(6), lines_.vector(10)};
      return true;
    }
    return false;
  }

  void requireTypes(const std::string& key) const {
    if (const std::size_t found = lines_.words().size() - 1; found != mphTypes)
      lines_.fail(fmt::format("{}: expected {} numbers, one for each of the types 0 to {}, found {}", key,
                              mphTypes, mphTypes - 1, found));
  }

  double notNegative(std::size_t word) const {
    const double x = lines_.number(word);
    if (x < 0) lines_.fail(fmt::format("expected a number that is not negative, found {}", x));
    return x;
  }

  MphLines lines_;
  MphParameters p_;
  double ignored_ = 0;
};

}  // namespace

MphParameters readMphParameters(const std::string& path, std::string_view content) {
  return ParameterReader(path, content).parameters();
}

}  // namespace treacle
