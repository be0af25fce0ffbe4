#include "support/gpu.hpp"
#include "treacle/core/cuda.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace treacle::test {
namespace {

TEST(DeviceBuffer, ReturnsWhatWasCopiedIn) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  for (std::size_t n : {0u, 1u, 31u, 33u, 100003u}) {
    std::vector<double> values(n);
    std::iota(values.begin(), values.end(), 0.5);
    Buffer<double, Cuda> device = copyToDevice<double>(context, values);
    const Buffer<double, Cuda> moved = std::move(device);
    const Buffer<double> back = copyToHost(context, moved);
    ASSERT_EQ(back.size(), n);
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(back[i], values[i]);
  }
}

TEST(DeviceBuffer, ReportsExhaustedMemory) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  EXPECT_THROW((Buffer<double, Cuda>(context, std::size_t{1} << 50)), std::bad_alloc);
  EXPECT_EQ(copyToHost(context, copyToDevice<double>(context, std::vector<double>{1.0}))[0], 1.0);
}

}  // namespace
}  // namespace treacle::test
