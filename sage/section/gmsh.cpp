#include "sage/section/gmsh.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <vector>

#include "sage/platform/module.hpp"
#include "sage/section/section_mesh.hpp"

namespace sage {

namespace section {

namespace {

struct Loaded {
  Gmsh functions;
  std::string reason;  // empty: usable
};

template <class Function>
void bind(Loaded& loaded, void* library, const char* name, Function& function) {
  void* const symbol = dlsym(library, name);
  if (symbol == nullptr && loaded.reason.empty())
    loaded.reason = std::string("the library of Gmsh has no ") + name;
  function = reinterpret_cast<Function>(symbol);
}

void bind_all(Loaded& loaded, void* library) {
  Gmsh& g = loaded.functions;
  bind(loaded, library, "gmshInitialize", g.Initialize);
  bind(loaded, library, "gmshFinalize", g.Finalize);
  bind(loaded, library, "gmshFree", g.Free);
  bind(loaded, library, "gmshOptionSetNumber", g.OptionSetNumber);
  bind(loaded, library, "gmshModelAdd", g.ModelAdd);
  bind(loaded, library, "gmshModelGeoAddPoint", g.ModelGeoAddPoint);
  bind(loaded, library, "gmshModelGeoAddLine", g.ModelGeoAddLine);
  bind(loaded, library, "gmshModelGeoAddCurveLoop", g.ModelGeoAddCurveLoop);
  bind(loaded, library, "gmshModelGeoAddPlaneSurface", g.ModelGeoAddPlaneSurface);
  bind(loaded, library, "gmshModelGeoSynchronize", g.ModelGeoSynchronize);
  bind(loaded, library, "gmshModelMeshSetTransfiniteCurve", g.ModelMeshSetTransfiniteCurve);
  bind(loaded, library, "gmshModelMeshEmbed", g.ModelMeshEmbed);
  bind(loaded, library, "gmshModelMeshSetSizeCallback", g.ModelMeshSetSizeCallback);
  bind(loaded, library, "gmshModelMeshRemoveSizeCallback", g.ModelMeshRemoveSizeCallback);
  bind(loaded, library, "gmshModelMeshGenerate", g.ModelMeshGenerate);
  bind(loaded, library, "gmshModelMeshGetNodes", g.ModelMeshGetNodes);
  bind(loaded, library, "gmshModelMeshGetElements", g.ModelMeshGetElements);
  bind(loaded, library, "gmshLoggerGetLastError", g.LoggerGetLastError);
}

Loaded load() {
  Loaded loaded;
  // Only 4.8 has these arguments: later versions add some to gmshInitialize and to the callback.
  std::vector<std::string> files{"libgmsh.so.4.8"};
  if (const char* chosen = std::getenv("SAGEFE_GMSH")) files = {chosen};
  for (const std::string& file : files) {
    const Library library = open_library(file);
    if (library.handle == nullptr) {
      loaded.reason += (loaded.reason.empty() ? "" : "; ") + library.error;
      continue;
    }
    loaded.reason.clear();
    bind_all(loaded, library.handle);
    break;
  }
  return loaded;
}

}  // namespace

const Gmsh* gmsh(std::string& reason) {
  static const Loaded loaded = load();
  reason = loaded.reason;
  return loaded.reason.empty() ? &loaded.functions : nullptr;
}

}  // namespace section

bool gmsh_available(std::string* reason) {
  std::string why;
  const bool there = section::gmsh(why) != nullptr;
  if (reason != nullptr) *reason = why;
  return there;
}

}  // namespace sage
