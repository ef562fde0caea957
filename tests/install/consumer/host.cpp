// A program that knows nothing but the C function of the shared object.
extern "C" int run_sagefe(int argc, char** argv);

int main(int argc, char** argv) {
  return run_sagefe(argc, argv);
}
