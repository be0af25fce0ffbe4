#include "treacle/core/work_in_hand.hpp"

#include <mutex>
#include <utility>

namespace treacle {
namespace {

std::mutex mutex;  // of the pointer, and so of the life of what it points at
const WorkInHand* inHand = nullptr;

}  // namespace

WorkInHand::WorkInHand(std::string what, std::size_t parts) : what_(std::move(what)), parts_(parts) {
  const std::lock_guard lock(mutex);
  before_ = std::exchange(inHand, this);
}

WorkInHand::~WorkInHand() {
  const std::lock_guard lock(mutex);
  inHand = before_;
}

void WorkInHand::add(std::size_t parts) { done_.fetch_add(parts, std::memory_order_relaxed); }

std::optional<WorkInHand::Look> WorkInHand::look() {
  const std::lock_guard lock(mutex);
  if (!inHand) return std::nullopt;
  Look look{inHand->what_, {}};
  if (inHand->parts_ > 0)
    look.done =
        static_cast<double>(inHand->done_.load(std::memory_order_relaxed)) / static_cast<double>(inHand->parts_);
  return look;
}

}  // namespace treacle
