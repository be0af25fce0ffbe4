#include "compare_tables.hpp"
#include "print.hpp"

#include <fmt/format.h>

#include <optional>

namespace treacle {

void printFrames(std::span<const FrameDifference> frames) {
  print("{:>12}", "");
  for (const char* field :
       {"position [m]", "velocity [m/s]", "pressure [Pa]", "number density", "nearest distance"})
    print("  {:>27}", field);
  print("\n{:>12}", "t [s]");
  for (std::size_t k = 0; k < comparedFieldCount; ++k) print("  {:>9}{:>9}{:>9}", "max", "rms", "relative");
  print("\n");
  for (const FrameDifference& frame : frames) {
    print("{:12.6g}", frame.time);
    for (const auto& d : frame.fields)
      if (d)
        print("  {:9.2e}{:9.2e}{:9.2e}", d->maximum, d->rms, d->relative);
      else
        print("  {0:>9}{0:>9}{0:>9}", "-");
    print("\n");
  }
}

void printMeasures(std::span<const SetMeasure> measures) {
  const auto number = [](const std::optional<double>& x, const char* format) {
    return x ? fmt::format(fmt::runtime(format), *x) : std::string("-");
  };
  print("{:24}{:>14}{:>14}{:>12}{:>12}\n", "", "A", "B", "difference", "relative");
  for (const SetMeasure& m : measures)
    print("{:24}{:>14}{:>14}{:>12}{:>12}\n", m.unit.empty() ? m.name : fmt::format("{} [{}]", m.name, m.unit),
          number(m.a, "{:.6g}"), number(m.b, "{:.6g}"), number(m.difference, "{:.2e}"),
          number(m.relative, "{:.2e}"));
}

std::string listOf(std::span<const ComparedField> fields) {
  std::string list;
  for (const ComparedField field : fields) list += fmt::format("{}{}", list.empty() ? "" : ", ", nameOf(field));
  return list;
}

}  // namespace treacle
