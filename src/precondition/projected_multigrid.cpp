#include "treacle/precondition/projected_multigrid.hpp"

#include "treacle/mph/particle_viscosity.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {

template <class T>
ProjectionTable<T> ProjectionConstants::table(double shift) const {
  ProjectionTable<T> t{};
  for (int m = 0; m < ViscosityClasses::most; ++m) {
    t.weight[m] = static_cast<T>(weight[m]);
    t.inverseLambda[m] = static_cast<T>(1 / lambda[m]);
    t.shift[m] = static_cast<T>(shift / lambda[m]);
  }
  t.share = share;
  return t;
}
template ProjectionTable<double> ProjectionConstants::table<double>(double) const;
template ProjectionTable<float> ProjectionConstants::table<float>(double) const;

template <int D>
ProjectionConstants projectionConstants(const MphPairs<D>& pairs) {
  const MphTerms<D>& terms = pairs.terms;
  const double viscous = latticeSum<D>(terms.viscosityRadius, pairs.spacing, [&](double r) {
    return terms.viscousFactor * terms.resistanceShape(PairDistance<double>{r * r, 1 / r}) / D;
  });
  const double gradients = latticeSum<D>(terms.pressureRadius, pairs.spacing, [&](double r) {
    return std::pow(terms.gradient(PairDistance<double>{r * r, 1 / r}) * r, 2);
  });
  ProjectionConstants c{};
  c.share = pairs.bulkShare();
  std::fill_n(c.weight, ViscosityClasses::most, 1.0);
  std::fill_n(c.lambda, ViscosityClasses::most, 1.0);
  double largestWeight = 0, largestLambda = 0;
  for (int m = 0; m < pairs.classes.count; ++m) {
    const MaterialTable& t = pairs.materials;
    const int material = pairs.classes.material[m];
    c.weight[m] = 1 / (t.inertia[material] + pairs.classes.viscosity[m] * viscous);
    const double natural = 1 / (c.weight[m] * gradients);
    c.lambda[m] = std::max(t.bulkViscosity[material], 1e-4 * natural);
    if (m >= t.count) continue;
    largestWeight = std::max(largestWeight, c.weight[m]);
    largestLambda = std::max(largestLambda, c.lambda[m]);
  }
  // Where two materials meet, the pressure of the one moves the particles of the other.
  c.stiffness = largestLambda * largestWeight * gradients;
  c.resistance = viscous;
  c.severalFluids = pairs.classes.ofNeighbours;
  for (int k = 0; k < D; ++k) c.extent = std::max(c.extent, pairs.grid.length[k] / pairs.spacing);
  return c;
}
template ProjectionConstants projectionConstants(const MphPairs<2>&);
template ProjectionConstants projectionConstants(const MphPairs<3>&);

ProjectionDegrees chooseDegrees(ProjectionDegrees chosen, const ProjectionConstants& constants) {
  // Pressures of short wavelength that C hardly sees have eigenvalues of S' down to 1/stiffness of the largest. In
  // large bodies that have flowed far, a higher degree costs no time and saves iterations (docs/solver.md).
  const double size = std::clamp(std::cbrt(constants.extent / 300), 1.0, 1.35);
  // Between fluids there are more such pressures, those that only the heavier one resists.
  const double exponent = constants.severalFluids ? 0.35 : 0.3;
  const double wanted = 8 * std::pow(constants.stiffness / 100, exponent) * size;
  if (chosen.pressure == 0) chosen.pressure = std::clamp(static_cast<int>(std::lround(wanted)), 4, 160);
  if (chosen.grid == 0) chosen.grid = 4;
  if (chosen.velocity == 0) chosen.velocity = 2;
  return chosen;
}

template <int D, class T, class Backend>
void ProjectedMultigrid<D, T, Backend>::setup(Context<Backend>& context, const MphPairs<D>& pairs,
                                              const WallTerms<D>& terms, const MphOperator<D, Backend>& a,
                                              const ProjectionDegrees& degrees, KeptEigenvalue* kept,
                                              std::uint64_t mostWhole) {
  pairs_ = pairs;
  degrees_ = degrees;
  const ProjectionConstants constants = projectionConstants(pairs);
  table_ = constants.table<T>();
  allocate(context, pairs.fluidCount, pairs.activeCount);
  products_.prepare(context, pairs_, terms, a);
  if (pairs.classes.ofNeighbours) findClasses(context, constants);
  products_.inverseDiagonals(context, table_, inversePressure_, inverseVelocity_);
  setupGrids(context, terms, a, constants.table<double>(gridPressureShift), mostWhole);

  if (kept && kept->isKnown()) return lambdaMax_.assume(context, static_cast<T>(kept->value));
  const auto product = [&](std::span<const T> x, std::span<T> y) {
    products_.gather(context, x);
    products_.schur(context, table_, products_.scalars(),
                    StorePressure<T, Backend>{table_, pairs.classOf(), products_.scalars(), y.data()});
  };
  // Where particles have viscosities of their own a few of them decide on it, which Lanczos' method finds late.
  lambdaMax_.run(context, product, inversePressure_, pairs.viscosityClass ? 16 : 10);
  if (kept) kept->estimated(lambdaMax_.onHost(context));
}

/// Where fluids meet, a particle's neighbours are another resistance than its material says.
template <int D, class T, class Backend>
void ProjectedMultigrid<D, T, Backend>::findClasses(Context<Backend>& context,
                                                    const ProjectionConstants& constants) {
  resisting_.resize(context, pairs_.fluidCount);
  class_.resize(context, pairs_.activeCount);
  products_.resistingViscosity(context, constants.resistance, resisting_.span());
  setClasses(context, ClassTerms{pairs_.classes, pairs_.material, resisting_.span(), class_.span()});
  pairs_.viscosityClass = class_.data();
}

template <int D, class T, class Backend>
void ProjectedMultigrid<D, T, Backend>::setupGrids(Context<Backend>& context, const WallTerms<D>& terms,
                                                   const MphOperator<D, Backend>& a,
                                                   const ProjectionTable<double>& table, std::uint64_t mostWhole) {
  transfer_.prepare(context, pairs_);
  findHatNodes(context, pairs_, HatsOn::Active, pressureNodes_, pressureGrids_.mostWhole(mostWhole));
  if constexpr (std::is_same_v<Backend, Cuda>)
    pressureGalerkin(context, pairs_, a.near(), table, pressureNodes_, galerkinWorkspace_, pressureMatrix_);
  else
    pressureGalerkin(context, pairs_, table, pressureNodes_, galerkinWorkspace_, pressureMatrix_);
  giveUp(galerkinWorkspace_);
  DenseInverses<T, Backend> inverses;
  pressureGrids_.setup(context, pressureNodes_, pressureMatrix_, {.degree = degrees_.grid, .mostWhole = mostWhole},
                       inverses);

  findHatNodes(context, pairs_, HatsOn::Fluid, velocityNodes_, velocityGrids_.mostWhole(mostWhole));
  if constexpr (std::is_same_v<Backend, Cuda>)
    viscousGalerkin(context, pairs_, terms, velocityNodes_, moments_, galerkinWorkspace_, velocityMatrix_);
  else
    viscousGalerkin(context, pairs_, terms, velocityNodes_, moments_, velocityMatrix_);
  giveUp(moments_, galerkinWorkspace_);
  velocityGrids_.setup(context, velocityNodes_, velocityMatrix_,
                       {.degree = degrees_.velocity, .reach = 1, .mostWhole = mostWhole}, inverses);
  inverses.finish(context);
}

template <int D, class T, class Backend>
void ProjectedMultigrid<D, T, Backend>::allocate(Context<Backend>& context, std::size_t fluid,
                                                 std::size_t active) {
  for (Buffer<T, Backend>* v : {&inversePressure_, &pressureResidual_, &p_}) v->resize(context, active);
  inverseVelocity_.resize(context, fluid);
  for (Buffer<Gathered<D, T>, Backend>* v : {&velocityResidual_, &y_, &correction_[0], &correction_[1]})
    v->resize(context, fluid);
}

/// p = Q b, and where it is gathered; the right-hand side and the first smoothing step of it are there.
template <int D, class T, class Backend>
ScalarField<T, Backend> ProjectedMultigrid<D, T, Backend>::pressureCycle(Context<Backend>& context) {
  int last = 0;  // which of the two fields has the latest correction; the same at the start of each cycle
  const auto step = [&]<StepKind Kind>(int i, std::integral_constant<StepKind, Kind>) {
    products_.schur(context, table_, products_.scalars(last),
                    PressureStep<T, Backend, Kind>{table_, pairs_.classOf(), inversePressure_.data(),
                                                   lambdaMax_.largest(), ChebyshevStep<T>::at(i),
                                                   pressureVectors(last), products_.scalars(1 - last)});
    if (Kind != StepKind::Residual) last = 1 - last;
  };
  constexpr std::integral_constant<StepKind, StepKind::Next> next;
  for (int i = 2; i <= degrees_.pressure; ++i) step(i, next);
  step(1, std::integral_constant<StepKind, StepKind::Residual>{});
  transfer_.restrict(context, pressureNodes_, pressureResidual_.span(), pressureGrids_.rhs());
  pressureGrids_.cycle(context);
  transfer_.prolong(context, pressureNodes_, pressureGrids_.solution(), products_.scalars(last), p_);
  for (int i = 1; i < degrees_.pressure; ++i) step(i, next);
  step(degrees_.pressure, std::integral_constant<StepKind, StepKind::Last>{});
  return products_.scalars(last);
}

/// y = B residual, likewise.
template <int D, class T, class Backend>
void ProjectedMultigrid<D, T, Backend>::velocityCycle(Context<Backend>& context) {
  int last = 0;  // which of the two corrections is the latest; the same at the start of each cycle
  const auto step = [&]<bool ResidualOnly>(int i, std::bool_constant<ResidualOnly>) {
    const auto c = ChebyshevStep<T>::at(i);
    products_.viscous(context, correction_[last].data(),
                      VelocityStep<D, T, ResidualOnly>{inverseVelocity_.data(), c.previous,
                                                       c.gain / static_cast<T>(viscousLambdaMax),
                                                       velocityVectors(last), correction_[1 - last].data()});
    if constexpr (!ResidualOnly) last = 1 - last;
  };
  for (int i = 2; i <= degrees_.velocity; ++i) step(i, std::false_type{});
  step(1, std::true_type{});
  transfer_.restrict(context, velocityNodes_, velocityResidual_.span(), velocityGrids_.rhs());
  velocityGrids_.cycle(context);
  transfer_.prolong(context, velocityNodes_, velocityGrids_.solution(), correction_[last].span(), y_.span());
  for (int i = 1; i <= degrees_.velocity; ++i) step(i, std::false_type{});
}

template <int D, class T, class Backend>
void ProjectedMultigrid<D, T, Backend>::apply(Context<Backend>& context, std::span<const Vec<D>> r,
                                              std::span<Vec<D>> z) {
  const std::uint8_t* material = pairs_.classOf();
  const ChebyshevStep<T> first = ChebyshevStep<T>::at(1);
  const auto startPressure = [&](bool holdsPressure) {
    products_.divergence(context, products_.vectors(),
                         StartPressure<T, Backend>{table_, material, inversePressure_.data(), lambdaMax_.largest(),
                                                   first, pressureVectors(0), holdsPressure});
  };
  products_.gatherWeighted(context, table_, r);
  startPressure(false);
  const ScalarField<T, Backend> p = pressureCycle(context);
  products_.gradient(context, p,
                     StartVelocity<D, T>{r.data(), inverseVelocity_.data(),
                                         first.gain / static_cast<T>(viscousLambdaMax), velocityVectors(0)});
  velocityCycle(context);
  products_.gather(context, y_.span());
  startPressure(true);
  const ScalarField<T, Backend> q = pressureCycle(context);
  products_.gradient(context, q, FinishVelocity<D, T>{table_, material, y_.data(), z.data()});
}

template <int D, class T, class Backend>
std::size_t ProjectedMultigrid<D, T, Backend>::bytes() const {
  std::size_t sum = products_.bytes() + transfer_.bytes() + pressureNodes_.bytes() + velocityNodes_.bytes() +
                    galerkinWorkspace_.bytes() + moments_.bytes() + pressureMatrix_.bytes() +
                    velocityMatrix_.bytes() + pressureGrids_.bytes() + velocityGrids_.bytes() +
                    resisting_.bytes() + class_.bytes() + lambdaMax_.bytes() + inversePressure_.bytes() +
                    inverseVelocity_.bytes() + pressureResidual_.bytes() + p_.bytes();
  for (const auto* v : {&velocityResidual_, &y_, &correction_[0], &correction_[1]}) sum += v->bytes();
  return sum;
}

#define TREACLE_INSTANTIATE(Backend)                     \
  template class ProjectedMultigrid<2, double, Backend>; \
  template class ProjectedMultigrid<3, double, Backend>; \
  template class ProjectedMultigrid<2, float, Backend>;  \
  template class ProjectedMultigrid<3, float, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
