// Stands for a module of library solvers that does not belong to this program.
extern "C" {

#ifndef WITHOUT_VERSION
const char* sage_solver_module_version() {
  return "sage-solvers-0";
}
#endif

#ifndef WITHOUT_MAKER
void* sage_make_library_solver(const char*) {
  return nullptr;
}
#endif

}  // extern "C"
