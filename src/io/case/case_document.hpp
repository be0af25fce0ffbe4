#pragma once

#include "treacle/io/case/case_reader.hpp"

#include <toml++/toml.h>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// Keys that may stand at the top of a case file.
std::vector<std::string_view> topLevelKeys();

/// "file:line:column: " or "--set key=value: ".
std::string placeOf(const toml::source_region& source);

/// "place: text"; `key`: what is at fault.
CaseFileError errorAt(const toml::source_region& source, std::string key, const std::string& text);

/// The file that a value names, relative to the case file that holds it; where that is --set, to the current
/// folder. Absolute.
std::filesystem::path fileNamedAt(const toml::source_region& source, const std::string& name);

/// A case file merged onto the file it names as `base`, with overrides on top. Tables merge key by key,
/// [[material]] and [[body]] by name, everything else replaces. Every value remembers where it was written.
/// Errors: CaseFileError for files that cannot be read or parsed, cycles of bases, entries without a name or with
/// the same name, overrides that address nothing.
toml::table readDocument(const std::filesystem::path& path, std::span<const std::string> overrides);

/// The same for a text that is no file: its values have no places, and files are relative to the current folder.
toml::table documentOf(std::string_view text, std::span<const std::string> overrides);

}  // namespace treacle
