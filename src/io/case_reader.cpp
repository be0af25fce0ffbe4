#include "treacle/io/case_reader.hpp"

#include "case_document.hpp"
#include "table_reader.hpp"
#include "treacle/io/shape_files.hpp"
#include "treacle/model/checks.hpp"

namespace treacle {
namespace {

/// The same error with its place in the file; without one where no table of the file holds the value.
InputError placed(const CaseError& error, const Sections& sections) {
  CasePath path = error.path();
  const std::string key = path.back();
  path.pop_back();
  const auto section = sections.find(path);
  if (section == sections.end()) return error;
  return section->second.error(key, error.text());
}

}  // namespace

Case readCase(const std::filesystem::path& path, std::span<const std::string> overrides, ShapeFiles files) {
  const toml::table document = readDocument(path, overrides);
  Case c;
  Sections sections;
  TableReader top(c, sections, Section(document, "the case file"), {});
  top.read(c);
  std::optional<Width> width;
  top(keys::widthKey, width);
  c.spacing /= c.resolution;
  if (!c.time.automatic) c.time.step /= c.resolution;
  try {
    if (width) applyWidth(c, *width);
    if (files == ShapeFiles::Read) readShapeFiles(c, path.parent_path());
    setStepBounds(c);  // which follow from where bodies are
    requireValid(c);
  } catch (const CaseError& error) {
    throw placed(error, sections);
  }
  return c;
}

}  // namespace treacle
