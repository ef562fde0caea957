#include "sage/app/run_restart.hpp"

#include <fmt/format.h>

#include "sage/app/commands.hpp"
#include "sage/app/run_key.hpp"
#include "sage/app/screen.hpp"
#include "sage/model/fingerprint.hpp"
#include "sage/umat/routine.hpp"
#include "solvers/choose_kernels.hpp"

namespace sage::app {

namespace {

// A library that was built anew computes something else, whatever it says of its version.
std::string plugin_words(const Catalogue& catalogue) {
  std::string text;
  for (const Plugin& plugin : catalogue.plugins)
    text += fmt::format(" plug-in {} {} {:016x}", plugin.name, plugin.version,
                        checksum_of(plugin.file).value_or(Checksum()).value());
  for (const umat::OpenedLibrary& library : umat::opened_libraries())
    text +=
        fmt::format(" umat {} {:016x}", library.file, checksum_of(library.file).value_or(Checksum()).value());
  return text;
}

}  // namespace

Checkpoint checkpoint_of(const RunRequest& request, const Model& model, std::uint64_t deck_sum,
                         const Catalogue& catalogue, ResultFiles& results) {
  const std::string run = fmt::format("{:016x} {:016x}{}{}", deck_sum, fingerprint(model), options_key(request),
                                      plugin_words(catalogue));
  return {request.output.folder / (stem_of(request) + ".restart"), request.checkpoint_seconds, run,
          choose_kernels(request.kernels).name, results};
}

std::string resume_from(Checkpoint& checkpoint, const RunRequest& request) {
  std::optional<std::string> state = checkpoint.load();
  if (!state && !request.quiet)
    say_note(request.deck, "no checkpoint in " + request.output.folder.string() + ": from the start", "S632");
  const std::string kernels = choose_kernels(request.kernels).name;
  if (!request.quiet && checkpoint.earlier_kernels() != kernels)
    say_note(request.deck,
             "what stands before the checkpoint was computed with kernels " + checkpoint.earlier_kernels() +
                 "; the digits are the same",
             "S632");
  for (const Checkpoint::Cut& cut : checkpoint.cut())
    if (!request.quiet)
      say_note(request.deck,
               fmt::format("{} goes on from its checkpoint: the {} bytes behind that are cut off and written "
                           "anew",
                           cut.file.string(), cut.bytes),
               "S632");
  return state.value_or("");
}

}  // namespace sage::app
