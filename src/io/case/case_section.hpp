#pragma once

#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <toml++/toml.h>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// One table of a case file, of which every error names the place, the key, what was found and what was expected.
/// The table must outlive the section.
class Section {
 public:
  /// `title`: how messages call the table, e.g. "[domain]".
  Section(const toml::table& table, std::string title) : table_(&table), title_(std::move(title)) {}

  const toml::table& table() const { return *table_; }
  const std::string& title() const { return title_; }

  /// The value of a key; none where it is optional and not there. `expected`: what a required one is to be.
  /// Errors: CaseFileError.
  const toml::node* value(const Key& key, const std::string& expected) const;

  /// Errors: CaseFileError for a key that is not among `known`; that for one of `foreign` says whose it is.
  void requireKnown(const std::vector<std::string_view>& known, const std::vector<std::string_view>& foreign,
                    std::string_view owner) const;

  /// "place: key in title: text", for the caller to throw; without a place of its own the key gets the table's.
  CaseFileError error(std::string_view key, const std::string& text) const;
  /// The same for a value that is not what was expected.
  CaseFileError unexpected(const Key& key, const std::string& expected, const toml::node& found) const;

 private:
  const toml::table* table_;
  std::string title_;
};

}  // namespace treacle
