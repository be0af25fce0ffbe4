#include "fields.hpp"

#include "arrays.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace treacle {
namespace {

namespace nb = nanobind;

enum class Number { Double, Byte, Word };

struct NamedField {
  const char* name;
  FluidField field;
  Number number = Number::Double;
  bool (*isThere)(const Case&) = nullptr;  // whether a case has it; null: all have
};
constexpr NamedField namedFields[] = {
    {"positions", FluidField::Position},
    {"velocities", FluidField::Velocity},
    {"pressures", FluidField::Pressure},
    {"number_densities", FluidField::NumberDensity},
    {"shear_rates", FluidField::ShearRate, Number::Double, [](const Case& c) { return c.hasOwnViscosities(); }},
    {"temperatures", FluidField::Temperature, Number::Double, [](const Case& c) { return c.heat.has_value(); }},
    {"viscosity_factors", FluidField::ViscosityFactor, Number::Double,
     [](const Case& c) { return c.hasViscosityFactors(); }},
    {"materials", FluidField::Material, Number::Byte},
    {"bodies", FluidField::Body, Number::Byte},
    {"ids", FluidField::Id, Number::Word}};

/// Fields of the table, and "state:NAME" of a state of the case's materials.
NamedField fieldNamed(const Session& session, const std::string& name) {
  for (const NamedField& f : namedFields)
    if (name == f.name) return f;
  const std::vector<std::string> states = session.theCase().stateNames();
  for (std::size_t k = 0; k < states.size(); ++k)
    if (name == "state:" + states[k]) return {"state", fieldOfState(k)};
  throw InputError(fmt::format("the fluid has no field '{}'", name));
}

/// f(a number of the field's type).
template <class F>
nb::object withNumber(Number number, F&& f) {
  if (number == Number::Byte) return f(std::uint8_t{});
  if (number == Number::Word) return f(std::uint32_t{});
  return f(double{});
}

std::size_t dimensionsOf(const FieldMemory& m) { return m.components > 1 ? 2 : 1; }
std::array<std::size_t, 2> shapeOf(const FieldMemory& m) {
  return {m.count, static_cast<std::size_t>(m.components)};
}

/// An array that was given, as long as it is needed.
class Given {
 public:
  using Array = nb::ndarray<const double, nb::c_contig>;

  Given(const nb::object& object, const char* what) {
    if (object.is_none()) return;
    if (!nb::try_cast(object, array_))
      throw InputError(fmt::format("{}: expected an array of 64 bit numbers without gaps", what));
  }
  bool isThere() const { return array_.is_valid(); }
  bool isOnDevice() const { return array_.device_type() == nb::device::cuda::value; }
  std::span<const double> span() const {
    return isThere() ? std::span<const double>(array_.data(), array_.size()) : std::span<const double>{};
  }

 private:
  Array array_;
};

}  // namespace

bool hasField(const Session& session, const std::string& name) {
  const NamedField named = fieldNamed(session, name);
  return !named.isThere || named.isThere(session.theCase());
}

nb::object copiedField(const Session& session, const std::string& name) {
  if (!hasField(session, name)) return nb::none();
  const NamedField named = fieldNamed(session, name);
  const FieldMemory m = session.simulation().field(named.field);
  return withNumber(named.number, [&]<class T>(T) -> nb::object {
    auto* values = new T[std::max<std::size_t>(m.bytes / sizeof(T), 1)];
    const nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    session.simulation().copyField(named.field, values);
    const auto shape = shapeOf(m);
    return nb::cast(nb::ndarray<nb::numpy, T>(values, dimensionsOf(m), shape.data(), owner));
  });
}

nb::object fieldInPlace(const Session& session, const std::string& name, nb::handle owner) {
  const NamedField named = fieldNamed(session, name);
  const FieldMemory m = session.simulation().field(named.field);
  const int device = m.where == BackendKind::Cuda ? nb::device::cuda::value : nb::device::cpu::value;
  return withNumber(named.number, [&]<class T>(T) -> nb::object {
    const auto shape = shapeOf(m);
    return nb::cast(nb::ndarray<nb::array_api, T>(static_cast<T*>(const_cast<void*>(m.data)), dimensionsOf(m),
                                                  shape.data(), owner, nullptr, nb::dtype<T>(), device, 0));
  });
}

nb::tuple fieldAddress(const Session& session, const std::string& name) {
  const NamedField named = fieldNamed(session, name);
  const FieldMemory m = session.simulation().field(named.field);
  const nb::object shape =
      m.components > 1 ? nb::object(nb::make_tuple(m.count, m.components)) : nb::object(nb::make_tuple(m.count));
  const char* type = named.number == Number::Byte ? "|u1" : named.number == Number::Word ? "<u4" : "<f8";
  return nb::make_tuple(reinterpret_cast<std::uintptr_t>(m.data), shape, type);
}

void giveFluid(Session& session, const nb::object& positions, const nb::object& velocities,
               const nb::object& temperatures, const nb::object& viscosityFactors,
               const nb::typed<nb::dict, nb::str, nb::object>& states) {
  const Given x(positions, "positions"), u(velocities, "velocities"), warm(temperatures, "temperatures"),
      factors(viscosityFactors, "viscosity_factors");
  std::optional<bool> onDevice;
  std::vector<const Given*> all{&x, &u, &warm, &factors};
  const std::vector<std::string> names = session.theCase().stateNames();
  std::vector<Given> ofStates;
  ofStates.reserve(maxStates);
  std::array<std::span<const double>, maxStates> values;
  for (const auto& [name, state] : states) {
    const auto found = std::ranges::find(names, nb::cast<std::string>(name));
    if (found == names.end())
      throw InputError(fmt::format("states: the case has no state '{}'", nb::cast<std::string>(name)));
    all.push_back(&ofStates.emplace_back(nb::borrow(state), "states"));
    values[static_cast<std::size_t>(found - names.begin())] = ofStates.back().span();
  }
  for (const Given* given : all) {
    if (!given->isThere()) continue;
    if (onDevice && *onDevice != given->isOnDevice())
      throw InputError("expected arrays in the memory of the host, or all in that of the GPU, found both");
    onDevice = given->isOnDevice();
  }
  const GivenFluid given{x.span(),    u.span(),
                         warm.span(), factors.span(),
                         values,      onDevice.value_or(false) ? BackendKind::Cuda : BackendKind::Cpu};
  const nb::gil_scoped_release release;
  session.giveFluid(given);
}

nb::dict arraysOf(const Frame& frame) {
  nb::dict arrays;
  const auto dimensions = static_cast<std::size_t>(frame.dimensions);
  forEachFrameField([&]<class T>(const char* name, std::vector<T> Frame::*member) {
    const std::vector<T>& values = frame.*member;
    if (values.empty() && frame.position.size() > 0) {
      arrays[name] = nb::none();
      return;
    }
    if constexpr (std::is_same_v<T, Vec<3>>)
      arrays[name] = arrayOf(values, dimensions);
    else
      arrays[name] = arrayOf(values);
  });
  nb::dict states;
  for (const FrameState& state : frame.states) states[state.name.c_str()] = arrayOf(state.values);
  arrays["states"] = states;
  return arrays;
}

}  // namespace treacle
