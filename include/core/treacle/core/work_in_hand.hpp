#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>

namespace treacle {

/// Says what a long preparation is doing, and how far it is, to a program that wants to show it. From its
/// construction to its end it is the work in hand; one that begins meanwhile takes its place for a while.
class WorkInHand {
 public:
  /// `what`: "filling body 'bed'". `parts`: equal pieces of work, or 0 where nobody knows how many there are.
  explicit WorkInHand(std::string what, std::size_t parts = 0);
  ~WorkInHand();
  WorkInHand(const WorkInHand&) = delete;
  WorkInHand& operator=(const WorkInHand&) = delete;

  /// Parts that are done. Any thread may call it.
  void add(std::size_t parts);

  struct Look {
    std::string what;
    std::optional<double> done;  // share of the parts
  };
  /// The work in hand; nothing where there is none. Any thread may call it.
  static std::optional<Look> look();

 private:
  std::string what_;
  std::size_t parts_;
  std::atomic<std::size_t> done_{0};
  const WorkInHand* before_;
};

}  // namespace treacle
