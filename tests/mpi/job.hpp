#pragma once

#include "treacle/core/communicator.hpp"

#include <string>

namespace treacle::test {

/// The processes that run the tests together.
const Communicator& job();

/// Makes the device that has this process's number on its host the current one; processes share where there are
/// too few.
void useOwnDevice();

/// The directory of the cases; the environment variable TREACLE_CASES says where it is on another machine.
std::string casesDirectory();

}  // namespace treacle::test
