#include "key_catalogue.hpp"

#include "key_axes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace treacle {
namespace {

/// Goes over the keys of one table in all of its variants.
class Catalogue {
 public:
  template <class T>
  void describe(const std::string& path, std::string_view about, bool isList, const T& sample) {
    const std::size_t place = tables_.size();
    if (std::ranges::find(tables_, path, &KeyTable::path) != tables_.end()) return;
    const std::vector<OwnAxis<T>> own = OwnAxes<T>::of();
    KeyTable& made = tables_.emplace_back();
    made.path = path, made.about = about, made.isList = isList;
    made.axes = {{"dimensions", {"2", "3"}}, {"method", allWords<MethodKind>()}, {"heat", {"without", "with"}}};
    for (const OwnAxis<T>& axis : own) made.axes.push_back(axis.axis);
    for (std::vector<std::size_t> at(made.axes.size()); !at.empty(); at = next(tables_[place].axes, at)) {
      Case c;
      c.dimensions = at[DimensionsAxis] == 0 ? 2 : 3;
      c.method.kind = namesOf<MethodKind>[at[MethodAxis]].value;
      if (at[HeatAxis] == 1) c.heat.emplace();
      if (c.heat && c.method.kind != MethodKind::MphI) continue;
      T table = sample;
      for (std::size_t k = 0; k < own.size(); ++k) own[k].set(table, at[CaseAxes + k]);
      if (!prepare(table, c)) continue;
      tables_[place].variants.push_back(at);
      Visitor visitor{*this, place, c.dimensions};
      keys::visit(visitor, std::as_const(table), c);
      if constexpr (std::is_same_v<T, Case>) {
        visitor(keys::baseKey, std::string(), keys::file);
        visitor(keys::widthKey, std::optional<Width>());
      }
    }
  }

  std::vector<KeyTable> take() && {
    for (KeyTable& t : tables_)
      for (KeyRow& row : t.rows) row.in.resize(t.variants.size()), row.value.resize(t.variants.size());
    return std::move(tables_);
  }

 private:
  /// The next variant, the last axis first; empty after the last one.
  static std::vector<std::size_t> next(const std::vector<KeyAxis>& axes, std::vector<std::size_t> at) {
    for (std::size_t k = axes.size(); k-- > 0;) {
      if (++at[k] < axes[k].values.size()) return at;
      at[k] = 0;
    }
    return {};
  }

  /// Notes each key that it is called for.
  struct Visitor {
    Catalogue& all;
    std::size_t place;
    int dimensions;

    void operator()(const Key& key, double x) { note(key, ValueKind::Number, ifHeld(key, x)); }
    void operator()(const Key& key, int x) {
      note(key, ValueKind::Integer, key.bound.holds(x) ? nlohmann::json(x) : nlohmann::json());
    }
    void operator()(const Key& key, bool flag) { note(key, ValueKind::Flag, flag); }
    void operator()(const Key& key, const std::array<bool, 3>& flags) { note(key, ValueKind::Flags, flags[0]); }
    void operator()(const Key& key, const Vec<3>& x) { note(key, ValueKind::Vector, vector(x)); }
    void operator()(const Key& key, const Vec<3>& x, const std::array<std::string, 3>&) {
      note(key, ValueKind::VectorOrFormulas, vector(x));
    }
    void operator()(const Key& key, double x, const std::string&) {
      note(key, ValueKind::NumberOrFormula, ifHeld(key, x));
    }
    void operator()(const Key& key, const std::vector<double>&) { note(key, ValueKind::Numbers); }
    void operator()(const Key& key, const std::vector<Vec<2>>&) { note(key, ValueKind::Points); }
    void operator()(const Key& key, const std::vector<std::string>&) { note(key, ValueKind::Names); }
    void operator()(const Key& key, const std::string& text) { note(key, ValueKind::Text, text); }
    void operator()(const Key& key, const std::string&, keys::FileTag) { note(key, ValueKind::File); }
    void operator()(const Key& key, const std::string&, keys::ExpressionTag) { note(key, ValueKind::Formula); }
    void operator()(const Key& key, const std::string& text, keys::FormulaTag) {
      note(key, ValueKind::Text, text);
    }
    void operator()(const Key& key, int, keys::MaterialTag) { note(key, ValueKind::MaterialName); }
    void operator()(const Key& key, double, bool, keys::OrAutoTag) { note(key, ValueKind::NumberOrAuto, "auto"); }
    void operator()(const Key& key, const std::optional<TimeFunction>&) { note(key, ValueKind::OfTime); }
    void operator()(const Key& key, const TimeVector&) { note(key, ValueKind::VectorOfTime); }
    void operator()(const Key& key, const Vec<3>&, const TimeVector&) { note(key, ValueKind::VectorOfTime); }
    void operator()(const Key& key, const OutputFields&) {
      std::vector<std::string> words;
      for (const OutputFieldName& f : outputFieldNames) words.emplace_back(f.name);
      note(key, ValueKind::Fields, words, words);
    }
    template <class E, class Fits = keys::AllFit>
    requires std::is_enum_v<E>
    void operator()(const Key& key, E value, Fits fits = {}) {
      const auto words = wordsThat<E>(fits);
      note(key, ValueKind::Word, std::string(nameOf(value)), {words.begin(), words.end()});
    }
    template <class T>
    requires std::is_class_v<T>
    void operator()(const Key& key, const T& table) { nested(key, ValueKind::Table, table); }
    template <class T>
    void operator()(const Key& key, const std::optional<T>&) {
      nested(key, ValueKind::Table, T{});
    }
    template <class T>
    void operator()(const Key& key, const std::vector<T>&) {
      const T sample;
      nested(key, ValueKind::Tables, sample);
    }

   private:
    static nlohmann::json ifHeld(const Key& key, double x) {
      return key.bound.holds(x) ? nlohmann::json(x) : nlohmann::json();
    }
    nlohmann::json vector(const Vec<3>& x) const {
      std::vector<double> components;
      for (int k = 0; k < dimensions; ++k) components.push_back(x[k]);
      return components;
    }

    void note(const Key& key, ValueKind kind, nlohmann::json value = {}, std::vector<std::string> words = {},
              std::string table = {}) {
      KeyTable& t = all.tables_[place];
      const KeyRow row{.name = std::string(key.name),
                       .about = std::string(key.about),
                       .unit = std::string(key.unit),
                       .required = key.required,
                       .bound = key.bound,
                       .kind = kind,
                       .words = std::move(words),
                       .table = std::move(table)};
      auto found = std::ranges::find_if(t.rows, [&](const KeyRow& r) { return r.isLike(row); });
      if (found == t.rows.end()) {  // beside those of the same name
        const auto last =
            std::find_if(t.rows.rbegin(), t.rows.rend(), [&](const KeyRow& r) { return r.name == row.name; });
        found = t.rows.insert(last == t.rows.rend() ? t.rows.end() : last.base(), row);
      }
      found->in.resize(t.variants.size()), found->value.resize(t.variants.size());
      found->in.back() = true;
      if (!key.required) found->value.back() = std::move(value);
    }

    template <class T>
    void nested(const Key& key, ValueKind kind, const T& table) {
      const std::string& path = all.tables_[place].path;
      const std::string below = (path.empty() ? "" : path + '.') + std::string(key.name);
      note(key, kind, {}, {}, below);
      all.describe(below, key.about, kind == ValueKind::Tables, table);
    }
  };

  std::vector<KeyTable> tables_;
};

}  // namespace

bool KeyRow::isLike(const KeyRow& other) const {
  const auto same = [&](auto... member) { return ((this->*member == other.*member) && ...); };
  return same(&KeyRow::name, &KeyRow::about, &KeyRow::unit, &KeyRow::required, &KeyRow::kind, &KeyRow::words,
              &KeyRow::table) &&
         bound.least == other.bound.least && bound.most == other.bound.most && bound.open == other.bound.open;
}

std::string KeyTable::name() const { return path.substr(path.rfind('.') + 1); }

std::vector<bool> KeyTable::valuesOf(const std::vector<bool>& in, std::size_t axis) const {
  std::vector<bool> values(axes[axis].values.size());
  for (std::size_t v = 0; v < variants.size(); ++v)
    if (in[v]) values[variants[v][axis]] = true;
  return values;
}

bool KeyTable::isProduct(const std::vector<bool>& in) const {
  std::vector<std::vector<bool>> values;
  for (std::size_t a = 0; a < axes.size(); ++a) values.push_back(valuesOf(in, a));
  for (std::size_t v = 0; v < variants.size(); ++v) {
    bool has = true;
    for (std::size_t a = 0; a < axes.size(); ++a) has = has && values[a][variants[v][a]];
    if (has != in[v]) return false;
  }
  return true;
}

std::vector<KeyTable> keyCatalogue() {
  Catalogue catalogue;
  catalogue.describe("", "", false, Case{});
  return std::move(catalogue).take();
}

}  // namespace treacle
