#pragma once

#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace treacle::test {

/// An override that makes a sound case a wrong one, and what is said of it.
struct Mistake {
  const char* override;
  const char* message;
};

/// `read(overrides)` reads the case.
template <class Mistakes, class Read>
void expectExplained(const Mistakes& mistakes, Read&& read) {
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.override);
    const std::vector<std::string> overrides{mistake.override};
    EXPECT_THAT(messageOf<InputError>([&] { read(overrides); }), testing::HasSubstr(mistake.message));
  }
}

}  // namespace treacle::test
