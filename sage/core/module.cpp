#include "sage/core/module.hpp"

#include <dlfcn.h>
#include <elf.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "sage/core/error.hpp"

namespace sage {

namespace {

std::string bytes_at(std::ifstream& in, std::uint64_t at, std::uint64_t count) {
  constexpr std::uint64_t kMost = 1 << 16;
  std::string bytes(std::min(count, kMost), '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(at));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

template <class T>
std::optional<T> value_at(std::ifstream& in, std::uint64_t at) {
  const std::string bytes = bytes_at(in, at, sizeof(T));
  if (bytes.size() < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

// Up to the first NUL.
std::string text_at(const std::string& bytes, std::uint64_t at) {
  return at < bytes.size() ? std::string(bytes.c_str() + at) : std::string();
}

// Folders that the linker wrote into an executable for its libraries.
std::vector<std::string> search_path(const std::string& executable) {
  const std::string dynamic = elf_section(executable, ".dynamic"), strings = elf_section(executable, ".dynstr");
  std::vector<std::string> folders;
  for (std::size_t at = 0; at + sizeof(Elf64_Dyn) <= dynamic.size(); at += sizeof(Elf64_Dyn)) {
    Elf64_Dyn entry;
    std::memcpy(&entry, dynamic.data() + at, sizeof entry);
    if (entry.d_tag != DT_RUNPATH && entry.d_tag != DT_RPATH) continue;
    std::istringstream parts(text_at(strings, entry.d_un.d_val));
    for (std::string folder; std::getline(parts, folder, ':');)
      if (folder.starts_with('/')) folders.push_back(folder);
  }
  return folders;
}

}  // namespace

std::string elf_section(const std::string& file, std::string_view name) {
  std::ifstream in(file, std::ios::binary);
  const auto head = value_at<Elf64_Ehdr>(in, 0);
  if (!head || std::memcmp(head->e_ident, ELFMAG, SELFMAG) != 0 || head->e_ident[EI_CLASS] != ELFCLASS64)
    return {};
  const auto section = [&](std::uint64_t i) {
    return value_at<Elf64_Shdr>(in, head->e_shoff + i * sizeof(Elf64_Shdr));
  };
  const auto names = section(head->e_shstrndx);
  for (std::uint64_t i = 0; names && i < head->e_shnum; ++i) {
    const auto one = section(i);
    if (!one) break;
    if (text_at(bytes_at(in, names->sh_offset + one->sh_name, name.size() + 1), 0) != name) continue;
    return bytes_at(in, one->sh_offset, one->sh_size);
  }
  return {};
}

std::vector<std::string> module_places(const Module& module) {
  std::vector<std::string> places;
  if (const char* chosen = std::getenv(module.variable.c_str())) places.emplace_back(chosen);
  std::error_code error;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back((executable.parent_path() / module.relative).lexically_normal().string());
  for (const std::string& folder : search_path("/proc/self/exe")) places.push_back(folder + "/" + module.file);
  return places;
}

// Opening a library runs its constructors: its version is read before.
void* load_module(const Module& module, const std::vector<std::string>& places) {
  std::string tried;
  for (const std::string& place : places) {
    tried += "\n  " + place;
    std::error_code ignored;
    if (!std::filesystem::exists(place, ignored)) continue;
    if (text_at(elf_section(place, SAGE_MODULE_SECTION), 0) != module.version) {
      tried += ": belongs to another version";
      continue;
    }
    void* handle = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
      tried += std::string(": ") + dlerror();
      continue;
    }
    if (void* function = dlsym(handle, module.function.c_str())) return function;
    tried += ": has no " + module.function;
    dlclose(handle);
  }
  throw AnalysisError("S505", module.what + " can't be loaded; tried:" + tried);
}

}  // namespace sage
