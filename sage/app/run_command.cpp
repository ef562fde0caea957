// sagefe run: computes decks and writes their results.
#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "sage/app/answer_run.hpp"
#include "sage/app/commands.hpp"
#include "sage/app/converge.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/interrupt.hpp"
#include "sage/app/jobs.hpp"
#include "sage/app/large_heap.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/report_page.hpp"
#include "sage/app/run_deck.hpp"
#include "sage/app/run_outputs.hpp"
#include "sage/app/run_warnings.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/state_choice.hpp"
#include "sage/deck/optional_file.hpp"
#include "sage/record/factor_envelope.hpp"
#include "sage/record/out_file.hpp"
#include "sage/record/profile_text.hpp"
#include "sage/record/sketch.hpp"
#include "sage/report/live_page.hpp"

namespace sage::app {

namespace {

struct RunOptions {
  std::vector<std::string> decks;
  RunRequest request;
  ConvergeOptions converge;
  std::string tables = "auto";
  std::vector<std::string> without;
  bool report = false;
  int jobs = 1;  // decks at a time; 0: as many as there are processors
};

Tables tables_of(const std::string& name) {
  if (name == "none") return Tables::none;
  if (name == "stage") return Tables::stage_end;
  if (name == "all") return Tables::all;
  return Tables::automatic;
}

std::string way_on(const RunOutcome& outcome) {
  if (outcome.checkpoint.empty()) return "there is no checkpoint, so that a run with --restart begins anew";
  return fmt::format("the same command with --restart goes on from {}", outcome.checkpoint.string());
}

// Notes of the run, a line each, where no summary shows them.
void say_notes(const std::string& deck, const std::string& notes) {
  for (std::size_t at = 0, end = 0; (end = notes.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string note = notes.substr(at, end - at);
    say_note(deck, note, code_in(note).value_or(Code("S513")));
  }
}

// Where the results go to a terminal with room for it.
std::string sketch_for_screen(const RunOutcome& outcome) {
  constexpr int kNarrow = 64;
  const int columns = is_screen(stdout) ? columns_of(stdout) : 0;
  if (columns < kNarrow) return {};
  const std::optional<Sketch> sketch = sketch_of(*outcome.model, *outcome.reports);
  return sketch ? sketch_text(*sketch, columns, unicode_locale()) : std::string();
}

// The member of the answer about a deck.  What is not known of a deck that was refused, or whose process died, is left out.
Json deck_json(const std::string& deck, int exit_code, Json found) {
  Json json = {{"deck", json_text(deck)}, {"exit_code", exit_code}};
  json["status"] = exit_code == kInterrupted ? "interrupted" : exit_word(exit_code);
  if (found.is_object())
    for (auto& [key, value] : found.items())
      if (key != "status" || exit_code != kInterrupted) json[key] = std::move(value);
  return json;
}

// model: gets the model of a run that has results.
int compute_request(const RunRequest& request, const Catalogue& catalogue, Json& found,
                    std::unique_ptr<Model>* model = nullptr) {
  const std::string& deck = request.deck;
  RunOutcome outcome = run_deck(request, catalogue);
  if (screen().json && !outcome.record.stages.empty()) found = outcome_json(outcome);
  if (outcome.exit_code == kInterrupted) {
    say_error(deck, "interrupted: " + outcome.record.result.reason + "; " + way_on(outcome), "S511");
    return outcome.exit_code;
  }
  if (outcome.record.stages.empty()) return outcome.exit_code;  // --strict stopped it
  if (screen().quiet || screen().json) {
    say_notes(deck, outcome.record.notes);
    say_report_messages(request, *outcome.reports);
  } else {
    if (request.input.strict) say_report_messages(request, *outcome.reports);
    fmt::print("{}\n", summary(*outcome.model, outcome.record, outcome.reports.get(), outcome.files,
                               outcome.error.get(), request.output.digits, sketch_for_screen(outcome),
                               screen().verbose));
  }
  if (request.profile) fmt::print("{}\n", profile_table(outcome.record.profile));
  if (const std::optional<Code>& code = outcome.record.result.code; code && outcome.exit_code != kOk)
    say_error(deck, outcome.record.result.reason, *code);
  if (model != nullptr) *model = std::move(outcome.model);
  return outcome.exit_code;
}

Json ranges_json(const Model& model, const std::vector<FactoredEnds>& sets) {
  Json ranges = Json::array();
  const auto extreme = [&](const FactoredExtreme& one) {
    return Json{
        {"value", one.value}, {"set", sets[one.set].set.name}, {"stage", one.stage}, {"element", one.element}};
  };
  for (const FactoredRange& range : factored_ranges(model, sets))
    ranges.push_back({{"group", model.groups[range.group].number},
                      {"quantity", kEndQuantities[range.quantity]},
                      {"least", extreme(range.least)},
                      {"largest", extreme(range.largest)}});
  return ranges;
}

// One run per set of factors, and the envelope of them all.
int compute_factors(const RunRequest& request, const Catalogue& catalogue, Json& found) {
  std::vector<FactoredEnds> ends;
  std::unique_ptr<Model> model;
  int worst = kOk;
  found = {{"sets", Json::array()}};
  for (const PartialFactors& set : request.input.build.factors) {
    RunRequest one = request;
    one.input.build.factors = {set};
    one.stem = stem_of(request) + "." + factor_word(set);
    FactorEnvelope envelope;
    one.watch = &envelope;
    Json part;
    worst = std::max(worst, compute_request(one, catalogue, part, &model));
    if (part.is_object()) part["factors"] = set.name;
    found["sets"].push_back(std::move(part));
    ends.push_back({set, envelope.rows()});
    if (worst == kInterrupted) return worst;
  }
  if (!model || end_quantities(*model).empty()) return worst;
  const std::filesystem::path file = request.output.folder / (stem_of(request) + ".factors.csv");
  write_file(file, factored_csv(*model, ends, csv_digits(request.output)));
  found["envelope"] = ranges_json(*model, ends);
  found["files"] = files_json({file});
  if (!screen().quiet && !screen().json) {
    fmt::print("{}", factored_text(*model, ends));
    print_files({file});
  }
  return worst;
}

// Empty where it can't be read, which reading the deck will say.
std::string text_of(const std::string& deck) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(deck, error)) return {};
  return read_file_if_any(deck).value_or("");
}

// STEM.html while the run goes, which must not outlive what is returned, and of the finished run.
std::unique_ptr<report::LivePage> ask_for_page(RunRequest& request, const Catalogue& catalogue) {
  const std::filesystem::path result = request.output.folder / (stem_of(request) + ".h5");
  auto live = std::make_unique<report::LivePage>(result, request.deck, text_of(request.deck));
  request.watch = live.get();
  request.output.result = true;
  request.write_page = [&catalogue](const std::filesystem::path& file) {
    const std::filesystem::path page = std::filesystem::path(file).replace_extension(".html");
    write_report_page({file}, page, {}, catalogue);
    return page;
  };
  return live;
}

// One deck's failure does not keep the next from running.  found: what the answer says of it, with --json.
int compute_deck(const RunOptions& options, const std::string& deck, const Catalogue& catalogue, Json& found) {
  RunRequest request = options.request;
  request.deck = deck;
  request.output.tables = tables_of(options.tables);
  std::unique_ptr<report::LivePage> live;
  if (options.report && !options.converge.asked()) live = ask_for_page(request, catalogue);
  for (const std::string& name : options.without)
    for (const SkipName& skip : kSkipNames)
      if (name == skip.name || name == "all") request.skips.*skip.flag = false;
  return guarded(deck, [&] {
    if (options.converge.asked()) {
      const OutputOptions& output = request.output;
      if (output.nodes || output.points || output.vtu || output.msh || output.result || options.report ||
          output.error || !output.states.empty() || !output.pictures.empty() || request.restart)
        say_note(
            deck,
            "--converge writes its table and the reports of the best mesh; the options of a line of the table "
            "give its mesh again, with all outputs",
            "S909");
      return converge(request, options.converge, catalogue, screen().json ? &found : nullptr);
    }
    return request.input.build.factors.empty() ? compute_request(request, catalogue, found)
                                               : compute_factors(request, catalogue, found);
  });
}

int run_one(const RunOptions& options, const std::string& deck, const Catalogue& catalogue) {
  Json found;
  const int code = compute_deck(options, deck, catalogue, found);
  if (Json* json = answer()) (*json)["decks"].push_back(deck_json(deck, code, std::move(found)));
  return code;
}

std::vector<std::string> skip_list() {
  std::vector<std::string> names{"all"};
  for (const SkipName& skip : kSkipNames) names.emplace_back(skip.name);
  return names;
}

std::string skip_names() {
  std::string text;
  for (const SkipName& skip : kSkipNames) text += (text.empty() ? "" : ", ") + std::string(skip.name);
  return text;
}

void not_run(const std::string& deck) {
  say_error(deck, "not run, interrupted before", "S511");
  if (Json* json = answer()) (*json)["decks"].push_back(deck_json(deck, kInterrupted, {}));
}

// What --converge has is complete: a mesh that was cut short is no failure of the deck.
int run_or_cut_short(const RunOptions& options, const std::string& deck, const Catalogue& catalogue) {
  const int code = run_one(options, deck, catalogue);
  return options.converge.asked() && code != kOk && interrupted() ? kInterrupted : code;
}

int run_in_turn(const RunOptions& options, const Catalogue& catalogue) {
  int worst = kOk;
  for (const std::string& deck : options.decks) {
    if (interrupted()) not_run(deck);
    worst = std::max(worst, interrupted() ? kInterrupted : run_or_cut_short(options, deck, catalogue));
  }
  return worst;
}

// What a worker has gathered for the answer about its deck.
void take_part(const std::string& deck, const JobEnd& end) {
  Json& decks = (*answer())["decks"];
  const Json part = take_answer_part(end.out);
  if (part.is_object() && part.contains("decks"))
    for (const Json& one : part["decks"]) decks.push_back(one);
  else
    decks.push_back(deck_json(deck, end.signal != 0 ? kNotConverged : end.exit_code, {{"signal", end.signal}}));
}

// Each deck as in run_in_turn(), `jobs` at a time; what they print stands in the order of the decks.
int run_beside(RunOptions options, int jobs, const Catalogue& catalogue) {
  if (options.request.threads == 0) options.request.threads = 1;  // the processors have their work
  int worst = kOk;
  JobList list;
  list.count = options.decks.size();
  Task task("run", true);
  const int count = static_cast<int>(list.count);
  list.run = [&](std::size_t i) {
    no_progress_here();
    if (!screen().json) return run_or_cut_short(options, options.decks[i], catalogue);
    const MutedOutput output;  // the answer's part takes the place of the text
    begin_answer_part();
    const int code = run_or_cut_short(options, options.decks[i], catalogue);
    output.write(answer_part_text());
    return code;
  };
  list.wait = [&](std::size_t ended, std::size_t under_way) {
    task.part(fmt::format("{} under way", under_way), static_cast<int>(ended) + 1, count);
    show_progress();
  };
  list.end = [&](std::size_t i, const JobEnd& end) {
    const ProgressPause pause;
    if (screen().json)
      take_part(options.decks[i], end);
    else
      fmt::print("{}", end.out);
    pass_on_stderr(end.err);
    worst = std::max(worst, end.signal != 0 ? kNotConverged : end.exit_code);
    if (end.signal != 0)
      say_error(options.decks[i],
                fmt::format("its process was ended by signal {} ({}); its results are not complete", end.signal,
                            strsignal(end.signal)),
                "S512");
  };
  list.skip = [&](std::size_t i) {
    not_run(options.decks[i]);
    worst = std::max(worst, kInterrupted);
  };
  do_jobs(list, jobs);
  return worst;
}

int run_all(const RunOptions& options, const Catalogue& catalogue) {
  const OutputOptions& output = options.request.output;
  if (!output.states.empty() && !output.result && !options.report && !output.vtu && !output.msh &&
      !output.nodes && !output.points && output.pictures.empty() && options.tables != "all") {
    say_error("sagefe",
              "--states: into which files? --result, --report, --picture, --vtu, --msh, --nodes, --points or "
              "--tables all",
              "S905");
    return kUsage;
  }
  std::set<std::string> names;
  for (const std::string& deck : options.decks)
    if (!names.insert(case_name(deck)).second) {
      say_error("sagefe",
                "two decks would both write " + case_name(deck) + ".*; run them into different folders (-o)",
                "S602");
      return kUsage;
    }
  keep_heap_in_large_pages();
  for (const std::string& deck : options.decks) keep_input(deck);  // of those too that come later
  const InterruptWatch watch;
  const int jobs = threads_for(options.jobs);
  return jobs > 1 && options.decks.size() > 1 ? run_beside(options, jobs, catalogue)
                                              : run_in_turn(options, catalogue);
}

constexpr const char* kRunExamples =
    "Examples:\n"
    "  sagefe run deck.dat -o results\n"
    "  sagefe run a.dat b.dat c.dat d.dat && sagefe plot out/*.report1.csv --xy axial_strain:ratio\n"
    "      curves of four runs in one plot (sagefe plot --help)\n"
    "  sagefe run deck.dat --picture conf --picture dev --states strain=.05,.1\n"
    "      contours of sigma_3 and sigma_1 - sigma_3 at 5 and 10 % of axial strain\n"
    "  sagefe run deck.dat --result --states strain=.05,.1\n"
    "      the same states kept in out/deck.h5, for sagefe plot";

}  // namespace

// NOLINTNEXTLINE(readability-function-size): one option after the other
Command run_command(CLI::App& parser, const Catalogue& catalogue) {
  parser.footer(std::string(kRunExamples) + "\n\n" + parser.get_footer());
  auto options = std::make_shared<RunOptions>();
  RunRequest& request = options->request;
  parser.add_option("DECK", options->decks, "deck files")->required();
  parser.add_option("-o,--output", request.output.folder,
                    "folder for results (default: out), called STEM.lst, STEM.report1.csv, ...; STEM is the "
                    "deck's name without its ending, or the name of its folder if the deck is called deck");
  parser.add_option("--solver", request.solver, "solver by name (see sagefe list solvers)")
      ->check(known_solver(catalogue));
  add_threads_option(parser, request.threads);
  add_kernels_option(parser, request.kernels);
  parser
      .add_option(
          "-j,--jobs", options->jobs,
          "decks computed at a time, in processes of their own and, without --threads, each on one thread "
          "(default: 1; 0 = as many as there are processors)")
      ->check(CLI::Range(0, 256));
  parser
      .add_option("--refine-solves", request.refinement,
                  "steps of iterative refinement in every solution, with residuals in twice the precision")
      ->check(CLI::Range(0, 20));
  parser.add_flag(
      "--condition", request.condition,
      "print the condition number of the equations, and the digits that it costs, after each stage");
  parser.add_option("--tables", options->tables, "tables in the listing: auto, none, stage, all")
      ->check(CLI::IsMember({"auto", "none", "stage", "all"}));
  parser.add_flag("--nodes", request.output.nodes, "write STEM.nodes.csv: displacements and reactions");
  parser.add_flag("--points", request.output.points, "write STEM.points.csv: stress and state of all points");
  add_digits_option(parser, request.output.digits);
  parser.add_flag("--vtu", request.output.vtu, "write VTU files and a PVD for ParaView");
  parser.add_flag("--msh", request.output.msh, "write STEM.msh: mesh and fields for Gmsh (MSH 4.1, binary)");
  parser.add_flag_function(
      "--msh-text", [&](std::int64_t) { request.output.msh = request.output.msh_text = true; },
      "write STEM.msh as text, which meshio needs");
  parser.add_flag("--result", request.output.result,
                  "write STEM.h5: all fields at all output increments in one HDF5 file (also for ParaView)");
  parser.add_flag(
      "--report", options->report,
      "write STEM.html, a page of the whole run for every browser (sagefe report), and the STEM.h5 that "
      "it is made of");
  parser
      .add_option(
          "--states", request.output.states,
          "more increments at which states are written, besides those of the deck: strain=VALUE,... "
          "(axial, of the specimen; the nearest increment of the last stage), load=VALUE,... (load factor of "
          "the last stage), or STAGE:INCREMENT,...; may be repeated.  For --result, --report, --picture, "
          "--vtu, "
          "--msh, --nodes, --points")
      ->allow_extra_args(false)
      ->check([](const std::string& text) { return state_error("--states", text); });
  add_field_options(parser, request.output.pictures, request.output.fields,
                    "SVG pictures at the end of each stage, and at --states",
                    "listing, CSV and reports of points");
  parser.add_flag("--error", request.output.error, "estimate the error of the mesh (Zienkiewicz-Zhu)");
  add_converge_options(parser, options->converge);
  parser.add_flag("!--no-listing", request.output.listing, "write no listing");
  parser
      .add_option("--without", options->without,
                  "do not skip this kind of work where a model does not need it: " + skip_names() + ", all")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(skip_list()));
  parser.add_flag("--restart", request.restart,
                  "continue from the checkpoint (STEM.restart) of an interrupted run in the output folder");
  parser
      .add_option("--checkpoint", request.checkpoint_seconds,
                  "seconds between checkpoints (default: 30; 0 = after every increment, negative = none)")
      ->check(number_in(-1e9, 1e9, "a number of seconds"));
  parser.add_flag("--profile", request.profile,
                  "print where time, memory and floating-point operations went, and write STEM.profile.json");
  add_input_options(parser, request.input);
  add_build_options(parser, request.input.build, catalogue);
  return [options, &catalogue] { return run_all(*options, catalogue); };
}

}  // namespace sage::app
