#include "commands.hpp"
#include "print.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace treacle {
namespace {

/// Runs the command of a module, of an installed package or else of the one beside the program; where that cannot
/// be imported, says why and how it comes.
constexpr const char* launcher = R"(import importlib, os, sys
name = sys.argv.pop(1)
beside = os.path.dirname(os.environ.get("TREACLE_PROGRAM", "")) + "/../share/treacle/python"
sys.path[:] = [folder for folder in sys.path if folder] + [beside]  # nothing of the current directory
try:
    if sys.version_info < (3, 10): raise ImportError("it needs Python 3.10 or later")
    main = importlib.import_module("treacle." + sys.argv.pop(1)).main
except ImportError as error:
    print(f"treacle: error: treacle {name} is written in Python: {error}; expected the package of treacle's sources, by "
          f"`pip install '.[pictures]'` in {sys.executable} or by scripts/pictures, or TREACLE_PYTHON=INTERPRETER", file=sys.stderr)
    sys.exit(2)
sys.exit(main(sys.argv[1:])))";

}  // namespace

void pythonCommand(const std::string& command, const std::string& module,
                   const std::vector<std::string>& arguments) {
  const char* chosen = std::getenv("TREACLE_PYTHON");
  const std::string interpreter = chosen != nullptr && *chosen != '\0' ? chosen : "python3";
  std::error_code unknown;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (!unknown) setenv("TREACLE_PROGRAM", self.c_str(), 0);  // for a module that needs it
  std::vector<std::string> words{interpreter, "-c", launcher, command, module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  flushPrinted();
  execvp(interpreter.c_str(), pointers.data());
  throw InputError(
      fmt::format("treacle {} is written in Python, and {} cannot be started: {}; expected Python 3 with the "
                  "package of treacle's sources, by "
                  "`pip install '.[pictures]'` or by scripts/pictures, or TREACLE_PYTHON=INTERPRETER",
                  command, interpreter, std::strerror(errno)));
}

bool tryPythonCommand(const std::string& command, const std::string& module,
                      const std::vector<std::string>& arguments) {
  flushPrinted();
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    try {
      pythonCommand(command, module, arguments);
    } catch (const InputError& error) {
      printWarning(error.what());
    }
    std::_Exit(static_cast<int>(ExitCode::BadInput));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void drawCurves(const std::filesystem::path& directory, const std::filesystem::path& picture,
                std::vector<std::string> options) {
  options.insert(options.end(), {"--output=" + picture.string(), "--", directory.string()});
  pythonCommand("plot", "plot", options);
}

bool tryDrawCurves(const std::filesystem::path& directory, const std::filesystem::path& picture,
                   std::vector<std::string> options) {
  options.insert(options.end(), {"--output=" + picture.string(), "--", directory.string()});
  return tryPythonCommand("plot", "plot", options);
}

}  // namespace treacle
