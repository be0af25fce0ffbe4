#pragma once

#include <string>

namespace treacle {

/// Has the program's errors arrive in Python as treacle.InputError, treacle.RunError and MemoryError.
void registerErrors();

/// A message with options of the command line as Python calls them.
std::string forPython(std::string text);

}  // namespace treacle
