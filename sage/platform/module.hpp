// Libraries of the program that are loaded when they are needed, and then only (docs/decisions/0003).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sage {

// The section of a module that holds its version, where it can be read before anything of the module runs.
#define SAGE_MODULE_SECTION ".sage_module"

struct Module {
  std::string what;      // "the module of library solvers", for messages
  std::string variable;  // of the environment, may name the file
  std::string relative;  // place of the file, from the folder of the executable
  std::string file;      // its name alone
  std::string version;   // other modules are not accepted
  std::string function;  // what it gives to the program
};

// The folder of the running program; empty where the system does not tell.
std::filesystem::path program_folder();

// Where the variable says, beside the executable, and on the search path that the linker wrote into the
// executable, which programs of the build tree have and installed ones have not; in this order.
std::vector<std::string> module_places(const Module& module);
// The function of the first of these files that is a module of this version.  It is never closed.  Throws
// AnalysisError that lists the places.
void* load_module(const Module& module, const std::vector<std::string>& places);

// Why a file is no shared library that this machine can load, in words behind its name ("is a folder"); empty = it
// may be one.  Reads its headers, runs nothing of it.
std::string library_flaw(const std::string& file);

struct Library {
  void* handle = nullptr;  // never closed; nullptr: `error` says why
  std::string error{};
};
// With all it needs; its names stay its own.  Runs its constructors, and restores the modes of floating point.
Library open_library(const std::string& file);

// Bytes of a section of an ELF file of 64 bits, at most 64 KiB of them; empty where there is none.
std::string elf_section(const std::string& file, std::string_view name);

}  // namespace sage
