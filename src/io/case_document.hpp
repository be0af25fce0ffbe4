#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// Keys that may stand at the top of a case file.
inline const std::vector<std::string_view> topLevelKeys = {
    "title",    "dimensions", "spacing", "resolution", "base",   "domain", "gravity",
    "material", "body",       "width",   "time",       "method", "solver", "output"};

/// "file:line:column: " or "--set key=value: ".
std::string placeOf(const toml::source_region& source);

/// A case file merged onto the file it names as `base`, with overrides on top. Tables merge key by key,
/// [[material]] and [[body]] by name, everything else replaces. Every value remembers where it was written.
/// Errors: InputError for files that cannot be read or parsed, cycles of bases, entries without a name or with the
/// same name, overrides that address nothing.
toml::table readDocument(const std::filesystem::path& path, std::span<const std::string> overrides);

}  // namespace treacle
