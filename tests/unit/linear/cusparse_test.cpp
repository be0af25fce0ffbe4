#include "linear/cusparse.hpp"

#include "treacle/core/error.hpp"

#include <gtest/gtest.h>

#include <array>

namespace treacle::test {
namespace {

std::string messageOfLoading(std::span<const std::string> files) {
  try {
    loadCusparse(files);
  } catch (const RunError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Cusparse, ThatIsMissingIsNamedWithWhatToInstall) {
  const std::array<std::string, 2> files{"libcusparse.so.0", "/nowhere/libcusparse.so.0"};
  const std::string message = messageOfLoading(files);
  EXPECT_NE(message.find("libcusparse.so.0: cannot open shared object file"), std::string::npos) << message;
  EXPECT_NE(message.find("pip install nvidia-cusparse"), std::string::npos) << message;
}

TEST(Cusparse, ThatLacksAFunctionIsAnErrorThatNamesTheFunction) {
  const std::array<std::string, 2> files{"libcusparse.so.0", "libm.so.6"};
  const std::string message = messageOfLoading(files);
  EXPECT_NE(message.find("has no function cusparseCreate"), std::string::npos) << message;
}

}  // namespace
}  // namespace treacle::test
