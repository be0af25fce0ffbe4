#include "frame_number.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <charconv>

namespace treacle {

void requireFrames(const RunDirectory& run) {
  if (run.frameCount() == 0) throw InputError(fmt::format("{}: the run has no frame", run.path().string()));
}

std::size_t frameNumber(const std::string& option, const RunDirectory& run) {
  requireFrames(run);
  const std::size_t count = run.frameCount();
  if (option == "last") return count - 1;
  std::size_t number = 0;
  const char* end = option.data() + option.size();
  const auto [stop, error] = std::from_chars(option.data(), end, number);
  if (error != std::errc{} || stop != end || number >= count)
    throw InputError(fmt::format("--frame {}: expected 'last' or a number from 0 to {}", option, count - 1));
  return number;
}

}  // namespace treacle
