#include "treacle/precondition/projected_multigrid.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace treacle::test {
namespace {

/// Of what is not a product with C.
template <class T>
constexpr double projectedToleranceOf = std::is_same_v<T, double> ? operatorTolerance : 200 * singleTolerance;

/// One scene with its products and preconditioner on both backends.
template <int D, class T>
struct Twin {
  Scene<D> s;
  DeviceScene<D> d;
  MphOperator<D> a;
  MphOperator<D, Cuda> aOnDevice;
  ParticleProducts<D, T> products;
  ParticleProducts<D, T, Cuda> productsOnDevice;
  ProjectionConstants constants;

  explicit Twin(Scene<D> scene) : s(std::move(scene)), d(s), constants(projectionConstants(s.pairs())) {
    a.prepare(s.context, s.pairs(), s.terms());
    aOnDevice.prepare(d.context, d.pairs, d.terms());
    products.prepare(s.context, s.pairs(), s.terms(), a);
    productsOnDevice.prepare(d.context, d.pairs, d.terms(), aOnDevice);
  }

  bool isStiff() const { return constants.stiffness > mostPackedStiffness<D>; }
  /// In single precision the device's elements of C have few bits where there is B: 1.2e-3 of a product in three
  /// dimensions, 2.7e-5 in two, and up to 5e-3 where fluid slips, whose elements have twice the range. Else
  /// positions have 16 bits in three dimensions: 3e-5 spacings, and 1e-4 of a product where they are random.
  double productTolerance() const {
    if (D == 2 || std::is_same_v<T, double> || (isStiff() && s.pairs().renormalisation))
      return projectedToleranceOf<T>;
    return s.pairs().slips() ? 6e-3 : s.pairs().renormalisation ? 3e-3 : 5e-4;
  }
  /// On the CPU elements of C have few bits in products with S'.
  double schurTolerance() const {
    return D == 3 && std::is_same_v<T, float> && !isStiff() ? 3e-3 : productTolerance();
  }

  std::uint32_t active() const { return s.pairs().activeCount; }

  Buffer<T> randomScalars(std::size_t n, unsigned seed) {
    const Vector v = randomVector(static_cast<Index>(n), seed);
    Buffer<T> b(n);
    for (std::size_t i = 0; i < n; ++i) b[i] = static_cast<T>(v[static_cast<Index>(i)]);
    return b;
  }
  Buffer<Gathered<D, T>> randomVectors(unsigned seed) {
    const Buffer<T> numbers = randomScalars(std::size_t{D} * s.n(), seed);
    Buffer<Gathered<D, T>> b(s.n());
    for (std::size_t i = 0; i < b.size(); ++i)
      for (int k = 0; k < D; ++k) b[i][k] = numbers[D * i + k];
    return b;
  }
  /// |x - y| / |y| over all numbers.
  template <class V>
  static double differ(const Buffer<V>& x, const Buffer<V>& y) {
    double sum = 0, scale = 0;
    constexpr int numbers = std::is_arithmetic_v<V> ? 1 : D;
    for (std::size_t i = 0; i < y.size(); ++i)
      for (int k = 0; k < numbers; ++k) {
        double a1, b1;
        if constexpr (std::is_arithmetic_v<V>)
          a1 = x[i], b1 = y[i];
        else
          a1 = x[i][k], b1 = y[i][k];
        sum += (a1 - b1) * (a1 - b1), scale += b1 * b1;
      }
    return std::sqrt(sum / scale);
  }

  void checkProducts() {
    const auto table = constants.template table<T>(),
               tableOnDevice = projectionConstants(d.pairs).template table<T>();
    const Buffer<T> q = randomScalars(active(), 1);
    products.gather(s.context, q.span());
    productsOnDevice.gather(d.context, copyToDevice<T>(d.context, q).span());
    Buffer<Gathered<D, T>> z(s.n());
    std::fill(z.begin(), z.end(), Gathered<D, T>{});
    Buffer<Vec<D>> gradient(s.n());
    Buffer<Vec<D>, Cuda> gradientOnDevice(d.context, s.n());
    const auto zOnDevice = copyToDevice<Gathered<D, T>>(d.context, z);
    products.gradient(s.context, products.scalars(),
                      FinishVelocity<D, T>{table, s.pairs().material.data(), z.data(), gradient.data()});
    productsOnDevice.gradient(
        d.context, productsOnDevice.scalars(),
        FinishVelocity<D, T>{tableOnDevice, d.pairs.material.data(), zOnDevice.data(), gradientOnDevice.data()});
    EXPECT_LE(differ(copyToHost(d.context, gradientOnDevice), gradient), productTolerance()) << "gradient";

    Buffer<Gathered<D, T>> u = randomVectors(2);
    auto uOnDevice = copyToDevice<Gathered<D, T>>(d.context, u);
    products.gather(s.context, u.span());
    productsOnDevice.gather(d.context, uOnDevice.span());
    Buffer<T> div(active());
    Buffer<T, Cuda> divOnDevice(d.context, active());
    products.divergence(s.context, products.vectors(),
                        StorePressure<T, Cpu>{table, s.pairs().material.data(), products.scalars(), div.data()});
    productsOnDevice.divergence(d.context, productsOnDevice.vectors(),
                                StorePressure<T, Cuda>{tableOnDevice, d.pairs.material.data(),
                                                       productsOnDevice.scalars(), divOnDevice.data()});
    EXPECT_LE(differ(copyToHost(d.context, divOnDevice), div), productTolerance()) << "divergence";

    products.gather(s.context, q.span());
    productsOnDevice.gather(d.context, copyToDevice<T>(d.context, q).span());
    products.schur(s.context, table, products.scalars(),
                   StorePressure<T, Cpu>{table, s.pairs().material.data(), products.scalars(), div.data()});
    productsOnDevice.schur(d.context, tableOnDevice, productsOnDevice.scalars(),
                           StorePressure<T, Cuda>{tableOnDevice, d.pairs.material.data(),
                                                  productsOnDevice.scalars(), divOnDevice.data()});
    EXPECT_LE(differ(copyToHost(d.context, divOnDevice), div), schurTolerance()) << "S'";

    Buffer<T> pressure(active());
    Buffer<Block<D, T>> velocity(s.n());
    Buffer<T, Cuda> pressureOnDevice(d.context, active());
    Buffer<Block<D, T>, Cuda> velocityOnDevice(d.context, s.n());
    products.inverseDiagonals(s.context, table, pressure, velocity);
    productsOnDevice.inverseDiagonals(d.context, tableOnDevice, pressureOnDevice, velocityOnDevice);
    EXPECT_LE(differ(copyToHost(d.context, pressureOnDevice), pressure), projectedToleranceOf<T>)
        << "diagonal of S'";
    Buffer<double> resisting(s.n());
    Buffer<double, Cuda> resistingOnDevice(d.context, s.n());
    products.resistingViscosity(s.context, constants.resistance, resisting.span());
    productsOnDevice.resistingViscosity(d.context, constants.resistance, resistingOnDevice.span());
    EXPECT_LE(differ(copyToHost(d.context, resistingOnDevice), resisting), projectedToleranceOf<T>)
        << "resisting viscosity";
    checkViscous(u, uOnDevice, velocity, velocityOnDevice);
  }

  void checkViscous(Buffer<Gathered<D, T>>& u, Buffer<Gathered<D, T>, Cuda>& uOnDevice,
                    const Buffer<Block<D, T>>& inverse, const Buffer<Block<D, T>, Cuda>& inverseOnDevice) {
    Buffer<Gathered<D, T>> residual = randomVectors(3), x = randomVectors(4), next(s.n()), z = randomVectors(2);
    auto residualOnDevice = copyToDevice<Gathered<D, T>>(d.context, residual);
    auto xOnDevice = copyToDevice<Gathered<D, T>>(d.context, x);
    auto zOnDevice = copyToDevice<Gathered<D, T>>(d.context, z);
    Buffer<Gathered<D, T>, Cuda> nextOnDevice(d.context, s.n());
    products.viscous(s.context, u.data(),
                     VelocityStep<D, T, false>{
                         inverse.data(), T(0.3), T(0.7), {residual.data(), z.data(), x.data()}, next.data()});
    productsOnDevice.viscous(
        d.context, uOnDevice.data(),
        VelocityStep<D, T, false>{inverseOnDevice.data(),
                                  T(0.3),
                                  T(0.7),
                                  {residualOnDevice.data(), zOnDevice.data(), xOnDevice.data()},
                                  nextOnDevice.data()});
    EXPECT_LE(differ(copyToHost(d.context, residualOnDevice), residual), projectedToleranceOf<T>)
        << "viscous product";
    EXPECT_LE(differ(copyToHost(d.context, nextOnDevice), next), projectedToleranceOf<T>) << "correction";
    EXPECT_LE(differ(copyToHost(d.context, xOnDevice), x), projectedToleranceOf<T>) << "iterate";
  }

  template <class Values>
  void checkNodes(const HatNodes<D>& nodes, const HatNodes<D, Cuda>& onDevice, const Values& matrix,
                  const Buffer<typename Values::value_type>& values, const char* what) {
    const Buffer<std::uint32_t> points = copyToHost(d.context, onDevice.point);
    ASSERT_EQ(points.size(), nodes.point.size()) << what;
    EXPECT_TRUE(std::equal(points.begin(), points.end(), nodes.point.begin())) << what;
    ASSERT_EQ(values.size(), matrix.size()) << what;
    double worst = 0, largest = 0;
    for (std::size_t k = 0; k < values.size(); ++k)
      for (std::size_t e = 0; e < std::size(values[k].a); ++e) {
        worst = std::max(worst, std::abs(values[k].a[e] - matrix[k].a[e]));
        largest = std::max(largest, std::abs(matrix[k].a[e]));
      }
    EXPECT_LE(worst, projectedToleranceOf<T> * largest) << what;
  }

  void checkGrid() {
    HatNodes<D> nodes, fluidNodes;
    HatNodes<D, Cuda> nodesOnDevice, fluidNodesOnDevice;
    findHatNodes(s.context, s.pairs(), HatsOn::Active, nodes);
    findHatNodes(d.context, d.pairs, HatsOn::Active, nodesOnDevice);
    findHatNodes(s.context, s.pairs(), HatsOn::Fluid, fluidNodes);
    findHatNodes(d.context, d.pairs, HatsOn::Fluid, fluidNodesOnDevice);

    Buffer<Vec<D, T>> columns;
    Buffer<T, Cuda> parts;
    BlockCsr<1> pressure;
    BlockCsr<1, double, Cuda> pressureOnDevice;
    const auto table = constants.template table<double>(),
               tableOnDevice = projectionConstants(d.pairs).template table<double>();
    pressureGalerkin(s.context, s.pairs(), table, nodes, columns, pressure);
    pressureGalerkin(d.context, d.pairs, aOnDevice.near(), tableOnDevice, nodesOnDevice, parts, pressureOnDevice);
    checkNodes(nodes, nodesOnDevice, std::span<const Block<1>>(pressure.value.span()),
               copyToHost(d.context, pressureOnDevice.value), "P^T S' P");

    Buffer<ViscousMoments<D, T>> moments;
    Buffer<ViscousMoments<D, T>, Cuda> momentsOnDevice;
    BlockCsr<D> velocity;
    BlockCsr<D, double, Cuda> velocityOnDevice;
    viscousGalerkin(s.context, s.pairs(), s.terms(), fluidNodes, moments, velocity);
    viscousGalerkin(d.context, d.pairs, d.terms(), fluidNodesOnDevice, momentsOnDevice, parts, velocityOnDevice);
    checkNodes(fluidNodes, fluidNodesOnDevice, std::span<const Block<D>>(velocity.value.span()),
               copyToHost(d.context, velocityOnDevice.value), "P^T K0 P");
    checkTransfer(nodes, nodesOnDevice, fluidNodes, fluidNodesOnDevice);
  }

  void checkTransfer(const HatNodes<D>& nodes, const HatNodes<D, Cuda>& nodesOnDevice,
                     const HatNodes<D>& fluidNodes, const HatNodes<D, Cuda>& fluidNodesOnDevice) {
    HatTransfer<D, T> transfer;
    HatTransfer<D, T, Cuda> transferOnDevice;
    transfer.prepare(s.context, s.pairs());
    transferOnDevice.prepare(d.context, d.pairs);
    const Buffer<T> r = randomScalars(active(), 5);
    Buffer<T> b(nodes.count()), x = randomScalars(active(), 6);
    Buffer<T, Cuda> bOnDevice(d.context, nodes.count());
    auto xOnDevice = copyToDevice<T>(d.context, x);
    transfer.restrict(s.context, nodes, r.span(), b);
    transferOnDevice.restrict(d.context, nodesOnDevice, copyToDevice<T>(d.context, r).span(), bOnDevice);
    EXPECT_LE(differ(copyToHost(d.context, bOnDevice), b), projectedToleranceOf<T>) << "restriction";
    transfer.prolong(s.context, nodes, b, products.scalars(), x);
    transferOnDevice.prolong(d.context, nodesOnDevice, copyToDevice<T>(d.context, b), productsOnDevice.scalars(),
                             xOnDevice);
    EXPECT_LE(differ(copyToHost(d.context, xOnDevice), x), projectedToleranceOf<T>) << "prolongation";

    const Buffer<Gathered<D, T>> u = randomVectors(7);
    Buffer<T> bu(D * fluidNodes.count());
    Buffer<T, Cuda> buOnDevice(d.context, bu.size());
    transfer.restrict(s.context, fluidNodes, u.span(), bu);
    transferOnDevice.restrict(d.context, fluidNodesOnDevice, copyToDevice<Gathered<D, T>>(d.context, u).span(),
                              buOnDevice);
    EXPECT_LE(differ(copyToHost(d.context, buOnDevice), bu), projectedToleranceOf<T>)
        << "restriction of velocities";
    Buffer<Gathered<D, T>> z(s.n()), y = randomVectors(8);
    Buffer<Gathered<D, T>, Cuda> zOnDevice(d.context, s.n());
    auto yOnDevice = copyToDevice<Gathered<D, T>>(d.context, y);
    transfer.prolong(s.context, fluidNodes, bu, z, y);
    transferOnDevice.prolong(d.context, fluidNodesOnDevice, copyToDevice<T>(d.context, bu), zOnDevice, yOnDevice);
    EXPECT_LE(differ(copyToHost(d.context, zOnDevice), z), projectedToleranceOf<T>)
        << "prolongation of velocities";
    EXPECT_LE(differ(copyToHost(d.context, yOnDevice), y), projectedToleranceOf<T>)
        << "prolongation of velocities";
  }

  /// z = M r on both; the two choose their smallest grids differently, so they agree as two good cycles do.
  void checkWhole() {
    const ProjectionDegrees degrees{8, 4, 2};
    ProjectedMultigrid<D, T> m;
    ProjectedMultigrid<D, T, Cuda> mOnDevice;
    m.setup(s.context, s.pairs(), s.terms(), a, degrees);
    mOnDevice.setup(d.context, d.pairs, d.terms(), aOnDevice, degrees);
    const std::vector<Vec<D>> r = unflat<D>(randomVector(s.unknowns(), 9));
    Buffer<Vec<D>> z(s.n());
    Buffer<Vec<D>, Cuda> zOnDevice(d.context, s.n()), again(d.context, s.n());
    const auto rOnDevice = copyToDevice<Vec<D>>(d.context, r);
    m.apply(s.context, r, z);
    mOnDevice.apply(d.context, rOnDevice, zOnDevice);
    mOnDevice.apply(d.context, rOnDevice, again);
    const Buffer<Vec<D>> first = copyToHost(d.context, zOnDevice), second = copyToHost(d.context, again);
    EXPECT_LE(differ(first, z), 1e-2);
    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.span().size_bytes()), 0) << "not the same bits";
  }

  void checkAll() {
    checkProducts();
    checkGrid();
    checkWhole();
  }
};

template <int D, class T>
void checkScenes(SchemeKind scheme) {
  SCOPED_TRACE(nameOf(scheme));
  for (const Walls walls : {Walls::Floor, Walls::None})
    for (const bool twoMaterials : {true, false}) {
      SCOPED_TRACE(testing::Message() << D << "D, " << sizeof(T) << " bytes, floor " << (walls == Walls::Floor)
                                      << ", two materials " << twoMaterials);
      Twin<D, T>(makeScene<D>({.walls = walls, .twoMaterials = twoMaterials, .scheme = scheme})).checkAll();
    }
  SCOPED_TRACE(testing::Message() << D << "D, " << sizeof(T) << " bytes, many particles");
  Twin<D, T>(makeLargeScene<D>(scheme)).checkAll();
}

TEST(ProjectedMultigridTwin, EqualsTheCpuInDouble) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    checkScenes<2, double>(scheme);
    checkScenes<3, double>(scheme);
  }
}

TEST(ProjectedMultigridTwin, EqualsTheCpuInSingle) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    checkScenes<2, float>(scheme);
    checkScenes<3, float>(scheme);
  }
}

/// Stiff fluids have elements of 64 bits; blocks with more neighbours than shared memory is there for find them
/// where they are.
TEST(ProjectedMultigridTwin, ProductsWithManyBitsAndOfManyNeighboursEqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  const auto check = []<int D>(std::integral_constant<int, D>, double stiffness, double wider) {
    SCOPED_TRACE(testing::Message() << D << "D, bulk viscosities times " << stiffness << ", wider " << wider);
    Scene<D> s = makeScene<D>({.scheme = SchemeKind::Accurate});
    for (Material& m : s.c.materials) m.bulkViscosity *= stiffness;
    s.c.method.pressureRadius *= wider;
    prepare(s);
    Twin<D, float> twin(std::move(s));
    EXPECT_EQ(twin.isStiff(), stiffness > 1);
    twin.checkProducts();
  };
  constexpr std::integral_constant<int, 2> plane;
  constexpr std::integral_constant<int, 3> space;
  for (const double stiffness : {1e-3, 1e6})
    for (const double wider : {1.0, 1.6}) check(plane, stiffness, wider), check(space, stiffness, wider);
}

/// Of so many particles none share their row of a block's neighbours (StagedLists).
TEST(ProjectedMultigridTwin, ProductsOfManyParticlesEqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Twin<2, float> plane(makeLargeScene<2>(SchemeKind::Accurate, 380));
  ASSERT_EQ(StagedLists<2>::sharing(plane.s.n()), 1u);
  plane.checkProducts();
  Twin<3, float> space(makeLargeScene<3>(SchemeKind::Accurate, 55));
  ASSERT_EQ(StagedLists<3>::sharing(space.s.n()), 1u);
  space.checkProducts();
}

}  // namespace
}  // namespace treacle::test
