#pragma once

#include "treacle/core/error.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/case/case_error.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace treacle {

/// Whether the files that shapes are made of are read with a case (io/shape_files.hpp): whoever makes its
/// particles needs them, whoever only looks at a run does not, and may not have them.
enum class ShapeFiles { Read, Leave };

/// Where in the text of a case something stands.
struct CasePlace {
  std::string file;                    // empty: in an override, or in a text that is no file
  std::uint32_t line = 0, column = 0;  // from 1; 0: not known
};

/// A case file that cannot be used, for programs that do not want to take its message apart.
class CaseFileError : public InputError {
 public:
  CaseFileError(CasePlace place, std::string key, const std::string& message)
      : InputError(message), place_(std::move(place)), key_(std::move(key)) {}

  const CasePlace& place() const { return place_; }
  /// The last part of the way to it; empty: no single one is at fault.
  const std::string& key() const { return key_; }

 private:
  CasePlace place_;
  std::string key_;
};

/// Reads a case file with everything it inherits by `base`, and checks the case as requireValid does;
/// docs/cases.md lists the keys. `overrides`: "key=value" each, as given to --set, applied in order on top of the
/// files. Errors: CaseFileError that begins with file:line:column (or "--set ...") and says what was found and
/// expected.
Case readCase(const std::filesystem::path& path, std::span<const std::string> overrides = {},
              ShapeFiles files = ShapeFiles::Read);

/// The same for a text that is no file. Files that it names are relative to the current folder. Errors name the
/// key and its table alone.
Case readCaseText(std::string_view text, std::span<const std::string> overrides = {},
                  ShapeFiles files = ShapeFiles::Read);

/// An error that was found after a case was read, with its place in the files that it was read from.
CaseFileError errorInFile(const CaseError& error, const std::filesystem::path& path,
                          std::span<const std::string> overrides);

/// The case as a complete TOML file: resolution applied (and therefore 1), every key explicit, files
/// by absolute paths and with their checksums. Reading it gives the same case and the same particles.
std::string caseText(const Case& c);

}  // namespace treacle
