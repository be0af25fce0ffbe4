// Times the parts of a step on the GPU over the papers' cases and writes one JSON record.
//   gpu_benchmark [--out FILE.json] [--cases DIR] [--scheme accurate] [--only TEXT] [--quick] [--largest
//   RESOLUTION]
// Parts, by name: products/..., setup/..., solve/... Figures of one run belong together: compare them as ratios,
// the machine may be shared.

#include "gpu_products.hpp"
#include "gpu_solves.hpp"
#include "treacle/core/device.hpp"
#include "treacle/core/version.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fstream>

int main(int argc, char** argv) {
  using namespace treacle;
  CLI::App app{"Times the parts of a step on the GPU"};
  BenchmarkOptions options;
  options.cases = TREACLE_CASES;
  std::string out;
  app.add_option("--out", out, "JSON record");
  app.add_option("--cases", options.cases, "directory of the case files");
  app.add_option("--scheme", options.scheme, "of the dam breaks, published unless told");
  app.add_option("--only", options.only, "only parts whose name contains this");
  app.add_option("--largest", options.largest, "only one step of the 3D dam break at this resolution");
  app.add_flag("--quick", options.quick, "few steps, small cases");
  CLI11_PARSE(app, argc, argv);

  const auto devices = cudaDevices();
  if (devices.empty()) {
    fmt::print(stderr, "gpu_benchmark: no CUDA device on this machine\n");
    return 2;
  }
  Record record;
  const BuildInfo build = buildInfo();
  record.json = {{"commit", build.commit},
                 {"compiler", build.compiler},
                 {"device", devices[0].name},
                 {"scheme", options.scheme}};
  record.copyBandwidth = copyBandwidth();
  record.json["copy_bandwidth_GB_per_s"] = record.copyBandwidth * 1e-9;
  fmt::print("{}, copy {:.2f} TB/s\n", devices[0].name, record.copyBandwidth * 1e-12);

  if (options.largest == 0) {
    benchmarkProducts<2>(options, record);
    benchmarkProducts<3>(options, record);
  }
  benchmarkSolves(options, record);
  if (!out.empty()) std::ofstream(out) << record.json.dump(1) << '\n';
}
