#include "sage/app/large_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "sage/app/answer.hpp"
#include "sage/app/large_specimen.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/study_model.hpp"
#include "sage/app/wrap.hpp"
#include "sage/deck/text.hpp"
#include "sage/messages/split_at.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

constexpr double kE = 3000.0, kPlasticNu = 0.495, kCellPressure = 50.0;

// Ends of a specimen; the names are columns of the chapter's tables.
struct Ends {
  std::string column, words, file;
  double slenderness;
  std::optional<MaterialInput> joint;
};

// As in the chapter's decks.
std::vector<Ends> friction_ends() {
  return {{"phi = 0.8", "friction 0.8 degrees, L/D = 2", "phi08", 2.0, platen_friction(0.8, 120.0, 1.0)},
          {"phi = 28.5", "friction 28.5 degrees, L/D = 2", "phi285", 2.0, platen_friction(28.5, 5000.0, 0.9)}};
}
std::vector<Ends> pinned_ends() {
  return {{"pinned L/D = 2", "pinned ends, L/D = 2", "pinned_ld2", 2.0, {}},
          {"pinned L/D = 1", "pinned ends, L/D = 1", "pinned_ld1", 1.0, {}}};
}

// Meshes on which a specimen gets to 20 %: smaller elements at the platen's edge are more accurate and fold earlier.
struct Grading {
  int columns;
  double shrink;
};

Grading elastic_grading(const Ends& ends, double nu) {
  if (ends.joint) return {16, 20.0};
  return {24, nu > 0.4 ? 300.0 : 50.0};
}
constexpr Grading kPlasticGrading{16, 5.0};

// A specimen of one of the tables: both platens, and what stands beside it in the chapter.
struct Case {
  std::string table, row;  // row: "nu = 0.250" of Table 7.3; "" of Table 7.4
  Ends ends;
  MaterialInput soil;
  double cell = 0.0;
  Grading grading;
};

std::vector<Case> cases_of(const LargeStudy& study) {
  std::vector<Case> cases;
  std::vector<Ends> all = friction_ends();
  for (const Ends& ends : pinned_ends()) all.push_back(ends);
  for (const Ends& ends : all)
    for (const double nu : study.poissons_ratios)
      cases.push_back(
          {"7.3",
           fmt::format("nu = {:.3f}", nu),
           ends,
           {.law = "linear_elastic", .parameters = {{"youngs_modulus", kE}, {"poissons_ratio", nu}}},
           0.0,
           elastic_grading(ends, nu)});
  if (!study.plastic) return cases;
  const MaterialInput drucker_prager{.law = "drucker_prager",
                                     .parameters = {{"youngs_modulus", kE},
                                                    {"poissons_ratio", kPlasticNu},
                                                    {"cohesion", 0.0},
                                                    {"friction_angle", 36.87},
                                                    {"dilation_angle", 0.0},
                                                    {"cone", 1.0},
                                                    {"flow", 1.0},
                                                    {"mean_tension_limit", -1.0}}};
  for (const Ends& ends : all)
    cases.push_back({"7.4", "", ends, drucker_prager, kCellPressure, kPlasticGrading});
  return cases;
}

// A line of large_specimens.csv.
struct LargeRow {
  double strain = 0.0;
  TriaxialRow at;
  double error = std::numeric_limits<
      double>::quiet_NaN();  // change of the ratio by a coarser mesh with half of the increments
};

struct Answer {
  double platen = 0.0;  // as of LargeSpecimen
  std::vector<LargeRow> rows;
  std::string reason;        // why it ends early
  double last_strain = 0.0;  // with equilibrium
};

std::string platen_words(const Answer& answer) {
  return answer.platen > 0.0 ? "wide" : "plain";
}

const TriaxialRow* at_strain(const LargeCurve& curve, double strain) {
  const auto found = std::ranges::find_if(
      curve.rows, [&](const TriaxialRow& row) { return std::abs(row.axial_strain / strain - 1.0) < 1e-9; });
  return found == curve.rows.end() ? nullptr : &*found;
}

LargeSpecimen specimen_of(const Case& one, double platen, double fineness) {
  return {.slenderness = one.ends.slenderness,
          .soil = one.soil,
          .cell = one.cell,
          .joint = one.ends.joint,
          .platen = platen,
          .columns = std::max(2, static_cast<int>(std::lround(fineness * one.grading.columns))),
          .shrink = one.grading.shrink};
}

std::string file_of(const Case& one, bool wide) {
  const std::string law = one.table == "7.3" ? "nu" + one.row.substr(one.row.find_last_of(' ') + 1) : "dp";
  return fmt::format("large_{}_{}_{}.sage.toml", law, one.ends.file, wide ? "wide" : "plain");
}

Answer answer_of(const LargeStudy& study, const Case& one, double platen, const std::filesystem::path& folder,
                 const Catalogue& catalogue, Task& task) {
  const double last = study.strains.back();
  const LargeSpecimen fine = specimen_of(one, platen, study.fineness),
                      coarse = specimen_of(one, platen, study.fineness * 2.0 / 3.0);
  write_study_model(large_specimen_input(fine, last, study.increments), folder / file_of(one, platen > 0.0),
                    catalogue);
  const LargeCurve curve = run_large_specimen(fine, last, study.increments, catalogue, task.pulse());
  const LargeCurve other = run_large_specimen(coarse, last, study.increments / 2, catalogue, task.pulse());
  Answer answer{platen, {}, curve.reason, curve.rows.empty() ? 0.0 : curve.rows.back().axial_strain};
  for (const double strain : study.strains) {
    const TriaxialRow* const row = at_strain(curve, strain);
    const TriaxialRow* const beside = at_strain(other, strain);
    if (row == nullptr) break;
    answer.rows.push_back(
        {strain, *row,
         beside != nullptr ? std::abs(beside->ratio - row->ratio) : std::numeric_limits<double>::quiet_NaN()});
  }
  return answer;
}

// ---- what is printed ----

// The chapter's ratios at the study's strains, and converged ones of small strain; 0 = none.
struct Beside {
  std::vector<double> chapter, converged;
};

Beside beside_of(const Case& one, const LargeStudy& study, const std::vector<ChapterEntry>& entries) {
  constexpr double kOfTable73 = 0.10;
  Beside beside{std::vector<double>(study.strains.size()), std::vector<double>(study.strains.size())};
  for (std::size_t i = 0; i < study.strains.size(); ++i)
    for (const ChapterEntry& entry : entries) {
      const bool here = one.table == "7.3"
                            ? entry.row == one.row && std::abs(study.strains[i] - kOfTable73) < 1e-9
                            : entry.row == fmt::format("strain {:.2f}", study.strains[i]);
      if (entry.table != one.table || entry.column != one.ends.column || !here) continue;
      beside.chapter[i] = entry.chapter;
      beside.converged[i] = entry.converged;
    }
  return beside;
}

void print_known(const std::string& words, const std::vector<double>& values) {
  if (std::ranges::all_of(values, [](double v) { return v == 0.0; })) return;
  std::string line = fmt::format("    {:<26}", words);
  for (const double value : values)
    line += value > 0.0 ? fmt::format("{:8.4f}", value) : fmt::format("{:8}", "");
  fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
}

void print_answer(const std::string& words, const Answer& answer, const LargeStudy& study) {
  std::string line = fmt::format("    {:<26}", words);
  double error = 0.0;
  for (std::size_t i = 0; i < study.strains.size(); ++i) {
    const bool is_there = i < answer.rows.size();
    line += is_there ? fmt::format("{:8.4f}", answer.rows[i].at.ratio) : fmt::format("{:>8}", "-");
    if (is_there && std::isfinite(answer.rows[i].error)) error = std::max(error, answer.rows[i].error);
  }
  fmt::print("{}{:9.0e}\n", line, error);
}

// The strain to which equilibrium was found, and the element that turns inside out or the node that is out of balance.
std::string end_words(const Answer& answer) {
  const std::string text =
      fmt::format("    {} platens end at {:.1f} %: ", platen_words(answer), 100.0 * answer.last_strain);
  const std::vector<std::string_view> lines = split_at('\n', answer.reason);
  for (const std::string_view words : {"turns inside out", "largest out-of-balance"})
    for (const std::string_view line : lines)
      if (line.find(words) != std::string_view::npos) return text + std::string(trimmed(line));
  return text + std::string(lines.front());
}

void print_case(const Case& one, const std::vector<Answer>& answers, const LargeStudy& study,
                const std::vector<ChapterEntry>& chapter) {
  fmt::print("\n{}{}\n", one.row.empty() ? "" : one.row + ", ", one.ends.words);
  const Beside beside = beside_of(one, study, chapter);
  print_known("chapter", beside.chapter);
  print_known("small strain, converged", beside.converged);
  for (const Answer& answer : answers) print_answer(platen_words(answer) + " platens", answer, study);
  for (const Answer& answer : answers)
    if (!answer.reason.empty()) fmt::print("{}\n", wrapped(end_words(answer), kHelpColumns));
}

void print_title(const std::string& table, const LargeStudy& study) {
  if (table == "7.3")
    fmt::print(
        "\nTable 7.3 under large strain: linear elasticity of logarithmic strains (Hencky).\n"
        "Measured / correct axial stress.  Wide platens have {:g} times the radius of the\n"
        "specimen, and its side may roll onto them; with plain ones it touches nothing.\n",
        study.platen);
  else
    fmt::print(
        "\nTable 7.4 under large strain: Drucker-Prager, cell pressure {:g} psi.\n"
        "Measured / correct deviator.\n",
        kCellPressure);
  std::string line = fmt::format("{:<30}", "axial strain");
  for (const double strain : study.strains) line += fmt::format("{:>6g} %", 100.0 * strain);
  fmt::print("{}{:>9}\n", line, "error");
}

// ---- files ----

std::string csv_lines(const Case& one, const std::vector<Answer>& answers) {
  std::string text;
  for (const Answer& answer : answers)
    for (const LargeRow& r : answer.rows)
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", one.table, one.row, one.ends.column,
                          one.ends.slenderness, platen_words(answer), r.strain, r.at.measured_deviator,
                          r.at.correct_deviator, r.at.measured_corrected, r.at.correct_corrected, r.at.ratio,
                          std::isfinite(r.error) ? fmt::format("{}", r.error) : "");
  return text;
}

constexpr const char* kCsvHeader =
    "# specimens under large strain between rigid platens; stresses in psi, compression positive; nominal ones "
    "by "
    "the first\n"
    "# area, *_corrected by that of a cylinder of the same length and volume; error: change of the ratio by "
    "two "
    "thirds of\n"
    "# the columns and half of the increments; blank: those end before\n"
    "table,row,ends,slenderness,platen,strain,measured_deviator,correct_deviator,measured_corrected,"
    "correct_corrected,ratio,error\n";

Json answer_json(const Case& one, const Answer& answer, const LargeRow& row) {
  return {{"table", one.table},
          {"row", one.row},
          {"ends", one.ends.column},
          {"slenderness", one.ends.slenderness},
          {"platen", platen_words(answer)},
          {"strain", row.strain},
          {"measured_deviator", row.at.measured_deviator},
          {"correct_deviator", row.at.correct_deviator},
          {"ratio", row.at.ratio},
          {"error", std::isfinite(row.error) ? Json(row.error) : Json(nullptr)}};
}

}  // namespace

void print_large_tables(const LargeStudy& study, const std::vector<ChapterEntry>& chapter,
                        const std::filesystem::path& folder, const Catalogue& catalogue) {
  Task task("tables --large");
  const std::vector<Case> cases = cases_of(study);
  std::string table, csv = kCsvHeader;
  int number = 0;
  for (const Case& one : cases) {
    std::vector<Answer> answers;
    for (const double platen : {0.0, study.platen}) {
      task.part(one.row + (one.row.empty() ? "" : ", ") + one.ends.words, ++number,
                2 * static_cast<int>(cases.size()));
      answers.push_back(answer_of(study, one, platen, folder, catalogue, task));
    }
    csv += csv_lines(one, answers);
    if (Json* json = answer())
      for (const Answer& one_answer : answers)
        for (const LargeRow& row : one_answer.rows)
          (*json)["large"].push_back(answer_json(one, one_answer, row));
    const ProgressPause pause;
    if (table != one.table) print_title(table = one.table, study);
    print_case(one, answers, study, chapter);
  }
  OutFile out(folder / "large_specimens.csv");
  out.text() = csv;
  out.finish();
  const ProgressPause pause;
  fmt::print(
      "\nerror: largest change of a ratio by two thirds of the columns of elements and\n"
      "half of the increments.  All rows, with models beside them:\n{}\n",
      (folder / "large_specimens.csv").string());
}

}  // namespace sage::app
