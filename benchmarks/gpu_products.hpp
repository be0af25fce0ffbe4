#pragma once

#include "gpu_record.hpp"
#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/diagonal.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"
#include "treacle/precondition/particle_products.hpp"
#include "treacle/precondition/projected_multigrid.hpp"

namespace treacle {

/// A dam break at its start on the device, ready for products; the velocity is a smooth field.
template <int D>
struct DeviceStart {
  Case c;
  Context<Cuda> context;
  Particles<D, Cuda> particles;
  MphNeighbourhood<D, Cuda> neighbourhood;
  Buffer<Block<D>, Cuda> wallBlock;
  Buffer<Vec<D>, Cuda> wallGradient, u, y;

  DeviceStart(const BenchmarkOptions& options, double resolution)
      : c(paperCase(options, D, resolution)), neighbourhood(c) {
    std::vector<std::string> notes;
    copyToDevice(context, createParticles<D>(c, notes), particles);
    neighbourhood.sort(context, particles);
    neighbourhood.buildLists(context, particles);
    const std::uint32_t n = particles.fluidCount;
    Buffer<Vec<D>> x;
    copyToHost(context, std::span<const Vec<D>>(particles.position).first(n), x);
    for (std::uint32_t i = 0; i < n; ++i)
      for (int k = 0; k < D; ++k) x[i][k] = std::sin(300 * x[i][k]);
    copyToDevice<Vec<D>>(context, x, u);
    for (auto* v : {&y, &wallGradient}) v->resize(context, n);
    wallBlock.resize(context, n);
    wallTerms<D>(context, pairs(), terms());
  }
  const MphPairs<D>& pairs() const { return neighbourhood.pairs(); }
  WallTerms<D> terms() { return {wallBlock.span(), wallGradient.span()}; }
  std::uint32_t n() const { return particles.fluidCount; }
};

/// Bytes that a product with A reads and writes at least, matrix-free: positions, vectors, wall terms and lists,
/// each once per pass.
template <int D>
double productBytes(DeviceStart<D>& s) {
  const double n = s.n(), active = s.pairs().activeCount;
  const double list = 4.0 * static_cast<double>(valueOnHost(
                                s.context, s.pairs().fluidList.offset + 4 * s.pairs().fluidList.clusterCount()));
  return 2 * active * D * 8 + n * (5 * sizeof(Vec<D>) + sizeof(Block<D>)) + 2 * active * 8 + 1.3 * list;
}

/// The products of a preconditioner in single precision.
template <int D>
void benchmarkSingle(const std::string& size, DeviceStart<D>& s, const MphOperator<D, Cuda>& a, Record& record) {
  ParticleProducts<D, float, Cuda> products;
  products.prepare(s.context, s.pairs(), s.terms(), a);
  const ProjectionTable<float> table = projectionConstants(s.pairs()).template table<float>();
  const std::uint8_t* material = s.pairs().material.data();
  Buffer<float, Cuda> q(s.context, s.pairs().activeCount);
  products.gatherWeighted(s.context, table, s.u);
  const auto time = [&](auto&& work) { return secondsOf(s.context, work); };
  record.add("products/C p float/" + size, s.n(), time([&] {
               products.gradient(s.context, products.scalars(),
                                 StoreWeighted<D, float, Cuda>{table, material, products.vectors()});
             }));
  const StorePressure<float, Cuda> store{table, material, products.scalars(), q.data()};
  record.add("products/C^T x float/" + size, s.n(),
             time([&] { products.divergence(s.context, products.vectors(), store); }));
  record.add("products/C^T W C p float/" + size, s.n(),
             time([&] { products.schur(s.context, table, products.scalars(), store); }));
}

template <int D>
void benchmarkAssembled(const std::string& size, DeviceStart<D>& s, Record& record) {
  GradientRows<D, Cuda> rows;
  BlockCsr<D, double, Cuda> a;
  record.add("setup/assemble/" + size, s.n(),
             secondsOf(
                 s.context,
                 [&] {
                   gradientRows(s.context, s.pairs(), rows);
                   assemble(s.context, s.pairs(), s.terms(), rows, a);
                 },
                 3));
  const double bytes = static_cast<double>(a.value.size() * sizeof(Block<D>) + a.column.size() * 4 +
                                           a.rowStart.size() * 8 + 2 * s.n() * sizeof(Vec<D>));
  record.add("products/A assembled/" + size, s.n(),
             secondsOf(s.context, [&] { multiply<D, double>(s.context, a, s.u, s.y); }), bytes);

  BucketLevels<Cuda> levels;
  findBuckets(s.context, s.neighbourhood.ranges().key, D * CellGrid<D>::subBits, D, levels);
  GalerkinSpgemm<D> spgemm;
  BlockCsr<D, double, Cuda> a0;
  record.add("setup/A^0 spgemm/" + size, s.n(),
             secondsOf(
                 s.context, [&] { spgemm.compute(s.context, a, levels.begin[0], a0); }, 3));
}

template <int D>
void benchmarkSetup(const std::string& size, DeviceStart<D>& s, Record& record) {
  auto& context = s.context;
  record.add("setup/sort/" + size, s.n(),
             secondsOf(
                 context, [&] { s.neighbourhood.sort(context, s.particles); }, 5));
  record.add("setup/lists/" + size, s.n(),
             secondsOf(
                 context, [&] { s.neighbourhood.buildLists(context, s.particles); }, 5));
  Buffer<Block<D>, Cuda> diagonal(context, s.n());
  Buffer<Vec<D>, Cuda> inverse(context, s.n());
  record.add("setup/diagonal/" + size, s.n(),
             secondsOf(
                 context,
                 [&] {
                   diagonalBlocks<D>(context, s.pairs(), s.terms(), diagonal);
                   jacobiInverse<D, double>(context, diagonal, inverse);
                 },
                 5));
  BucketLevels<Cuda> levels;
  BlockCsr<D, double, Cuda> a0;
  Buffer<Vec<D>, Cuda> columns;
  record.add("setup/A^0 direct/" + size, s.n(),
             secondsOf(
                 context,
                 [&] {
                   findBuckets(context, s.neighbourhood.ranges().key, D * CellGrid<D>::subBits, D, levels);
                   bucketGalerkin(context, s.pairs(), s.neighbourhood.ranges(), levels, s.terms(), columns, a0);
                 },
                 5));
  BucketMultigrid<D, double, Cuda> k;
  record.add("setup/coarse levels/" + size, s.n(),
             secondsOf(
                 context,
                 [&] {
                   k.setup(context, a0, {levels.begin.begin(), levels.begin.end()}, {});
                 },
                 5));
  record.add("solve/V-cycle/" + size, s.n(), secondsOf(context, [&] { k.apply(context, inverse, s.u, s.y); }));
}

template <int D>
void benchmarkProducts(const BenchmarkOptions& options, Record& record) {
  const std::vector<double> sizes = D == 2 ? std::vector<double>{1, 4, 8, 16, 32} : std::vector<double>{1, 2, 4};
  for (const double resolution : sizes) {
    const std::string size = fmt::format("{}D x1/{:g}", D, resolution);
    if (!options.wants("products setup " + size) || (options.quick && resolution != sizes.back())) continue;
    DeviceStart<D> s(options, resolution);
    MphOperator<D, Cuda> a;
    a.prepare(s.context, s.pairs(), s.terms());
    record.add("setup/operator/" + size, s.n(),
               secondsOf(
                   s.context, [&] { a.prepare(s.context, s.pairs(), s.terms()); }, 5));
    record.add("products/A double/" + size, s.n(), secondsOf(s.context, [&] { a.multiply(s.context, s.u, s.y); }),
               productBytes(s));
    benchmarkSingle(size, s, a, record);
    benchmarkSetup(size, s, record);
    benchmarkAssembled(size, s, record);
  }
}

}  // namespace treacle
