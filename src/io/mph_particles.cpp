#include "mph_files.hpp"
#include "mph_lines.hpp"
#include "treacle/model/create.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

/// Characters of the shortest row of a particle: seven words of one, and what parts them.
constexpr std::size_t shortestRow = 14;

void requireInside(const MphLines& lines, const MphGeometry& g, const Vec<3>& x) {
  for (int k = 0; k < 3; ++k)
    if (!(x[k] >= g.lower[k] && x[k] < g.upper[k]))
      lines.fail(fmt::format("expected a particle inside of the domain, {} from {} to less than {}, found {}",
                             "xyz"[k], g.lower[k], g.upper[k], x[k]));
}

}  // namespace

MphGeometry readMphParticles(const std::string& path, std::string_view content) {
  MphLines lines(path, content);
  MphGeometry g;
  g.path = path;
  if (!lines.next()) lines.fail("the file is empty; expected a line with the time [s]");
  if (lines.words().size() != 1)
    lines.fail(fmt::format("expected one number, the time [s], found {} words", lines.words().size()));
  g.time = lines.number(0);
  if (g.time < 0) lines.fail(fmt::format("expected a time that is not negative, found {}", g.time));

  constexpr const char* header = "the number of particles, their distance, and least and largest x, y and z";
  if (!lines.next()) lines.fail(fmt::format("the file ends after the time; expected a line with {}", header));
  if (lines.words().size() != 8)
    lines.fail(fmt::format("expected 8 numbers, {}, found {} words", header, lines.words().size()));
  const auto count = static_cast<std::size_t>(lines.integer(0, 1, maxParticles, "the number of particles"));
  g.spacing = lines.positive(1);
  for (int k = 0; k < 3; ++k) {
    const auto word = static_cast<std::size_t>(2 + 2 * k);
    g.lower[k] = lines.number(word), g.upper[k] = lines.number(word + 1);
    if (!(g.lower[k] < g.upper[k]))
      lines.fail(fmt::format("expected the least {0} and then the largest {0}, found {1} and {2}", "xyz"[k],
                             g.lower[k], g.upper[k]));
  }
  if (count > content.size() / shortestRow + 1)
    lines.fail(
        fmt::format("expected rows of {} particles, found a file of {} characters, which has no room for them",
                    count, content.size()));

  g.particles.reserve(count);
  while (lines.next()) {
    if (g.particles.size() == count)
      lines.fail(fmt::format("expected {} particles, as many as the second row says, found more", count));
    if (lines.words().size() != 7)
      lines.fail(fmt::format("expected 7 values, a type, x, y, z and the velocity along x, y, z, found {}",
                             lines.words().size()));
    g.particles.push_back({lines.type(0), lines.vector(1), lines.vector(4)});
    requireInside(lines, g, g.particles.back().position);
  }
  if (g.particles.size() < count)
    lines.fail(fmt::format("expected {} particles, the file ends after {}", count, g.particles.size()));
  return g;
}

}  // namespace treacle
