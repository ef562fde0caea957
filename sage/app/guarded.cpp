#include <fmt/format.h>

#include <new>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/core/error.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

int guarded(const std::string& name, const std::function<int()>& work) {
  try {
    return work();
  } catch (const InputError& error) {
    print_diagnostics(error.diagnostics());
    return kInput;
  } catch (const UsageError& error) {
    fmt::print(stderr, "{}: {}\n", name, message_of(error));
    return kUsage;
  } catch (const OverInput& error) {
    fmt::print(stderr, "{}: {}\n", name, message_of(error));
    return kUsage;
  } catch (const OutputError& error) {
    fmt::print(stderr, "{}: {}\n", name, message_of(error));
    return kOutput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "{}: not enough memory for this model\n", name);
    return kNotConverged;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, message_of(error));
    return kNotConverged;
  }
}

}  // namespace sage::app
