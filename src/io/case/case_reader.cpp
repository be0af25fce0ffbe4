#include "treacle/io/case/case_reader.hpp"

#include "case_document.hpp"
#include "table_reader.hpp"
#include "treacle/io/shapes/shape_files.hpp"
#include "treacle/model/case/bulk_constants.hpp"
#include "treacle/model/case/checks.hpp"

namespace treacle {
namespace {

/// The same error with its place in the file; without one where no table of the file holds the value.
CaseFileError placed(const CaseError& error, const Sections& sections) {
  CasePath path = error.path();
  const std::string key = path.back();
  path.pop_back();
  const auto section = sections.find(path);
  if (section == sections.end()) return {{}, key, error.what()};
  return section->second.error(key, error.text());
}

/// Scales follow the mean over the run.
void setGravity(Case& c) {
  if (!c.gravityVaries() || !(c.time.end > 0)) return;
  try {
    c.gravity = c.meanGravity(0, c.time.end);
  } catch (const InputError& error) {
    throw CaseError({"gravity", "acceleration"}, error.what());
  }
}

/// `folder`: that of the file.
Case caseOf(const toml::table& document, const std::filesystem::path& folder, ShapeFiles files) {
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
    if (files == ShapeFiles::Read) readShapeFiles(c, folder);
    requireValidMaterialsAndInflows(c);
    setGravity(c);
    setBulkConstants(c);
    setStepBounds(c);  // which follow from materials, and from where bodies are
    requireValid(c);
  } catch (const CaseError& error) {
    throw placed(error, sections);
  }
  return c;
}

}  // namespace

Case readCase(const std::filesystem::path& path, std::span<const std::string> overrides, ShapeFiles files) {
  return caseOf(readDocument(path, overrides), path.parent_path(), files);
}

CaseFileError errorInFile(const CaseError& error, const std::filesystem::path& path,
                          std::span<const std::string> overrides) {
  const toml::table document = readDocument(path, overrides);
  Case c;
  Sections sections;
  TableReader(c, sections, Section(document, "the case file"), {}).read(c);
  return placed(error, sections);
}

Case readCaseText(std::string_view text, std::span<const std::string> overrides, ShapeFiles files) {
  return caseOf(documentOf(text, overrides), {}, files);
}

}  // namespace treacle
