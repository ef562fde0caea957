// The functions of Gmsh that are used, by their names in its C interface (gmshc.h of 4.8).  Not part of the public
// interface.
#pragma once

#include <cstddef>
#include <string>

namespace sage::section {

struct Gmsh {
  void (*Initialize)(int, char**, int, int*) = nullptr;
  void (*Finalize)(int*) = nullptr;
  void (*Free)(void*) = nullptr;
  void (*OptionSetNumber)(const char*, double, int*) = nullptr;
  void (*ModelAdd)(const char*, int*) = nullptr;
  int (*ModelGeoAddPoint)(double, double, double, double, int, int*) = nullptr;
  int (*ModelGeoAddLine)(int, int, int, int*) = nullptr;
  int (*ModelGeoAddCurveLoop)(int*, std::size_t, int, int, int*) = nullptr;
  int (*ModelGeoAddPlaneSurface)(int*, std::size_t, int, int*) = nullptr;
  void (*ModelGeoSynchronize)(int*) = nullptr;
  void (*ModelMeshSetTransfiniteCurve)(int, int, const char*, double, int*) = nullptr;
  void (*ModelMeshEmbed)(int, int*, std::size_t, int, int, int*) = nullptr;
  void (*ModelMeshSetSizeCallback)(double (*)(int, int, double, double, double, void*), void*, int*) = nullptr;
  void (*ModelMeshRemoveSizeCallback)(int*) = nullptr;
  void (*ModelMeshGenerate)(int, int*) = nullptr;
  void (*ModelMeshGetNodes)(std::size_t**, std::size_t*, double**, std::size_t*, double**, std::size_t*, int,
                            int, int, int, int*) = nullptr;
  void (*ModelMeshGetElements)(int**, std::size_t*, std::size_t***, std::size_t**, std::size_t*, std::size_t***,
                               std::size_t**, std::size_t*, int, int, int*) = nullptr;
  void (*LoggerGetLastError)(char**, int*) = nullptr;
};

// Loaded on first use.  nullptr: it is missing, `reason` says why.
const Gmsh* gmsh(std::string& reason);

}  // namespace sage::section
