#include "sage/app/run_key.hpp"

#include <fmt/format.h>

namespace sage::app {

namespace {

// The structured bindings below name every member of a struct, in its order: a new member does not compile before it is
// named there, and it counts unless it is put among those that don't.
class Key {
 public:
  template <class... Members>
  void count(const Members&... members) {
    (add(members), ...);
  }

  void add(bool value) { text_ += value ? " yes" : " no"; }
  void add(int value) { text_ += fmt::format(" {}", value); }
  void add(Tables value) { add(static_cast<int>(value)); }
  // The length keeps apart lists that read alike.
  void add(const std::string& value) { text_ += fmt::format(" {}:{}", value.size(), value); }
  void add(const std::vector<std::string>& values) {
    add(static_cast<int>(values.size()));
    for (const std::string& value : values) add(value);
  }
  void add(const OutputOptions& options);
  void add(const Skips& skips);

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

template <class... Members>
void does_not_count(const Members&...) {}

void Key::add(const OutputOptions& options) {
  const auto& [folder, listing, tables, increments, nodes, points, digits, error, vtu, msh, msh_text, result,
               pictures, states, fields] = options;
  does_not_count(folder);  // the checkpoint lies in it
  count(listing, tables, increments, nodes, points, digits, error, vtu, msh, msh_text, result, pictures, states,
        fields);
}

void Key::add(const Skips& skips) {
  const auto& [factors, elements, states, condensation, repeats, contraction, twins, prediction] = skips;
  count(factors, elements, states, condensation, repeats, contraction, twins, prediction);
}

}  // namespace

std::string options_key(const RunRequest& request) {
  const auto& [deck, input, output, stem, solver, threads, kernels, refinement, condition, quiet, skips,
               max_dofs, restart, checkpoint_seconds, interrupt_patience, stop_asked, results, profile,
               keep_result, watch, write_page] = request;
  does_not_count(deck, input);       // they make the model, which has its own sum beside that of the deck
  does_not_count(stem, results);     // where the checkpoint lies
  does_not_count(threads, kernels);  // results are the same to the last bit
  does_not_count(quiet, profile, watch, write_page);  // what is shown of it
  // Whether and how far it runs.
  does_not_count(restart, checkpoint_seconds, interrupt_patience, stop_asked, max_dofs);
  Key key;
  key.count(output, solver, refinement, condition, skips, keep_result);
  return key.text();
}

}  // namespace sage::app
