#pragma once

#include <stdexcept>
#include <string>

namespace treacle {

/// Exit codes of the `treacle` command.
enum class ExitCode : int { Done = 0, BadInput = 2, RunFailed = 3 };

/// What the user gave cannot be used: case file, command line, output directory. Exit code 2.
/// The message says where (file:line:column, key) and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run that started well went wrong: no convergence, a value not finite, a particle outside an open
/// domain, memory or disk exhausted. Exit code 3. The message is the diagnosis.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run came to an end that no settings put off, so that to continue it is of no use.
class EndOfRun : public RunError {
 public:
  using RunError::RunError;
};

}  // namespace treacle
