#include "table_reader.hpp"

#include "toml_string.hpp"

#include "case_document.hpp"
#include "suggestion.hpp"
#include "time_table.hpp"
#include "treacle/model/case/expression.hpp"

#include <algorithm>
#include <limits>

namespace treacle {

namespace {

/// Whether a body of the case is a rigid one.
bool hasRigidBody(const toml::table& document) {
  const toml::array* bodies = document["body"].as_array();
  return bodies && std::ranges::any_of(*bodies, [](const toml::node& body) {
           const toml::table* table = body.as_table();
           return table && (*table)["type"].value<std::string_view>() == "rigid";
         });
}

}  // namespace

/// The method, on which the keys of other tables depend, is read before them; whether there is heat, likewise.
void TableReader::prepare(Case& c) {
  if (hasRigidBody(section_.table())) c.method.pressureRadius = radiusAroundBodies;
  (*this)({"method", "Numerical method"}, c.method);
  if (c.method.kind != MethodKind::MphI)
    for (const auto& [key, text] : {std::pair("heat", heatOfMphI), std::pair("rheology", rheologyOfMphI)})
      if (section_.table().contains(key)) throw section_.error(key, text);
  if (section_.table().contains("heat")) c.heat.emplace();
  c.solver = defaultSolver(c.method.kind);
}

void TableReader::prepare(MethodSettings& method) {
  (*this)({"name", "Numerical method"}, method.kind);
  if (method.kind == MethodKind::MphI)
    if (lookUp<SchemeKind>("scheme") == SchemeKind::Published) method = defaultMethod(SchemeKind::Published);
  nameMethod();
}

/// A viscosity beside a rheology would be one that nobody uses.
void TableReader::prepare(Material&) {
  if (section_.table().contains("rheology") && section_.table().contains("dynamic_viscosity"))
    throw section_.error("dynamic_viscosity", viscosityBesideRheology);
}

void TableReader::prepare(Body& body) {
  if (const auto kind = lookUp<BodyKind>("type")) body.kind = *kind;
  if (body.kind == BodyKind::Inflow) {
    section_ = Section(section_.table(), section_.title() + " (inflow)");
    return;
  }
  prepareKind("shape", body.shape.kind);
  body.fileTemperatures = section_.table()["file_temperatures"].value_or(false);
}

void TableReader::prepare(Rotation&) {
  if (!section_.table().contains("speed") && !section_.table().contains("angle"))
    throw section_.error("speed", "missing; expected a finite number [rad/s], or angle");
}

void TableReader::prepare(SolverSettings& solver) {
  if (const auto preconditioner = lookUp<PreconditionerKind>("preconditioner"))
    solver = defaultSolver(case_.method.kind, *preconditioner);
  nameMethod();
}

void TableReader::prepare(TimeSettings& time) {
  time.automatic = section_.table()["step"].value<std::string_view>() == "auto";
}

/// In the title, for tables whose keys are others with ISPH.
void TableReader::nameMethod() {
  if (case_.method.kind == MethodKind::Isph) section_ = Section(section_.table(), section_.title() + " (isph)");
}

void TableReader::requireKnownKeys(const TimeSettings& time) const {
  TimeSettings automatic;
  automatic.automatic = true;
  section_.requireKnown(knownKeys(time), keys::namesIn(automatic, case_), "step = \"auto\"");
}

std::vector<std::string_view> TableReader::knownKeys(const Case&) const { return topLevelKeys(); }

std::vector<std::string_view> TableReader::knownKeys(const Body& body) const {
  if (body.kind == BodyKind::Inflow) return keys::namesIn(body, case_);
  return keysOfKind<ShapeKind>("shape", body, [](Body& b, ShapeKind kind) { b.shape.kind = kind; });
}

std::string TableReader::titleOf(std::string_view key) const {
  if (path_.size() > 1) return fmt::format("the {} of [[{}]] '{}'", key, path_[0], path_[1]);
  return path_.empty() ? fmt::format("[{}]", key) : fmt::format("[{}.{}]", path_[0], key);
}

TableReader TableReader::below(const toml::table& table, std::string title,
                               std::initializer_list<std::string_view> keys) const {
  CasePath path = path_;
  path.insert(path.end(), keys.begin(), keys.end());
  return {case_, sections_, Section(table, std::move(title)), std::move(path)};
}

double TableReader::number(const Key& key, const toml::node& node, const std::string& expected) const {
  const std::optional<double> x = node.is_number() ? node.value<double>() : std::nullopt;
  if (!x || !key.bound.holds(*x)) throw section_.unexpected(key, expected, node);
  return *x;
}

std::string TableReader::expression(const Key& key, const toml::node& node) const {
  if (!node.is_string()) throw section_.unexpected(key, "an expression", node);
  const std::string& text = node.as_string()->get();
  try {
    Expression{text, case_.dimensions};
  } catch (const InputError& e) {
    throw section_.error(key.name, e.what());
  }
  return text;
}

const std::string* TableReader::word(const Key& key) const {
  const std::string expected = "a string";
  const toml::node* node = section_.value(key, expected);
  if (node && !node->is_string()) throw section_.unexpected(key, expected, *node);
  return node ? &node->as_string()->get() : nullptr;
}

const toml::table* TableReader::table(const Key& key) const {
  const toml::node* node = section_.value(key, fmt::format("a table [{}]", key.name));
  if (node && !node->is_table()) throw section_.unexpected(key, "a table", *node);
  return node ? node->as_table() : nullptr;
}

std::vector<TableReader::Entry> TableReader::entries(const Key& key) const {
  const std::string expected = expectedEntries(key);
  const toml::node* node = section_.value(key, expected);
  if (!node) return {};
  if (const toml::array* list = node->as_array(); list && list->empty() && key.bound.least == 0) return {};
  if (!node->is_array_of_tables()) throw section_.unexpected(key, expected, *node);
  std::vector<Entry> entries;
  for (const toml::node& entry : *node->as_array())
    entries.push_back({(*entry.as_table())["name"].value_or(std::string{}), entry.as_table()});
  return entries;
}

const toml::array* TableReader::array(const Key& key, const std::string& expected) const {
  const toml::node* node = section_.value(key, expected);
  if (!node) return nullptr;
  const toml::array* array = node->as_array();
  if (!array || array->size() != static_cast<std::size_t>(case_.dimensions))
    throw section_.unexpected(key, expected, *node);
  return array;
}

void TableReader::operator()(const Key& key, double& x) const {
  const std::string expected = expectedNumber(key);
  if (const toml::node* node = section_.value(key, expected)) x = number(key, *node, expected);
}

void TableReader::operator()(const Key& key, int& x) const {
  const std::string expected = expectedInteger(key);
  const toml::node* node = section_.value(key, expected);
  if (!node) return;
  if (const auto* real = node->as_floating_point())
    throw section_.error(key.name,
                         fmt::format("expected {}, found {:#}; write it without a point", expected, real->get()));
  const auto* value = node->as_integer();
  if (!value || !key.bound.holds(static_cast<double>(value->get())) ||
      value->get() > std::numeric_limits<int>::max())
    throw section_.unexpected(key, expected, *node);
  x = static_cast<int>(value->get());
}

void TableReader::operator()(const Key& key, bool& flag) const {
  const std::string expected = "true or false";
  const toml::node* node = section_.value(key, expected);
  if (!node) return;
  if (!node->is_boolean()) throw section_.unexpected(key, expected, *node);
  flag = node->as_boolean()->get();
}

void TableReader::operator()(const Key& key, std::array<bool, 3>& flags) const {
  const auto axes = static_cast<std::size_t>(case_.dimensions);
  const std::string expected = fmt::format("true, false or an array of {} of them", axes);
  const toml::node* node = section_.value(key, expected);
  if (!node) return;
  const toml::array* array = node->as_array();
  const bool fits =
      array ? array->size() == axes && array->is_homogeneous(toml::node_type::boolean) : node->is_boolean();
  if (!fits) throw section_.unexpected(key, expected, *node);
  for (std::size_t k = 0; k < axes; ++k) flags[k] = (array ? (*array)[k] : *node).as_boolean()->get();
}

void TableReader::operator()(const Key& key, Vec<3>& x) const {
  const std::string expected = expectedVector(key, case_.dimensions);
  const toml::array* array = this->array(key, expected);
  for (int k = 0; array && k < case_.dimensions; ++k)
    x[k] = number(key, (*array)[static_cast<std::size_t>(k)], expected);
}

void TableReader::operator()(const Key& key, Vec<3>& numbers, std::array<std::string, 3>& texts) const {
  const std::string expected = expectedVector(key, case_.dimensions, true);
  const toml::array* array = this->array(key, expected);
  for (std::size_t k = 0; array && k < array->size(); ++k)
    if (const toml::node& node = (*array)[k]; node.is_string())
      texts[k] = expression(key, node);
    else
      numbers[static_cast<int>(k)] = number(key, node, expected);
}

void TableReader::operator()(const Key& key, double& x, std::string& text) const {
  const std::string expected = expectedNumber(key, false, true);
  const toml::node* node = section_.value(key, expected);
  if (node && node->is_string())
    text = expression(key, *node);
  else if (node)
    x = number(key, *node, expected);
}

void TableReader::operator()(const Key& key, std::vector<double>& numbers) const {
  const std::string expected = expectedNumbers(key);
  const toml::node* node = section_.value(key, expected);
  if (!node) return;
  if (!node->is_array()) throw section_.unexpected(key, expected, *node);
  numbers.clear();
  for (const toml::node& entry : *node->as_array()) numbers.push_back(number(key, entry, expected));
}

void TableReader::operator()(const Key& key, std::vector<Vec<2>>& points) const {
  const std::string expected = expectedPoints(key);
  const toml::node* node = section_.value(key, expected);
  if (!node) return;
  if (!node->is_array()) throw section_.unexpected(key, expected, *node);
  points.clear();
  for (const toml::node& entry : *node->as_array()) {
    const toml::array* pair = entry.as_array();
    if (!pair || pair->size() != 2) throw section_.unexpected(key, expected, entry);
    points.push_back({number(key, (*pair)[0], expected), number(key, (*pair)[1], expected)});
  }
}

void TableReader::operator()(const Key& key, std::string& path, keys::FileTag) const {
  const std::string* name = word(key);
  if (!name) return;
  if (name->empty()) throw section_.error(key.name, "expected the name of a file, found \"\"");
  if (name->find('\0') != std::string::npos)
    throw section_.error(key.name, "expected the name of a file, found a NUL");
  path = fileNamedAt(section_.table().get(key.name)->source(), *name).string();
  if (!isUtf8(path))
    throw section_.error(key.name,
                         fmt::format("{}: the folder's name is no UTF-8, in which a run writes it down", path));
}

void TableReader::operator()(const Key& key, std::string& text) const {
  if (const std::string* word = this->word(key)) text = *word;
}

void TableReader::operator()(const Key& key, std::string& text, keys::ExpressionTag) const {
  if (const toml::node* node = section_.value(key, "an expression")) text = expression(key, *node);
}

void TableReader::operator()(const Key& key, int& index, keys::MaterialTag) const {
  const std::string* name = word(key);
  if (!name) return;
  const auto found = std::ranges::find(case_.materials, *name, &Material::name);
  if (found == case_.materials.end()) {
    std::vector<std::string_view> names;
    for (const Material& m : case_.materials) names.push_back(m.name);
    throw section_.error(key.name, fmt::format("unknown material '{}'{}", *name, suggestion(*name, names)));
  }
  index = static_cast<int>(found - case_.materials.begin());
}

void TableReader::operator()(const Key& key, double& x, bool& isAuto, keys::OrAutoTag) const {
  const std::string expected = expectedNumber(key, true);
  const toml::node* node = section_.value(key, expected);
  isAuto = !node || node->value<std::string_view>() == "auto";
  if (!isAuto) x = number(key, *node, expected);
}

TimeFunction TableReader::function(const Key& key, const toml::node& node) const {
  TimeFunction f;
  if (node.is_string()) {
    f.expression = node.as_string()->get();
    try {
      Expression::ofTime(f.expression);
    } catch (const InputError& e) {
      throw section_.error(key.name, e.what());
    }
  } else if (const toml::table* table = node.as_table()) {
    const Section section(*table, titleOf(key.name));
    section.requireKnown({"times", "values", "file", "column"}, {}, "");
    const TableReader reader(case_, sections_, section, path_);
    if (table->contains("file")) {
      if (table->contains("times") || table->contains("values"))
        throw section_.error(key.name, "expected either file or times and values, found both");
      std::string path, column;
      reader({"file", "Text file with the table", keys::required}, path, keys::file);
      reader({"column", "Name of its column"}, column);
      try {
        return readTimeTable(path, column);
      } catch (const InputError& e) {
        throw section_.error(key.name, e.what());
      }
    }
    reader({"times", "Rising times", keys::required, "s"}, f.times);
    if (f.times.empty()) throw section_.error(key.name, "expected at least one time, found none");
    reader({"values", "Values at these times", keys::required, key.unit, key.bound}, f.values);
  } else {
    f.value = number(key, node, expectedFunction(key));
  }
  return f;
}

void TableReader::operator()(const Key& key, std::optional<TimeFunction>& function) const {
  if (const toml::node* node = section_.value(key, expectedFunction(key))) function = this->function(key, *node);
}

void TableReader::operator()(const Key& key, TimeVector& functions) const {
  const std::string expected = fmt::format("an array of {} of these: {}", case_.dimensions, expectedFunction(key));
  const toml::array* array = this->array(key, expected);
  for (std::size_t k = 0; array && k < array->size(); ++k) functions[k] = function(key, (*array)[k]);
}

void TableReader::operator()(const Key& key, Vec<3>& numbers, TimeVector& varying) const {
  TimeVector functions;
  (*this)(key, functions);
  for (std::size_t k = 0; k < functions.size(); ++k) {
    if (!functions[k]) continue;
    varying[k].reset(), numbers[static_cast<int>(k)] = functions[k]->value;
    if (!functions[k]->isConstant()) varying[k] = std::move(functions[k]);
  }
}

void TableReader::operator()(const Key& key, std::vector<std::string>& names) const {
  const std::string expected = "an array of strings";
  const toml::node* node = section_.value(key, expected);
  if (!node) return;
  const toml::array* words = node->as_array();
  if (!words || !(words->empty() || words->is_homogeneous(toml::node_type::string)))
    throw section_.unexpected(key, expected, *node);
  names.clear();
  for (const toml::node& entry : *words) names.push_back(entry.as_string()->get());
}

void TableReader::operator()(const Key& key, OutputFields& fields) const {
  std::vector<std::string> words;
  for (const OutputFieldName& f : outputFieldNames)
    if (fields.*(f.flag)) words.emplace_back(f.name);
  (*this)(key, words);
  std::vector<std::string_view> names;
  for (const OutputFieldName& f : outputFieldNames) names.push_back(f.name), fields.*(f.flag) = false;
  for (const std::string& word : words) {
    const auto field = std::ranges::find(outputFieldNames, word, &OutputFieldName::name);
    if (field == std::end(outputFieldNames)) throw section_.error(key.name, wrongWord(names, word));
    fields.*(field->flag) = true;
  }
}

}  // namespace treacle
