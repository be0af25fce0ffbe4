#include "case_tables.hpp"

#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/kind_key.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>

namespace treacle {
namespace {

// Names of the tables. One that has none here does not compile.
constexpr const char* classOf(const Domain&) { return "Domain"; }
template <class V, class F>
constexpr const char* classOf(const keys::Gravity<V, F>&) {
  return "Gravity";
}
constexpr const char* classOf(const Width&) { return "Width"; }
constexpr const char* classOf(const TimeSettings&) { return "Time"; }
constexpr const char* classOf(const Material&) { return "Material"; }
constexpr const char* classOf(const Rheology&) { return "Rheology"; }
constexpr const char* classOf(const ContactAngle&) { return "ContactAngle"; }
constexpr const char* classOf(const Spring&) { return "Spring"; }
constexpr const char* classOf(const Hinge&) { return "Hinge"; }
constexpr const char* classOf(const ElasticMode&) { return "ElasticMode"; }
constexpr const char* classOf(const MaterialState&) { return "MaterialState"; }
constexpr const char* classOf(const Gelling&) { return "Gelling"; }
constexpr const char* classOf(const StateStart&) { return "StateStart"; }
constexpr const char* classOf(const ViscosityShift&) { return "ViscosityShift"; }
constexpr const char* classOf(const Freezing&) { return "Freezing"; }
constexpr const char* classOf(const Body&) { return "Body"; }
constexpr const char* classOf(const Oscillation&) { return "Oscillation"; }
constexpr const char* classOf(const Rotation&) { return "Rotation"; }
constexpr const char* classOf(const Transform&) { return "Transform"; }
constexpr const char* classOf(const Nozzle&) { return "Nozzle"; }
constexpr const char* classOf(const Outflow&) { return "Outflow"; }
constexpr const char* classOf(const Opening&) { return "Opening"; }
constexpr const char* classOf(const MethodSettings&) { return "Method"; }
constexpr const char* classOf(const RheologySettings&) { return "RheologyIteration"; }
constexpr const char* classOf(const HeatSettings&) { return "Heat"; }
constexpr const char* classOf(const GasSettings&) { return "Gas"; }
constexpr const char* classOf(const Vent&) { return "Vent"; }
constexpr const char* classOf(const SolverSettings&) { return "Solver"; }
constexpr const char* classOf(const MultigridSettings&) { return "Multigrid"; }
constexpr const char* classOf(const ProjectedSettings&) { return "Projected"; }
constexpr const char* classOf(const CellSettings&) { return "Cells"; }
constexpr const char* classOf(const HatSettings&) { return "Hats"; }
constexpr const char* classOf(const OutputSettings&) { return "Output"; }
constexpr const char* classOf(const Probe&) { return "Probe"; }
constexpr const char* classOf(const ProbeBox&) { return "ProbeBox"; }
constexpr const char* classOf(const WatchSettings&) { return "Watch"; }

/// Calls f with a table of each kind that has keys of its own.
template <class Table, class F>
void forEachKind(const Table& table, F&& f) {
  f(table);
}
template <class E, class Table, class Set, class F>
void forEachWord(Table table, Set set, F&& f) {
  for (const Named<E>& kind : namesOf<E>) {
    set(table, kind.value);
    f(table);
  }
}
template <HasKind Table, class F>
void forEachKind(const Table& table, F&& f) {
  constexpr auto key = kindKey(static_cast<const Table*>(nullptr));
  forEachWord<KindOf<Table>>(
      table, [](Table& t, KindOf<Table> kind) { t.*(key.member) = kind; }, f);
}
template <class F>
void forEachKind(const Body& body, F&& f) {
  forEachWord<BodyKind>(
      body, [](Body& b, BodyKind kind) { b.kind = kind; },
      [&](const Body& ofKind) {
        forEachWord<ShapeKind>(
            ofKind, [](Body& b, ShapeKind kind) { b.shape.kind = kind; }, f);
      });
}
template <class F>
void forEachKind(const Material& material, F&& f) {
  f(material);
  Material other = material;
  other.rheology.emplace();
  f(other);
}
template <class F>
void forEachKind(const TimeSettings& time, F&& f) {
  f(time);
  TimeSettings other = time;
  other.automatic = true;
  f(other);
}

/// Cases that differ in what decides on keys.
std::vector<Case> casesOfAllKinds() {
  std::vector<Case> cases;
  for (const int dimensions : {2, 3})
    for (const Named<MethodKind>& method : namesOf<MethodKind>)
      for (const bool heat : {false, true}) {
        if (heat && method.value != MethodKind::MphI) continue;
        Case c;
        c.dimensions = dimensions;
        c.method.kind = method.value;
        if (heat) c.heat.emplace();
        cases.push_back(c);
      }
  return cases;
}

/// Collects the tables, as a visitor of their keys.
class Collector {
 public:
  explicit Collector(std::vector<CaseTable>& tables) : tables_(tables) {}

  template <class Table>
  void collect(const Table& table, const char* name) {
    CaseTable found{name, {}};
    for (const Case& c : casesOfAllKinds())
      forEachKind(table, [&](const Table& ofKind) {
        Collector inside(tables_);
        inside.found_ = &found;
        keys::visit(inside, ofKind, c);
      });
    const auto known = std::ranges::find(tables_, found.name, &CaseTable::name);
    if (known == tables_.end()) tables_.push_back(std::move(found));
  }
  void collectCase() {
    CaseTable found{"Case", {{"base", "str", ""}}};
    for (const Case& c : casesOfAllKinds()) {
      Case withHeat = c;
      if (c.method.kind == MethodKind::MphI) withHeat.heat.emplace();
      Collector inside(tables_);
      inside.found_ = &found;
      keys::visit(inside, withHeat, withHeat);
      inside({"width", "What is made wider"}, std::optional<Width>());
    }
    tables_.push_back(std::move(found));
  }

  void operator()(const Key& key, double) { put(key, "float"); }
  void operator()(const Key& key, int) { put(key, "int"); }
  void operator()(const Key& key, bool) { put(key, "bool"); }
  void operator()(const Key& key, const std::array<bool, 3>&) { put(key, "bool | Sequence[bool]"); }
  void operator()(const Key& key, const Vec<3>&) { put(key, "Sequence[float]"); }
  void operator()(const Key& key, const Vec<3>&, const std::array<std::string, 3>&) {
    put(key, "Sequence[float | str]");
  }
  void operator()(const Key& key, double, const std::string&) { put(key, "float | str"); }
  void operator()(const Key& key, const std::vector<double>&) { put(key, "Sequence[float]"); }
  void operator()(const Key& key, const std::vector<Vec<2>>&) { put(key, "Sequence[Sequence[float]]"); }
  void operator()(const Key& key, const std::vector<std::string>&) { put(key, "Sequence[str]"); }
  void operator()(const Key& key, const std::string&) { put(key, "str"); }
  void operator()(const Key& key, const std::string&, keys::FileTag) { put(key, "str | PathLike[str]"); }
  void operator()(const Key& key, const std::string&, keys::FormulaTag) { put(key, "str"); }
  void operator()(const Key& key, const std::string&, keys::ExpressionTag) { put(key, "str"); }
  void operator()(const Key& key, int, keys::MaterialTag) { put(key, "str"); }
  void operator()(const Key& key, double, bool, keys::OrAutoTag) { put(key, "float | Literal[\"auto\"]"); }
  void operator()(const Key& key, const OutputFields&) {
    std::vector<std::string_view> words;
    for (const OutputFieldName& f : outputFieldNames) words.push_back(f.name);
    put(key, "Sequence[" + literal(words) + "]");
  }
  void operator()(const Key& key, const std::optional<TimeFunction>&) { put(key, function); }
  void operator()(const Key& key, const TimeVector&) { put(key, fmt::format("Sequence[{}]", function)); }
  void operator()(const Key& key, const Vec<3>&, const TimeVector&) {
    put(key, fmt::format("Sequence[{}]", function));
  }
  template <class E>
  requires std::is_enum_v<E>
  void operator()(const Key& key, E, auto&&...) { put(key, literal(wordsThat<E>(keys::AllFit{}))); }

  template <class Table>
  requires std::is_class_v<Table>
  void operator()(const Key& key, const Table& table) {
    if (put(key, classOf(table))) collect(table, classOf(table));
  }
  template <class Table>
  void operator()(const Key& key, const std::optional<Table>&) {
    (*this)(key, Table{});
  }
  template <class Table>
  void operator()(const Key& key, const std::vector<Table>&) {
    if (put(key, fmt::format("Sequence[{}]", classOf(Table{})))) collect(Table{}, classOf(Table{}));
  }

 private:
  static constexpr const char* function = "float | str | TimeTable";

  static std::string literal(const std::vector<std::string_view>& words) {
    return fmt::format("Literal[\"{}\"]", fmt::join(words, "\", \""));
  }

  /// Whether it is new. Kinds may give a key different types: it then has all of them.
  bool put(const Key& key, const std::string& type) {
    const auto known = std::ranges::find(found_->keys, key.name, &TableKey::name);
    if (known == found_->keys.end()) {
      found_->keys.push_back({std::string(key.name), type, std::string(key.unit)});
      return true;
    }
    const auto add = [](std::string& all, const std::string& one, const char* between) {
      if (one.empty() || all.find(one) != all.npos) return;
      all += all.empty() ? one : between + one;
    };
    add(known->type, type, " | ");
    add(known->unit, std::string(key.unit), " or ");
    return false;
  }

  std::vector<CaseTable>& tables_;
  CaseTable* found_ = nullptr;
};

}  // namespace

std::vector<CaseTable> caseTables() {
  std::vector<CaseTable> tables;
  Collector(tables).collectCase();
  return tables;
}

}  // namespace treacle
