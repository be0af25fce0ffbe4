#include "case_settings.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace treacle {
TimeSettings readTime(const Section& top, double resolution) {
  const Section s = top.required("time", {"step", "end", "courant"});
  TimeSettings time;
  time.step = s.number("step", Bound::Positive, "s") / resolution;
  time.end = s.number("end", Bound::Positive, "s");
  time.courant = s.number("courant", Bound::NonNegative, "", time.courant);
  const double steps = time.end / time.step;
  if (steps < 0.5 && !time.stepsVary())
    throw s.error("end", fmt::format("expected at least one step of {} s, found {}", time.step, time.end));
  if (steps > 1e15) throw s.error("step", fmt::format("{:.3g} steps to the end are too many", steps));
  return time;
}

OutputSettings readOutput(const Section& top, MethodKind method) {
  std::vector<std::string_view> keys{"interval", "checkpoint_interval", "fields", "format", "precision"};
  const std::vector<std::string_view> mphKeys{"balance"};
  const bool isph = method == MethodKind::Isph;
  if (!isph) keys.insert(keys.end(), mphKeys.begin(), mphKeys.end());
  const Section s =
      top.section("output", "[output]", keys, isph ? keysOf(MethodKind::MphI, mphKeys) : ForeignKeys{});
  OutputSettings output;
  output.interval = s.number("interval", Bound::NonNegative, "s", output.interval);
  output.checkpointInterval = s.number("checkpoint_interval", Bound::NonNegative, "s", output.checkpointInterval);
  output.precision = s.choice<OutputPrecision>("precision", output.precision);
  if (!isph) output.balance = s.flag("balance", output.balance);
  if (const std::string format = s.string("format", "vtp"); format != "vtp")
    throw s.error("format", fmt::format("expected 'vtp', found '{}'", format));
  if (const auto words = s.strings("fields")) {
    output.fields = {false, false, false, false, false, false};
    for (const std::string& word : *words) {
      const auto named = std::ranges::find(outputFieldNames, word, &OutputFieldName::name);
      if (named == std::end(outputFieldNames)) {
        std::vector<std::string_view> names;
        for (const OutputFieldName& f : outputFieldNames) names.push_back(f.name);
        throw s.error("fields", fmt::format("expected {}, found '{}'", listOf(names), word));
      }
      output.fields.*(named->flag) = true;
    }
  }
  return output;
}

}  // namespace treacle
