#include "key_catalogue.hpp"
#include "treacle/io/case/case_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

namespace treacle {
namespace {

using json = nlohmann::ordered_json;

/// A case as far as the keys of its tables follow from it: the values on the axes of the case. None: nothing is
/// known, as in a file that changes another one.
using Situation = std::optional<std::array<std::size_t, CaseAxes>>;

json stringOf() { return {{"type", "string"}, {"minLength", 1}}; }

json numberOf(const Bound& b) {
  json schema{{"type", "number"}};
  if (std::isfinite(b.least)) schema[b.open ? "exclusiveMinimum" : "minimum"] = b.least;
  if (std::isfinite(b.most)) schema[b.open ? "exclusiveMaximum" : "maximum"] = b.most;
  return schema;
}

json anyOf(const std::vector<json>& schemas) {
  return schemas.size() == 1 ? schemas.front() : json{{"anyOf", schemas}};
}

json arrayOf(const json& items, int least, int most) {
  return {{"type", "array"}, {"items", items}, {"minItems", least}, {"maxItems", most}};
}

json timeFunction(const Bound& bound) {
  json table{{"type", "object"}, {"additionalProperties", false}};
  const json numbers{{"type", "array"}, {"items", json{{"type", "number"}}}, {"minItems", 1}};
  table["properties"] = {{"times", numbers}, {"values", numbers}, {"file", stringOf()}, {"column", stringOf()}};
  table["oneOf"] = {json{{"required", {"times", "values"}}}, json{{"required", json::array({"file"})}}};
  return anyOf({numberOf(bound), stringOf(), table});
}

/// Makes the schema of all tables, each a definition.
class Schema {
 public:
  Schema() : tables_(keyCatalogue()) {}

  json document() {
    json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                {"title", "Case file of treacle"},
                {"description", "SI units"},
                {"type", "object"},
                {"additionalProperties", false}};
    const json open = tableSchema(table(""), {});
    schema["properties"] = open["properties"];
    json cases = json::array();
    for (const Situation& s : situations()) cases.push_back({{"if", conditionOf(*s)}, {"then", reference("", s)}});
    const json isWhole{{"not", json{{"required", json::array({"base"})}}}};
    schema["if"] = isWhole;
    schema["then"] = {{"required", requiredEverywhere(table(""))}, {"allOf", cases}};
    schema["definitions"] = definitions_;
    return schema;
  }

 private:
  const KeyTable& table(const std::string& path) const {
    return *std::ranges::find(tables_, path, &KeyTable::path);
  }

  std::vector<Situation> situations() const {
    std::vector<Situation> found;
    for (const std::vector<std::size_t>& v : table("").variants) found.push_back({{v[0], v[1], v[2]}});
    return found;
  }

  static std::vector<std::string> requiredEverywhere(const KeyTable& t) {
    std::vector<std::string> names;
    for (const KeyRow& r : t.rows)
      if (r.required && std::ranges::find(r.in, false) == r.in.end()) names.push_back(r.name);
    return names;
  }

  /// The condition for a whole case file.
  static json conditionOf(const std::array<std::size_t, CaseAxes>& s) {
    const json dimensions{{"properties", {{"dimensions", {{"const", s[DimensionsAxis] + 2}}}}},
                          {"required", json::array({"dimensions"})}};
    json isIsph{{"properties",
                 {{"method",
                   {{"type", "object"},
                    {"properties", {{"name", {{"const", "isph"}}}}},
                    {"required", json::array({"name"})}}}}},
                {"required", json::array({"method"})}};
    if (s[MethodAxis] == 1) return {{"allOf", {dimensions, isIsph}}};
    json hasHeat{{"required", json::array({"heat"})}};
    if (s[HeatAxis] == 0) hasHeat = {{"not", hasHeat}};
    return {{"allOf", {dimensions, json{{"not", isIsph}}, hasHeat}}};
  }

  /// A definition of the table, shared by the situations in which it is the same.
  json reference(const std::string& path, const Situation& s) {
    json definition = tableSchema(table(path), s);
    const std::string content = path + definition.dump();
    const auto [known, isNew] = names_.try_emplace(content, path.empty() ? "case" : path);
    if (isNew) {
      if (const int number = ++numbers_[path]; number > 1) known->second += fmt::format("-{}", number);
      definitions_[known->second] = std::move(definition);
    }
    return {{"$ref", "#/definitions/" + known->second}};
  }

  json valueSchema(const KeyRow& r, const Situation& s) {
    const int least = s ? static_cast<int>((*s)[DimensionsAxis]) + 2 : 2, most = s ? least : 3;
    switch (r.kind) {
      case ValueKind::Number:
        return numberOf(r.bound);
      case ValueKind::NumberOrAuto:
        return anyOf({numberOf(r.bound), json{{"const", "auto"}}});
      case ValueKind::NumberOrFormula:
        return anyOf({numberOf(r.bound), stringOf()});
      case ValueKind::Numbers:
        return {{"type", "array"}, {"items", numberOf(r.bound)}};
      case ValueKind::Integer: {
        json schema = numberOf(r.bound);
        schema["type"] = "integer";
        return schema;
      }
      case ValueKind::Flag:
        return {{"type", "boolean"}};
      case ValueKind::Flags:
        return anyOf({json{{"type", "boolean"}}, arrayOf({{"type", "boolean"}}, least, most)});
      case ValueKind::Vector:
        return arrayOf(numberOf(r.bound), least, most);
      case ValueKind::VectorOrFormulas:
        return arrayOf(anyOf({numberOf(r.bound), stringOf()}), least, most);
      case ValueKind::Points:
        return {{"type", "array"}, {"items", arrayOf(numberOf(r.bound), 2, 2)}, {"minItems", 3}};
      case ValueKind::Text:
        return {{"type", "string"}};
      case ValueKind::Names:
        return {{"type", "array"}, {"items", stringOf()}};
      case ValueKind::File:
      case ValueKind::Formula:
      case ValueKind::MaterialName:
        return stringOf();
      case ValueKind::Word:
        return {{"enum", r.words}};
      case ValueKind::Fields:
        return {{"type", "array"}, {"items", json{{"enum", r.words}}}};
      case ValueKind::OfTime:
        return timeFunction(r.bound);
      case ValueKind::VectorOfTime:
        return arrayOf(timeFunction(r.bound), least, most);
      case ValueKind::Table:
        return reference(r.table, s);
      case ValueKind::Tables:
        break;
    }
    return arrayOf(reference(r.table, s), static_cast<int>(r.bound.least), static_cast<int>(r.bound.most));
  }

  /// With description, unit and default, for editors.
  json describedSchema(const KeyRow& r) {
    json schema = valueSchema(r, {});
    if (r.kind == ValueKind::Table) return schema;  // nothing may stand beside a $ref
    schema["description"] = r.about + (r.unit.empty() ? "" : fmt::format(" [{}]", r.unit));
    std::optional<nlohmann::json> value;
    for (std::size_t v = 0; v < r.in.size(); ++v)
      if (r.in[v] && value && *value != r.value[v])
        return schema;
      else if (r.in[v])
        value = r.value[v];
    if (value && !value->is_null()) schema["default"] = *value;
    return schema;
  }

  /// What is in one situation, without what the keys of the table say about each other: all keys of its variants.
  json tableSchema(const KeyTable& t, const Situation& s) {
    json schema{{"type", "object"}};
    if (!t.about.empty()) schema["description"] = t.about;
    schema["additionalProperties"] = false;
    json properties = json::object();
    std::vector<KeyRow> rows;
    for (KeyRow row : t.rows) {
      for (std::size_t v = 0; v < row.in.size(); ++v)
        for (std::size_t a = 0; s && a < CaseAxes; ++a)
          if (t.variants[v][a] != (*s)[a]) row.in[v] = false;
      if (std::ranges::find(row.in, true) != row.in.end()) rows.push_back(row);
    }
    for (const KeyRow& r : rows) {
      if (properties.contains(r.name)) continue;
      std::vector<json> schemas;
      for (const KeyRow& other : rows)
        if (other.name == r.name)
          if (json one = s ? valueSchema(other, s) : describedSchema(other);
              std::ranges::find(schemas, one) == schemas.end())
            schemas.push_back(std::move(one));
      properties[r.name] = anyOf(schemas);
    }
    schema["properties"] = properties;
    if (s)
      addConditions(schema, t, *s, rows);
    else if (t.isList)
      schema["required"] = json::array({"name"});
    return schema;
  }

  /// Whether a key of the table has one of some values.
  static json keyIs(const KeyTable& t, std::size_t axis, const std::vector<bool>& marked) {
    const KeyAxis& a = t.axes[axis];
    if (a.values.front() == "without") {
      const json there{{"required", json::array({a.name})}};
      return marked[1] ? there : json{{"not", there}};
    }
    std::vector<std::string> words;
    for (std::size_t k = 0; k < marked.size(); ++k)
      if (marked[k]) words.push_back(a.values[k]);
    json is{{"properties", {{a.name, {{"enum", words}}}}}, {"required", json::array({a.name})}};
    if (a.values.front() == "number") is["properties"][a.name] = {{"const", "auto"}};
    if (a.values.front() == "false") is["properties"][a.name] = {{"const", true}};
    const bool isDefault = a.values.front() == "number" || a.values.front() == "false";
    return isDefault && marked[0] ? json{{"not", is}} : is;
  }

  /// Which keys are required, are not there, or are something else, by other keys of the same table.
  static void addRule(json& rules, const json& condition, const char* what, const std::string& name,
                      const json& value) {
    for (json& rule : rules)
      if (rule["if"] == condition) {
        if (value.is_null())
          rule["then"][what].push_back(name);
        else
          rule["then"][what][name] = value;
        return;
      }
    json then = value.is_null() ? json{{what, json::array({name})}} : json{{what, {{name, value}}}};
    rules.push_back({{"if", condition}, {"then", std::move(then)}});
  }

  void addConditions(json& schema, const KeyTable& t, const std::array<std::size_t, CaseAxes>& s,
                     const std::vector<KeyRow>& rows) {
    std::vector<bool> all(t.variants.size(), true);
    for (std::size_t v = 0; v < all.size(); ++v)
      for (std::size_t a = 0; a < CaseAxes; ++a) all[v] = all[v] && t.variants[v][a] == s[a];
    json rules = json::array();
    std::vector<std::string> required;
    for (const KeyRow& r : rows) {
      if (!t.isProduct(r.in)) throw std::logic_error(fmt::format("{}.{}: keys without a rule", t.path, r.name));
      std::vector<bool> anywhere(all.size());
      bool several = false;
      for (const KeyRow& other : rows) {
        if (other.name != r.name) continue;
        several = several || valueSchema(other, {s}) != valueSchema(r, {s});
        for (std::size_t v = 0; v < all.size(); ++v) anywhere[v] = anywhere[v] || other.in[v];
      }
      json where = json::array();
      for (std::size_t a = CaseAxes; a < t.axes.size(); ++a) {
        const std::vector<bool> possible = t.valuesOf(all, a), has = t.valuesOf(anywhere, a);
        if (const std::vector<bool> own = t.valuesOf(r.in, a); own != possible) where.push_back(keyIs(t, a, own));
        std::vector<bool> without(has.size());
        for (std::size_t k = 0; k < has.size(); ++k) without[k] = possible[k] && !has[k];
        for (std::size_t k = 0; k < has.size(); ++k) {
          std::vector<bool> one(has.size());
          one[k] = without[k];
          if (one[k]) addRule(rules, keyIs(t, a, one), "properties", r.name, false);
        }
      }
      if (where.empty()) {
        if (r.required) required.push_back(r.name);
        continue;
      }
      const json condition = where.size() == 1 ? where[0] : json{{"allOf", where}};
      if (r.required) addRule(rules, condition, "required", r.name, {});
      if (several) addRule(rules, condition, "properties", r.name, valueSchema(r, {s}));
    }
    if (!required.empty()) schema["required"] = required;
    if (!rules.empty()) schema["allOf"] = rules;
  }

  std::vector<KeyTable> tables_;
  json definitions_ = json::object();
  std::map<std::string, std::string> names_;  // of definitions, by path and content
  std::map<std::string, int> numbers_;        // of definitions of a table so far
};

}  // namespace

std::string caseSchema() { return Schema().document().dump(1) + '\n'; }

}  // namespace treacle
