// The three products that a step of MPH-I spends its time in, against the ceilings of the processor, on the dam
// breaks by the default scheme; one thread.
//   product_benchmark --benchmark_out=FILE.json --benchmark_out_format=json
// A: the operator of conjugate gradients, in double precision. S': the pressure matrix of the preconditioner, in
// single precision with packed elements. K0: its viscous matrix, in single precision. Counters: bytes and vector
// operations that a product needs per particle (a multiplication with an addition is one operation on eight or
// sixteen numbers), and the shares of the time that they would take at the measured ceilings. In a case that fits
// the caches the share of the memory may be above 1.

#include "treacle/core/lanes.hpp"
#include "treacle/core/vectors.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/mph/renormalisation.hpp"
#include "treacle/precondition/particle_products.hpp"
#include "treacle/precondition/projected_multigrid.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

namespace treacle {
namespace {

/// Processor time, as the products are measured; least of five trials.
double secondsOf(auto&& work) {
  double best = 1e300;
  for (int trial = 0; trial < 5; ++trial) {
    const std::clock_t start = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

/// Multiplications with additions of a vector type that one thread does in a second.
template <class Vector>
double operationsPerSecond() {
  // Enough of them for the latency of the units, and few enough for the registers.
  constexpr bool oneRegister = sizeof(Vector) <= sizeof(std::experimental::native_simd<float>);
  constexpr int chains = oneRegister ? 10 : 5, turns = 20'000'000;
  Vector sum[chains] = {}, factor = Vector(0.999999f), summand = Vector(1e-3f);
  const double seconds = secondsOf([&] {
    for (int turn = 0; turn < turns; ++turn)
      for (Vector& s : sum) s = s * factor + summand;
    benchmark::DoNotOptimize(sum);
  });
  return chains * turns / seconds;
}

/// Bytes that one thread reads in a second from memory.
double bytesPerSecond() {
  constexpr std::size_t size = std::size_t{1} << 26;  // half a gigabyte, more than any cache
  const std::vector<double> values(size, 1.0);
  const double seconds = secondsOf([&] {
    Lanes sum[4] = {};
    for (std::size_t k = 0; k < size; k += 4 * laneCount)
      for (std::size_t s = 0; s < 4; ++s) sum[s] += load<Lanes>(&values[k + s * laneCount]);
    benchmark::DoNotOptimize(sum);
  });
  return size * sizeof(double) / seconds;
}

struct Ceilings {
  double bytes = bytesPerSecond(), doubles = operationsPerSecond<Lanes>(),
         floats = operationsPerSecond<LanesOf<float>>(), floatPairs = operationsPerSecond<Simd<float, 16>>();
};
const Ceilings& ceilings() {
  static const Ceilings measured;
  return measured;
}

/// What a product needs: bytes and seconds of arithmetic at the ceiling.
struct Need {
  double bytes = 0, operations = 0, operationsPerSecond = 0;
};

void report(benchmark::State& state, double particles, const Need& need) {
  using benchmark::Counter;
  state.counters["particles"] = particles;
  state.counters["B/particle"] = need.bytes / particles;
  state.counters["operations/particle"] = need.operations / particles;
  const double runs = static_cast<double>(state.iterations());
  state.counters["ns/particle"] = Counter(1e-9 * particles * runs, Counter::kIsRate | Counter::kInvert);
  state.counters["of memory"] = Counter(need.bytes / ceilings().bytes * runs, Counter::kIsRate);
  state.counters["of arithmetic"] = Counter(need.operations / need.operationsPerSecond * runs, Counter::kIsRate);
}

/// A dam break at its start, ready for products; the velocity is a smooth field.
template <int D>
struct Start {
  Case c;
  Particles<D> particles;
  Context<Cpu> context;
  MphNeighbourhood<D> neighbourhood;
  Buffer<Block<D>> wallBlock;
  Buffer<Vec<D>> wallGradient, u, y;
  Buffer<SymmetricBlock<D>> b;
  MphOperator<D> a;

  explicit Start(const std::string& resolution) : c(read(resolution)), particles(create(c)), neighbourhood(c) {
    neighbourhood.sort(context, particles);
    neighbourhood.buildLists(context, particles);
    const std::uint32_t n = particles.fluidCount;
    b.resize(n);
    renormalisation<D>(context, neighbourhood.pairs(), b.span());
    neighbourhood.setRenormalisation(b);
    for (Buffer<Vec<D>>* v : {&wallGradient, &u, &y}) v->resize(n);
    wallBlock.resize(n);
    wallTerms<D>(context, pairs(), terms());
    for (std::uint32_t i = 0; i < n; ++i)
      for (int k = 0; k < D; ++k) u[i][k] = std::sin(300 * particles.position[i][k]);
    a.prepare(context, pairs(), terms());
  }

  const MphPairs<D>& pairs() const { return neighbourhood.pairs(); }
  WallTerms<D> terms() { return {wallBlock.span(), wallGradient.span()}; }
  double particleCount() const { return particles.fluidCount; }

  /// Neighbours in the lists of all clusters of fluid, each of which serves eight particles.
  double columns(std::initializer_list<ListSegment> segments) const {
    const ClusterListView& list = pairs().fluidList;
    double sum = 0;
    for (std::uint32_t cluster = 0; cluster < list.clusterCount(); ++cluster)
      for (ListSegment s : segments) sum += static_cast<double>(list.segment(cluster, s).size());
    return sum;
  }

 private:
  static Case read(const std::string& resolution) {
    const std::vector<std::string> settings{"resolution=" + resolution};
    return readCase(fmt::format("{}/dam-break-{}d.toml", TREACLE_CASES, D), settings);
  }
  static Particles<D> create(const Case& c) {
    std::vector<std::string> notes;
    return createParticles<D>(c, notes);
  }
};

constexpr double index = sizeof(std::uint32_t);

template <int D>
void multiplyA(benchmark::State& state, const std::string& resolution) {
  using enum ListSegment;
  Start<D> s(resolution);
  for (auto _ : state) s.a.multiply(s.context, s.u, s.y);
  const double near = s.columns({NearFluid}), far = s.columns({FarFluid}), walls = s.columns({NearWall});
  constexpr double lanes = laneCount * sizeof(double);
  Need need;
  // Viscous terms and the divergence in one pass, the gradient in another.
  need.bytes = near * (3 * lanes + 2 * index) + far * (lanes + index) + walls * (lanes + index) +
               s.particleCount() * (2 * sizeof(SymmetricBlock<D>) + 6 * sizeof(Vec<D>) + 3 * sizeof(double));
  need.operations = (near + far) * (4 * D + 1) + near * (2 * D * D + 5 * D + 1) + walls * 4 * D;
  need.operationsPerSecond = ceilings().doubles;
  report(state, s.particleCount(), need);
}

template <int D>
void multiplySchur(benchmark::State& state, const std::string& resolution) {
  Start<D> s(resolution);
  ParticleProducts<D, float> products;
  products.prepare(s.context, s.pairs(), s.terms(), s.a);
  const ProjectionTable<float> table = projectionConstants(s.pairs()).template table<float>();
  std::vector<float> q(s.pairs().activeCount, 1.0f);
  products.gather(s.context, q);
  const StorePressure<float, Cpu> store{table, s.pairs().classOf(), products.scalars(), q.data()};
  for (auto _ : state) products.schur(s.context, table, products.scalars(), store);
  const auto [gradient, divergence] = products.packedPairs();
  Need need;
  need.bytes = (gradient + divergence) * 2 * (laneCount * sizeof(float) + index) +
               s.particleCount() * (2 * D + 4) * sizeof(float);
  need.operations = (gradient + divergence) * 2 * D;  // an element is converted, and multiplied
  need.operationsPerSecond = ceilings().floatPairs;
  report(state, s.particleCount(), need);
}

template <int D>
void multiplyK0(benchmark::State& state, const std::string& resolution) {
  using enum ListSegment;
  Start<D> s(resolution);
  ParticleProducts<D, float> products;
  products.prepare(s.context, s.pairs(), s.terms(), s.a);
  const std::size_t n = s.particles.fluidCount;
  std::vector<float> pressure(s.pairs().activeCount);
  std::vector<Block<D, float>> inverse(n);
  products.inverseDiagonals(s.context, projectionConstants(s.pairs()).template table<float>(), pressure, inverse);
  std::vector<Gathered<D, float>> residual(n), solution(n), correction(n), next(n);
  const VelocityStep<D, float, false> store{
      inverse.data(), 0.5f, 0.1f, {residual.data(), correction.data(), solution.data()}, next.data()};
  for (auto _ : state) products.viscous(s.context, correction.data(), store);
  const double columns = s.columns({NearFluid, FarFluid});
  Need need;
  need.bytes = columns * (laneCount * sizeof(float) + index) +
               s.particleCount() * (2 * sizeof(Block<D, float>) + 6 * sizeof(Gathered<D, float>));
  need.operations = columns * (3 * D + 1);
  need.operationsPerSecond = ceilings().floats;
  report(state, s.particleCount(), need);
}

template <int D>
void registerProducts(std::initializer_list<const char*> resolutions) {
  for (const char* resolution : resolutions) {
    const auto add = [&](const char* name, auto* product) {
      benchmark::RegisterBenchmark(fmt::format("{}/{}D/r{}", name, D, resolution).c_str(), product, resolution);
    };
    add("A", multiplyA<D>);
    add("S'", multiplySchur<D>);
    add("K0", multiplyK0<D>);
  }
}

}  // namespace
}  // namespace treacle

int main(int argc, char** argv) {
  using namespace treacle;
  omp_set_num_threads(1);
  benchmark::AddCustomContext("commit", buildInfo().commit);
  benchmark::AddCustomContext("vectors", std::string(vectorInstructions()));
  const Ceilings& c = ceilings();
  benchmark::AddCustomContext("GB/s", fmt::format("{:.3g}", 1e-9 * c.bytes));
  benchmark::AddCustomContext(
      "operations on 8 doubles, 8 floats, 16 floats [1e9/s]",
      fmt::format("{:.3g}, {:.3g}, {:.3g}", 1e-9 * c.doubles, 1e-9 * c.floats, 1e-9 * c.floatPairs));
  registerProducts<2>({"1", "8"});
  registerProducts<3>({"0.5", "2"});
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
