#include "sage/umat/routine.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <setjmp.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sage/platform/float_modes.hpp"
#include "sage/platform/module.hpp"
#include "sage/umat/host.h"

namespace sage::umat {

namespace {

// The call under way in this thread.  Plain data: what ends a program by exit() has destroyed other thread-local
// objects before it is caught.
struct Under {
  jmp_buf* back = nullptr;
  CallEnd end;
  std::array<char, 201> words{};
  bool asked = false;  // with numbers that some routines crash on
  Pages pages;
};
thread_local Under under;

std::string job_folder = ".", job_name = "job";
std::vector<OpenedLibrary> libraries;

void keep_end(Ending ending, const char* words, std::size_t length) {
  const std::size_t size = std::min(length, under.words.size() - 1);
  std::memcpy(under.words.data(), words, size);
  under.words[size] = '\0';
  under.end = {ending, under.words.data()};
}

void leave(Ending ending, const char* words, std::size_t length) {
  if (under.back == nullptr) return;
  keep_end(ending, words, length);
  longjmp(*under.back, 1);
}

void leave_for_module(int who, const char* words, size_t length) {
  leave(who == 0 ? Ending::xit : who == 1 ? Ending::stop : Ending::exit, words, length);
}

// A routine was left in the middle of its Fortran library, whose locks then stay taken: who asks it for anything would
// wait for ever.
std::atomic<bool> library_left = false;
std::mutex when_left_lock;
Under when_left;

// So would the end of the program, where the library closes its units: it is passed over.
void end_at_once(int code, void*) {
  std::fflush(nullptr);
  std::_Exit(code);
}

void leave_library() {
  if (under.asked) return;
  if (!library_left.exchange(true)) on_exit(end_at_once, nullptr);
}

// exit(), and what ends in it: STOP of other compilers, errors of the Fortran library.
void caught_exit() {
  if (under.back == nullptr) return;
  leave_library();
  std::atexit(caught_exit);  // for the next time
  leave(Ending::exit, "", 0);
}

void caught_quick_exit() {
  if (under.back == nullptr) return;
  std::at_quick_exit(caught_quick_exit);  // for the next time
  leave(Ending::exit, "quick_exit()", 12);
}

// Signals of a crash.  Outside of a call the program ends by them as it would without this.
constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

void crashed(int signal, siginfo_t* info, void*) {
  if (under.back != nullptr) {
    leave_library();
    const char* const place = static_cast<const char*>(info->si_addr);
    const bool beside = signal == SIGSEGV && place >= under.pages.first && place < under.pages.end;
    const char* words = beside ? "an access far beyond one of its arrays" : sigdescr_np(signal);
    leave(Ending::crash, words, std::strlen(words));
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void catch_crashes() {
  struct sigaction action {};
  action.sa_sigaction = crashed;
  action.sa_flags =
      SA_SIGINFO | SA_ONSTACK | SA_NODEFER;  // the handler is left by longjmp, which lifts no block
  for (const int signal : kCrashes) sigaction(signal, &action, nullptr);
}

// Routines with large local arrays use up a thread's stack: the handler needs another.  A sanitizer has given one.
void expect_spare_stack() {
  thread_local bool there = false;
  thread_local std::array<char, std::size_t{64} << 10> stack;
  if (std::exchange(there, true)) return;
  stack_t spare{};
  if (sigaltstack(nullptr, &spare) != 0 || (spare.ss_flags & SS_DISABLE) == 0) return;
  spare = {stack.data(), 0, stack.size()};
  sigaltstack(&spare, nullptr);
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
    std::at_quick_exit(caught_quick_exit);
    catch_crashes();
    // A process that a routine begins is not the run: it ends as it likes.
    pthread_atfork(nullptr, nullptr, [] { under.back = nullptr; });
    return true;
  }();
  (void)loaded;
}

// They would share data with the routine.
std::string routines_not_called(void* handle) {
  std::string names;
  for (const char* symbol : {"usdfld_", "uexternaldb_"})
    if (dlsym(handle, symbol) != nullptr) {
      std::string name(symbol, std::strlen(symbol) - 1);
      for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      names += (names.empty() ? "" : ", ") + name;
    }
  return names;
}

// As gfortran names a routine, or as C does.
template <class Function>
Function optional_routine(void* handle, const char* fortran, const char* c) {
  void* const found = dlsym(handle, fortran);
  return reinterpret_cast<Function>(found != nullptr ? found : dlsym(handle, c));
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
  routine.not_called = routines_not_called(library.handle);
  routine.first_history = optional_routine<FirstHistory>(library.handle, "sdvini_", "sdvini");
  routine.first_stress = optional_routine<FirstStress>(library.handle, "sigini_", "sigini");
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

bool may_flush() {
  return !library_left;
}

CallEnd call_caught(void (*call)(void*), void* data, bool may_crash, Pages pages) {
  if (library_left) return when_left.end;
  expect_spare_stack();
  const FloatModes modes;
  jmp_buf back;
  under.end = {};
  under.back = &back;
  under.asked = may_crash;
  under.pages = pages;
  // What changes between here and a longjmp is not read after it.
  if (_setjmp(back) == 0) {
    try {
      call(data);
    } catch (const std::exception& thrown) {  // of a routine in C++
      keep_end(Ending::exception, thrown.what(), std::strlen(thrown.what()));
    } catch (...) {
      keep_end(Ending::exception, "", 0);
    }
  }
  under.back = nullptr;
  modes.restore();
  if (library_left) {
    const std::lock_guard lock(when_left_lock);
    when_left.words = under.words;
    when_left.end = {under.end.ending, when_left.words.data()};
  }
  return under.end;
}

[[noreturn]] static void end_immediately(int code) {
  leave(Ending::exit, "_exit()", 7);
  for (;;) syscall(SYS_exit_group, code);
}

}  // namespace sage::umat

// They run no handler, so that a routine would end the run without a word and, by _exit(0), as if it had succeeded.
// The linker gives a program's own functions to all libraries that it loads.
extern "C" {

void _exit(int code) {
  sage::umat::end_immediately(code);
}
void _Exit(int code) noexcept {
  sage::umat::end_immediately(code);
}

}  // extern "C"
