#include "nozzle_profile.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/expression.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace treacle {
namespace {

/// cosh(a) / cosh(b) for 0 <= a <= b.
double coshRatio(double a, double b) { return std::exp(a - b) * (1 + std::exp(-2 * a)) / (1 + std::exp(-2 * b)); }

/// Steady viscous flow through a rectangle, but for a factor. `x`: from its centre over half of its sides.
double flowOfRectangle(const Vec<2>& x, double width, double height) {
  constexpr int terms = 100;
  double sum = 0;
  for (int n = 1, sign = 1; n < 2 * terms; n += 2, sign = -sign) {
    const double q = n * std::numbers::pi / 2, b = q * height / width;
    sum += sign / std::pow(n, 3) * (1 - coshRatio(b * std::abs(x[1]), b)) * std::cos(q * x[0]);
  }
  return sum;
}

/// Steady viscous flow at a place from the centre of the opening [m], but for a factor: between two plates, or in
/// a pipe whose section is the opening.
double viscousFlow(const Nozzle& n, const Vec<1>& place) {
  const double x = std::abs(place[0]);
  return n.kind == NozzleKind::Disc ? (n.radius - x) * (x + (n.innerRadius > 0 ? -n.innerRadius : n.radius))
                                    : n.width * n.width / 4 - x * x;
}
double viscousFlow(const Nozzle& n, const Vec<2>& place) {
  if (n.kind == NozzleKind::Rectangle) {
    const Vec<2> x{2 * place[0] / n.width, 2 * place[1] / n.height};
    return n.height < n.width ? flowOfRectangle({x[1], x[0]}, n.height, n.width)
                              : flowOfRectangle(x, n.width, n.height);
  }
  const double r = norm(place) / n.radius, inner = n.innerRadius / n.radius;
  return 1 - r * r - (inner > 0 ? (1 - inner * inner) * std::log(r) / std::log(inner) : 0);
}

}  // namespace

template <int D>
std::vector<double> nozzleProfile(const Body& body, std::span<const Vec<D>> across,
                                  const std::array<Vec<D>, D - 1>& axes) {
  const Inflow& inflow = body.inflow;
  if (inflow.profile == plugProfile) return {1};
  std::vector<double> speeds;
  if (inflow.profile == parabolicProfile) {
    for (const Vec<D>& x : across) {
      Vec<D - 1> place;
      for (int k = 0; k < D - 1; ++k) place[k] = dot(x, axes[static_cast<std::size_t>(k)]);
      speeds.push_back(std::max(0.0, viscousFlow(inflow.nozzle, place)));
    }
  } else {
    const Expression expression(inflow.profile, D);
    for (const Vec<D>& x : across) {
      const Vec<3> place = inflow.nozzle.center + resized<3>(x);
      const double speed = expression(place);
      if (!(speed >= 0) || !std::isfinite(speed))
        throw InputError(fmt::format(
            "\"{}\" is {:g} for the column of particles at {}; expected a finite number not less than 0",
            inflow.profile, speed, positionText(place, D)));
      speeds.push_back(speed);
    }
  }
  const double sum = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  if (!(sum > 0) || !std::isfinite(sum))
    throw InputError(fmt::format("\"{}\" is {:g} for all columns of particles together; expected more than 0",
                                 inflow.profile, sum));
  const double count = static_cast<double>(speeds.size());
  for (double& speed : speeds) speed *= count / sum;
  return speeds;
}

template std::vector<double> nozzleProfile(const Body&, std::span<const Vec<2>>, const std::array<Vec<2>, 1>&);
template std::vector<double> nozzleProfile(const Body&, std::span<const Vec<3>>, const std::array<Vec<3>, 2>&);

}  // namespace treacle
