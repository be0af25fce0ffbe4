#pragma once

#include "treacle/core/symmetric_block.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// A state of the fluid's materials, or a component of its elastic stress [Pa].
struct FrameState {
  std::string name;
  std::vector<double> values;

  bool operator==(const FrameState&) const = default;
};

/// A copy of one group of particles (fluid or walls) at one instant: what is written to and read from files.
/// Always three components; fields that a file does not hold are empty.
struct Frame {
  int dimensions = 3;
  double time = 0;                       // [s]
  std::vector<Vec<3>> position;          // [m]
  std::vector<Vec<3>> velocity;          // [m/s]
  std::vector<double> pressure;          // [Pa]
  std::vector<double> numberDensity;     // [-]
  std::vector<double> nearestDistance;   // of fluid: to the nearest other particle over the spacing [-]
  std::vector<double> dynamicViscosity;  // of fluid in cases where a material has a rheology [Pa s]
  std::vector<double> shearRate;         // likewise [1/s]
  std::vector<double> temperature;       // of fluid in cases with heat [K]
  std::vector<double> viscosityFactor;   // of fluid in cases where bodies give one [-]
  std::vector<std::int32_t> material;    // index into the case's materials
  std::vector<std::int32_t> body;        // index into the case's bodies
  std::vector<std::uint32_t> id;
  std::vector<FrameState> states;  // of fluid in cases where materials have some
  // Of fluid, mode by mode, until addViscosities makes stresses of it.
  std::vector<std::vector<SymmetricBlock<3>>> conformation;
};

/// Calls f(name in files, pointer to member) for every field but the states. The binding names all members of
/// Frame: it does not compile once one is added that is not written here.
template <class F>
void forEachFrameField(F&& f) {
  [[maybe_unused]] const auto& [dimensions, time, position, velocity, pressure, numberDensity, nearestDistance,
                                dynamicViscosity, shearRate, temperature, viscosityFactor, material, body, id,
                                states, conformation] = Frame{};
  f("position", &Frame::position), f("velocity", &Frame::velocity), f("pressure", &Frame::pressure);
  f("number_density", &Frame::numberDensity), f("nearest_distance", &Frame::nearestDistance);
  f("dynamic_viscosity", &Frame::dynamicViscosity), f("shear_rate", &Frame::shearRate);
  f("temperature", &Frame::temperature), f("viscosity_factor", &Frame::viscosityFactor);
  f("material", &Frame::material), f("body", &Frame::body), f("id", &Frame::id);
}

/// Copies particles [begin, end), sorted by id: files do not depend on how the search sorts. Shear rates,
/// temperatures and factors are those of fluid where it has some. Of thin sheets one layer is shown.
template <int D>
Frame makeFrame(const Particles<D>& particles, std::uint32_t begin, std::uint32_t end, double time);

/// The places of those walls of a frame that have a thickness: fluid may be where the particles of thin sheets
/// are.
Frame solidWalls(const Case& c, const Frame& walls);

/// Completes a frame of fluid, made from particles of the case: with the names of its states, its elastic stresses
/// and the viscosities of its shear rates, temperatures, factors and states, if it has some.
void addViscosities(const Case& c, Frame& frame);

extern template Frame makeFrame<2>(const Particles<2>&, std::uint32_t, std::uint32_t, double);
extern template Frame makeFrame<3>(const Particles<3>&, std::uint32_t, std::uint32_t, double);

}  // namespace treacle
