#pragma once

#include <string>

namespace treacle {

/// What a case file may hold, made from the table of keys (model/case_keys.hpp), for editors and for people.

/// A JSON schema (draft-07): types, units, bounds, words, defaults and descriptions of all keys, which of them are
/// required, and which there are in cases of other dimensions, methods and kinds of bodies. It knows nothing of
/// what values must be together, and little of files with a `base`, where all but names may be left out.
std::string caseSchema();

/// A page of Markdown with a table for each table of a case file.
std::string keyReference();

}  // namespace treacle
