#pragma once

#include "support/replaced.hpp"
#include "support/temporary_directory.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace treacle::test {

/// What one call of the command left.
struct Outcome {
  int exitCode = -1;  // -1: ended by a signal
  std::string out, err;
};

/// A fresh directory, gone with the object, in which the built command is called.
class Workshop : public TemporaryDirectory {
 public:
  void put(const std::string& name, const std::string& text) const {
    const auto file = *this / name;
    std::filesystem::create_directories(file.parent_path());
    test::put(file, text);
  }

  std::string content(const std::string& name) const { return test::content(*this / name); }

  /// `treacle ARGUMENTS` by the shell, after the shell commands `before`.
  Outcome call(const std::string& arguments, const std::string& before = "") const {
    const std::string line = "cd '" + path().string() + "' || exit 99; { " + before + " '" + TREACLE_BINARY +
                             "' " + arguments + "; } >stdout.txt 2>stderr.txt";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout.txt"), content("stderr.txt")};
  }
};

/// A case of few particles and two steps that stands alone.
inline const std::string smallCase = R"(title = "Small dam break"
dimensions = 2
spacing = 1e-3

[domain]
min = [-4e-3, -4e-3]
max = [12e-3, 12e-3]

[gravity]
acceleration = [0, -10]

[[material]]
name = "syrup"
density = 1000
dynamic_viscosity = 10
bulk_viscosity = 1e4
bulk_modulus = 1e6

[[body]]
name = "column"
type = "fluid"
material = "syrup"
shape = "box"
min = [0, 0]
max = [6e-3, 6e-3]

[[body]]
name = "floor"
type = "wall"
material = "syrup"
shape = "box"
min = [-4e-3, -4e-3]
max = [12e-3, 0]

[time]
step = 1e-3
end = 2e-3

[output]
interval = 1e-3
)";

/// A workshop with the small case in small.toml.
inline Workshop& withSmallCase(Workshop& shop) {
  shop.put("small.toml", smallCase);
  return shop;
}

/// The small case for ISPH.
inline const std::string smallIsphCase =
    replaced(smallCase, "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n", "\n[method]\nname = \"isph\"\n");

}  // namespace treacle::test
