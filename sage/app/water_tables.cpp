#include "sage/app/water_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "sage/app/answer.hpp"
#include "sage/app/closed_specimen.hpp"
#include "sage/app/exit_codes.hpp"
#include "sage/app/progress.hpp"
#include "sage/app/screen.hpp"
#include "sage/app/study_model.hpp"
#include "sage/record/out_file.hpp"

namespace sage::app {

namespace {

constexpr double kStrain = 0.01;  // of elastic specimens, whose ratios don't depend on it
constexpr double kFirst = 1e-4,
                 kEqual = 1e5;  // times: the end of the first part, and one by which nothing moves
constexpr int kPartsOfADecade = 3;

// One line of closed_specimens.csv.  Compression positive.
struct WaterRow {
  std::string law, test;
  double slenderness = 0.0, parameter = 0.0;  // nu' or OCR
  double rate = 0.0;  // time of the whole test; 0 = water shut in, or no test of constant rate
  SpecimenState at = {};
  FrictionlessState frictionless = {};
  double ratio = 0.0, error = 0.0;  // error: largest change of the ratio by mesh, steps and element
};

// ---- elastic skeletons ----

double shear_modulus(double nu) {
  return 1.0 / (2.0 * (1.0 + nu));
}

// E' = 1, coefficient of consolidation 1.
ClosedSpecimen elastic_specimen(double slenderness, double nu, const Fineness& fine) {
  return {.slenderness = slenderness,
          .skeleton = {"linear_elastic", {{"youngs_modulus", 1.0}, {"poissons_ratio", nu}}},
          .permeability = (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu),
          .columns = fine.columns,
          .element = fine.element};
}

// Times grow by a third of a decade from part to part.  The first is of first order and damps what starts at once.
std::vector<SpecimenPart> marched(double until, int steps, double rate) {
  std::vector<SpecimenPart> parts{{rate * kFirst, kFirst, steps, 1.0}};
  const int count = static_cast<int>(std::lround(kPartsOfADecade * std::log10(until / kFirst)));
  double begin = kFirst;
  for (int k = 1; k <= count; ++k) {
    const double end = kFirst * std::pow(10.0, static_cast<double>(k) / kPartsOfADecade);
    parts.push_back({rate * (end - begin), end - begin, steps, 0.5});
    begin = end;
  }
  return parts;
}

struct ElasticTests {
  std::vector<SpecimenPart> at_once, at_a_rate;
};
ElasticTests elastic_tests(int steps) {
  constexpr double kLongest = 100.0;  // of a test at constant rate
  ElasticTests tests{marched(1.0, steps, 0.0), marched(kLongest, steps, kStrain / kLongest)};
  tests.at_once.insert(tests.at_once.begin(), {kStrain, 0.0, 1, 1.0});
  tests.at_once.push_back({0.0, kEqual, 8, 1.0});
  return tests;
}

WaterRow elastic_row(const std::string& test, double slenderness, double nu, const SpecimenState& at) {
  const double correct = 3.0 * shear_modulus(nu) * at.strain;
  WaterRow row{"linear_elastic", test, slenderness, nu};
  row.at = at;
  row.frictionless = {correct, correct / 3.0};
  row.ratio = at.deviator / correct;
  return row;
}

const SpecimenState& state_at(const SpecimenCurve& curve, double time) {
  return *std::ranges::min_element(curve.states, {},
                                   [&](const SpecimenState& s) { return std::abs(s.time / time - 1.0); });
}

constexpr std::array<double, 3> kTimes{0.01, 0.1, 1.0};

std::vector<WaterRow> elastic_rows(double slenderness, double nu, const Fineness& fine,
                                   const Catalogue& catalogue, Task& task) {
  const ClosedSpecimen specimen = elastic_specimen(slenderness, nu, fine);
  const ElasticTests tests = elastic_tests(fine.steps);
  const SpecimenCurve once = run_specimen(specimen, tests.at_once, catalogue, task.pulse());
  const SpecimenCurve rate = run_specimen(specimen, tests.at_a_rate, catalogue, task.pulse());
  for (const SpecimenCurve* curve : {&once, &rate})
    if (!curve->reason.empty()) throw AnalysisError("S501", curve->reason);
  std::vector<WaterRow> rows{elastic_row("shut in", slenderness, nu, once.states.front())};
  for (const double time : kTimes)
    rows.push_back(elastic_row("at once", slenderness, nu, state_at(once, time)));
  rows.push_back(elastic_row("equalised", slenderness, nu, once.states.back()));
  for (const SpecimenState& state : rate.states) {
    rows.push_back(elastic_row("constant rate", slenderness, nu, state));
    rows.back().rate = rate.states.back().time;
  }
  return rows;
}

// ---- Cam clay ----

constexpr double kM = 1.2, kLambda = 0.2, kKappa = 0.04, kVolume = 2.0, kClayNu = 0.3, kCell = 100.0;
constexpr double kClayStrain = 0.15, kClaySlenderness = 2.0;
constexpr std::array<double, 4> kClayRates{0.0, 1.0, 10.0, 1000.0};  // time of the whole test; 0: water shut in
constexpr std::array<double, 4> kClayStrains{0.02, 0.05, 0.10, 0.15};

// Coefficient of consolidation 1 under small strains from the start.
ClosedSpecimen clay_specimen(double ocr, const Fineness& fine) {
  const double K = kVolume * kCell / kKappa, G = 1.5 * K * (1.0 - 2.0 * kClayNu) / (1.0 + kClayNu);
  return {.slenderness = kClaySlenderness,
          .skeleton = {"modified_cam_clay",
                       {{"M", kM},
                        {"lambda", kLambda},
                        {"kappa", kKappa},
                        {"specific_volume", kVolume},
                        {"poissons_ratio", kClayNu},
                        {"ocr", ocr}}},
          .permeability = 1.0 / (K + 4.0 / 3.0 * G),
          .cell = kCell,
          .columns = fine.columns,
          .element = fine.element};
}

// Of one rate; fewer where the run ends early.
std::vector<WaterRow> clay_rows(double ocr, double rate, const Fineness& fine, const Catalogue& catalogue,
                                Task& task, std::string* reason = nullptr) {
  const ClosedSpecimen specimen = clay_specimen(ocr, fine);
  const int steps = 30 * fine.steps;
  const SpecimenCurve curve =
      run_specimen(specimen, {{kClayStrain, rate, steps, 1.0}}, catalogue, task.pulse());
  const std::vector<FrictionlessState> point = frictionless_test(specimen, kClayStrain, steps, catalogue);
  std::vector<WaterRow> rows;
  for (std::size_t i = 0; i < curve.states.size(); ++i) {
    WaterRow row{"modified_cam_clay", rate > 0.0 ? "constant rate" : "shut in", kClaySlenderness, ocr, rate};
    row.at = curve.states[i];
    row.frictionless = point[std::min(i, point.size() - 1)];
    row.ratio = row.at.deviator / row.frictionless.deviator;
    rows.push_back(row);
  }
  if (reason != nullptr) *reason = curve.reason;
  return rows;
}

// ---- errors ----

// The row of the same specimen, test and moment; nullptr = it has none.
const WaterRow* like(const WaterRow& row, const std::vector<WaterRow>& others) {
  const auto same = [&](const WaterRow& other) {
    return other.test == row.test && other.rate == row.rate &&
           std::abs(other.at.time - row.at.time) <= 1e-9 * row.at.time &&
           std::abs(other.at.strain - row.at.strain) <= 1e-9 * row.at.strain;
  };
  const auto found = std::ranges::find_if(others, same);
  return found == others.end() ? nullptr : &*found;
}

// Keeps what all have in common.
void add_errors(std::vector<WaterRow>& rows, const std::vector<std::vector<WaterRow>>& others) {
  std::erase_if(rows, [&](const WaterRow& row) {
    return std::ranges::any_of(others, [&](const auto& other) { return like(row, other) == nullptr; });
  });
  for (WaterRow& row : rows)
    for (const std::vector<WaterRow>& other : others)
      row.error = std::max(row.error, std::abs(like(row, other)->ratio - row.ratio));
}

// A coarser mesh, half of the steps, another element.
template <class Compute>
std::vector<WaterRow> with_errors(const Fineness& fine, const Compute& compute) {
  std::vector<WaterRow> rows = compute(fine);
  Fineness coarse = fine, few = fine, other = fine;
  coarse.columns = 2 * fine.columns / 3;
  few.steps = fine.steps / 2;
  other.element = fine.element == "quad9p4" ? "quad8p4" : "quad9p4";
  add_errors(rows, {compute(coarse), compute(few), compute(other)});
  return rows;
}

// ---- what is printed ----

// The first row of a test at a time; nullptr = there is none.
const WaterRow* row_at(const std::vector<WaterRow>& rows, const std::string& test, double time) {
  const auto found = std::ranges::find_if(rows, [&](const WaterRow& row) {
    return row.test == test && (time == 0.0 || std::abs(row.at.time / time - 1.0) < 1e-6);
  });
  return found == rows.end() ? nullptr : &*found;
}

// Time by which 95 % of what moving water changes has changed, in a test at constant rate; NaN = none of the rows.
double time_of_equalisation(const std::vector<WaterRow>& rows) {
  const double first = row_at(rows, "shut in", 0.0)->ratio, last = row_at(rows, "equalised", 0.0)->ratio;
  const WaterRow* before = nullptr;
  for (const WaterRow& row : rows) {
    if (row.test != "constant rate") continue;
    const auto left = [&](const WaterRow& r) { return std::log((r.ratio - last) / (first - last)); };
    const double target = std::log(0.05);
    if (before != nullptr && left(row) <= target) {
      const double share = (target - left(*before)) / (left(row) - left(*before));
      return before->at.time * std::pow(row.at.time / before->at.time, share);
    }
    before = &row;
  }
  return std::nan("");
}

double largest_error(const std::vector<WaterRow>& rows) {
  double largest = 0.0;
  for (const WaterRow& row : rows)
    if (row.test != "constant rate" || row.at.time > 0.5 * kTimes.front())
      largest = std::max(largest, row.error);
  return largest;
}

void print_elastic(const std::vector<std::vector<WaterRow>>& specimens) {
  fmt::print(
      "\nTable 7.3 with water: elastic skeleton, closed specimen, pinned ends.\n"
      "Measured axial stress over that without friction.  T = c t / a^2, c the\n"
      "coefficient of consolidation, a the radius.\n"
      "{:<11}{:>9}{:>30}{:>9}{:>9}\n{:<11}{:>9}{:>10}{:>10}{:>10}{:>9}{:>9}\n",
      "", "water", "free to move, pushed at once", "in the", "its", "nu'   L/D", "shut in", "T = .01", "T = .1",
      "T = 1", "end", "error");
  for (const auto& rows : specimens) {
    fmt::print("{:<6.3f}{:<5g}{:9.5f}", rows.front().parameter, rows.front().slenderness, rows.front().ratio);
    for (const double time : kTimes) fmt::print("{:10.5f}", row_at(rows, "at once", time)->ratio);
    fmt::print("{:9.5f}{:9.0e}\n", row_at(rows, "equalised", 0.0)->ratio, largest_error(rows));
  }
}

void print_pressures(const std::vector<std::vector<WaterRow>>& specimens) {
  fmt::print(
      "\nPore pressures over that without friction, shut in and in the end; 95 % of the\n"
      "change at constant rate takes T95 (h: half of the length).\n"
      "{:<11}{:>27}{:>12}{:>11}\n{:<11}{:>9}{:>9}{:>9}{:>12}{:>11}{:>10}\n",
      "", "water shut in", "in the end,", "T95 =", "nu'   L/D", "platen", "middle", "mean", "everywhere",
      "c t / a^2", "c t / h^2");
  for (const auto& rows : specimens) {
    const WaterRow& shut = rows.front();
    const double correct = shut.frictionless.pressure, T95 = time_of_equalisation(rows), L = shut.slenderness;
    fmt::print("{:<6.3f}{:<5g}{:9.3f}{:9.3f}{:9.3f}{:12.4f}{:11.2f}{:10.2f}\n", shut.parameter, L,
               shut.at.pressure_end / correct, shut.at.pressure_middle / correct,
               shut.at.pressure_mean / correct, row_at(rows, "equalised", 0.0)->at.pressure_mean / correct, T95,
               T95 / (L * L));
  }
  fmt::print(
      "Beside them, in c t / h^2: 1.6 for undrained tests (Blight 1963, as it is\n"
      "commonly quoted); 20 / eta for drained ones (Bishop & Gibson 1963), that is\n"
      "26.7 with one end drained and 6.7 with both.\n");
}

void print_clay(const std::vector<std::vector<WaterRow>>& specimens) {
  fmt::print(
      "\nTable 7.4 with water: modified Cam clay, L/D = 2, cell pressure {:g}, M {:g},\n"
      "lambda {:g}, kappa {:g}, nu' {:g}.  Measured / correct deviator, in tests of the\n"
      "duration T_f = c t_f / a^2.  Pressures, of the slowest test and the correct one,\n"
      "over the cell pressure.\n"
      "{:<13}{:>8}{:>28}{:>8}{:>23}\n{:<5}{:<8}{:>8}{:>8}{:>10}{:>10}{:>8}{:>8}{:>8}{:>7}\n",
      kCell, kM, kLambda, kKappa, kClayNu, "", "water", "free to move, T_f =", "its", "pore pressure", "OCR",
      "strain", "shut in", "1", "10", "1000", "error", "platen", "mean", "corr.");
  for (const auto& rows : specimens)
    for (const double strain : kClayStrains) {
      std::string line = fmt::format("{:<5g}{:<8.2f}", rows.empty() ? 0.0 : rows.front().parameter, strain);
      double error = 0.0;
      const WaterRow* slow = nullptr;
      for (std::size_t k = 0; k < kClayRates.size(); ++k) {
        const auto found = std::ranges::find_if(rows, [&](const WaterRow& row) {
          return row.rate == kClayRates[k] && std::abs(row.at.strain / strain - 1.0) < 1e-6;
        });
        const int width = k < 2 ? 8 : 10;
        slow = found == rows.end() ? nullptr : &*found;
        line +=
            slow == nullptr ? fmt::format("{:>{}}", "-", width) : fmt::format("{:{}.4f}", slow->ratio, width);
        if (slow != nullptr) error = std::max(error, slow->error);
      }
      line += fmt::format("{:8.0e}", error);
      if (slow != nullptr)
        line += fmt::format("{:8.3f}{:8.3f}{:7.3f}", slow->at.pressure_end / kCell,
                            slow->at.pressure_mean / kCell, slow->frictionless.pressure / kCell);
      fmt::print("{}\n", line);
    }
}

// ---- files ----

void write_csv(const std::vector<std::vector<WaterRow>>& specimens, const std::filesystem::path& path) {
  OutFile out(path);
  out.text() +=
      "# closed specimens between rough platens: radius 1, compression positive; ratio: deviator over that of "
      "a point\n"
      "# without friction; parameter: nu' of linear_elastic, OCR of modified_cam_clay; error: of the ratio, "
      "the largest\n"
      "# change by a coarser mesh, half of the steps and another element\n"
      "law,test,slenderness,parameter,test_time,time,strain,deviator,frictionless_deviator,ratio,error,"
      "pressure_platen,"
      "pressure_middle,pressure_rim,pressure_mean,frictionless_pressure\n";
  for (const auto& rows : specimens)
    for (const WaterRow& r : rows)
      out.text() +=
          fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.law, r.test, r.slenderness,
                      r.parameter, r.rate, r.at.time, r.at.strain, r.at.deviator, r.frictionless.deviator,
                      r.ratio, r.error, r.at.pressure_end, r.at.pressure_middle, r.at.pressure_rim,
                      r.at.pressure_mean, r.frictionless.pressure);
  out.finish();
}

Json row_json(const WaterRow& r) {
  return {{"law", r.law},
          {"test", r.test},
          {"slenderness", r.slenderness},
          {"parameter", r.parameter},
          {"test_time", r.rate},
          {"time", r.at.time},
          {"strain", r.at.strain},
          {"ratio", r.ratio},
          {"error", r.error},
          {"pressure_platen", r.at.pressure_end},
          {"pressure_middle", r.at.pressure_middle},
          {"pressure_rim", r.at.pressure_rim},
          {"pressure_mean", r.at.pressure_mean},
          {"frictionless_pressure", r.frictionless.pressure}};
}

std::vector<WaterRow> elastic_study(const WaterStudy& study, double slenderness, double nu,
                                    const std::filesystem::path& folder, const Catalogue& catalogue,
                                    Task& task) {
  write_study_model(specimen_input(elastic_specimen(slenderness, nu, study.elastic),
                                   elastic_tests(study.elastic.steps).at_once),
                    folder / fmt::format("closed_nu{:g}_ld{:g}.sage.toml", nu, slenderness), catalogue);
  return with_errors(study.elastic, [&](const Fineness& fine) {
    return elastic_rows(slenderness, nu, fine, catalogue, task);
  });
}

// ends: tests that ended early, with their reasons.
std::vector<WaterRow> clay_study(const WaterStudy& study, double ocr, const std::filesystem::path& folder,
                                 const Catalogue& catalogue, Task& task, std::vector<std::string>& ends) {
  write_study_model(specimen_input(clay_specimen(ocr, study.clay),
                                   {{kClayStrain, kClayRates.back(), 30 * study.clay.steps, 1.0}}),
                    folder / fmt::format("closed_clay_ocr{:g}.sage.toml", ocr), catalogue);
  std::vector<WaterRow> rows;
  for (const double rate : kClayRates) {
    std::string reason;
    const std::vector<WaterRow> found = with_errors(study.clay, [&](const Fineness& fine) {
      return clay_rows(ocr, rate, fine, catalogue, task, reason.empty() ? &reason : nullptr);
    });
    rows.insert(rows.end(), found.begin(), found.end());
    if (!reason.empty()) ends.push_back(fmt::format("OCR {:g}, T_f = {:g}: {}", ocr, rate, reason));
  }
  return rows;
}

}  // namespace

void print_water_tables(const WaterStudy& study, const std::filesystem::path& folder,
                        const Catalogue& catalogue) {
  Task task("tables --water");
  const auto count =
      static_cast<int>(study.poissons_ratios.size() * study.slenderness.size() + study.ocr.size());
  int number = 0;
  std::vector<std::vector<WaterRow>> elastic, clay;
  std::vector<std::string> ends;
  for (const double nu : study.poissons_ratios)
    for (const double slenderness : study.slenderness) {
      task.part(fmt::format("nu {:g}, L/D {:g}", nu, slenderness), ++number, count);
      elastic.push_back(elastic_study(study, slenderness, nu, folder, catalogue, task));
    }
  for (const double ocr : study.ocr) {
    task.part(fmt::format("OCR {:g}", ocr), ++number, count);
    clay.push_back(clay_study(study, ocr, folder, catalogue, task, ends));
  }
  const ProgressPause pause;
  print_elastic(elastic);
  print_pressures(elastic);
  print_clay(clay);
  for (const std::string& end : ends) fmt::print("{}\n", end);
  std::vector<std::vector<WaterRow>> all = elastic;
  all.insert(all.end(), clay.begin(), clay.end());
  write_csv(all, folder / "closed_specimens.csv");
  fmt::print("\nAll rows, with models beside them:\n{}\n", (folder / "closed_specimens.csv").string());
  if (Json* json = answer())
    for (const auto& rows : all)
      for (const WaterRow& row : rows) (*json)["water"].push_back(row_json(row));
}

}  // namespace sage::app
