#include "treacle/io/frames/frame.hpp"

#include "treacle/model/geometry/side.hpp"
#include "treacle/model/materials/rheology_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace treacle {

namespace {

template <class Out, class Buffer, class Convert>
std::vector<Out> gathered(const Buffer& field, const std::vector<std::uint32_t>& order, Convert convert) {
  std::vector<Out> values(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) values[i] = convert(field[order[i]]);
  return values;
}

}  // namespace

template <int D>
Frame makeFrame(const Particles<D>& particles, std::uint32_t begin, std::uint32_t end, double time) {
  std::vector<std::uint32_t> order(end - begin);
  std::iota(order.begin(), order.end(), begin);
  const auto isHidden = [](std::uint32_t word) { return (word & sides::ofSheet) && !(word & sides::shown); };
  if (particles.has.sides) std::erase_if(order, [&](std::uint32_t i) { return isHidden(particles.side[i]); });
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return particles.id[a] < particles.id[b]; });

  const auto inSpace = [](const Vec<D>& v) { return resized<3>(v); };
  const auto same = [](auto value) { return value; };
  Frame frame;
  frame.dimensions = D;
  frame.time = time;
  frame.position = gathered<Vec<3>>(particles.position, order, inSpace);
  frame.velocity = gathered<Vec<3>>(particles.velocity, order, inSpace);
  frame.pressure = gathered<double>(particles.pressure, order, same);
  frame.numberDensity = gathered<double>(particles.numberDensity, order, same);
  frame.material = gathered<std::int32_t>(particles.material, order, same);
  frame.body = gathered<std::int32_t>(particles.body, order, same);
  frame.id = gathered<std::uint32_t>(particles.id, order, same);
  if (particles.has.shearRates && end <= particles.fluidCount)
    frame.shearRate = gathered<double>(particles.shearRate, order, same);
  if (particles.has.temperatures && end <= particles.fluidCount)
    frame.temperature = gathered<double>(particles.temperature, order, same);
  if (particles.has.viscosityFactors && end <= particles.fluidCount)
    frame.viscosityFactor = gathered<double>(particles.viscosityFactor, order, same);
  for (std::size_t k = 0; k < particles.has.states && end <= particles.fluidCount; ++k)
    frame.states.push_back({"", gathered<double>(particles.states[k], order, same)});
  const auto inSpaceToo = [](const SymmetricBlock<D>& c) {
    auto whole = SymmetricBlock<3>::identity();
    for (int r = 0; r < D; ++r)
      for (int s = r; s < D; ++s) whole(r, s) = c(r, s);
    return whole;
  };
  for (std::size_t k = 0; k < particles.has.elasticModes && end <= particles.fluidCount; ++k)
    frame.conformation.push_back(gathered<SymmetricBlock<3>>(particles.conformation[k], order, inSpaceToo));
  return frame;
}

Frame solidWalls(const Case& c, const Frame& walls) {
  Frame solid;
  for (std::size_t i = 0; i < walls.position.size(); ++i)
    if (!c.bodies[static_cast<std::size_t>(walls.body[i])].shape.isThinSheet())
      solid.position.push_back(walls.position[i]);
  return solid;
}

namespace {

/// The components of the elastic stress in place of the conformations.
void addStresses(const Case& c, Frame& frame) {
  if (frame.conformation.empty()) return;
  for (int r = 0; r < frame.dimensions; ++r)
    for (int s = r; s < frame.dimensions; ++s) {
      FrameState stress{fmt::format("elastic_stress_{}{}", "xyz"[r], "xyz"[s]), {}};
      stress.values.resize(frame.position.size());
      for (std::size_t i = 0; i < stress.values.size(); ++i) {
        const std::vector<ElasticMode>& modes = c.materials[static_cast<std::size_t>(frame.material[i])].elastic;
        for (std::size_t k = 0; k < modes.size(); ++k)
          stress.values[i] +=
              modes[k].viscosity / modes[k].relaxationTime * (frame.conformation[k][i](r, s) - (r == s));
      }
      frame.states.push_back(std::move(stress));
    }
  frame.conformation.clear();
}

}  // namespace

void addViscosities(const Case& c, Frame& frame) {
  const std::vector<std::string> names = c.stateNames();
  for (std::size_t k = 0; k < frame.states.size(); ++k) frame.states[k].name = names[k];
  frame.dynamicViscosity.resize(frame.shearRate.size());
  std::vector<FormulaStep> steps;
  RheologyTable table = RheologyTable::make(c, steps);
  if (!steps.empty()) table.states.steps = steps.data();
  table.temperature = frame.temperature, table.factor = frame.viscosityFactor, table.time = frame.time;
  for (std::size_t k = 0; k < frame.states.size(); ++k) table.state[k] = frame.states[k].values.data();
  for (std::size_t i = 0; i < frame.shearRate.size(); ++i)
    frame.dynamicViscosity[i] = table.viscosity(i, frame.material[i], frame.shearRate[i]);
  addStresses(c, frame);
}

template Frame makeFrame<2>(const Particles<2>&, std::uint32_t, std::uint32_t, double);
template Frame makeFrame<3>(const Particles<3>&, std::uint32_t, std::uint32_t, double);

}  // namespace treacle
