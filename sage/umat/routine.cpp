#include "sage/umat/routine.hpp"

#include <dlfcn.h>
#include <setjmp.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "sage/core/module.hpp"
#include "sage/umat/host.h"

namespace sage::umat {

namespace {

// The call under way in this thread.  Plain data: what ends a program by exit() has destroyed other thread-local
// objects before it is caught.
struct Under {
  jmp_buf* back = nullptr;
  CallEnd end;
  std::array<char, 201> words{};
};
thread_local Under under;

std::string job_folder = ".", job_name = "job";
std::vector<OpenedLibrary> libraries;

void leave(Ending ending, const char* words, std::size_t length) {
  if (under.back == nullptr) return;
  const std::size_t size = std::min(length, under.words.size() - 1);
  std::memcpy(under.words.data(), words, size);
  under.words[size] = '\0';
  under.end = {ending, under.words.data()};
  longjmp(*under.back, 1);
}

void leave_for_module(int who, const char* words, size_t length) {
  leave(who == 0 ? Ending::xit : who == 1 ? Ending::stop : Ending::exit, words, length);
}

// exit(), and what ends in it: STOP of other compilers, errors of the Fortran library.
void caught_exit() {
  if (under.back != nullptr) std::atexit(caught_exit);  // for the next time
  leave(Ending::exit, "", 0);
}

// Its names stand for all libraries that are loaded from then on: before the first UMAT.
void load_utilities() {
  static const bool loaded = [] {
    const Module module{"the module of UMAT's utility routines",
                        "SAGE_UMAT_MODULE",
                        SAGE_UMAT_MODULE_RELATIVE,
                        SAGE_UMAT_MODULE_NAME,
                        SAGE_UMAT_MODULE_VERSION,
                        "sage_umat_host"};
    void* function = load_module(module, module_places(module));
    Dl_info place{};
    if (dladdr(function, &place) == 0 ||
        dlopen(place.dli_fname, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD) == nullptr)
      throw std::runtime_error("the module of UMAT's utility routines can't be shown to other libraries");
    const SageUmatHost host{leave_for_module, [] { return job_folder.c_str(); },
                            [] { return job_name.c_str(); }};
    reinterpret_cast<void (*)(const SageUmatHost*)>(function)(&host);
    std::atexit(caught_exit);
    return true;
  }();
  (void)loaded;
}

}  // namespace

void set_job(const std::string& folder, const std::string& name) {
  job_folder = folder;
  job_name = name;
}

Routine open_routine(const std::string& text) {
  Routine routine;
  const std::size_t colon = text.rfind(':');
  routine.file = text.substr(0, colon);
  const std::string wanted = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (const std::string flaw = library_flaw(routine.file); !flaw.empty())
    throw std::runtime_error(routine.file + " " + flaw);
  load_utilities();
  const Library library = open_library(std::filesystem::absolute(routine.file).string());
  if (library.handle == nullptr) throw std::runtime_error(routine.file + " can't be loaded: " + library.error);
  libraries.push_back({routine.file, library.handle});
  std::string tried;
  for (const std::string& symbol :
       wanted.empty() ? std::vector<std::string>{"umat_", "umat", "UMAT"} : std::vector{wanted, wanted + "_"}) {
    routine.function = reinterpret_cast<Function>(dlsym(library.handle, symbol.c_str()));
    routine.symbol = symbol;
    if (routine.function != nullptr) return routine;
    tried += (tried.empty() ? "" : ", ") + symbol;
  }
  throw std::runtime_error(routine.file + " has no routine " + tried +
                           "; another name is given as LIBRARY:SYMBOL (nm -D shows the names)");
}

const std::vector<OpenedLibrary>& opened_libraries() {
  return libraries;
}

CallEnd call_caught(void (*call)(void*), void* data) {
  jmp_buf back;
  under.end = {};
  under.back = &back;
  // What changes between here and a longjmp is not read after it.
  if (_setjmp(back) == 0) call(data);
  under.back = nullptr;
  return under.end;
}

}  // namespace sage::umat
