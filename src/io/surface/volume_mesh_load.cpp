#include "treacle/core/error.hpp"
#include "volume_mesh.hpp"

#include <dlfcn.h>

#include <filesystem>

namespace treacle {
namespace {

/// Where the module may be: beside this program as it was installed, then as it was built.
std::vector<std::filesystem::path> moduleFiles() {
  std::vector<std::filesystem::path> files;
  Dl_info self;
  if (dladdr(reinterpret_cast<const void*>(&moduleFiles), &self) && self.dli_fname) {
    std::error_code failed;
    const std::filesystem::path here = std::filesystem::canonical(self.dli_fname, failed).parent_path();
    files = {here / TREACLE_MODULES_FROM_PROGRAM, here / "treacle"};
  }
  files.emplace_back(TREACLE_BUILT_MODULES);
  files.emplace_back(TREACLE_INSTALLED_MODULES);
  for (std::filesystem::path& file : files) file /= "treacle_volume_mesh.so";
  return files;
}

struct Module {
  VolumeMeshFunction* mesh = nullptr;
  std::string reason;  // why there is none

  static Module load() {
    Module module;
    for (const std::filesystem::path& file : moduleFiles()) {
      if (!exists(file)) continue;
      void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (library) {
        module.mesh = reinterpret_cast<VolumeMeshFunction*>(dlsym(library, volumeMeshFunction));
        if (module.mesh) return module;
      }
      if (module.reason.empty()) module.reason = dlerror();
    }
    if (module.reason.empty()) module.reason = "the file treacle_volume_mesh.so was not found beside the program";
    module.reason = "surfaces are made by OpenVDB, which cannot be loaded: " + module.reason;
    return module;
  }
};

const Module& loaded() {
  static const Module module = Module::load();
  return module;
}

}  // namespace

std::string whyNoVolumeMesh() { return loaded().reason; }

TriangleMesh volumeMesh(const BlockedField& field) {
  if (!loaded().mesh) throw InputError(loaded().reason);
  TriangleMesh mesh;
  loaded().mesh(field, mesh);
  return mesh;
}

}  // namespace treacle
