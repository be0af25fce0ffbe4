#pragma once

#include "treacle/core/error.hpp"
#include "treacle/model/particles/particles.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace treacle {

/// A state of the solver study, as study_state.py writes it; its case is one of the papers' dam breaks.
struct StudyState {
  int dimensions = 0;
  std::uint32_t fluidCount = 0, count = 0;
  double spacing = 0, timeStep = 0;             // [m], [s]
  std::vector<double> position;                 // of all particles, fluid first [m]
  std::vector<double> velocity, rightHandSide;  // of the fluid
};

/// Errors: InputError with path and reason.
inline StudyState readStudyState(const std::filesystem::path& path) {
  const auto fail = [&](const char* why) { throw InputError(path.string() + ": " + why); };
  std::ifstream in(path, std::ios::binary);
  if (!in) fail("cannot be opened");
  char magic[8];
  std::int64_t sizes[3];
  in.read(magic, sizeof(magic));
  in.read(reinterpret_cast<char*>(sizes), sizeof(sizes));
  if (!in || std::memcmp(magic, "treacle1", sizeof(magic)) != 0) fail("is no file of study_state.py");
  const auto [d, fluid, all] = sizes;
  if ((d != 2 && d != 3) || fluid < 1 || all < fluid || all > (std::int64_t{1} << 27))
    fail("has impossible sizes");
  StudyState s;
  s.dimensions = static_cast<int>(d);
  s.fluidCount = static_cast<std::uint32_t>(fluid);
  s.count = static_cast<std::uint32_t>(all);
  const auto readDoubles = [&](double* to, std::int64_t count) {
    in.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count * 8));
    if (!in) fail("is truncated");
  };
  readDoubles(&s.spacing, 1);
  readDoubles(&s.timeStep, 1);
  for (const auto& [vector, count] :
       {std::pair{&s.position, all}, {&s.velocity, fluid}, {&s.rightHandSide, fluid}}) {
    vector->resize(static_cast<std::size_t>(d * count));
    readDoubles(vector->data(), d * count);
  }
  return s;
}

template <int D>
Particles<D> particlesOf(const StudyState& s) {
  Particles<D> p;
  p.resize(s.fluidCount, s.count - s.fluidCount);
  const auto vectors = [](const std::vector<double>& flat) {
    return reinterpret_cast<const Vec<D>*>(flat.data());
  };
  p.forEachField([](auto& field) { std::fill(field.begin(), field.end(), std::decay_t<decltype(field[0])>{}); });
  std::copy_n(vectors(s.position), s.count, p.position.begin());
  std::copy_n(vectors(s.velocity), s.fluidCount, p.velocity.begin());
  std::iota(p.id.begin(), p.id.end(), 0u);
  return p;
}

}  // namespace treacle
