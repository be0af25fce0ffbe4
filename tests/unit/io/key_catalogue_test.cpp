#include "case/key_catalogue.hpp"
#include "treacle/io/case/case_reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace treacle {
namespace {

const KeyTable& table(const std::vector<KeyTable>& all, const std::string& path) {
  return *std::ranges::find(all, path, &KeyTable::path);
}

std::vector<const KeyRow*> rows(const KeyTable& t, const std::string& name) {
  std::vector<const KeyRow*> found;
  for (const KeyRow& r : t.rows)
    if (r.name == name) found.push_back(&r);
  return found;
}

TEST(KeyCatalogue, EveryKeySaysWhatItIs) {
  std::size_t keys = 0;
  for (const KeyTable& t : keyCatalogue())
    for (const KeyRow& r : t.rows) {
      const std::string key = t.path + ": " + r.name;
      ++keys;
      ASSERT_GE(r.about.size(), 4u) << key;
      EXPECT_TRUE(std::isupper(static_cast<unsigned char>(r.about.front()))) << key;
      EXPECT_NE(r.about.back(), '.') << key;
      EXPECT_EQ(r.about.find('\n'), std::string::npos) << key;
    }
  EXPECT_GT(keys, 150u);
}

TEST(KeyCatalogue, HasEachTableOnce) {
  std::set<std::string> paths;
  for (const KeyTable& t : keyCatalogue()) EXPECT_TRUE(paths.insert(t.path).second) << t.path;
  for (const char* path : {"", "body", "body.rotation", "material.rheology", "probe.box", "solver.hats", "width"})
    EXPECT_TRUE(paths.contains(path)) << path;
}

/// A schema can say which keys there are by the values of the others alone, one by one.
TEST(KeyCatalogue, KeysFollowFromSingleValues) {
  for (const KeyTable& t : keyCatalogue())
    for (const KeyRow& r : t.rows) EXPECT_TRUE(t.isProduct(r.in)) << t.path << ": " << r.name;
}

TEST(KeyCatalogue, KnowsDefaultsAndWhereKeysAre) {
  const std::vector<KeyTable> all = keyCatalogue();
  const KeyTable& method = table(all, "method");
  const auto radius = rows(method, "pressure_radius");
  ASSERT_EQ(radius.size(), 1u);
  for (std::size_t v = 0; v < method.variants.size(); ++v) {
    const bool isIsph = method.variants[v][MethodAxis] == 1, isPublished = method.variants[v][CaseAxes] == 1;
    EXPECT_EQ(radius[0]->in[v], !isIsph);
    if (isIsph) continue;
    EXPECT_EQ(radius[0]->value[v], isPublished ? 1.75 : 2.5);
  }
  // Of a fluid a temperature is required, of a wall it is not, of an inflow it is no expression.
  const auto temperature = rows(table(all, "body"), "temperature");
  ASSERT_EQ(temperature.size(), 3u);
  EXPECT_TRUE(temperature[0]->required);
  EXPECT_FALSE(temperature[1]->required);
  EXPECT_EQ(temperature[2]->kind, ValueKind::Number);
}

TEST(KeyReference, NamesUnitsAndConditions) {
  const std::string page = keyReference();
  for (const char* text :
       {"| `density` | number > 0 [kg/m3] | required |  |", "| three dimensions, `shape` `\"torus\"` |",
        "| `2.5`; `scheme` `\"published\"`: `1.75` | MPH-I |", "without `rheology`"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace treacle
