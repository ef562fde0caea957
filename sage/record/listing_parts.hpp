// The parts of a listing, each appended to a text.
#pragma once

#include <iterator>
#include <string>

#include "sage/core/catalogue.hpp"
#include "sage/record/report.hpp"
#include "sage/record/values.hpp"

namespace sage::listing {

// The end of a text, where fmt appends.
inline auto to(std::string& text) {
  return std::back_inserter(text);
}

// "== TITLE ====..." with an empty line before it.
void heading(std::string& text, std::string_view title);
// "warning deck.dat:12: message", detail lines indented below.
void diagnostic(std::string& text, const Diagnostic& diagnostic);

// listing_header.cpp: what was read.
void banner(std::string& text, const Model& model, std::string_view date);
void description(std::string& text, const Model& model, const Scene& scene, std::string_view solver,
                 int equations);
void materials(std::string& text, const Model& model, const Catalogue& catalogue);
void groups(std::string& text, const Model& model);
void counts(std::string& text, const Model& model);
void stage(std::string& text, const Model& model, int stage);

// listing_tables.cpp: states, with the usual columns and those of the fields that were asked for.
void nodes(std::string& text, const Model& model, const Solution& solution,
           const std::vector<std::string>& asked);
void points(std::string& text, const Model& model, const Solution& solution,
            const std::vector<std::string>& asked);
// Of structures' elements; nothing where there are none.
void ends(std::string& text, const Model& model, const Solution& solution);

// listing_record.cpp: what was done.
void increment_columns(std::string& text);
void increment(std::string& text, const StepReport& report);
void audit(std::string& text, const Model& model, const EquilibriumAudit& audit);
// Places of the free surface of water; nothing where there is none.
void free_surface(std::string& text, const Model& model, const Solution& solution);
void report_rows(std::string& text, const Model& model, const Reports& reports);
void work(std::string& text, const RunResult& result);

}  // namespace sage::listing
