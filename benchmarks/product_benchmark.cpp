// One product with A, matrix-free and assembled, on the dam breaks of [K23] by its scheme; one thread.
//   product_benchmark --benchmark_out=FILE.json --benchmark_out_format=json
// Counters: time per million particles; GB/s of what the operator keeps, read once per product.

#include "treacle/core/version.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/create.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_operator.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <omp.h>

#include <cmath>

namespace treacle {
namespace {

/// A dam break at its start, ready for products; the velocity is a smooth field.
template <int D>
struct Start {
  Case c;
  Particles<D> particles;
  Context<Cpu> context;
  MphNeighbourhood<D> neighbourhood;
  Buffer<Block<D>> wallBlock;
  Buffer<Vec<D>> wallGradient, u, y;

  explicit Start(const std::string& resolution) : c(read(resolution)), particles(create(c)), neighbourhood(c) {
    neighbourhood.sort(context, particles);
    neighbourhood.buildLists(context, particles);
    for (Buffer<Vec<D>>* v : {&wallGradient, &u, &y}) v->resize(particles.fluidCount);
    wallBlock.resize(particles.fluidCount);
    wallTerms<D>(context, neighbourhood.pairs(), terms());
    for (std::uint32_t i = 0; i < particles.fluidCount; ++i)
      for (int k = 0; k < D; ++k) u[i][k] = std::sin(300 * particles.position[i][k]);
  }

  WallTerms<D> terms() { return {wallBlock.span(), wallGradient.span()}; }

 private:
  static Case read(const std::string& resolution) {
    const std::vector<std::string> settings{"resolution=" + resolution};
    return readCase(fmt::format("{}/published/dam-break-{}d.toml", TREACLE_CASES, D), settings);
  }
  static Particles<D> create(const Case& c) {
    std::vector<std::string> notes;
    return createParticles<D>(c, notes);
  }
};

void report(benchmark::State& state, double particles, std::size_t bytes) {
  const double products = static_cast<double>(state.iterations());
  state.counters["particles"] = particles;
  state.counters["per_Mparticle"] =
      benchmark::Counter(particles * products * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["B/particle"] = static_cast<double>(bytes) / particles;
  state.counters["GB/s"] =
      benchmark::Counter(1e-9 * static_cast<double>(bytes) * products, benchmark::Counter::kIsRate);
}

template <int D>
void matrixFree(benchmark::State& state, const std::string& resolution) {
  Start<D> s(resolution);
  MphOperator<D> a;
  a.prepare(s.context, s.neighbourhood.pairs(), s.terms());
  for (auto _ : state) a.multiply(s.context, s.u, s.y);
  report(state, s.particles.fluidCount, a.bytes());
}

template <int D>
void assembled(benchmark::State& state, const std::string& resolution) {
  Start<D> s(resolution);
  GradientRows<D> rows;
  gradientRows(s.context, s.neighbourhood.pairs(), rows);
  BlockCsr<D> a;
  assemble(s.context, s.neighbourhood.pairs(), s.terms(), rows, a);
  for (auto _ : state) multiply<D, double>(s.context, a, s.u.span(), s.y.span());
  report(state, s.particles.fluidCount, a.bytes());
}

}  // namespace
}  // namespace treacle

int main(int argc, char** argv) {
  using namespace treacle;
  omp_set_num_threads(1);
  benchmark::AddCustomContext("commit", buildInfo().commit);
  for (const char* resolution : {"1", "4", "8"}) {
    benchmark::RegisterBenchmark((std::string("matrix-free/2D/x1:") + resolution).c_str(), matrixFree<2>,
                                 resolution);
    benchmark::RegisterBenchmark((std::string("assembled/2D/x1:") + resolution).c_str(), assembled<2>, resolution);
  }
  for (const char* resolution : {"0.5", "1", "2"}) {
    benchmark::RegisterBenchmark((std::string("matrix-free/3D/x1:") + resolution).c_str(), matrixFree<3>,
                                 resolution);
    benchmark::RegisterBenchmark((std::string("assembled/3D/x1:") + resolution).c_str(), assembled<3>, resolution);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
