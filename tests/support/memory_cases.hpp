#pragma once

#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/any_simulation.hpp"
#include "treacle/step/run/memory_plan.hpp"

#include <string>
#include <vector>

namespace treacle::test {

/// How far an estimate of memory may be off.
inline constexpr double memoryShare = 0.15;

/// A case with what decides on its memory.
struct MemoryCase {
  const char* file;
  std::vector<std::string> settings;

  Case read() const { return readCase(std::string(TREACLE_CASES) + "/" + file, settings); }
  std::string name() const {
    std::string text = file;
    for (const std::string& s : settings) text += " " + s;
    return text;
  }
};

/// The particles of a case, and what is counted of them.
struct MemoryScene {
  Case c;
  AnyParticles particles;
  MemoryCounts counts;

  explicit MemoryScene(const MemoryCase& memoryCase) : c(memoryCase.read()), particles(c.dimensions) {
    std::vector<std::string> notes;
    particles = createParticles(c, notes);
    counts = countForMemory(c, particles);
  }
};

}  // namespace treacle::test
