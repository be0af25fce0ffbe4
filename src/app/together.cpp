#include "together.hpp"

#include "treacle/core/error.hpp"
#include "treacle/core/version.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <new>
#include <vector>

namespace treacle {
namespace {

/// Kinds of errors, by which the text of one begins on its way to the others.
constexpr char badInput = 'i', failed = 'f';

/// FNV-1a.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace

void together(const Communicator& processes, const std::function<void()>& body) {
  if (processes.size() == 1) return body();
  std::string error;
  try {
    body();
  } catch (const InputError& e) {
    error = badInput + std::string(e.what());
  } catch (const std::bad_alloc&) {
    error = failed + std::string("memory exhausted");
  } catch (const std::exception& e) {
    error = failed + std::string(e.what());
  }
  const Communicator::RankText first = processes.first(error);
  if (first.text.empty()) return;
  // What all have met is the first one's: it needs no rank.
  const std::string text = (first.rank > 0 ? fmt::format("rank {}: ", first.rank) : "") + first.text.substr(1);
  if (first.text[0] == badInput) throw InputError(text);
  throw RunError(text);
}

void requireSame(const Communicator& processes, const std::string& theCase) {
  struct Hashes {
    std::uint64_t program, theCase;
  };
  const BuildInfo build = buildInfo();
  const Hashes own{hashOf(fmt::format("{} {} {} {}", build.version, build.commit, build.compiler, build.native)),
                   hashOf(theCase)};
  const std::vector<Hashes> all = processes.all(own);
  for (std::size_t r = 1; r < all.size(); ++r) {
    if (all[r].program != all[0].program)
      throw InputError(fmt::format("rank {} runs another version of treacle than rank 0", r));
    if (all[r].theCase != all[0].theCase)
      throw InputError(fmt::format("rank {} has another case, or another state to continue from, than rank 0", r));
  }
}

}  // namespace treacle
