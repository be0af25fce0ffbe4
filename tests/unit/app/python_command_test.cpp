#include "command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

using namespace treacle::test;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

class PythonCommand : public testing::Test {
 protected:
  /// Called with this interpreter, a script of the shell.
  Outcome callWith(const std::string& script, const std::string& arguments) const {
    shop.put("python", "#!/bin/sh\n" + script + "\n");
    return shop.call(arguments, "chmod +x python; unset TREACLE_PROGRAM; export TREACLE_PYTHON=./python;");
  }

  Workshop shop;
};

}  // namespace

TEST_F(PythonCommand, HandsOnItsWordsItsNameAndTheExitCode) {
  const Outcome outcome = callWith(R"(shift 2; printf '%s;' "$@"; echo "$TREACLE_PROGRAM"; exit 3)",
                                   "movie run --size 4x4 --help -o 'a b.mp4'");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.out, testing::StartsWith("movie;run;--size;4x4;--help;-o;a b.mp4;/"));
  EXPECT_THAT(outcome.out, testing::EndsWith("/treacle\n"));
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(callWith("shift 2; echo \"$1\"", "report run").out, HasSubstr("report\n"));
}

TEST_F(PythonCommand, SaysWhatIsMissing) {
  Outcome outcome = shop.call("movie run", "export TREACLE_PYTHON=/no/such/python;");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("treacle movie is written in Python, and /no/such/python cannot be started"));
  EXPECT_THAT(outcome.err, HasSubstr("pip install '.[pictures]'"));
  // -I -S: a Python without any package.
  outcome = callWith("exec python3 -I -S \"$@\"", "report run");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("treacle report is written in Python: No module named 'treacle'"));
  EXPECT_THAT(outcome.err, HasSubstr("pip install '.[pictures]'"));
}
