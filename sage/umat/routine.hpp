// User materials of Abaqus/Standard, the interface UMAT: a routine of a shared library, in Fortran or C
// (docs/manual/umat.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sage::umat {

// 37 arguments by reference, and by value the length of CMNAME as Fortran has it.  Integers are 4 bytes, or 8
// in libraries that were built so.
using Function = void (*)(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd,
                          double* rpl, double* ddsddt, double* drplde, double* drpldt, double* stran,
                          double* dstran, double* time, double* dtime, double* temp, double* dtemp,
                          double* predef, double* dpred, char* cmname, void* ndi, void* nshr, void* ntens,
                          void* nstatv, double* props, void* nprops, double* coords, double* drot,
                          double* pnewdt, double* celent, double* dfgrd0, double* dfgrd1, void* noel, void* npt,
                          void* layer, void* kspt, void* jstep, void* kinc, std::size_t cmname_length);

// SDVINI and SIGINI: first values of the state variables and of the stress at a point.
using FirstHistory = void (*)(double* statev, double* coords, void* nstatv, void* ncrds, void* noel, void* npt,
                              void* layer, void* kspt);
using FirstStress = void (*)(double* sigma, double* coords, void* ntens, void* ncrds, void* noel, void* npt,
                             void* layer, void* kspt, void* lrebar, char* names, std::size_t names_length);

struct Routine {
  std::string file, symbol;
  Function function = nullptr;
  FirstHistory first_history = nullptr;  // nullptr: the library has none
  FirstStress first_stress = nullptr;

  std::string not_called;  // other user routines of the library, which a user may think are called

  std::string words() const { return "routine " + symbol + " of " + file; }
};

// LIBRARY[:SYMBOL]; without a symbol umat_ or umat.  Runs the library's constructors; it is never closed.  Throws
// std::runtime_error that names the file.
Routine open_routine(const std::string& text);

struct OpenedLibrary {
  std::string file;
  void* handle = nullptr;
};
const std::vector<OpenedLibrary>& opened_libraries();

// What the utility routines tell a UMAT of the run.
void set_job(const std::string& folder, const std::string& name);

// How a call ended.
enum class Ending : std::uint8_t { returned, xit, stop, exit, crash, exception };

// `words` of at most 200 characters: the message of STOP, of STDB_ABQERR or of an exception, the name of a signal.
struct CallEnd {
  Ending ending = Ending::returned;
  const char* words = "";
};

// Whether the libraries' Fortran runtime can be asked for anything: not after it was left by an error of its own or a
// crash.
bool may_flush();

// Memory that a routine must not touch, from the first to before the end, but for what is its own.
struct Pages {
  const char *first = nullptr, *end = nullptr;
};

// Does `call(data)` and restores the modes of floating point.  Where the routine calls XIT, executes STOP, ends the
// program in another way or crashes, its frames are left by longjmp: what it had allocated or opened stays so.
// After an error of the Fortran library or a crash there are no more calls: each ends as that one did.  may_crash: not
// after this one, which is made to find something out.  pages: of its arguments, for the words of a crash.
CallEnd call_caught(void (*call)(void*), void* data, bool may_crash = false, Pages pages = {});

}  // namespace sage::umat
