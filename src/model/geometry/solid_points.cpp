#include "solid_points.hpp"

#include "thin_sheet.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/core/work_in_hand.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace treacle {
namespace {

/// Points `origin + k spacing` with 0 <= k < count on each axis.
template <int D>
struct Rows {
  Vec<D> origin;
  Vec<D, std::int64_t> count;
};

/// The rows of the lattice that may lie in the solid, in the domain and a spacing beside it: a particle there
/// shows that the body reaches out of the domain.
template <int D, class Region>
Rows<D> rowsOf(const Case& c, const Body& body, const Region& solid) {
  const Domain& domain = c.domain;
  double points = 1;
  Rows<D> rows{};
  for (int k = 0; k < D; ++k) {
    const double first = domain.min[k] + c.spacing / 2;
    const double last = std::ceil((domain.max[k] - domain.min[k]) / c.spacing);
    const double low = std::max(std::ceil((solid.min()[k] - first) / c.spacing), -1.0),
                 high = std::min(std::floor((solid.max()[k] - first) / c.spacing), last);
    rows.origin[k] = first + low * c.spacing;
    points *= std::max(0.0, high - low + 1);
    rows.count[k] = static_cast<std::int64_t>(std::clamp(high - low + 1, 0.0, 1e15));
  }
  if (points > static_cast<double>(maxParticles) * 16) throw tooManyPoints(body);
  return rows;
}

/// Errors: InputError for one that cannot be meant so.
template <int D, class Region>
void requireNearDomain(const Case& c, const Body& body, const Region& solid) {
  constexpr double much = 10;
  const Domain& domain = c.domain;
  bool apart = false, larger = true;
  for (int k = 0; k < D; ++k) {
    apart = apart || solid.min()[k] >= domain.max[k] || solid.max()[k] < domain.min[k];
    larger = larger && solid.max()[k] - solid.min()[k] > much * (domain.max[k] - domain.min[k]);
  }
  if (!apart && !larger) return;
  throw InputError(fmt::format(
      "body '{}' {}: it reaches from {}, the domain from {}{}", body.name,
      apart ? "is outside of the domain" : "is far larger than the domain",
      rangeText(resized<3>(solid.min()), resized<3>(solid.max()), D), rangeText(domain.min, domain.max, D),
      body.shape.kind == ShapeKind::Mesh
          ? "; one metre is one unit of the file, or transform.scale of one: 1e-3 for a file in millimetres"
          : ""));
}

template <int D, class Region>
std::vector<Vec<D>> pointsIn(const Region& solid, const Case& c, const Body& body, std::vector<std::string>& notes,
                             const std::function<bool(const Vec<D>&)>& keep) {
  requireNearDomain<D>(c, body, solid);
  const Rows<D> rows = rowsOf<D>(c, body, solid);
  const std::int64_t length = rows.count[0], count = rows.count[1] * (D == 3 ? rows.count[D - 1] : 1);
  const auto at = [&](std::int64_t i, std::int64_t row) {
    Vec<D> x = rows.origin;
    x[0] += static_cast<double>(i) * c.spacing, x[1] += static_cast<double>(row % rows.count[1]) * c.spacing;
    if constexpr (D == 3) x[2] += static_cast<double>(row / rows.count[1]) * c.spacing;
    return x;
  };
  const std::int64_t some = std::min(count, 1 + (std::int64_t{1} << 22) / std::max<std::int64_t>(length, 1));
  std::vector<char> within(static_cast<std::size_t>(length * some));
  std::vector<Vec<D>> points;
  bool any = false;
  WorkInHand work(fmt::format("filling body '{}'", body.name), static_cast<std::size_t>(count));
  for (std::int64_t begin = 0; begin < count; begin += some) {
    const std::int64_t end = std::min(begin + some, count);
    parallelForDynamic(static_cast<std::size_t>(end - begin), 2, 1, [&](std::size_t r) {
      char* row = within.data() + static_cast<std::int64_t>(r) * length;
      for (std::int64_t i = 0; i < length;) {
        const auto [is, sure] = solid.filled(at(i, begin + static_cast<std::int64_t>(r)));
        const double further = std::ceil(sure / c.spacing) - 1;  // points for which that is the answer, too
        const auto last = i + 1 + static_cast<std::int64_t>(std::clamp(further, 0.0, static_cast<double>(length)));
        for (; i < std::min(last, length); ++i) row[i] = is;
      }
      work.add(1);
    });
    for (std::int64_t k = 0; k < (end - begin) * length; ++k) {
      if (!within[static_cast<std::size_t>(k)]) continue;
      any = true;
      if (const Vec<D> x = at(k % length, begin + k / length); keep(x)) points.push_back(x);
      if (points.size() > maxParticles) throw tooManyPoints(body);
    }
  }
  if (!any)
    notes.push_back(
        fmt::format("body '{}' ({}, {}) has no particles: no point of the lattice of spacing {} is in it",
                    body.name, nameOf(body.shape.kind), nameOf(body.shape.fill), lengthText(c.spacing)));
  return points;
}

}  // namespace

InputError tooManyPoints(const Body& body) {
  return InputError(
      fmt::format("body '{}' would have more than {} particles; take a larger spacing or a lower "
                  "resolution",
                  body.name, maxParticles));
}

template <int D>
std::vector<Vec<D>> solidPoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                                const std::function<bool(const Vec<D>&)>& keep) {
  return pointsIn<D>(Solid<D>(body.shape, c.interactionRadius(), c.spacing), c, body, notes, keep);
}

template <int D>
std::vector<Vec<D>> sheetPoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                                const std::function<bool(const Vec<D>&)>& keep) {
  const ThinSheet<D> sheet(c, body);
  const auto inDomain = [&](const Vec<D>& x) {
    for (int k = 0; k < D; ++k)
      if (!(x[k] >= c.domain.min[k] && x[k] < c.domain.max[k])) return false;
    return true;
  };
  std::size_t all = 0, outside = 0;
  std::optional<Vec<D>> place;
  std::vector<Vec<D>> points = pointsIn<D>(sheet, c, body, notes, [&](const Vec<D>& x) {
    const Vec<D> seen = x + sheet.at(x, c.interactionRadius()).way;
    const bool isThere = inDomain(x), isSeen = inDomain(seen);
    if (isSeen) ++all;
    if (isSeen && !isThere && outside++ == 0) place = seen;
    return isThere && keep(seen);
  });
  constexpr double most = 0.02;  // where a sheet leaves the domain aslant, a few are outside
  if (static_cast<double>(outside) > most * static_cast<double>(all))
    notes.push_back(fmt::format(
        "thin sheet '{}': {:.0f} % of its particles are left out, because they would be outside of the domain: "
        "fluid beside the sheet, such as at {}, does not feel all of it; expected a domain that goes on for {} "
        "on both sides of the sheet",
        body.name, 100.0 * static_cast<double>(outside) / static_cast<double>(all),
        positionText(resized<3>(*place), D), lengthText(c.interactionRadius())));
  return points;
}

template std::vector<Vec<2>> solidPoints<2>(const Case&, const Body&, std::vector<std::string>&,
                                            const std::function<bool(const Vec<2>&)>&);
template std::vector<Vec<3>> solidPoints<3>(const Case&, const Body&, std::vector<std::string>&,
                                            const std::function<bool(const Vec<3>&)>&);
template std::vector<Vec<2>> sheetPoints<2>(const Case&, const Body&, std::vector<std::string>&,
                                            const std::function<bool(const Vec<2>&)>&);
template std::vector<Vec<3>> sheetPoints<3>(const Case&, const Body&, std::vector<std::string>&,
                                            const std::function<bool(const Vec<3>&)>&);

}  // namespace treacle
