#pragma once

#include "treacle/core/communicator.hpp"

namespace treacle::test {

/// The processes that run the tests together.
const Communicator& job();

}  // namespace treacle::test
