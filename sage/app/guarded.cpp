#include <new>

#include "sage/app/commands.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/input.hpp"
#include "sage/app/screen.hpp"
#include "sage/messages/error.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

int guarded(const std::string& name, const std::function<int()>& work) {
  try {
    return work();
  } catch (const InputError& error) {
    print_diagnostics(error.diagnostics());
    return kInput;
  } catch (const UsageError& error) {
    say_error(name, error);
    return kUsage;
  } catch (const OverInput& error) {
    say_error(name, error);
    return kUsage;
  } catch (const OutputError& error) {
    say_error(name, error);
    return kOutput;
  } catch (const std::bad_alloc&) {
    say_error(name, "not enough memory for this model", "S508");
    return kNotConverged;
  } catch (const std::exception& error) {
    say_error(name, error);
    return kNotConverged;
  }
}

}  // namespace sage::app
