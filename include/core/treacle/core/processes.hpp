#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/core/error.hpp"

#include <span>
#include <string>
#include <vector>

namespace treacle {

/// What loops say to the processes that share their simulation (Processes); nothing where it is alone.

/// Everybody's values joined by join(one, other) in the order of ranks.
template <class T, class Join>
T joinedOverProcesses(const Processes& processes, T own, Join&& join) {
  if (!processes.communicator) return own;
  const std::vector<T> all = processes.communicator->all(own);
  T joint = all[0];
  for (std::size_t r = 1; r < all.size(); ++r) joint = join(joint, all[r]);
  return joint;
}

inline double sumOverProcesses(const Processes& processes, double own) {
  return joinedOverProcesses(processes, own, [](double a, double b) { return a + b; });
}
template <class T>
void sumOverProcesses(const Processes& processes, std::span<T> values) {
  if (processes.communicator) processes.communicator->sum(values);
}

/// Everybody's lists, one after the other in the order of ranks.
template <class T>
std::vector<T> joinedLists(const Processes& processes, std::vector<T> own) {
  if (!processes.communicator) return own;
  const auto ranks = static_cast<std::size_t>(processes.communicator->size());
  std::vector<T> all;
  for (const std::vector<T>& list : processes.communicator->swap(std::vector(ranks, own)))
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

/// Does what may throw a RunError in one process only: then all throw it, with the rank of the first. Nothing
/// inside may wait for other processes.
template <class F>
void agreed(const Processes& processes, F&& body) {
  if (!processes.communicator) return body();
  std::string error;
  try {
    body();
  } catch (const RunError& e) {
    error = e.what();
  }
  const Communicator::RankText first = processes.communicator->first(error);
  if (!first.text.empty()) throw RunError("rank " + std::to_string(first.rank) + ": " + first.text);
}

/// The first text that is not empty, in the order of ranks, and `otherwise` where all are.
inline std::string firstText(const Processes& processes, const std::string& own, const std::string& otherwise) {
  const std::string first = processes.communicator ? processes.communicator->first(own).text : own;
  return first.empty() ? otherwise : first;
}

}  // namespace treacle
