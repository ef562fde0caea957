#include "sage/platform/module.hpp"

#include <dlfcn.h>
#include <elf.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "sage/messages/error.hpp"
#include "sage/platform/float_modes.hpp"

namespace sage {

namespace {

std::string bytes_at(std::ifstream& in, std::uint64_t at, std::uint64_t count) {
  constexpr std::uint64_t kMost = 1 << 16;
  std::string bytes(std::min(count, kMost), '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(at));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(in.gcount());
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

Library open_library(const std::string& file) {
  const FloatModes modes;
  void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  modes.restore();
  if (handle != nullptr) return {handle};
  const char* error = dlerror();
  return {nullptr, error != nullptr ? error : "the system gives no reason"};
}

std::string library_flaw(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return "does not exist";
  if (error) return "can't be opened: " + error.message();
  if (std::filesystem::is_directory(status)) return "is a folder";
  if (!std::filesystem::is_regular_file(status)) return "is no file";
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) return "can't be opened: " + std::generic_category().message(errno);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (size == 0) return "is empty";
  const std::string mark = bytes_at(in, 0, EI_NIDENT);
  if (!mark.starts_with(std::string_view(ELFMAG, SELFMAG))) return "is no shared library (no ELF file)";
  if (mark.size() < EI_NIDENT) return "is cut short";
  if (mark[EI_CLASS] != ELFCLASS64) return "is a library of 32 bits, the program has 64";
  Elf64_Ehdr own;
  std::ifstream program("/proc/self/exe", std::ios::binary);
  own = value_at<Elf64_Ehdr>(program, 0).value_or(Elf64_Ehdr{});
  const auto head = value_at<Elf64_Ehdr>(in, 0);
  if (!head) return "is cut short";
  if (mark[EI_DATA] != static_cast<char>(own.e_ident[EI_DATA]) || head->e_machine != own.e_machine)
    return "is a library for another kind of processor";
  if (head->e_type != ET_DYN) return "is an ELF file, but no shared library";
  for (std::uint64_t i = 0; i < head->e_phnum; ++i) {
    const auto part = value_at<Elf64_Phdr>(in, head->e_phoff + i * sizeof(Elf64_Phdr));
    if (!part || (part->p_type == PT_LOAD && (part->p_filesz > size || part->p_offset > size - part->p_filesz)))
      return "is cut short";
  }
  return {};
}

std::filesystem::path program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

namespace {

// The shared library that this code is a part of; empty where it is a part of the running program.
std::filesystem::path own_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&program_folder), &info) == 0 || info.dli_fname == nullptr)
    return {};
  const std::filesystem::path file = info.dli_fname;
  std::error_code error;
  const bool is_program = std::filesystem::equivalent(file, "/proc/self/exe", error);
  return is_program || error || file.extension() != ".so" ? std::filesystem::path() : file;
}

}  // namespace

std::vector<std::string> module_places(const Module& module) {
  std::vector<std::string> places;
  if (const char* chosen = std::getenv(module.variable.c_str())) places.emplace_back(chosen);
  if (const std::filesystem::path library = own_library(); !library.empty()) {
    // As the package of Python is installed: PREFIX/lib/python3/dist-packages/sagefe.
    const std::filesystem::path programs = library.parent_path() / "../../../../bin";
    places.push_back((programs / module.relative).lexically_normal().string());
    for (const std::string& folder : search_path(library.string()))
      places.push_back(folder + "/" + module.file);
  }
  const std::filesystem::path beside = program_folder();
  if (!beside.empty()) places.push_back((beside / module.relative).lexically_normal().string());
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
    const Library library = open_library(place);
    if (library.handle == nullptr) {
      tried += ": " + library.error;
      continue;
    }
    if (void* function = dlsym(library.handle, module.function.c_str())) return function;
    tried += ": has no " + module.function;
    dlclose(library.handle);
  }
  throw AnalysisError("S505", module.what + " can't be loaded; tried:" + tried);
}

}  // namespace sage
