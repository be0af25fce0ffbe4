#include "treacle/mph/near_products.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace treacle::test {
namespace {

Vector roundedToSingle(const Vector& numbers) {
  return Vector(std::vector<float>(numbers.begin(), numbers.end()));
}
/// Random numbers that single precision holds exactly, so that it is the products alone that round.
Vector randomSingles(Index n, unsigned seed) { return roundedToSingle(randomVector(n, seed)); }

/// Numbers of type T as values of type V in device memory.
template <class T, class V = T>
Buffer<V, Cuda> upload(const Context<Cuda>& context, const Vector& numbers) {
  const std::vector<T> converted(numbers.begin(), numbers.end());
  return copyToDevice<V>(context,
                         {reinterpret_cast<const V*>(converted.data()), numbers.size() * sizeof(T) / sizeof(V)});
}

/// The relative difference of two results, norm-wise.
template <class T, class V = T>
double difference(const Context<Cuda>& context, const Vector& expected, const Buffer<V, Cuda>& found) {
  const Buffer<V> onHost = copyToHost(context, found);
  const Vector f(std::span(reinterpret_cast<const T*>(onHost.data()), onHost.size() * sizeof(V) / sizeof(T)));
  EXPECT_EQ(f.size(), expected.size());
  return (f - expected).norm() / expected.norm();
}

/// The products of lists per particle against the sums of the CPU.
template <int D>
struct ProductsTwin {
  using Single = Vec<D, float>;

  Scene<D> s;
  DeviceScene<D> d;
  NearProducts<D> products;
  Index n, active;
  Vector q, y, u;

  explicit ProductsTwin(Scene<D> scene)
      : s(std::move(scene)),
        d(s),
        n(s.unknowns()),
        active(s.pairs().activeCount),
        q(randomSingles(active, 1)),
        y(roundedToSingle(randomVector(n, 2) / s.c.spacing)),  // as large as the gradient that is added
        u(randomSingles(n, 3)) {
    products.prepare(d.context, d.pairs);
  }

  /// y + C q of the CPU.
  Vector gradientAddedTo(const Vector& before) {
    std::vector<Vec<D>> sum = unflat<D>(before);
    addPressureGradient<D>(s.context, s.pairs(), {q.data(), std::size_t(active)}, 1, sum);
    return flat<D>(sum);
  }

  void checkDouble() {
    auto found = upload<double, Vec<D>>(d.context, y);
    products.addPressureGradient(d.context, upload<double>(d.context, q), found.span());
    EXPECT_LE((difference<double>(d.context, gradientAddedTo(y), found)), 10 * kernelTolerance);
  }

  void checkSingleGradient() {
    const auto single = upload<float>(d.context, q);
    auto found = upload<float, Single>(d.context, y);
    products.addPressureGradient(d.context, single, found.span());
    EXPECT_LE((difference<float>(d.context, gradientAddedTo(y), found)), singleTolerance);

    const Vector zero = Vector::Zero(n);
    found = upload<float, Single>(d.context, Vector::Constant(n, std::numeric_limits<double>::quiet_NaN()));
    products.pressureGradient(d.context, single, found.span());
    EXPECT_LE((difference<float>(d.context, gradientAddedTo(zero), found)), singleTolerance);
  }

  void checkSingleDivergence() {
    std::vector<Vec<D>> velocity = unflat<D>(u);
    velocity.resize(active, Vec<D>{});  // walls at rest
    Vector expected(active);
    divergence<D>(s.context, s.pairs(), velocity, {expected.data(), std::size_t(active)});
    auto found = upload<float>(d.context, Vector::Constant(active, std::numeric_limits<double>::quiet_NaN()));
    products.divergence(d.context, upload<float, Single>(d.context, u), found.span());
    EXPECT_LE(difference<float>(d.context, expected, found), singleTolerance);
  }
};

template <int D>
void check(Scene<D> scene, const char* what) {
  SCOPED_TRACE(testing::Message() << D << "D, " << what);
  ProductsTwin<D> twin(std::move(scene));
  twin.checkDouble();
  twin.checkSingleGradient();
  twin.checkSingleDivergence();
}

template <int D>
void checkAll() {
  check<D>(makeScene<D>(Walls::Floor, 3), "floor");
  check<D>(makeScene<D>(Walls::None, 3), "no walls");
  check<D>(makeLargeScene<D>(), "many particles");
}

TEST(NearProductsTwin, EqualThePairSumsOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkAll<2>();
  checkAll<3>();
}

}  // namespace
}  // namespace treacle::test
