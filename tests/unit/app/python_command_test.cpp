#include "command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

using namespace treacle::test;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

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
  EXPECT_THAT(outcome.out, StartsWith("movie;movie;run;--size;4x4;--help;-o;a b.mp4;/"));
  EXPECT_THAT(outcome.out, testing::EndsWith("/treacle\n"));
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(callWith("shift 2; echo \"$1\"", "report run").out, HasSubstr("report\n"));
  EXPECT_EQ(callWith("shift 2; echo \"$*\"", "import a.data -o x.toml --force -- -b.grid").out,
            "import import_case --output=x.toml --force -- a.data -b.grid\n");
}

TEST_F(PythonCommand, SaysWhatIsMissing) {
  Outcome outcome = shop.call("movie run", "export TREACLE_PYTHON=/no/such/python;");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("treacle movie is written in Python, and /no/such/python cannot be started"));
  EXPECT_THAT(outcome.err, HasSubstr("pip install '.[pictures]'"));
  // -I -S: a Python without any package; that of the sources lies beside the program.
  outcome = callWith("exec python3 -I -S \"$@\"", "report run");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, StartsWith("treacle: error: No module named '"));
  EXPECT_THAT(outcome.err, HasSubstr("pip install '.[pictures]'"));
  outcome = callWith("export TREACLE_PROGRAM=/no/such/treacle; exec python3 -I -S \"$@\"", "report run");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("treacle report is written in Python: No module named 'treacle'"));
  EXPECT_THAT(outcome.err, HasSubstr("pip install '.[pictures]'"));
}

TEST_F(PythonCommand, DrawsCurves) {
  const std::string echo = R"(shift 2; printf '%s;' "$@")";
  ASSERT_EQ(withSmallCase(shop).call("run small.toml -o -run --quiet --threads 1").exitCode, 0);
  EXPECT_EQ(callWith(echo, "plot --history -- -run").out,
            "plot;plot;--history;--output=-run/history.png;--;-run;");
  EXPECT_EQ(callWith(echo, "plot --history -o a.png -- -run").out, "plot;plot;--history;--output=a.png;--;-run;");
  const Outcome compared = callWith(echo, "convergence small.toml -o here --threads 1 --solver ''");
  EXPECT_EQ(compared.exitCode, 0) << compared.err;
  EXPECT_THAT(compared.out,
              testing::EndsWith("plot;plot;--convergence;--title=Small dam break;--remark=step 1, from "
                                "t = 0 s;--output=here/convergence.png;--;here;"));
}

TEST_F(PythonCommand, ComparesSolversWithoutPython) {
  const Outcome outcome = withSmallCase(shop).call("convergence small.toml -o here --threads 1 --solver ''",
                                                   "export TREACLE_PYTHON=/no/such/python;");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, StartsWith("treacle: warning: treacle plot is written in Python, and /no/such/python"));
  EXPECT_THAT(shop.content("here/solvers.csv"), HasSubstr("converged"));
}

TEST_F(PythonCommand, ImportsWithoutAnyPackage) {
  shop.put("argparse.py", "raise ImportError('of the current directory')");
  const Outcome outcome = callWith("unset PYTHONPATH; exec python3 -S \"$@\"", "import x.data x.grid");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.err, "treacle: error: x.grid: No such file or directory\n");
}
